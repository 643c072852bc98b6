#include "railtab/runtime/vsi/contact_inverse.hpp"

#include <Eigen/LU>
#include <array>
#include <cmath>

#include "railtab/runtime/base/index.hpp"
#include "railtab/runtime/vsi/element_forces.hpp"

namespace railtab {

namespace {

using Matrix12 = NewtonWorkspace::Matrix12;

// C of a group that is a whole vehicle, less what its force elements take away. In a time step, where groups are single
// wheelsets, that is as small as their coupling.
Eigen::MatrixXd with_elements(const ContactProblem& problem, int vehicle, const Eigen::MatrixXd& compliance) {
  if (!problem.elements || problem.wheelsets_per_group != problem.wheelsets_per_vehicle) return compliance;
  const TrainElements& elements = *problem.elements;
  const Eigen::MatrixXd stiffening = elements.vehicle[index(vehicle)].stiffening(*elements.compliance);
  Eigen::MatrixXd result = compliance;
  for (int i = 0; i < problem.wheelsets_per_group; ++i) {
    for (int j = 0; j < problem.wheelsets_per_group; ++j) {
      result.block<6, 6>(wheelset_unknowns * i, wheelset_unknowns * j) -= stiffening.block<6, 6>(6 * i, 6 * j);
    }
  }
  return result;
}

// By Gauss and Jordan with pivots from the columns: column by column of a fixed size, which the compiler unrolls.
void invert_in_place(Eigen::Map<Matrix12>& m) {
  std::array<int, wheelset_unknowns> pivot;
  for (int k = 0; k < wheelset_unknowns; ++k) {
    int p = 0;
    m.col(k).tail(wheelset_unknowns - k).cwiseAbs().maxCoeff(&p);
    pivot[index(k)] = p += k;
    if (p != k) m.row(p).swap(m.row(k));
    const double inverse = 1.0 / m(k, k);
    const Eigen::Matrix<double, wheelset_unknowns, 1> column = m.col(k);
    m.col(k).setZero();
    m(k, k) = 1.0;
    for (int j = 0; j < wheelset_unknowns; ++j) {
      const double factor = m(k, j) * inverse;
      m.col(j) -= factor * column;
      m(k, j) = factor;
    }
  }
  for (int k = wheelset_unknowns - 1; k >= 0; --k) {
    if (pivot[index(k)] != k) m.col(pivot[index(k)]).swap(m.col(k));
  }
}

}  // namespace

void assemble_compliances(const ContactProblem& problem, NewtonWorkspace& ws) {
  const int wheelsets = problem.wheelsets_per_group;
  const int size = wheelset_unknowns * wheelsets;
  for (std::size_t g = 0; g < ws.compliance.size(); ++g) {
    const int of_vehicle = static_cast<int>(g) * wheelsets % problem.wheelsets_per_vehicle;
    ws.compliance[g].setZero(size, size);
    for (int i = 0; i < wheelsets; ++i) {
      for (int j = 0; j < wheelsets; ++j) {
        ws.compliance[g].block<6, 6>(wheelset_unknowns * i, wheelset_unknowns * j) =
            problem.vehicle_compliance.block<6, 6>(6 * (of_vehicle + i), 6 * (of_vehicle + j));
      }
    }
  }
  for (const RailCoupling& c : problem.rail) {
    const int g = c.i / 2 / wheelsets;
    if (c.j / 2 / wheelsets != g) continue;
    const int first = 2 * wheelsets * g;
    ws.compliance[index(g)].block<3, 3>(rail_unknown(c.i - first), rail_unknown(c.j - first)) = c.compliance;
  }
}

void invert(const ContactProblem& problem, int group, NewtonWorkspace& ws) {
  const Eigen::MatrixXd& compliance = ws.compliance[index(group)];
  Eigen::MatrixXd& inverse = ws.inverse[index(group)];
  const int first = group * problem.wheelsets_per_group;
  inverse.resize(compliance.rows(), compliance.cols());
  if (problem.wheelsets_per_group == 1) {
    Eigen::Map<Matrix12> jacobian(inverse.data());
    jacobian.noalias() = -Eigen::Map<const Matrix12>(compliance.data()) * ws.tangent[index(first)];
    jacobian.diagonal().array() += 1.0;
    invert_in_place(jacobian);
    return;
  }
  const Eigen::MatrixXd stiffened = with_elements(problem, group, compliance);
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Identity(compliance.rows(), compliance.cols());
  for (int j = 0; j < problem.wheelsets_per_group; ++j) {
    jacobian.middleCols<12>(12 * j) -= stiffened.middleCols<12>(12 * j) * ws.tangent[index(first + j)];
  }
  inverse = jacobian.partialPivLu().inverse();
}

bool add_to_tangent(NewtonWorkspace& ws, int group, const ContactVector& u, const ContactVector& v) {
  constexpr double nearly_singular = 0.1;
  Eigen::Map<Matrix12> inverse(ws.inverse[index(group)].data());
  const ContactVector responded = Eigen::Map<const Matrix12>(ws.compliance[index(group)].data()) * u;
  const ContactVector z = inverse * responded;
  const double denominator = 1.0 - v.dot(z);
  if (!(std::abs(denominator) > nearly_singular)) return false;
  ws.tangent[index(group)] += u * v.transpose();
  const Eigen::Matrix<double, 1, wheelset_unknowns> row = v.transpose() * inverse / denominator;
  inverse += z * row;
  return true;
}

}  // namespace railtab
