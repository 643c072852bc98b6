#include "railtab/runtime/profile/cubic_spline.hpp"

#include <cassert>
#include <cstddef>

namespace railtab {

namespace {

/// Row i of the tridiagonal system for the slopes: lower m[i-1] + diagonal m[i] + upper m[i+1] = right.
struct Row {
  double lower, diagonal, upper, right;
};

/// Continuity of the second derivative at knot i.
Row inner_row(const std::vector<double>& s, const std::vector<double>& v, std::size_t i) {
  const double h_left = s[i] - s[i - 1];
  const double h_right = s[i + 1] - s[i];
  const double chord_left = (v[i] - v[i - 1]) / h_left;
  const double chord_right = (v[i + 1] - v[i]) / h_right;
  return {h_right, 2 * (h_left + h_right), h_left, 3 * (h_right * chord_left + h_left * chord_right)};
}

/// Thomas's algorithm; the rows are diagonally dominant, so that no pivoting is needed.
std::vector<double> solve_slopes(const std::vector<double>& s, const std::vector<double>& v, Row first, Row last) {
  assert(s.size() >= 2 && s.size() == v.size());
  const std::size_t n = s.size();
  std::vector<double> upper(n), m(n);
  upper[0] = first.upper / first.diagonal;
  m[0] = first.right / first.diagonal;
  for (std::size_t i = 1; i < n; ++i) {
    const Row row = i + 1 < n ? inner_row(s, v, i) : last;
    const double pivot = row.diagonal - row.lower * upper[i - 1];
    upper[i] = row.upper / pivot;
    m[i] = (row.right - row.lower * m[i - 1]) / pivot;
  }
  for (std::size_t i = n - 1; i-- > 0;) m[i] -= upper[i] * m[i + 1];
  return m;
}

}  // namespace

std::vector<double> clamped_spline_slopes(const std::vector<double>& s, const std::vector<double>& v,
                                          double slope_begin, double slope_end) {
  return solve_slopes(s, v, {0, 1, 0, slope_begin}, {0, 1, 0, slope_end});
}

std::vector<double> natural_spline_slopes(const std::vector<double>& s, const std::vector<double>& v) {
  const std::size_t n = s.size();
  const double chord_first = (v[1] - v[0]) / (s[1] - s[0]);
  const double chord_last = (v[n - 1] - v[n - 2]) / (s[n - 1] - s[n - 2]);
  return solve_slopes(s, v, {0, 2, 1, 3 * chord_first}, {1, 2, 0, 3 * chord_last});
}

}  // namespace railtab
