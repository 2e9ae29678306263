// envelope_cholesky.h — a Cholesky factor kept as dense rows, for small matrices that are solved with at every step.
//
// Rows are ordered by a breadth-first walk from the rim of the mesh [CuthillMcKee1969], so that each row's entries lie close
// before the diagonal, and all from the first to the diagonal are kept. More numbers than in a sparse factor, but they
// lie side by side: solving takes two streams over them and not a search for each. Eight rows are taken together, so that
// what they are multiplied with is read once.
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <cstdint>
#include <vector>

namespace glisson {

/// An order of the vertices of a graph in which neighbours are close: place of each vertex.
/// @param neighbours  per vertex, without itself
std::vector<std::uint32_t> close_order(const std::vector<std::vector<std::uint32_t>>& neighbours);

class EnvelopeCholesky {
 public:
  /// Numbers that the factor of a matrix would have.
  static std::size_t entries(const Eigen::SparseMatrix<double>& matrix);

  /// @param matrix  symmetric; both triangles are there
  /// @return false where it is not positive
  bool factorise(const Eigen::SparseMatrix<double>& matrix);
  /// x ← A⁻¹ x.
  void solve(Eigen::VectorXd& x) const;

 private:
  static constexpr int kPanelRows = 8;
  using Corner = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, kPanelRows, kPanelRows>;
  using Part = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kPanelRows, 1>;
  /// Rows [begin, begin + inverse.rows()) from column `first` on.
  struct Panel {
    Eigen::Index first, begin;
    std::size_t at;  ///< in values_: the rows up to `begin`, one after the other
    Corner inverse;  ///< of the lower triangle at the diagonal
  };
  void pack(const std::vector<Eigen::Index>& first, const std::vector<std::size_t>& begin,
            const std::vector<double>& rows, const std::vector<double>& inverse);

  std::vector<Panel> panels_;
  std::vector<double> values_;
};

}  // namespace glisson
