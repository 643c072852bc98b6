#include "railtab/runtime/vehicle/vehicle_checks.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "railtab/runtime/base/dense_solvers.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/motion_names.hpp"
#include "railtab/runtime/fe/matrix_scales.hpp"

namespace railtab {

namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;
using Eigen::Index;

constexpr double softest = 0.01;  // Hz: what resists less is free

constexpr double square(double x) { return x * x; }

constexpr double softest_omega2 = square(2.0 * std::numbers::pi * softest);

std::string row_text(const FreeVehicle& vehicle, Index row) {
  for (const TableBody& body : vehicle.bodies) {
    for (std::size_t k = 0; k < 6; ++k) {
      if (body.row[k] == row) return fmt::format("row {} ({} of {})", row + 1, motion_names[k], body.name);
    }
  }
  return fmt::format("row {} (of no body)", row + 1);
}

Index largest(const Vector& v) {
  Index row = 0;
  v.cwiseAbs().maxCoeff(&row);
  return row;
}

// Energy against what its parts have: 0 where nothing resists, of the order of 1 where single springs do.
double resistance(const Matrix& matrix, const Vector& v) {
  const double parts = v.cwiseAbs().dot(matrix.cwiseAbs() * v.cwiseAbs());
  return parts > 0.0 ? v.dot(matrix * v) / parts : 0.0;
}

void check_rigid_motions(const FreeVehicle& vehicle, const Matrix& matrix, const std::filesystem::path& file,
                         GeometricStiffness geometric) {
  // of rotations what positions leave that are written in whole millimetres
  constexpr double ties = 1e-9, ties_of_rotations = 1e-6;
  for (int k = 0; k < 6; ++k) {
    if (geometric == GeometricStiffness::in_matrices && (k == roll_dof || k == pitch_dof)) continue;
    const Vector v = vehicle.rigid.col(k);
    if (std::abs(resistance(matrix, v)) <= (k < roll_dof ? ties : ties_of_rotations)) continue;
    throw input_error(fmt::format("{}: {}", file.string(), row_text(vehicle, largest(matrix * v))),
                      fmt::format("{:.3g} that resists {} of the whole vehicle", v.dot(matrix * v), motion_names[k]),
                      fmt::format("0: a vehicle that nothing ties to the ground (no track, contact or gravity, or "
                                  "train.geometric_stiffness = \"in-matrices\"), with its bodies where {} says",
                                  vehicle.import.dofs.string()));
  }
}

// About its axle a wheelset rolls on what the profiles say, and nothing else turns with it.
void check_rotation(const FreeVehicle& vehicle, const TableBody& wheelset) {
  constexpr double rounding = 1e-9;
  const int row = wheelset.row[pitch_dof];
  const auto rejection = [&](const std::filesystem::path& file, std::string_view found) {
    return input_error(fmt::format("{}: {}", file.string(), row_text(vehicle, row)), found,
                       "a wheelset that turns freely about its axle: axle boxes are bodies of their own, or rows that "
                       "belong to no body");
  };
  const auto bound = [&](const Matrix& matrix) {
    double stiffest = 0.0;
    for (std::size_t k = 0; k < 3; ++k) stiffest = std::max(stiffest, matrix(wheelset.row[k], wheelset.row[k]));
    return rounding * stiffest * square(wheelset.position.z());
  };
  if (const double k = vehicle.stiffness(row, row); std::abs(k) > bound(vehicle.stiffness)) {
    throw rejection(vehicle.import.stiffness, fmt::format("a stiffness of {:.3g} N m/rad", k));
  }
  if (const double c = vehicle.damping(row, row); std::abs(c) > bound(vehicle.damping)) {
    throw rejection(vehicle.import.damping, fmt::format("a damping of {:.3g} N m s/rad", c));
  }
  for (Index j = 0; j < vehicle.mass.rows(); ++j) {
    const double coupled = std::abs(vehicle.mass(row, j));
    if (j == row || coupled <= 1e-6 * std::sqrt(vehicle.mass(row, row) * vehicle.mass(j, j))) continue;
    throw rejection(vehicle.import.mass,
                    fmt::format("an inertia of {:.3g} shared with {}", coupled, row_text(vehicle, j)));
  }
}

// A matrix in coordinates in which the mass is one: L⁻¹ A L⁻ᵀ with M = L Lᵀ.
Matrix per_mass(const CholeskyFactor& mass, const Matrix& matrix) {
  const Matrix half = mass.solve_L(matrix);
  const Matrix whole = mass.solve_L(half.transpose());
  return 0.5 * (whole + whole.transpose());
}

// The row that moves most in a motion of unit mass, by its energy.
Index moving_row(const FreeVehicle& vehicle, const CholeskyFactor& mass, const Vector& shape) {
  const Vector motion = mass.solve_LT(shape);
  return largest(vehicle.mass.diagonal().cwiseSqrt().cwiseProduct(motion));
}

// Rigid motions and rotations of the wheelsets that a stiffness does not resist.
Matrix unresisted_motions(const FreeVehicle& vehicle, const Matrix& stiffness) {
  const Index wheelsets = static_cast<Index>(vehicle.wheelsets.size());
  const Matrix M = vehicle.rigid.transpose() * vehicle.mass * vehicle.rigid;
  const CholeskyFactor factor(M);
  const SymmetricSpectrum eigen =
      symmetric_spectrum(per_mass(factor, vehicle.rigid.transpose() * stiffness * vehicle.rigid));
  Matrix motions = Matrix::Zero(vehicle.mass.rows(), 6 + wheelsets);
  Index count = 0;
  for (Index k = 0; k < 6; ++k) {
    if (eigen.values[k] < softest_omega2) motions.col(count++) = vehicle.rigid * factor.solve_LT(eigen.vectors.col(k));
  }
  for (Index w = 0; w < wheelsets; ++w) {
    motions(vehicle.wheelset(static_cast<std::size_t>(w)).row[pitch_dof], count++) = 1.0;
  }
  return motions.leftCols(count);
}

// Stiffness of the vehicle on rails that hold its wheelsets in y, z and roll: what is a hinge there is no mechanism.
Matrix stiffness_on_rails(const FreeVehicle& vehicle) {
  constexpr double half_gauge = 0.75, support_omega2 = square(2.0 * std::numbers::pi * 10.0);
  const double support = support_omega2 * vehicle.rigid.col(2).dot(vehicle.mass * vehicle.rigid.col(2));
  Matrix K = vehicle.stiffness;
  for (std::size_t w = 0; w < vehicle.wheelsets.size(); ++w) {
    const DofIndices& row = vehicle.wheelset(w).row;
    K(row[1], row[1]) += support;
    K(row[2], row[2]) += support;
    K(row[roll_dof], row[roll_dof]) += square(half_gauge) * support;
  }
  return K;
}

struct SoftestMotion {
  double omega2;  // [rad²/s²]
  Index row;      // that moves most
};

// The lowest squared frequency besides motions that are lifted above all others.
SoftestMotion softest_motion(const FreeVehicle& vehicle, const CholeskyFactor& mass, const Matrix& stiffness,
                             const Matrix& lifted_motions) {
  const Matrix Q = orthonormal_basis(mass.multiply_LT(lifted_motions));
  Matrix K = per_mass(mass, stiffness);
  const double lifted = K.norm() + 1.0;
  K -= Q * (Q.transpose() * K);
  K -= (K * Q) * Q.transpose();
  K += lifted * (Q * Q.transpose());
  const SymmetricSpectrum eigen = symmetric_spectrum(0.5 * (K + K.transpose()));
  return {eigen.values[0], moving_row(vehicle, mass, eigen.vectors.col(0))};
}

// Weights in the matrices push where no rails hold the vehicle: it has to stand on them alone.
void check_springs(const FreeVehicle& vehicle, const CholeskyFactor& mass, GeometricStiffness geometric) {
  const auto place = [&](const SoftestMotion& motion) {
    return fmt::format("{}: {}", vehicle.import.stiffness.string(), row_text(vehicle, motion.row));
  };
  if (geometric != GeometricStiffness::in_matrices) {
    const Matrix nothing = Matrix::Zero(vehicle.mass.rows(), vehicle.mass.rows());
    const SoftestMotion free = softest_motion(vehicle, mass, vehicle.stiffness, unresisted_motions(vehicle, nothing));
    if (free.omega2 < -softest_omega2) {
      throw input_error(place(free), fmt::format("springs that push, ω² = {:.3g} rad²/s²", free.omega2),
                        "a positive semidefinite stiffness");
    }
  }
  const Matrix on_rails = stiffness_on_rails(vehicle);
  const SoftestMotion standing = softest_motion(vehicle, mass, on_rails, unresisted_motions(vehicle, on_rails));
  if (standing.omega2 >= softest_omega2) return;
  if (standing.omega2 < -softest_omega2) {
    throw input_error(place(standing), fmt::format("springs that push, ω² = {:.3g} rad²/s²", standing.omega2),
                      "a stiffness by which the vehicle stands on its rails");
  }
  throw input_error(
      place(standing), "a motion that no spring resists",
      "six rigid motions of the whole vehicle, the wheelsets' rotations, and hinges that do not move while the "
      "rails hold the wheelsets in y, z and roll, alone without resistance");
}

void check_dampers(const FreeVehicle& vehicle, const CholeskyFactor& mass) {
  constexpr double rounding = 1e-9;
  const SymmetricSpectrum eigen = symmetric_spectrum(per_mass(mass, vehicle.damping));
  const Vector& rates = eigen.values;
  if (rates[0] >= -rounding * rates.cwiseAbs().maxCoeff()) return;
  throw input_error(fmt::format("{}: {}", vehicle.import.damping.string(),
                                row_text(vehicle, moving_row(vehicle, mass, eigen.vectors.col(0)))),
                    fmt::format("a damping that drives a motion by {:.3g} 1/s", -rates[0]),
                    "a positive semidefinite damping");
}

void check_total_mass(const FreeVehicle& vehicle) {
  constexpr double rounding = 1e-6;
  const Eigen::Vector3d mass =
      (vehicle.rigid.leftCols<3>().transpose() * vehicle.mass * vehicle.rigid.leftCols<3>()).diagonal();
  if (mass.maxCoeff() - mass.minCoeff() <= rounding * mass.maxCoeff()) return;
  throw input_error(
      vehicle.import.mass.string(),
      fmt::format("{:.6g} kg along x, {:.6g} kg along y, {:.6g} kg along z", mass.x(), mass.y(), mass.z()),
      "the same mass along all: each body with all its translations");
}

}  // namespace

std::vector<int> inner_rows(const FreeVehicle& vehicle) {
  std::vector<bool> named(static_cast<std::size_t>(vehicle.mass.rows()), false);
  for (const TableBody& body : vehicle.bodies) {
    for (int row : body.row) {
      if (row != held) named[static_cast<std::size_t>(row)] = true;
    }
  }
  std::vector<int> inner;
  for (std::size_t r = 0; r < named.size(); ++r) {
    if (!named[r]) inner.push_back(static_cast<int>(r));
  }
  return inner;
}

void check_wheelsets(const FreeVehicle& vehicle) {
  constexpr double accuracy = 1e-6;  // m
  const TableBody& first = vehicle.wheelset(0);
  for (std::size_t w = 0; w < vehicle.wheelsets.size(); ++w) {
    const TableBody& wheelset = vehicle.wheelset(w);
    for (std::size_t k = 0; k < 6; ++k) {
      if (wheelset.row[k] != held) continue;
      throw input_error(wheelset.place, fmt::format("wheelset {} without {}", wheelset.name, motion_names[k]),
                        "a row for each of x, y, z, roll, pitch, yaw of every wheelset");
    }
    const Eigen::Vector3d& p = wheelset.position;
    if (std::abs(p.y()) > accuracy) {
      throw input_error(wheelset.place, fmt::format("wheelset {} at y = {:.6g} m", wheelset.name, p.y()),
                        "0, the track's centre (vehicle.origin)");
    }
    if (!(p.z() < -accuracy) || std::abs(p.z() - first.position.z()) > accuracy) {
      throw input_error(wheelset.place, fmt::format("the axle of {} {:.6g} m above the rails", wheelset.name, -p.z()),
                        "one height of all axles, above the rail-head tops (vehicle.origin, vehicle.axes)");
    }
    if (w > 0 && !(p.x() < vehicle.wheelset(w - 1).position.x())) {
      throw input_error("scene: vehicle.wheelsets",
                        fmt::format("{} at x = {:.6g} m after {} at {:.6g} m", wheelset.name, p.x(),
                                    vehicle.wheelset(w - 1).name, vehicle.wheelset(w - 1).position.x()),
                        "their order from the front");
    }
  }
  const TableBody& car = vehicle.bodies[static_cast<std::size_t>(vehicle.car_body)];
  if (car.row[0] == held) {
    throw input_error(car.place, fmt::format("car body {} without x", car.name), "a free vehicle, the train holds it");
  }
}

void check_numbers(const FreeVehicle& vehicle) {
  const Eigen::SparseMatrix<double> mass = vehicle.mass.sparseView(), damping = vehicle.damping.sparseView(),
                                    stiffness = vehicle.stiffness.sparseView();
  check_scales({mass, vehicle.import.mass}, {damping, vehicle.import.damping}, {stiffness, vehicle.import.stiffness},
               vehicle_scales, [&](Index row) { return row_text(vehicle, row); });
}

void check_mass(const FreeVehicle& vehicle) {
  constexpr double rounding = 1e-12;
  const Vector diagonal = vehicle.mass.diagonal();
  Index row = 0;
  if (!(diagonal.minCoeff(&row) > 0.0)) {
    throw input_error(fmt::format("{}: {}", vehicle.import.mass.string(), row_text(vehicle, row)),
                      fmt::format("mass {}", diagonal[row]), "> 0 on the diagonal");
  }
  const Vector scale = diagonal.cwiseSqrt().cwiseInverse();
  const SymmetricSpectrum eigen = symmetric_spectrum(scale.asDiagonal() * vehicle.mass * scale.asDiagonal());
  if (eigen.values[0] > rounding) return;
  throw input_error(
      fmt::format("{}: {}", vehicle.import.mass.string(), row_text(vehicle, largest(eigen.vectors.col(0)))),
      "a motion without or with negative mass", "a positive definite mass");
}

Matrix rigid_motions(const FreeVehicle& vehicle) {
  const Eigen::Vector3d centre = vehicle.bodies[static_cast<std::size_t>(vehicle.car_body)].position;
  Matrix rigid = Matrix::Zero(vehicle.mass.rows(), 6);
  for (const TableBody& body : vehicle.bodies) {
    const Eigen::Vector3d r = body.position - centre;
    Eigen::Matrix<double, 6, 6> of_body = Eigen::Matrix<double, 6, 6>::Identity();
    of_body.topRightCorner<3, 3>() << 0, r.z(), -r.y(), -r.z(), 0, r.x(), r.y(), -r.x(), 0;  // θ × r
    for (int k = 0; k < 6; ++k) {
      if (body.row[static_cast<std::size_t>(k)] != held) {
        rigid.row(body.row[static_cast<std::size_t>(k)]) = of_body.row(k);
      }
    }
  }
  const std::vector<int> inner = inner_rows(vehicle);
  if (inner.empty()) return rigid;
  const Matrix K = vehicle.stiffness(inner, inner);
  const Vector scale = vehicle.mass.diagonal()(inner).cwiseSqrt().cwiseInverse();
  const SymmetricSpectrum eigen = symmetric_spectrum(scale.asDiagonal() * K * scale.asDiagonal());
  if (eigen.values[0] < softest_omega2) {
    const auto row = static_cast<std::size_t>(largest(eigen.vectors.col(0)));
    throw input_error(
        fmt::format("{}: row {} (of no body)", vehicle.import.stiffness.string(), inner[row] + 1),
        fmt::format("an inner degree of freedom at ω² = {:.3g} rad²/s² while the bodies rest", eigen.values[0]),
        "degrees of freedom that springs hold to the bodies");
  }
  const Matrix load = vehicle.stiffness(inner, Eigen::all) * rigid;  // rigid is 0 at the inner rows
  rigid(inner, Eigen::all) = -symmetric_solution(K, load);
  return rigid;
}

void check_free_motions(const FreeVehicle& vehicle, GeometricStiffness geometric) {
  check_rigid_motions(vehicle, vehicle.stiffness, vehicle.import.stiffness, geometric);
  check_rigid_motions(vehicle, vehicle.damping, vehicle.import.damping, GeometricStiffness::omitted);
  for (std::size_t w = 0; w < vehicle.wheelsets.size(); ++w) check_rotation(vehicle, vehicle.wheelset(w));
  check_total_mass(vehicle);
  const CholeskyFactor mass(vehicle.mass);
  check_springs(vehicle, mass, geometric);
  check_dampers(vehicle, mass);
}

}  // namespace railtab
