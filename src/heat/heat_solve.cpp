#include "heat/heat_solve.h"

#include <cmath>
#include <ctime>

namespace glisson::heat {
namespace {

constexpr int kMostIterations = 500;

}  // namespace

HeatSolver::HeatSolver(const HeatBody& body, Blocks& blocks) : body_(&body), blocks_(&blocks) {
  for (auto* of : {&r_, &p_, &q_, &inverse_}) of->resize(body.size());
  for (std::size_t i = 0; i < body.size(); ++i) begin_.push_back(body.links().begin[body.first_part(i)]);
  begin_.push_back(body.links().begin.back());
  if (body.tissues() == 1) return;
  for (auto* of : {&s_, &t_, &shadow_, &scaled_}) of->resize(body.size());
  z_.resize(body.part_count());
}

int HeatSolver::solve(const HeatMatrix& a, std::span<const double> b, double tolerance, std::vector<double>& y) {
  y.assign(body_->size(), 0.0);
  blocks_->run([&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) inverse_[i] = 1.0 / a.diagonal[i];
  });
  return a.ratio.empty() ? conjugate_gradients(a, b, tolerance, y) : stabilised_gradients(a, b, tolerance, y);
}

void HeatSolver::multiply(const HeatMatrix& a, const std::vector<double>& p, std::vector<double>& q) {
  const std::clock_t start = counts_time ? std::clock() : 0;
  std::span<const double> z = p;
  if (!a.ratio.empty()) {
    blocks_->run(body_->part_count(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) z_[k] = a.ratio[k] * p[body_->vertex_of(k)];
    });
    z = z_;
  }
  blocks_->run([&](std::size_t begin, std::size_t end) {
    const std::uint32_t *to = body_->links().to.data(), *first = begin_.data();
    const double *left = a.left.data(), *from = z.data();
    for (std::size_t i = begin; i < end; ++i) {
      double even = 0.0, odd = 0.0;  // two sums, as an addition takes longer than the next two loads
      std::uint32_t k = first[i];
      const std::uint32_t last = first[i + 1];
      for (; k + 1 < last; k += 2) even += left[k] * from[to[k]], odd += left[k + 1] * from[to[k + 1]];
      if (k < last) even += left[k] * from[to[k]];
      q[i] = a.fixed[i] != 0 ? 0.0 : a.diagonal[i] * p[i] - a.h * (even + odd);
    }
  });
  ++products;
  if (counts_time) seconds += static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

int HeatSolver::conjugate_gradients(const HeatMatrix& a, std::span<const double> b, double tolerance,
                                    std::vector<double>& y) {
  double rz = blocks_->sums<1>([&](std::size_t begin, std::size_t end) -> std::array<double, 1> {
    double sum = 0.0;
    for (std::size_t i = begin; i < end; ++i) r_[i] = b[i], p_[i] = b[i] * inverse_[i], sum += r_[i] * p_[i];
    return {sum};
  })[0];
  const double enough = tolerance * tolerance * rz;
  int k = 0;
  while (rz > enough && k < kMostIterations) {
    ++k;
    multiply(a, p_, q_);
    const double pq = blocks_->sums<1>([&](std::size_t begin, std::size_t end) -> std::array<double, 1> {
      double sum = 0.0;
      for (std::size_t i = begin; i < end; ++i) sum += p_[i] * q_[i];
      return {sum};
    })[0];
    const double alpha = rz / pq;
    const double next = blocks_->sums<1>([&](std::size_t begin, std::size_t end) -> std::array<double, 1> {
      double sum = 0.0;
      for (std::size_t i = begin; i < end; ++i) {
        y[i] += alpha * p_[i], r_[i] -= alpha * q_[i];
        sum += r_[i] * r_[i] * inverse_[i];
      }
      return {sum};
    })[0];
    const double beta = next / rz;
    rz = next;
    blocks_->run([&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) p_[i] = r_[i] * inverse_[i] + beta * p_[i];
    });
  }
  return k;
}

int HeatSolver::stabilised_gradients(const HeatMatrix& a, std::span<const double> b, double tolerance,
                                     std::vector<double>& y) {
  const auto dot = [&](const std::vector<double>& u, const std::vector<double>& v) {  // weighted by 1/D
    return blocks_->sums<1>([&](std::size_t begin, std::size_t end) -> std::array<double, 1> {
      double sum = 0.0;
      for (std::size_t i = begin; i < end; ++i) sum += u[i] * v[i] * inverse_[i];
      return {sum};
    })[0];
  };
  const auto scale = [&](const std::vector<double>& of) {
    blocks_->run([&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) scaled_[i] = of[i] * inverse_[i];
    });
  };
  std::copy(b.begin(), b.end(), r_.begin());
  shadow_ = r_, p_ = r_;
  double rho = dot(r_, shadow_);
  const double enough = tolerance * tolerance * rho;
  double left = rho;
  int k = 0;
  while (left > enough && k < kMostIterations) {
    ++k;
    scale(p_), multiply(a, scaled_, q_);
    const double alpha = rho / dot(q_, shadow_);
    blocks_->run([&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) s_[i] = r_[i] - alpha * q_[i], y[i] += alpha * scaled_[i];
    });
    scale(s_), multiply(a, scaled_, t_);
    const double tt = dot(t_, t_), omega = tt > 0.0 ? dot(t_, s_) / tt : 0.0;
    blocks_->run([&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) r_[i] = s_[i] - omega * t_[i], y[i] += omega * scaled_[i];
    });
    left = dot(r_, r_);
    const double next = dot(r_, shadow_);
    if (!(left > enough) || next == 0.0 || omega == 0.0) break;
    const double beta = next / rho * (alpha / omega);
    rho = next;
    blocks_->run([&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) p_[i] = r_[i] + beta * (p_[i] - omega * q_[i]);
    });
  }
  return k;
}

}  // namespace glisson::heat
