#include "railtab/runtime/vehicle/vehicle_modes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <map>
#include <numbers>
#include <utility>

#include "railtab/runtime/base/dense_solvers.hpp"
#include "railtab/runtime/base/motion_names.hpp"

namespace railtab {

namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;
using Complex = std::complex<double>;

// Rows that move while the wheelsets stand, with mass and without.
struct Rows {
  std::vector<int> massive, massless;
};

Rows by_mass(const VehicleModel& vehicle, const std::vector<int>& all) {
  Rows rows;
  for (const int row : all) (vehicle.mass(row, row) > 0.0 ? rows.massive : rows.massless).push_back(row);
  return rows;
}

Rows moving_rows(const VehicleModel& vehicle) {
  std::vector<bool> stands(static_cast<std::size_t>(vehicle.dofs()), false);
  for (const int w : vehicle.wheelsets) {
    for (const int row : vehicle.dof[static_cast<std::size_t>(w)]) {
      if (row != held) stands[static_cast<std::size_t>(row)] = true;
    }
  }
  std::vector<int> moving;
  for (int row = 0; row < vehicle.dofs(); ++row) {
    if (!stands[static_cast<std::size_t>(row)]) moving.push_back(row);
  }
  return by_mass(vehicle, moving);
}

/// ẋ = A x with x = [u, u̇, s], u of the rows with mass and s of those without:
///     M ü = −K u − K_us s − C u̇ − C_us ṡ,      C_ss ṡ = −K_su u − K_ss s − C_su u̇
Matrix state_matrix(const VehicleModel& vehicle, const Rows& rows) {
  const auto n = static_cast<Eigen::Index>(rows.massive.size()), m = static_cast<Eigen::Index>(rows.massless.size());
  const auto& u = rows.massive;
  const auto& s = rows.massless;
  Matrix A = Matrix::Zero(2 * n + m, 2 * n + m);
  Matrix rate(m, 2 * n + m);  // of s
  if (m > 0) {
    rate << vehicle.stiffness(s, u), vehicle.damping(s, u), vehicle.stiffness(s, s);
    rate = -symmetric_solution(vehicle.damping(s, s), rate);
  }
  Matrix force(n, 2 * n + m);
  force << vehicle.stiffness(u, u), vehicle.damping(u, u), vehicle.stiffness(u, s);
  if (m > 0) force += vehicle.damping(u, s) * rate;
  A.block(0, n, n, n).setIdentity();
  A.middleRows(n, n) = -symmetric_solution(vehicle.mass(u, u), force);
  A.bottomRows(m) = rate;
  return A;
}

// "side-frame" of "side-frame-1-left": what bodies of one kind have in common.
std::string kind_of(std::string_view body) {
  for (const std::string_view side : {"-left", "-right"}) {
    if (body.ends_with(side)) body.remove_suffix(side.size());
  }
  const std::size_t last = body.find_last_not_of("0123456789");
  if (last != body.npos && last + 1 < body.size() && last > 0 && body[last] == '-') body = body.substr(0, last);
  std::string name(body);
  std::replace(name.begin(), name.end(), '-', ' ');
  return name;
}

std::string motion_name(const std::string& kind, int motion, const std::vector<Complex>& moves, bool is_lower_sway) {
  constexpr const char* names[] = {"longitudinal", "lateral", "bounce", "roll", "pitch", "yaw"};
  const bool car = kind == "car body";
  std::string name = kind + " ";
  name +=
      car && (motion == y_dof || motion == roll_dof) ? (is_lower_sway ? "lower sway" : "upper sway") : names[motion];
  if (moves.size() < 2) return name;
  const double together = std::real(moves.front() * std::conj(moves.back()));
  return name + (together > 0.0 ? ", in phase" : ", in opposition");
}

// After the kind of bodies and the motion with the most kinetic energy.
std::string name_of(const VehicleModel& vehicle, const Eigen::VectorXcd& shape) {
  std::map<std::pair<std::string, int>, double> energy;
  std::map<std::pair<std::string, int>, std::vector<Complex>> moves;
  bool is_lower_sway = false;
  for (std::size_t b = 0; b < vehicle.bodies.size(); ++b) {
    const std::string kind = kind_of(vehicle.bodies[b].name);
    const DofIndices& dof = vehicle.dof[b];
    for (int motion = 0; motion < 6; ++motion) {
      const int row = dof[static_cast<std::size_t>(motion)];
      if (row == held) continue;
      energy[{kind, motion}] += vehicle.mass(row, row) * std::norm(shape[row]);
      moves[{kind, motion}].push_back(shape[row]);
    }
    if (kind == "car body" && dof[y_dof] != held && dof[roll_dof] != held) {
      // a point h above the centre of gravity moves by y + h·roll
      is_lower_sway = std::real(shape[dof[y_dof]] * std::conj(shape[dof[roll_dof]])) > 0.0;
    }
  }
  const auto largest =
      std::max_element(energy.begin(), energy.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  if (largest == energy.end() || !(largest->second > 0.0)) return "inner degree of freedom";
  const auto& [kind, motion] = largest->first;
  return motion_name(kind, motion, moves[largest->first], is_lower_sway);
}

}  // namespace

MotionSpectrum motion_spectrum(const VehicleModel& vehicle, const std::vector<int>& rows) {
  const Rows parts = by_mass(vehicle, rows);
  const GeneralSpectrum spectrum = general_spectrum(state_matrix(vehicle, parts));
  return {spectrum.values, spectrum.vectors.topRows(static_cast<Eigen::Index>(parts.massive.size()))};
}

Eigen::VectorXcd motion_eigenvalues(const VehicleModel& vehicle, const std::vector<int>& rows) {
  return general_eigenvalues(state_matrix(vehicle, by_mass(vehicle, rows)));
}

std::vector<VehicleMode> natural_modes(const VehicleModel& vehicle, int count) {
  const Rows rows = moving_rows(vehicle);
  const auto n = static_cast<Eigen::Index>(rows.massive.size());
  if (n == 0) return {};
  const GeneralSpectrum spectrum = general_spectrum(state_matrix(vehicle, rows));
  std::vector<Eigen::Index> order;
  for (Eigen::Index k = 0; k < spectrum.values.size(); ++k) {
    if (spectrum.values[k].imag() >= 0.0) order.push_back(k);
  }
  std::stable_sort(order.begin(), order.end(), [&](Eigen::Index a, Eigen::Index b) {
    return std::abs(spectrum.values[a]) < std::abs(spectrum.values[b]);
  });
  std::vector<VehicleMode> modes;
  for (const Eigen::Index k : order) {
    if (static_cast<int>(modes.size()) >= count) break;
    const Complex value = spectrum.values[k];
    const double size = std::abs(value);
    Eigen::VectorXcd shape = Eigen::VectorXcd::Zero(vehicle.dofs());
    shape(rows.massive) = spectrum.vectors.col(k).head(n);
    modes.push_back(
        {size / (2.0 * std::numbers::pi), size > 0.0 ? -value.real() / size : 0.0, name_of(vehicle, shape)});
  }
  return modes;
}

}  // namespace railtab
