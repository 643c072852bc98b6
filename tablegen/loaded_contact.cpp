#include "railtab/tablegen/loaded_contact.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "railtab/runtime/base/input_error.hpp"

namespace railtab {

double LoadedContactOptions::contact_modulus() const noexcept {
  const auto compliance = [](const ElasticMaterial& m) { return (1.0 - m.nu * m.nu) / m.E; };
  return 1.0 / (compliance(wheel) + compliance(rail));
}

void LoadedContactOptions::validate() const {
  wheel.validate();
  rail.validate();
  elements.validate();
  tolerance.validate();
  if (!(load_tolerance >= 1e-9 && load_tolerance <= 1e-2)) {
    throw input_error("load_tolerance", fmt::format("{}", load_tolerance), "1e-9..1e-2");
  }
}

void RailWrench::add(const Eigen::Vector3d& at, const Eigen::Vector3d& f) {
  force += f;
  moment += at.cross(f);
}

namespace {

/// Of a Hertzian contact with the same greatest overlap: pressure where the overlap exceeds half of it, in the best
/// proportion for this overlap.
Eigen::VectorXd first_guess(NormalInfluence& influence, const Eigen::VectorXd& overlap) {
  const double half = 0.5 * overlap.maxCoeff();
  Eigen::VectorXd pressure = (overlap.array() - half).max(0.0).sqrt(), displacement(overlap.size());
  influence.apply(pressure, displacement);
  return pressure * (pressure.dot(overlap) / pressure.dot(displacement));
}

/// Rows across a Hertzian pressure that is curved as much along s, for its height, as this one is at its largest:
/// p = p_0 √(1 − (2s/w)²) has the second difference −(2 ds/w)² p_0.
double rows_across_peak(const ContactElements& e, const Eigen::VectorXd& pressure) {
  Eigen::Index k = 0;
  const double largest = pressure.maxCoeff(&k);
  if (largest <= 0.0) return std::numeric_limits<double>::infinity();
  const double below = k >= e.nx ? pressure[k - e.nx] : 0.0, above = k + e.nx < e.count() ? pressure[k + e.nx] : 0.0;
  const double second = (2.0 * largest - below - above) / largest;
  return second > 0.0 ? 2.0 / std::sqrt(second) : std::numeric_limits<double>::infinity();
}

/// The pressure of the contact's elements.
/// @param start pressures to begin with; none: first_guess()
void solve_pressure(const LoadedContactOptions& options, std::optional<Eigen::VectorXd> start, LoadedContact& contact) {
  const ContactElements& e = contact.elements;
  std::vector<double> angle;
  for (const SurfaceLine& line : e.line) angle.push_back(line.angle);
  NormalInfluence influence({e.nx, e.ns, e.dx, e.ds}, angle, options.contact_modulus());
  NormalPressure found = normal_pressure(
      influence, e.overlap, start ? std::move(*start) : first_guess(influence, e.overlap), options.tolerance);
  contact.pressure = std::move(found.pressure);
  contact.residual = found.residual;
  contact.iterations += found.iterations;
  contact.converged = found.converged;
  contact.rows_across_peak = rows_across_peak(e, contact.pressure);
}

constexpr double row_growth = 1.5;
constexpr int finest_rows = 8;  // times those that the overlap asks for: an edge has no largest pressure

/// Rows of elements after some refinements of those that the overlap asks for.
int refined_rows(const ContactElements& coarse, int refinements, const ContactElementOptions& options) {
  const int most = std::min(finest_rows * coarse.ns, options.most / coarse.nx);
  double rows = coarse.ns;
  for (int k = 0; k < refinements && rows < most; ++k) rows = std::ceil(row_growth * rows);
  return std::min(static_cast<int>(rows), most);
}

/// More rows until the largest pressure is resolved, or a finer solution does not converge. A ridge of pressure over a
/// strongly curved strip of the surfaces is no part of the overlap by itself, so that elements may be too wide for it,
/// and rows beside it may miss its height.
/// @param coarse the elements that the overlap asks for
void refine_peak(const UndeformedDistance& distance, const ContactElements& coarse, const LoadedContactOptions& options,
                 LoadedContact& contact) {
  constexpr double most_smooth_rows = 12.0, smooth_share = 0.4;  // a Hertzian contact has 0.7 of the rows asked for
  constexpr double ridge_rows = 8.0;
  constexpr double settled_change = 0.01;  // of the largest pressure by the last rows
  const double smooth_rows = std::min(most_smooth_rows, smooth_share * options.elements.across_narrowest);
  if (!contact.converged || contact.rows_across_peak >= smooth_rows) return;
  while (true) {
    const ContactElements& e = contact.elements;
    const int rows = refined_rows(coarse, contact.refinements + 1, options.elements);
    if (rows <= e.ns) return;
    LoadedContact finer = contact;
    ++finer.refinements;
    finer.elements = contact_elements(distance, contact.regions, e.nx, rows);
    Eigen::VectorXd start(finer.elements.count());
    for (int j = 0; j < rows; ++j) {
      start.segment(j * e.nx, e.nx) = contact.pressure.segment((2 * j + 1) * e.ns / (2 * rows) * e.nx, e.nx);
    }
    solve_pressure(options, std::move(start), finer);
    if (!finer.converged) return;
    const double change = std::abs(finer.pressure.maxCoeff() / contact.pressure.maxCoeff() - 1.0);
    contact = std::move(finer);
    if (contact.rows_across_peak >= ridge_rows && change < settled_change) return;
  }
}

/// Numbers of elements and pressure of a solution near by.
struct Neighbour {
  int nx, ns;
  Eigen::VectorXd pressure;
};

/// @param refinements to begin with; more follow until the largest pressure has settled
LoadedContact solution(const ContactSearch& search, const WheelsetPose& pose, const LoadedContactOptions& options,
                       const std::optional<Neighbour>& neighbour, int refinements = 0) {
  LoadedContact contact;
  contact.pose = pose;
  const UndeformedDistance distance(search.pair(), pose);
  contact.regions = surface_overlaps(search, pose, distance);
  contact.converged = contact.regions.empty();
  if (contact.regions.empty()) return contact;
  if (neighbour) {
    contact.elements = contact_elements(distance, contact.regions, neighbour->nx, neighbour->ns);
    solve_pressure(options, neighbour->pressure, contact);
  } else {
    const ContactElements coarse = contact_elements(distance, contact.regions, options.elements);
    for (contact.refinements = refinements;; contact.refinements = 0) {
      const int rows = refined_rows(coarse, contact.refinements, options.elements);
      contact.elements = rows == coarse.ns ? coarse : contact_elements(distance, contact.regions, coarse.nx, rows);
      solve_pressure(options, std::nullopt, contact);
      if (contact.converged || contact.refinements == 0) break;
    }
    refine_peak(distance, coarse, options, contact);
  }
  const ContactElements& e = contact.elements;
  contact.bands = contact_bands(search.pair(), e, contact.pressure, contact.band);
  for (int k = 0; k < e.count(); ++k) {
    if (contact.pressure[k] <= 0.0) continue;
    const SurfaceLine& line = e.line[static_cast<std::size_t>(k / e.nx)];
    const double force = contact.pressure[k] * e.area();
    contact.on_rail.add({e.x[static_cast<std::size_t>(k % e.nx)], line.y, line.z},
                        force * Eigen::Vector3d(0.0, -std::sin(line.angle), std::cos(line.angle)));
    contact.normal_force += force;
    contact.elastic_energy += 0.5 * force * e.overlap[k];
    contact.area += e.area();
  }
  contact.largest_pressure = contact.pressure.maxCoeff();
  return contact;
}

}  // namespace

LoadedContact loaded_contact(const ContactSearch& search, const WheelsetPose& pose, const LoadedContactOptions& options,
                             int refinements) {
  options.validate();
  return solution(search, pose, options, std::nullopt, refinements);
}

namespace {

/// The zero of load − F(z): F^(2/3) grows almost linearly from first touch, so its secant, inside the bracket.
class LoadSearch {
 public:
  LoadSearch(double z_touch, double load)
      : touch_(z_touch),
        load_(load),
        low_(z_touch),
        high_(std::numeric_limits<double>::infinity()),
        z_before_(z_touch) {}

  /// @returns the next height, from the force at z
  double next(double z, double force) {
    const double power = std::cbrt(force * force), wanted = std::cbrt(load_ * load_);
    (force < load_ ? low_ : high_) = z;
    double next = force > 0.0 ? z + (wanted - power) * (z - z_before_) / (power - power_before_) : 0.0;
    z_before_ = z;
    power_before_ = power;
    if (next > low_ && next < high_) return next;
    return std::isfinite(high_) ? 0.5 * (low_ + high_) : touch_ + 2.0 * (z - touch_);
  }
  [[nodiscard]] bool exhausted() const { return high_ - low_ < 1e-13; }

 private:
  double touch_, load_, low_, high_;
  double z_before_, power_before_ = 0.0;
};

}  // namespace

ContactAtLoad contact_at_load(const ContactSearch& search, const WheelsetPose& pose, double load,
                              const LoadedContactOptions& options, const FrictionShare& friction) {
  options.validate();
  if (!(load > 0.0 && load <= 1e8)) throw input_error("load", fmt::format("{}", load), "above 0, at most 1e8 N");
  const TouchPoint touch = search.first_touch(pose.y, pose.roll, pose.yaw);
  if (!std::isfinite(touch.z_touch)) {
    throw input_error("pose", fmt::format("y = {} m, roll = {} rad, yaw = {} rad", pose.y, pose.roll, pose.yaw),
                      "one at which wheel and rail can touch");
  }
  constexpr int most_evaluations = 40;
  const double approach = std::cbrt(load * load / 1e22);  // of a stiffness of 1e11 N/m^(3/2), ordinary for a tread
  LoadSearch heights(touch.z_touch, load);
  WheelsetPose at = pose;
  at.z = touch.z_touch + approach * std::hypot(1.0, touch.z_touch_dy);
  ContactAtLoad result;
  std::optional<Neighbour> neighbour;
  while (result.evaluations < most_evaluations) {
    result.contact = solution(search, at, options, neighbour);
    ++result.evaluations;
    result.vertical_force = result.contact.on_rail.force.z();
    if (friction && result.contact.normal_force > 0.0) result.vertical_force += friction(result.contact);
    const double error = std::abs(result.vertical_force - load) / load;
    result.converged = error <= options.load_tolerance && result.contact.converged;
    if (result.converged || !result.contact.converged) break;
    // the same elements from here on: the force is then smooth in z
    if (error < 0.1) neighbour = {result.contact.elements.nx, result.contact.elements.ns, result.contact.pressure};
    at.z = heights.next(at.z, std::max(0.0, result.vertical_force));
    if (heights.exhausted()) break;
  }
  return result;
}

}  // namespace railtab
