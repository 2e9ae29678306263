#include "dynamics/solvers/tangent_system.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace glisson {
namespace {

constexpr std::size_t kMostFactorised = 20000;  ///< tets up to which `automatic` factorises (docs/integrators.md)
constexpr int kWornOut = 15;                    ///< iterations after which the factor is made anew
constexpr int kMostIterations = 2000;
constexpr double kLeastModulus = 1e-9;  ///< of the largest of all vertices: one that is not positive counts as that
constexpr double kAsymmetry = 1e-9;     ///< of an element's tangent, relative, up to which it counts as symmetric

bool linear_tissue(const TissueBlock& block) {
  return block.tissue.has_small_strain() && block.tissue.has_constant_moduli();
}

bool is_symmetric(const TissueTangent& tangent) {
  for (std::size_t e = 0; e < tangent.local.size(); ++e) {
    const ElementTangent& C = tangent.local[e];
    const double size = C.lpNorm<Eigen::Infinity>();
    if ((C - C.transpose()).lpNorm<Eigen::Infinity>() > kAsymmetry * size) return false;
    if (tangent.volume.empty()) continue;
    for (std::size_t i = 0; i < 9; ++i) {
      const double own = tangent.modulus[e] * tangent.volume[e](i / 3, i % 3);
      if (std::abs(tangent.pressure[e](i / 3, i % 3) - own) > kAsymmetry * size) return false;
    }
  }
  return true;
}

/// The element's C with the bulk that it shares as if it were its own.
ElementTangent whole_tangent(const TissueTangent& tangent, std::size_t e) {
  using Nine = Eigen::Map<const Eigen::Matrix<double, 9, 1>>;
  ElementTangent C = tangent.local[e];
  if (!tangent.volume.empty())
    C += Nine(tangent.pressure[e].m[0].data()) * Nine(tangent.volume[e].m[0].data()).transpose();
  return C;
}

/// V s_a C s_b, symmetric part over the pair: the 3 × 3 block of vertices a and b.
Eigen::Matrix3d block_of(const ElementTangent& C, double volume, const Vec3d& a, const Vec3d& b) {
  Eigen::Matrix3d K;
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index k = 0; k < 3; ++k) {
      double sum = 0.0;
      for (Eigen::Index j = 0; j < 3; ++j) {
        const Eigen::Index row = 3 * i + j, column = 3 * k;
        const double along = C(row, column) * b.x + C(row, column + 1) * b.y + C(row, column + 2) * b.z;
        sum += a[static_cast<std::size_t>(j)] * along;
      }
      K(i, k) = volume * sum;
    }
  }
  return K;
}

}  // namespace

TangentSystem::TangentSystem(const TissueOperator& tissue, Preconditioner preconditioner, StepInterrupt& interrupt)
    : tissue_(tissue), interrupt_(interrupt),
      factorises_(preconditioner == Preconditioner::factorised ||
                  (preconditioner == Preconditioner::automatic && tissue.body().elements.size() <= kMostFactorised)) {
  tissues_changed();
}

void TangentSystem::tissues_changed() {
  const std::vector<TissueBlock>& blocks = tissue_.body().blocks;
  linear_ = std::all_of(blocks.begin(), blocks.end(), linear_tissue);
}

void TangentSystem::set_free(std::vector<char> free) {
  free_ = std::move(free);
  x_.assign(free_.size() / 3, Vec3d{});
  y_.assign(free_.size() / 3, Vec3d{});
  known_ = has_pattern_ = has_factor_ = current_ = false;
}

void TangentSystem::linearise(const TissueState& state, const Terms& terms, bool semidefinite, bool anew) {
  const bool same = (linear_ || !anew) && terms.rate == terms_.rate && state.since == state_.since;
  const bool stiffened = !terms.triangles.empty() || !triangles_.empty() || !terms.tets.empty() || !tets_.empty();
  current_ = current_ && same && terms.weight == terms_.weight && !stiffened &&
             std::equal(diagonal_.begin(), diagonal_.end(), terms.diagonal.begin(), terms.diagonal.end());
  diagonal_.assign(terms.diagonal.begin(), terms.diagonal.end());
  terms_ = terms;
  terms_.diagonal = diagonal_;
  loads_.assign(terms.loads.begin(), terms.loads.end());
  terms_.loads = loads_;
  triangles_.assign(terms.triangles.begin(), terms.triangles.end());
  terms_.triangles = triangles_;
  known_ = known_ && tets_.empty() && terms.tets.empty();
  tets_.assign(terms.tets.begin(), terms.tets.end());
  terms_.tets = tets_;
  state_ = state;
  if (same && known_) return;
  tissue_.linearise(state, terms.rate, semidefinite, tangent_);
  add_tets(tangent_, semidefinite);
  symmetric_ = is_symmetric(tangent_);
  known_ = true;
}

/// Adds what interactions do to the stress of tets.
void TangentSystem::add_tets(TissueTangent& tangent, bool semidefinite) {
  if (tets_.empty()) return;
  const std::vector<std::uint32_t>& tet_of = tissue_.body().mesh_tet;
  if (element_of_.empty()) {
    element_of_.resize(tet_of.size());
    for (std::uint32_t e = 0; e < tet_of.size(); ++e) element_of_[tet_of[e]] = e;
  }
  for (const TetStiffness& t : tets_) {
    ElementTangent& C = tangent.local[element_of_[t.tet]];
    C += Eigen::Map<const ElementTangent>(t.slope.data());
    if (semidefinite) make_semidefinite(C);
  }
}

void TangentSystem::apply(std::span<const Vec3d> x, std::span<Vec3d> y) const {
  tissue_.apply(tangent_, x, y);
  for (const FaceStiffness& face : loads_) {
    Vec3d force{};
    for (std::size_t a = 0; a < 3; ++a) force += face.slope[a] * x[face.corners[a]];
    for (const std::uint32_t v : face.corners) y[v] -= force;
  }
  for (const TriangleStiffness& t : triangles_) {
    for (std::size_t a = 0; a < 3; ++a) {
      for (std::size_t b = 0; b < 3; ++b) y[t.corners[a]] += t.blocks[a][b] * x[t.corners[b]];
    }
  }
  for (std::size_t i = 0; i < x.size(); ++i) y[i] = y[i] * terms_.weight + component_product(diagonal_[i], x[i]);
}

/// Where an entry of the pattern is among the values.
int TangentSystem::place_in(int row, int column) const {
  const int* begin = f_->matrix.innerIndexPtr() + f_->matrix.outerIndexPtr()[column];
  const int* end = f_->matrix.innerIndexPtr() + f_->matrix.outerIndexPtr()[column + 1];
  return static_cast<int>(std::lower_bound(begin, end, row) - f_->matrix.innerIndexPtr());
}

/// Rows of the pressures, one for each vertex of each tissue that shares its volume changes.
void TangentSystem::find_pressures() {
  const Body& body = tissue_.body();
  f_->pressures = 0;
  f_->pressure.clear();
  for (const TissueBlock& block : body.blocks) {
    if (block.tissue.volume_change != VolumeChange::average_nodal) continue;
    f_->pressure.resize(body.elements.size(), {-1, -1, -1, -1});
    std::vector<int> of_vertex(body.vertex_count, -1);
    for (std::size_t e = block.begin; e < block.end; ++e) {
      for (std::size_t a = 0; a < 4; ++a) {
        int& row = of_vertex[body.elements[e][a]];
        if (row < 0) row = f_->unknowns + f_->pressures++;
        f_->pressure[e][a] = row;
      }
    }
  }
}

/// Which entries the lower triangle of A has on the free components, and where each element's go.
void TangentSystem::find_pattern() {
  if (f_.use_count() > 1) f_ = std::make_shared<Factored>();
  const Body& body = tissue_.body();
  f_->number.assign(free_.size(), -1);
  f_->unknowns = 0;
  for (std::size_t c = 0; c < free_.size(); ++c) f_->number[c] = free_[c] != 0 ? f_->unknowns++ : -1;
  find_pressures();
  const int rows = f_->unknowns + f_->pressures;
  std::vector<Eigen::Triplet<double>> entries;
  const auto visit = [&](auto&& act) {
    for (std::size_t e = 0; e < body.elements.size(); ++e) {
      for (std::size_t r = 0; r < 12; ++r) {
        for (std::size_t c = 0; c < 12; ++c) {
          const int row = f_->number[3 * body.elements[e][r / 3] + r % 3],
                    column = f_->number[3 * body.elements[e][c / 3] + c % 3];
          act(e, 12 * r + c, row, column);
        }
      }
    }
  };
  const auto visit_pressures = [&](auto&& act) {
    for (std::size_t e = 0; e < f_->pressure.size(); ++e) {
      for (std::size_t entry = 0; entry < 48; ++entry) {
        const std::size_t c = entry % 12;
        act(e, entry, f_->pressure[e][entry / 12], f_->number[3 * body.elements[e][c / 3] + c % 3]);
      }
    }
  };
  const auto take = [&](std::size_t, std::size_t, int row, int column) {
    if (column >= 0 && row >= column) entries.emplace_back(row, column, 0.0);
  };
  visit(take), visit_pressures(take);
  for (int r = 0; r < rows; ++r) entries.emplace_back(r, r, 0.0);
  f_->matrix.resize(rows, rows);
  f_->matrix.setFromTriplets(entries.begin(), entries.end());
  const auto place = [&](int row, int column) { return place_in(row, column); };
  f_->position.resize(body.elements.size());
  visit([&](std::size_t e, std::size_t entry, int row, int column) {
    f_->position[e][entry] = column >= 0 && row >= column ? place(row, column) : -1;
  });
  f_->pressure_position.resize(f_->pressure.size());
  visit_pressures([&](std::size_t e, std::size_t entry, int row, int column) {
    f_->pressure_position[e][entry] = column >= 0 && row >= column ? place(row, column) : -1;
  });
  f_->diagonal_position.resize(static_cast<std::size_t>(rows));
  for (int r = 0; r < rows; ++r) f_->diagonal_position[static_cast<std::size_t>(r)] = place(r, r);
  f_->knows_entries = false;
  has_pattern_ = true;
}

void TangentSystem::assemble(const TissueTangent& tangent) {
  const Body& body = tissue_.body();
  double* values = f_->matrix.valuePtr();
  std::fill_n(values, f_->matrix.nonZeros(), 0.0);
  for (std::size_t e = 0; e < body.elements.size(); ++e) {
    ElementTangent C = tangent.local[e];
    C = (0.5 * terms_.weight * (C + C.transpose())).eval();
    const std::array<Vec3d, 4> s = shape_gradients(body.rest[e]);
    for (std::size_t a = 0; a < 4; ++a) {
      for (std::size_t b = 0; b < 4; ++b) {
        const Eigen::Matrix3d K = block_of(C, body.rest[e].volume, s[a], s[b]);
        for (std::size_t entry = 0; entry < 9; ++entry) {
          const int at = f_->position[e][12 * (3 * a + entry / 3) + 3 * b + entry % 3];
          if (at >= 0) values[at] += K(static_cast<Eigen::Index>(entry / 3), static_cast<Eigen::Index>(entry % 3));
        }
      }
    }
  }
  for (std::size_t c = 0; c < f_->number.size(); ++c) {
    if (f_->number[c] >= 0)
      values[f_->diagonal_position[static_cast<std::size_t>(f_->number[c])]] += diagonal_[c / 3][c % 3];
  }
}

/// What couples displacements by pressures. A modulus that is not the same in all tets at a vertex is taken as their mean.
void TangentSystem::assemble_pressures(const TissueTangent& tangent) {
  const Body& body = tissue_.body();
  double* values = f_->matrix.valuePtr();
  std::vector<double> volume(static_cast<std::size_t>(f_->pressures)), along(volume.size()), square(volume.size());
  for (std::size_t e = 0; e < f_->pressure.size(); ++e) {
    if (f_->pressure[e][0] < 0) continue;
    const Mat3d& rise = tangent.volume[e];
    const double V = body.rest[e].volume;
    const std::array<Vec3d, 4> s = shape_gradients(body.rest[e]);
    std::array<Vec3d, 4> b;
    for (std::size_t a = 0; a < 4; ++a) b[a] = (rise * s[a]) * (0.25 * V * terms_.weight);
    for (std::size_t entry = 0; entry < 48; ++entry) {
      const int at = f_->pressure_position[e][entry];
      if (at >= 0) values[at] += b[entry % 12 / 3][entry % 3];
    }
    for (const int row : f_->pressure[e]) {
      const auto at = static_cast<std::size_t>(row - f_->unknowns);
      volume[at] += V;
      along[at] += V * trace(transposed_product(tangent.pressure[e], rise));
      square[at] += V * trace(transposed_product(rise, rise));
    }
  }
  double largest = std::numeric_limits<float>::min();  // ν = 0: the pressures do nothing
  for (std::size_t at = 0; at < volume.size(); ++at) largest = std::max(largest, along[at] / square[at]);
  for (std::size_t at = 0; at < volume.size(); ++at) {
    const double modulus = std::max(along[at] / square[at], kLeastModulus * largest);
    values[f_->diagonal_position[static_cast<std::size_t>(f_->unknowns) + at]] -=
        terms_.weight * volume[at] / (4.0 * modulus);
  }
}

/// Triangles are faces of tets: the pattern has their entries.
void TangentSystem::assemble_triangles() {
  double* values = f_->matrix.valuePtr();
  for (const TriangleStiffness& t : triangles_) {
    for (std::size_t r = 0; r < 9; ++r) {
      for (std::size_t c = 0; c < 9; ++c) {
        const int row = f_->number[3 * t.corners[r / 3] + r % 3], column = f_->number[3 * t.corners[c / 3] + c % 3];
        if (column < 0 || row < column) continue;
        values[place_in(row, column)] += terms_.weight * t.blocks[r / 3][c / 3](r % 3, c % 3);
      }
    }
  }
}

bool TangentSystem::factorise(const TissueTangent& tangent) {
  if (f_.use_count() > 1) {  // a saved state has it
    if (spare_ == nullptr) spare_ = std::make_shared<Factored>();
    *spare_ = *f_;
    f_ = std::move(spare_);
  }
  assemble(tangent);
  assemble_pressures(tangent);
  assemble_triangles();
  return take_factor();
}

bool TangentSystem::take_factor() {
  f_->solved.reset();
  if (std::exchange(f_->knows_entries, true)) return f_->factor.factorise_again(f_->matrix, &interrupt_);
  return f_->factor.factorise(f_->matrix, f_->pressures, &interrupt_);
}

void TangentSystem::refresh() {
  if (!has_pattern_) find_pattern();
  has_factor_ = factorise(tangent_);
  if (!has_factor_ && !interrupt_.is_wanted()) {
    TissueTangent definite;
    tissue_.linearise(state_, terms_.rate, true, definite);
    add_tets(definite, true);
    has_factor_ = factorise(definite);
  }
  if (interrupt_.is_wanted()) {
    has_factor_ = current_ = false;
    return;
  }
  current_ = true;
  ++factor_number_;
  if (!has_factor_) find_blocks();
}

void TangentSystem::find_blocks() {
  const Body& body = tissue_.body();
  std::vector<Eigen::Matrix3d> sum(body.vertex_count, Eigen::Matrix3d::Zero());
  for (std::size_t e = 0; e < body.elements.size(); ++e) {
    const ElementTangent C = whole_tangent(tangent_, e);
    const std::array<Vec3d, 4> s = shape_gradients(body.rest[e]);
    for (std::size_t a = 0; a < 4; ++a) {
      const Eigen::Matrix3d K = block_of(C, body.rest[e].volume * terms_.weight, s[a], s[a]);
      sum[body.elements[e][a]] += 0.5 * (K + K.transpose());
    }
  }
  for (const TriangleStiffness& t : triangles_) {
    for (std::size_t a = 0; a < 3; ++a) {
      for (std::size_t i = 0; i < 9; ++i) {
        sum[t.corners[a]](static_cast<Eigen::Index>(i / 3), static_cast<Eigen::Index>(i % 3)) +=
            terms_.weight * t.blocks[a][a](i / 3, i % 3);
      }
    }
  }
  inverse_blocks_.resize(sum.size());
  for (std::size_t i = 0; i < sum.size(); ++i) {
    sum[i].diagonal() += Eigen::Vector3d(diagonal_[i].x, diagonal_[i].y, diagonal_[i].z);
    const Eigen::Vector3d diagonal = sum[i].diagonal();
    for (Eigen::Index a = 0; a < 3; ++a) {
      if (free_[3 * i + static_cast<std::size_t>(a)] != 0) continue;
      sum[i].row(a).setZero(), sum[i].col(a).setZero();
      sum[i](a, a) = 1.0;
    }
    const Eigen::LLT<Eigen::Matrix3d> llt(sum[i]);
    if (llt.info() == Eigen::Success) {
      inverse_blocks_[i] = llt.solve(Eigen::Matrix3d::Identity());
    } else {
      const Eigen::Vector3d safe = diagonal.cwiseAbs().cwiseMax(1e-12 * diagonal.cwiseAbs().maxCoeff() + 1e-300);
      inverse_blocks_[i] = safe.cwiseInverse().asDiagonal();
    }
  }
}

void TangentSystem::precondition(const Eigen::VectorXd& r, Eigen::VectorXd& z) const {
  if (has_factor_) {
    moved_ = r;
    factor_solve(moved_);
    z = moved_.col(0);
    return;
  }
  z.setZero(r.size());
  for (std::size_t i = 0; i < inverse_blocks_.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(3 * i);
    z.segment<3>(at) = inverse_blocks_[i] * r.segment<3>(at);
    for (Eigen::Index a = 0; a < 3; ++a) {
      if (free_[3 * i + static_cast<std::size_t>(a)] == 0) z[at + a] = 0.0;
    }
  }
}

void TangentSystem::factor_solve(Eigen::MatrixXd& x) const {
  packed_.setZero(f_->matrix.rows(), x.cols());
  for (std::size_t c = 0; c < f_->number.size(); ++c) {
    if (f_->number[c] >= 0) packed_.row(f_->number[c]) = x.row(static_cast<Eigen::Index>(c));
  }
  f_->factor.solve(packed_);
  for (std::size_t c = 0; c < f_->number.size(); ++c) {
    if (f_->number[c] >= 0) {
      x.row(static_cast<Eigen::Index>(c)) = packed_.row(f_->number[c]);
    } else {
      x.row(static_cast<Eigen::Index>(c)).setZero();
    }
  }
}

/// The matrix that was factorised, and for which terms: iterations go on with it to the last bit.
void TangentSystem::archive(Archive& ar) {
  ar(has_factor_, current_, terms_.rate, terms_.weight, state_.since, diagonal_);
  ar.check(diagonal_.empty() || 3 * diagonal_.size() == free_.size());
  if (!has_factor_ || ar.in_memory()) return;
  if (ar.reads()) find_pattern();
  std::vector<double> values(f_->matrix.valuePtr(), f_->matrix.valuePtr() + f_->matrix.nonZeros());
  ar.same_size(values);
  if (!ar.reads()) return;
  std::copy(values.begin(), values.end(), f_->matrix.valuePtr());
  has_factor_ = take_factor();
  ++factor_number_;
}

std::shared_ptr<const void> TangentSystem::save_factor() const {
  return has_factor_ ? std::shared_ptr<const void>(f_) : nullptr;
}

void TangentSystem::load_factor(const std::shared_ptr<const void>& factor) {
  if (factor == nullptr) return;
  has_pattern_ = true;
  if (f_ == factor) return;  // what was solved with it still holds
  if (f_.use_count() == 1) spare_ = std::move(f_);
  f_ = std::const_pointer_cast<Factored>(std::static_pointer_cast<const Factored>(factor));
  ++factor_number_;
}

KrylovResult TangentSystem::solve(const Eigen::VectorXd& b, double tolerance, Eigen::VectorXd& x) {
  const auto product = [&](const Eigen::VectorXd& in, Eigen::VectorXd& out) {
    flat(std::span<Vec3d>(x_)) = in;
    apply(x_, y_);
    out = flat(std::span<const Vec3d>(y_));
    for (std::size_t c = 0; c < free_.size(); ++c) {
      if (free_[c] == 0) out[static_cast<Eigen::Index>(c)] = 0.0;
    }
  };
  const auto nearly = [&](const Eigen::VectorXd& r, Eigen::VectorXd& z) { precondition(r, z); };
  const auto stops = [&] { return interrupt_.wanted(); };
  const auto run = [&](int most) {
    return symmetric_ && loads_.empty() ? conjugate_gradients(product, nearly, b, tolerance, most, x, stops)
                                        : bicgstab(product, nearly, b, tolerance, most, x, stops);
  };
  if (!factorises_) {
    find_blocks();
    return run(kMostIterations);
  }
  if (has_factor_ && !current_) {  // an earlier factor: good as long as few iterations do
    const KrylovResult old = run(kWornOut);
    if (old.converged) return old;
  }
  if (!current_) refresh();
  if (interrupt_.is_wanted()) {
    x = Eigen::VectorXd::Zero(b.size());
    return {};
  }
  return run(has_factor_ ? kMostIterations / 10 : kMostIterations);
}

}  // namespace glisson
