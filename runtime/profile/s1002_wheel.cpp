#include "railtab/runtime/profile/s1002_wheel.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>

#include "railtab/runtime/base/constants.hpp"

namespace railtab {

namespace {

// Everything here is in mm, as the standard prints it, until a segment is made of it.

/// z and its derivatives over y [mm].
struct Value {
  double z, dz, ddz;
};

constexpr std::array<double, 9> zone_b{0.0,
                                       -3.358537058e-2,
                                       1.565681624e-3,
                                       -2.810427944e-5,
                                       5.844240864e-8,
                                       -1.562379023e-8,
                                       5.309217349e-15,
                                       -5.957839843e-12,
                                       2.646656573e-13};
constexpr std::array<double, 8> zone_c{-4.320221063e3,  -1.038384026e3,  -1.065501873e2,  -6.051367875,
                                       -2.054332446e-1, -4.169739389e-3, -4.687195829e-5, -2.252755540e-7};

/// Horner's scheme with derivatives. The terms of zone C reach 1.7e5 mm and cancel to 20 mm: extended precision keeps
/// the rounding from showing in the curvature.
Value polynomial(std::span<const double> c, double y) {
  long double z = 0, dz = 0, half_ddz = 0;
  for (std::size_t i = c.size(); i-- > 0;) {
    half_ddz = half_ddz * y + dz;
    dz = dz * y + z;
    z = z * y + static_cast<long double>(c[i]);
  }
  return {static_cast<double>(z), static_cast<double>(dz), static_cast<double>(2 * half_ddz)};
}

/// Straight zone z = constant + slope y.
struct StraightZone {
  double constant, slope;
  [[nodiscard]] double z(double y) const { return constant + slope * y; }
};
constexpr StraightZone zone_a{1.364323640, -0.066666667};
constexpr StraightZone zone_e{-93.576667419, -2.747477419};

/// Arc zone z = z0 + side sqrt(radius^2 - (y - y0)^2).
struct ArcZone {
  double y0, z0, radius, side;
  [[nodiscard]] double z(double y) const { return z0 + side * std::sqrt(radius * radius - (y - y0) * (y - y0)); }
  [[nodiscard]] double dz(double y) const {
    return -side * (y - y0) / std::sqrt(radius * radius - (y - y0) * (y - y0));
  }
};
constexpr ArcZone zone_d{-26.210665, 16.446, 13.0, -1.0};
constexpr ArcZone zone_f{-58.558326413, 8.834924130, 20.0, 1.0};
constexpr ArcZone zone_g{-55.0, 16.0, 12.0, 1.0};
constexpr ArcZone zone_h{-49.5, 9.519259302, 20.5, 1.0};

// Joints between the zones named.
constexpr double y_begin = -70.0;
constexpr double y_hg = -62.764705882;
constexpr double y_gf = -49.662510381;
constexpr double y_fe = -39.764473993;
constexpr double y_ed = -38.426669071;
constexpr double y_dc = -35.0;
constexpr double y_cb = -26.0;
constexpr double y_ba = 32.15796;
constexpr double tread_end = 60.0;

/// The cubic over zone C that closes its steps of value and slope against D and B (Hermite's).
struct JointCorrection {
  double z0, dz0, z1, dz1;  ///< steps at y_dc and y_cb
  [[nodiscard]] Value at(double y) const {
    const double h = y_cb - y_dc;
    const double t = (y - y_dc) / h;
    const double rise = z1 - z0;
    const double c2 = 3 * rise - h * (2 * dz0 + dz1);
    const double c3 = h * (dz0 + dz1) - 2 * rise;
    return {z0 + t * (h * dz0 + t * (c2 + t * c3)), dz0 + t * (2 * c2 + 3 * t * c3) / h,
            (2 * c2 + 6 * t * c3) / (h * h)};
  }
};

JointCorrection close_zone_c() {
  const Value at_d = polynomial(zone_c, y_dc);
  const Value at_b = polynomial(zone_c, y_cb);
  const Value b = polynomial(zone_b, y_cb);
  return {zone_d.z(y_dc) - at_d.z, zone_d.dz(y_dc) - at_d.dz, b.z - at_b.z, b.dz - at_b.dz};
}

ProfileSegment polynomial_segment(std::span<const double> c, const JointCorrection& correction, double y0, double y1) {
  return graph_segment(
      [=](double y) {
        const Value p = polynomial(c, y / mm);
        const Value q = correction.at(y / mm);
        return GraphPoint{(p.z + q.z) * mm, p.dz + q.dz, (p.ddz + q.ddz) / mm};
      },
      y0 * mm, y1 * mm);
}

ProfileSegment arc_zone_segment(const ArcZone& zone, double shift, double y0, double y1) {
  const auto phi = [&](double y) {
    const double from_bottom = std::asin((y - zone.y0) / zone.radius);
    return zone.side > 0 ? from_bottom : std::numbers::pi - from_bottom;
  };
  return arc_segment({zone.y0 * mm, (zone.z0 + shift) * mm}, zone.radius * mm, phi(y0), phi(y1));
}

ProfileSegment straight_zone_segment(const StraightZone& zone, double shift, double y0, double y1) {
  return straight_segment({y0 * mm, (zone.z(y0) + shift) * mm}, {y1 * mm, (zone.z(y1) + shift) * mm});
}

}  // namespace

std::vector<ProfileSegment> s1002_segments() {
  const double shift_e = zone_d.z(y_ed) - zone_e.z(y_ed);
  const double shift_f = shift_e + zone_e.z(y_fe) - zone_f.z(y_fe);
  const double shift_g = shift_f + zone_f.z(y_gf) - zone_g.z(y_gf);
  const double shift_h = shift_g + zone_g.z(y_hg) - zone_h.z(y_hg);
  const double shift_a = polynomial(zone_b, y_ba).z - zone_a.z(y_ba);
  const JointCorrection none{0, 0, 0, 0};
  return {arc_zone_segment(zone_h, shift_h, y_begin, y_hg), arc_zone_segment(zone_g, shift_g, y_hg, y_gf),
          arc_zone_segment(zone_f, shift_f, y_gf, y_fe),    straight_zone_segment(zone_e, shift_e, y_fe, y_ed),
          arc_zone_segment(zone_d, 0.0, y_ed, y_dc),        polynomial_segment(zone_c, close_zone_c(), y_dc, y_cb),
          polynomial_segment(zone_b, none, y_cb, y_ba),     straight_zone_segment(zone_a, shift_a, y_ba, tread_end)};
}

}  // namespace railtab
