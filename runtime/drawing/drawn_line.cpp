#include "railtab/runtime/drawing/drawn_line.hpp"

#include <algorithm>
#include <cmath>

#include "railtab/runtime/base/dense_solvers.hpp"

namespace railtab::drawing {
namespace {

struct Knot {
  double x = 0.0;
  std::optional<int> node;
};

/// Recorded nodes and points at rest in order, one of each place; what is recorded goes first.
std::vector<Knot> knots_of(const std::vector<double>& nodes, const std::vector<double>& rests) {
  std::vector<Knot> knots;
  for (std::size_t i = 0; i < nodes.size(); ++i) knots.push_back({nodes[i], static_cast<int>(i)});
  for (const double x : rests) knots.push_back({x, std::nullopt});
  std::stable_sort(knots.begin(), knots.end(), [](const Knot& a, const Knot& b) { return a.x < b.x; });
  constexpr double one_place = 1e-6;  // [m]
  std::vector<Knot> single;
  for (const Knot& knot : knots) {
    if (single.empty() || knot.x - single.back().x > one_place) {
      single.push_back(knot);
    } else if (!single.back().node) {
      single.back() = knot;
    }
  }
  return single;
}

/// Second derivatives of the natural cubic spline at its knots, by the values there.
Eigen::MatrixXd bending(const std::vector<Knot>& knots) {
  const auto n = static_cast<Eigen::Index>(knots.size());
  Eigen::MatrixXd A = Eigen::MatrixXd::Identity(n, n), B = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index i = 1; i + 1 < n; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const double before = knots[k].x - knots[k - 1].x, after = knots[k + 1].x - knots[k].x;
    A(i, i - 1) = before;
    A(i, i) = 2.0 * (before + after);
    A(i, i + 1) = after;
    B(i, i - 1) = 6.0 / before;
    B(i, i) = -6.0 / before - 6.0 / after;
    B(i, i + 1) = 6.0 / after;
  }
  return dense_solution(A, B);
}

}  // namespace

DrawnLine drawn_line(const std::vector<double>& nodes, const std::vector<double>& rests, double spacing) {
  const std::vector<Knot> knots = knots_of(nodes, rests);
  const auto count = static_cast<Eigen::Index>(knots.size());
  const Eigen::MatrixXd m = bending(knots);
  std::vector<Eigen::RowVectorXd> rows;  // by the values at the knots
  DrawnLine line;
  for (Eigen::Index i = 0; i < count; ++i) {
    const Knot& knot = knots[static_cast<std::size_t>(i)];
    line.x.push_back(knot.x);
    line.of.push_back(knot.node);
    rows.emplace_back(Eigen::RowVectorXd::Unit(count, i));
    if (i + 1 == count) break;
    const double h = knots[static_cast<std::size_t>(i + 1)].x - knot.x;
    const int parts = std::max(1, static_cast<int>(std::ceil(h / spacing)));
    for (int p = 1; p < parts; ++p) {
      const double b = static_cast<double>(p) / parts, a = 1.0 - b;
      Eigen::RowVectorXd row = h * h / 6.0 * ((a * a * a - a) * m.row(i) + (b * b * b - b) * m.row(i + 1));
      row[i] += a;
      row[i + 1] += b;
      line.x.push_back(knot.x + b * h);
      line.of.push_back(std::nullopt);
      rows.push_back(std::move(row));
    }
  }
  line.weights = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(rows.size()), static_cast<Eigen::Index>(nodes.size()));
  for (std::size_t p = 0; p < rows.size(); ++p) {
    for (Eigen::Index k = 0; k < count; ++k) {
      const std::optional<int>& node = knots[static_cast<std::size_t>(k)].node;
      if (node) line.weights(static_cast<Eigen::Index>(p), *node) = rows[p][k];
    }
  }
  return line;
}

}  // namespace railtab::drawing
