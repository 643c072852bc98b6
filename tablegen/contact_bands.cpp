#include "railtab/tablegen/contact_bands.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace railtab {

namespace {

/// Marks the elements connected to `first`. @returns them
std::vector<int> connected(const ContactElements& e, const Eigen::VectorXd& pressure, int first, int number,
                           std::vector<int>& band) {
  std::vector<int> members{first};
  band[static_cast<std::size_t>(first)] = number;
  for (std::size_t next = 0; next < members.size(); ++next) {
    const int i = members[next] % e.nx, j = members[next] / e.nx;
    for (int row = std::max(0, j - 1); row <= std::min(e.ns - 1, j + 1); ++row) {
      for (int column = std::max(0, i - 1); column <= std::min(e.nx - 1, i + 1); ++column) {
        const int k = row * e.nx + column;
        if (pressure[k] <= 0.0 || band[static_cast<std::size_t>(k)] >= 0) continue;
        band[static_cast<std::size_t>(k)] = number;
        members.push_back(k);
      }
    }
  }
  return members;
}

ContactBand describe(const WheelRailPair& pair, const ContactElements& e, const Eigen::VectorXd& pressure,
                     const std::vector<int>& members) {
  ContactBand band;
  band.elements = static_cast<int>(members.size());
  band.area = band.elements * e.area();
  band.x_low = band.s_low = std::numeric_limits<double>::infinity();
  band.x_high = band.s_high = -std::numeric_limits<double>::infinity();
  const auto x = [&](int k) { return e.x[static_cast<std::size_t>(k % e.nx)]; };
  const auto line = [&](int k) -> const SurfaceLine& { return e.line[static_cast<std::size_t>(k / e.nx)]; };
  for (const int k : members) {
    const double force = pressure[k] * e.area(), angle = line(k).angle;
    band.normal_force += force;
    band.force += force * Eigen::Vector3d(0.0, -std::sin(angle), std::cos(angle));
    band.largest_pressure = std::max(band.largest_pressure, pressure[k]);
    band.x += force * x(k);
    band.s_rail += force * line(k).s;
    band.s_wheel += force * e.s_wheel[static_cast<std::size_t>(k)];
    band.x_low = std::min(band.x_low, x(k) - 0.5 * e.dx);
    band.x_high = std::max(band.x_high, x(k) + 0.5 * e.dx);
    band.s_low = std::min(band.s_low, line(k).s - 0.5 * e.ds);
    band.s_high = std::max(band.s_high, line(k).s + 0.5 * e.ds);
  }
  for (double* mean : {&band.x, &band.s_rail, &band.s_wheel}) *mean /= band.normal_force;
  // an element's own second moment: its pressure is constant
  PressureMoments& m = band.moments;
  m.xx = e.dx * e.dx / 12.0;
  m.ss = e.ds * e.ds / 12.0;
  for (const int k : members) {
    const double share = pressure[k] * e.area() / band.normal_force;
    const double u = x(k) - band.x, v = line(k).s - band.s_rail;
    m.xx += share * u * u;
    m.xs += share * u * v;
    m.ss += share * v * v;
    m.mean_pressure += share * pressure[k];
  }
  const EllipseOfPressure ellipse(m, band.normal_force);
  band.a = ellipse.a;
  band.b = ellipse.b;
  band.skew = ellipse.skew;
  band.angle = std::atan2(-band.force.y(), band.force.z());
  const CurvePoint rail = pair.rail().at(band.s_rail), wheel = pair.wheel().at(band.s_wheel);
  band.y_rail = rail.y;
  band.z_rail = rail.z;
  band.y_wheel = wheel.y;
  band.z_wheel = wheel.z;
  band.rolling_radius = pair.nominal_radius() + wheel.z;
  return band;
}

}  // namespace

std::vector<ContactBand> contact_bands(const WheelRailPair& pair, const ContactElements& elements,
                                       const Eigen::VectorXd& pressure, std::vector<int>& band) {
  band.assign(static_cast<std::size_t>(elements.count()), -1);
  std::vector<ContactBand> bands;
  for (int k = 0; k < elements.count(); ++k) {
    if (pressure[k] <= 0.0 || band[static_cast<std::size_t>(k)] >= 0) continue;
    const std::vector<int> members = connected(elements, pressure, k, static_cast<int>(bands.size()), band);
    bands.push_back(describe(pair, elements, pressure, members));
  }
  return bands;
}

}  // namespace railtab
