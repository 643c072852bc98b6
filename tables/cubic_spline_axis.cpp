#include "railtab/tables/cubic_spline_axis.hpp"

#include <Eigen/LU>
#include <cassert>

namespace railtab {

namespace {

/// Equation of an end: the place before it against the place after it, or no jump of the third derivative.
void end_row(Eigen::MatrixXd& a, int row, int outside, int inwards, SplineEnd end) {
  if (end == SplineEnd::free) {
    const double difference[] = {1, -4, 6, -4, 1};
    for (int i = 0; i < 5; ++i) a(row, outside + i * inwards) = difference[i];
    return;
  }
  a(row, outside) = 1.0;
  a(row, outside + 2 * inwards) = end == SplineEnd::even ? -1.0 : 1.0;
}

Eigen::MatrixXd closed_coefficients(int nodes, double sign) {
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(nodes, nodes);
  for (int i = 0; i < nodes; ++i) {
    a(i, i) += 4.0 / 6.0;
    a(i, (i + nodes - 1) % nodes) += (i == 0 ? sign : 1.0) / 6.0;
    a(i, (i + 1) % nodes) += (i == nodes - 1 ? sign : 1.0) / 6.0;
  }
  const Eigen::MatrixXd once = a.inverse();
  Eigen::MatrixXd all(nodes + 3, nodes);
  all.row(0) = sign * once.row(nodes - 1);
  all.middleRows(1, nodes) = once;
  all.row(nodes + 1) = sign * once.row(0);
  all.row(nodes + 2) = sign * once.row(1);
  return all;
}

}  // namespace

Eigen::MatrixXd spline_coefficient_matrix(int nodes, SplineEnd first, SplineEnd last) {
  assert(nodes >= 4);
  if (first == SplineEnd::periodic || first == SplineEnd::turned) {
    assert(first == last);
    return closed_coefficients(nodes, first == SplineEnd::turned ? -1.0 : 1.0);
  }
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(nodes + 2, nodes + 2);
  for (int i = 0; i < nodes; ++i) {
    a(i, i) = a(i, i + 2) = 1.0 / 6.0;
    a(i, i + 1) = 4.0 / 6.0;
  }
  end_row(a, nodes, 0, 1, first);
  end_row(a, nodes + 1, nodes + 1, -1, last);
  return a.inverse().leftCols(nodes);
}

}  // namespace railtab
