#include "contact/coupled_points.h"

#include <algorithm>
#include <map>

namespace glisson {
namespace {

/// Means whose columns give those of all points.
struct Basis {
  struct Part {
    std::size_t mean;
    double weight;
  };
  std::vector<StepMobility::Mean> means{};
  std::vector<std::vector<Part>> parts{};  ///< per point

  Basis(std::span<const StepMobility::Mean> points, std::span<const char> as_one) {
    std::map<std::uint32_t, std::size_t> of_vertex;
    for (std::size_t k = 0; k < points.size(); ++k) {
      std::vector<Part>& mine = parts.emplace_back();
      if (as_one[k] != 0) {
        mine.push_back({means.size(), 1.0});
        means.push_back(points[k]);
        continue;
      }
      for (const VertexWeight& w : points[k]) {
        const auto [known, is_new] = of_vertex.try_emplace(w.vertex, means.size());
        if (is_new) means.push_back({{w.vertex, 1.0}});
        mine.push_back({known->second, w.weight});
      }
    }
  }
};

}  // namespace

void CoupledPoints::add(std::span<const VertexWeight> mean, bool as_one, ToolYield* yields) {
  means_.emplace_back(mean.begin(), mean.end());
  as_one_.push_back(as_one ? 1 : 0);
  yields_.push_back(yields);
}

void CoupledPoints::couple(StepMobility& mobility, const InteractionStep& step, std::span<const Vec3d> free) {
  const Basis basis(means_, as_one_);
  const std::vector<const StepMobility::Column*> columns = mobility.columns(basis.means);
  std::vector<std::uint32_t> vertices;  // of all points, ascending
  for (const StepMobility::Mean& mean : means_) {
    for (const VertexWeight& w : mean) vertices.push_back(w.vertex);
  }
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  const auto number_of = [&](std::uint32_t v) {
    return static_cast<std::size_t>(std::lower_bound(vertices.begin(), vertices.end(), v) - vertices.begin());
  };
  std::vector<std::vector<std::pair<std::size_t, double>>> taken(size());
  v_.setZero(at(size()));
  for (std::size_t j = 0; j < size(); ++j) {
    for (const VertexWeight& w : means_[j]) {
      taken[j].emplace_back(number_of(w.vertex), w.weight);
      v_.segment<3>(at(j)) += w.weight * eigen(free[step.place_of[w.vertex]]);
    }
  }
  const double scale = 1.0 / (step.h * step.h);
  W_.setZero(at(size()), at(size()));
  StepMobility::Column moved(at(vertices.size()), 3);  // all these vertices, by a unit impulse on a point
  for (std::size_t k = 0; k < size(); ++k) {
    moved.setZero();
    for (const Basis::Part& part : basis.parts[k]) {
      const StepMobility::Column& whole = *columns[part.mean];
      for (std::size_t i = 0; i < vertices.size(); ++i) {
        moved.middleRows<3>(at(i)) += (part.weight * scale) * whole.middleRows<3>(at(vertices[i]));
      }
    }
    for (std::size_t j = 0; j < size(); ++j) {
      for (const auto& [vertex, weight] : taken[j]) {
        W_.block<3, 3>(at(j), at(k)) += weight * moved.middleRows<3>(at(vertex));
      }
    }
  }
  W_ = (0.5 * (W_ + W_.transpose())).eval();
  add_yields(step.h);
}

void CoupledPoints::add_yields(double h) {
  for (std::size_t k = 0; k < size(); ++k) {
    if (yields_[k] == nullptr) continue;
    const ToolYield& tool = *yields_[k];
    v_.segment<3>(at(k)) += eigen(tool.compliance * tool.force) / h;
    for (std::size_t j = 0; j < size(); ++j) {
      if (yields_[j] != yields_[k]) continue;
      for (std::size_t i = 0; i < 9; ++i) {
        W_(at(j) + static_cast<Eigen::Index>(i / 3), at(k) + static_cast<Eigen::Index>(i % 3)) +=
            tool.compliance(i / 3, i % 3) / (h * h);
      }
    }
  }
}

Vec3d CoupledPoints::own(std::size_t k, const Vec3d& impulse) const {
  const Eigen::Vector3d v = W_.block<3, 3>(at(k), at(k)) * eigen(impulse);
  return {v.x(), v.y(), v.z()};
}

Vec3d CoupledPoints::most_own(std::size_t k) const {
  const Eigen::Matrix3d own = W_.block<3, 3>(at(k), at(k));
  const double most = own.cwiseAbs().rowwise().sum().maxCoeff();  // no eigenvalue is above it
  Vec3d bound;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto axis = static_cast<Eigen::Index>(i);
    bound[i] = own(axis, axis) > 0.0 ? most : 0.0;
  }
  return bound;
}

void CoupledPoints::push(std::size_t k, const Vec3d& impulse) {
  v_.noalias() += W_.middleCols<3>(at(k)) * eigen(impulse);
}

void CoupledPoints::spread(std::size_t k, const Vec3d& impulse, const InteractionStep& step,
                           std::span<Vec3d> impulses) const {
  for (const VertexWeight& w : means_[k]) impulses[step.place_of[w.vertex]] += impulse * w.weight;
  if (yields_[k] != nullptr) yields_[k]->found -= impulse * (1.0 / step.h);
}

}  // namespace glisson
