// heat_solve.h — the linear system of one iteration, never assembled: a diagonal and the rows of links that are there anyway.
//
//   A y = D y − h Σ left (y_q r_q),    r = k of a part over the mean of its vertex, 1 with one tissue, where A is symmetric
//
// Conjugate gradients, or BiCGSTAB where vertices are of several tissues, by the diagonal. Rows are summed in a fixed order.
#pragma once

#include <span>
#include <vector>

#include "heat/blocks.h"
#include "heat/heat_body.h"

namespace glisson::heat {

struct HeatMatrix {
  double h = 0.0;                    ///< [s]
  std::span<const double> diagonal;  ///< D, of each vertex
  std::span<const double> left;      ///< of each link [m]
  std::span<const double> ratio;     ///< r of each part; empty: 1
  std::span<const char> fixed;       ///< of vertices that do not change
};

class HeatSolver {
 public:
  HeatSolver(const HeatBody& body, Blocks& blocks);

  /// Solves A y = b, where b is 0 at fixed vertices. @param tolerance  of the residual, relative, weighted by 1/D
  /// @param y  the result @return iterations, each of one product or two
  int solve(const HeatMatrix& a, std::span<const double> b, double tolerance, std::vector<double>& y);

  std::size_t products = 0;
  double seconds = 0.0;  ///< in products, of all threads, where they are counted
  bool counts_time = false;

 private:
  /// q = A p.
  void multiply(const HeatMatrix& a, const std::vector<double>& p, std::vector<double>& q);
  int conjugate_gradients(const HeatMatrix& a, std::span<const double> b, double tolerance, std::vector<double>& y);
  int stabilised_gradients(const HeatMatrix& a, std::span<const double> b, double tolerance, std::vector<double>& y);

  const HeatBody* body_;
  Blocks* blocks_;
  std::vector<double> r_, p_, q_, s_, t_, shadow_, scaled_, z_, inverse_;
  std::vector<std::uint32_t> begin_;  // of the links of each vertex
};

}  // namespace glisson::heat
