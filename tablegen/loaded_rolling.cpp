#include "railtab/tablegen/loaded_rolling.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "railtab/runtime/base/input_error.hpp"

namespace railtab {

void LoadedRollingOptions::validate() const {
  if (!(friction >= 1e-6 && friction <= 2.0)) {
    throw input_error("friction coefficient", fmt::format("{}", friction), "1e-6 to 2");
  }
  if (!(speed >= 1e-6 && speed <= 1e3)) {
    throw input_error("speed", fmt::format("{} m/s", speed), "1e-6 to 1000 m/s");
  }
  solution.validate();
}

RelativeMotion running_motion(const WheelsetPose& pose, double speed, double pitch_rate) {
  const Eigen::Vector3d axle(-std::sin(pose.yaw), std::cos(pose.yaw) * std::cos(pose.roll),
                             std::cos(pose.yaw) * std::sin(pose.roll));
  return {Eigen::Vector3d(speed, 0.0, 0.0), pitch_rate * axle};
}

namespace {

/// G and ν of two materials taken for one.
struct CombinedMaterial {
  double G, nu;
  explicit CombinedMaterial(const LoadedContactOptions& o)
      : G(2.0 / (1.0 / o.wheel.shear_modulus() + 1.0 / o.rail.shear_modulus())),
        nu(0.5 * G * (o.wheel.nu / o.wheel.shear_modulus() + o.rail.nu / o.rail.shear_modulus())) {}
};

/// The smallest rectangle of elements that holds all with pressure.
struct PressedRectangle {
  int column = 0, row = 0;  ///< of its first element in the contact's elements
  RollingContactGrid grid;

  [[nodiscard]] int element(int k, int nx) const { return (row + k / grid.nx) * nx + column + k % grid.nx; }
};

PressedRectangle pressed_rectangle(const LoadedContact& contact, double bound_per_pressure) {
  const ContactElements& e = contact.elements;
  int left = e.nx, right = -1, low = e.ns, high = -1;
  for (int k = 0; k < e.count(); ++k) {
    if (contact.pressure[k] <= 0.0) continue;
    left = std::min(left, k % e.nx);
    right = std::max(right, k % e.nx);
    low = std::min(low, k / e.nx);
    high = std::max(high, k / e.nx);
  }
  PressedRectangle r{left, low, {}};
  RollingContactGrid& grid = r.grid;
  grid.nx = right - left + 1;
  grid.ny = high - low + 1;
  grid.dx = e.dx;
  grid.dy = e.ds;
  grid.x.assign(e.x.begin() + left, e.x.begin() + right + 1);
  for (int j = low; j <= high; ++j) grid.y.push_back(e.line[static_cast<std::size_t>(j)].s);
  grid.bound = Eigen::VectorXd::Zero(grid.count());
  for (int k = 0; k < grid.count(); ++k) {
    grid.bound[k] = bound_per_pressure * contact.pressure[r.element(k, e.nx)];
    if (grid.bound[k] > 0.0) grid.inside.push_back(k);
  }
  return r;
}

/// Creepages at the wheel's deepest point of one line of the rail.
PatchCreepage line_creepage(const SurfaceLine& line, const WheelsetCentre& centre, const RelativeMotion& motion,
                            double speed) {
  const ContactAxes axes(line.angle);
  const Eigen::Vector3d arm =
      Eigen::Vector3d(line.x, line.y - centre.y, line.z - centre.z) + line.overlap * axes.normal;
  return patch_creepage(motion, arm, axes, speed);
}

/// Rigid slip of the elements along one line of the rail is that of its creepages, turning about its deepest point.
struct LineSlip {
  PatchCreepage creepage;
  double x;  ///< of the deepest point [m]
};

std::vector<LineSlip> curved_slip(const ContactElements& e, const PressedRectangle& r, const WheelsetCentre& centre,
                                  const RelativeMotion& motion, double speed) {
  std::vector<LineSlip> slip;
  for (int j = r.row; j < r.row + r.grid.ny; ++j) {
    const SurfaceLine& line = e.line[static_cast<std::size_t>(j)];
    slip.push_back({line_creepage(line, centre, motion, speed), line.x});
  }
  return slip;
}

/// The same on a plane: one set of creepages, at the line through the centre of pressure.
std::vector<LineSlip> planar_slip(const PressedRectangle& r, const SurfaceLine& line, const PatchCreepage& creepage) {
  std::vector<LineSlip> slip;
  for (const double s : r.grid.y) {
    slip.push_back({{creepage.x - creepage.spin * (s - line.s), creepage.y, creepage.spin}, line.x});
  }
  return slip;
}

RigidSlip rigid_slip(const std::vector<LineSlip>& slip, const PressedRectangle& r, double slip_ahead) {
  const int m = r.grid.count();
  RigidSlip rigid{ElementField::Zero(2 * m), slip[slip.size() / 2].creepage.spin};
  for (const int k : r.grid.inside) {
    const LineSlip& line = slip[static_cast<std::size_t>(k / r.grid.nx)];
    const double x = r.grid.x[static_cast<std::size_t>(k % r.grid.nx)] + slip_ahead * r.grid.dx;
    rigid.w[k] = line.creepage.x;
    rigid.w[m + k] = line.creepage.y + line.creepage.spin * (x - line.x);
  }
  return rigid;
}

/// The line of the rail through the centre of pressure of all bands.
std::optional<SurfaceLine> central_line(const UndeformedDistance& distance, const LoadedContact& contact) {
  double s_rail = 0.0, s_wheel = 0.0;
  for (const ContactBand& band : contact.bands) {
    s_rail += band.normal_force / contact.normal_force * band.s_rail;
    s_wheel += band.normal_force / contact.normal_force * band.s_wheel;
  }
  const std::optional<SurfaceLine> line = distance.line(s_rail, s_wheel);
  return line ? line : distance.line(s_rail);
}

void add_element(const ContactElements& e, const std::vector<ContactBand>& bands, int element, int band,
                 const Eigen::Vector2d& force, LoadedRolling& result) {
  const SurfaceLine& line = e.line[static_cast<std::size_t>(element / e.nx)];
  const double x = e.x[static_cast<std::size_t>(element % e.nx)];
  const Eigen::Vector3d on_wheel(force.x(), std::cos(line.angle) * force.y(), std::sin(line.angle) * force.y());
  result.on_rail.add({x, line.y, line.z}, -on_wheel);
  BandFriction& b = result.bands[static_cast<std::size_t>(band)];
  const ContactBand& centre = bands[static_cast<std::size_t>(band)];
  b.force += on_wheel;
  b.x += force.x();
  b.y += force.y();
  b.moment += (x - centre.x) * force.y() - (line.s - centre.s_rail) * force.x();
}

}  // namespace

LoadedRolling loaded_rolling(const WheelRailPair& pair, const LoadedContact& contact,
                             const LoadedContactOptions& material, const RelativeMotion& motion,
                             const LoadedRollingOptions& options) {
  options.validate();
  const ContactElements& e = contact.elements;
  LoadedRolling result;
  result.traction_x = result.traction_y = Eigen::VectorXd::Zero(e.count());
  result.solution.converged = contact.bands.empty();
  if (contact.bands.empty()) return result;
  const CombinedMaterial combined(material);
  PressedRectangle r = pressed_rectangle(contact, options.friction / combined.G);
  const WheelsetCentre centre = wheelset_centre(pair, contact.pose);
  const UndeformedDistance distance(pair, contact.pose);
  std::vector<LineSlip> slip = curved_slip(e, r, centre, motion, options.speed);
  if (options.slip == LoadedRollingOptions::SlipField::planar) {
    const std::optional<SurfaceLine> line = central_line(distance, contact);
    if (line) slip = planar_slip(r, *line, line_creepage(*line, centre, motion, options.speed));
  }
  RollingContact rolling(r.grid, combined.nu, options.solution);
  result.solution = rolling.solve(rigid_slip(slip, r, options.solution.slip_ahead));
  result.bands.resize(contact.bands.size());
  for (std::size_t b = 0; b < contact.bands.size(); ++b) {
    const ContactBand& band = contact.bands[b];
    const std::optional<SurfaceLine> line = distance.line(band.s_rail, band.s_wheel);
    if (line) result.bands[b].creepage = line_creepage(*line, centre, motion, options.speed);
  }
  const int m = r.grid.count();
  for (const int k : r.grid.inside) {
    const int element = r.element(k, e.nx);
    const Eigen::Vector2d p(result.solution.traction[static_cast<std::size_t>(k)],
                            result.solution.traction[static_cast<std::size_t>(m + k)]);
    result.traction_x[element] = combined.G * p.x();
    result.traction_y[element] = combined.G * p.y();
    add_element(e, contact.bands, element, contact.band[static_cast<std::size_t>(element)], combined.G * e.area() * p,
                result);
  }
  return result;
}

}  // namespace railtab
