#pragma once

#include <Eigen/SparseCore>
#include <array>
#include <span>
#include <vector>

namespace railtab {

/// Ends of the cells that a line is divided into [m]: spans are cells of their own, since they move as wholes, and what
/// lies before, between and behind them is cut into pieces of about `length` [m].
/// @param x positions of the unknowns, not decreasing
[[nodiscard]] std::vector<double> line_cells(std::span<const double> x, std::span<const std::array<double, 2>> spans,
                                             double length);

/// Elimination order of a long and narrow structure for substitutions on a part of its length: cell by cell, minimum
/// degree within a cell, and the unknowns that join neighbouring cells last, by nested dissection [George1973]. The
/// factor is nearly as small as minimum degree alone makes it, and what a part of the line needs is its own cells and a
/// logarithmic number of joints.
/// @param matrix symmetric, lower triangle or full; x positions of its unknowns; ends of the cells [m]
/// @return the unknown that is eliminated k-th, for each k
[[nodiscard]] std::vector<int> cell_order(const Eigen::SparseMatrix<double>& matrix, std::span<const double> x,
                                          std::span<const double> ends);

}  // namespace railtab
