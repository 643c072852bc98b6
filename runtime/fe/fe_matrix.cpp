#include "railtab/runtime/fe/fe_matrix.hpp"

#include <fmt/format.h>

#include <cmath>

#include "railtab/runtime/base/input_error.hpp"

namespace railtab {

namespace {

using Sparse = Eigen::SparseMatrix<double>;

constexpr double symmetry_tolerance = 1e-9;  // of the largest diagonal entry: what writing with ten digits leaves

}  // namespace

Sparse symmetric_mean(const std::filesystem::path& file, const Sparse& matrix, Eigen::Index rows) {
  const Eigen::Index expected = rows > 0 ? rows : matrix.rows();
  if (matrix.rows() != expected || matrix.cols() != expected) {
    throw input_error(file.string(), fmt::format("{} x {}", matrix.rows(), matrix.cols()),
                      fmt::format("{0} x {0}{1}", expected, rows > 0 ? ", as the others" : ", square"));
  }
  const Sparse transposed = matrix.transpose();
  const Sparse difference = matrix - transposed;
  const double bound = symmetry_tolerance * matrix.diagonal().cwiseAbs().maxCoeff();
  for (int column = 0; column < difference.outerSize(); ++column) {
    for (Sparse::InnerIterator entry(difference, column); entry; ++entry) {
      if (std::abs(entry.value()) <= bound) continue;
      throw input_error(fmt::format("{}: row {}, column {}", file.string(), entry.row() + 1, column + 1),
                        fmt::format("{} against {} at the mirrored place", matrix.coeff(entry.row(), column),
                                    matrix.coeff(column, entry.row())),
                        "a symmetric matrix");
    }
  }
  return 0.5 * (matrix + transposed);
}

void require_other_numbers(std::string_view key, const std::filesystem::path& file, const Sparse& matrix,
                           const std::filesystem::path& stiffness_file, const Sparse& stiffness) {
  if ((matrix - stiffness).norm() > 0.0) return;
  throw input_error(fmt::format("scene: {}", key),
                    fmt::format("{} with the numbers of {}", file.string(), stiffness_file.string()),
                    "another matrix than the stiffness");
}

}  // namespace railtab
