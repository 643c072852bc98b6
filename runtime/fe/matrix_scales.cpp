#include "railtab/runtime/fe/matrix_scales.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "railtab/runtime/base/input_error.hpp"

namespace railtab {

namespace {

using Sparse = Eigen::SparseMatrix<double>;
using RowText = std::function<std::string(Eigen::Index row)>;
using Eigen::Index;

constexpr std::string_view see_units = "see the units of the model";

std::string place(const FileMatrix& m, const RowText& row_text, Index row) {
  return fmt::format("{}: {}", m.file.string(), row_text(row));
}

void check_amounts(const FileMatrix& m, std::string_view name, double most, const RowText& row_text) {
  for (Index column = 0; column < m.matrix.outerSize(); ++column) {
    for (Sparse::InnerIterator entry(m.matrix, column); entry; ++entry) {
      if (std::abs(entry.value()) <= most) continue;
      throw input_error(fmt::format("{}, column {}", place(m, row_text, entry.row()), column + 1),
                        fmt::format("{} {:.6g}", name, entry.value()),
                        fmt::format("{:g} to {:g} in SI units ({})", -most, most, see_units));
    }
  }
}

void check_ratio(const FileMatrix& stiffness, double largest_ratio, const RowText& row_text) {
  const Eigen::VectorXd k = stiffness.matrix.diagonal();
  if (!((k.array() > 0.0).any())) return;  // other checks name what has no stiffness
  Index low = 0, high = 0;
  const double most = k.maxCoeff(&high);
  const double least = (k.array() > 0.0).select(k, most).minCoeff(&low);
  if (most <= largest_ratio * least) return;
  throw input_error(
      place(stiffness, row_text, high), fmt::format("stiffness {:.6g} beside {:.6g} in {}", most, least, row_text(low)),
      fmt::format("at most {:g} times as much: beyond that no digit of the softer one is left", largest_ratio));
}

void check_frequencies(const FileMatrix& mass, const FileMatrix& stiffness, const MatrixScales& scales,
                       const RowText& row_text) {
  const Eigen::VectorXd m = mass.matrix.diagonal(), k = stiffness.matrix.diagonal();
  const double least = m.size() == 0 ? 0.0 : scales.massless * m.maxCoeff();
  for (Index row = 0; row < m.size(); ++row) {
    if (!(m[row] > least) || !(k[row] > 0.0)) continue;
    const double frequency = std::sqrt(k[row] / m[row]) / (2.0 * std::numbers::pi);
    if (frequency >= scales.lowest_frequency && frequency <= scales.highest_frequency) continue;
    throw input_error(place(mass, row_text, row),
                      fmt::format("mass {:.6g} on stiffness {:.6g}, {:.3g} Hz", m[row], k[row], frequency),
                      fmt::format("{:g} to {:g} Hz of every row for itself: see {} and {}, and {}",
                                  scales.lowest_frequency, scales.highest_frequency, mass.file.filename().string(),
                                  stiffness.file.filename().string(), see_units));
  }
}

}  // namespace

void check_off_diagonals(const FileMatrix& m, std::string_view name, const RowText& row_text) {
  constexpr double writing = 1e-3, rounding = 1e-9;
  const Eigen::VectorXd diagonal = m.matrix.diagonal().cwiseMax(0.0);
  for (Index column = 0; column < m.matrix.outerSize(); ++column) {
    for (Sparse::InnerIterator entry(m.matrix, column); entry; ++entry) {
      if (entry.row() == column) continue;
      const double a = diagonal[entry.row()], b = diagonal[column];
      const double most = (1.0 + writing) * std::sqrt(a) * std::sqrt(b) + rounding * std::max(a, b);
      if (std::abs(entry.value()) <= most) continue;
      throw input_error(fmt::format("{}, column {}", place(m, row_text, entry.row()), column + 1),
                        fmt::format("{} {:.6g} with {:.6g} and {:.6g} on the diagonal", name, entry.value(),
                                    m.matrix.coeff(entry.row(), entry.row()), m.matrix.coeff(column, column)),
                        "an amount of at most the root of their product: a positive semidefinite matrix");
    }
  }
}

void check_scales(const FileMatrix& mass, const FileMatrix& damping, const FileMatrix& stiffness,
                  const MatrixScales& scales, const RowText& row_text) {
  check_amounts(mass, "mass", scales.largest_mass, row_text);
  check_amounts(damping, "damping", scales.largest_damping, row_text);
  check_amounts(stiffness, "stiffness", scales.largest_stiffness, row_text);
  check_ratio(stiffness, scales.largest_ratio, row_text);
  check_frequencies(mass, stiffness, scales, row_text);
}

}  // namespace railtab
