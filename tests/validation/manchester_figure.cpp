// Figures of the Manchester benchmark's wheelset, cases A1.1 and A1.2: railtab's contact under load (lines) next to
// CONTACT's (circles), all 21 lateral shifts, both wheels. Usage: manchester_figure FOLDER, which writes
// manchester_a11.svg and manchester_a12.svg there.

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "../reference_table.hpp"
#include "manchester_wheelset.hpp"
#include "railtab/runtime/base/text_file.hpp"
#include "railtab/runtime/report/svg_figure.hpp"

namespace railtab {
namespace {

constexpr double mm = 1e-3;
constexpr double yaw_per_shift = 2.4;  // in case A1.2 [rad/m]

/// A quantity of the loaded wheel, and the reference's column.
struct Quantity {
  const char* title;
  const char* unit;
  const char* column;
  double factor;  // of railtab's SI value to the unit shown
  double column_factor;
  double (*value)(const LoadedWheel&);
};

const std::vector<Quantity> quantities{
    {"Position on the rail", "y [mm]", "ycp_r", 1e3, 1, [](const LoadedWheel& w) { return w.y_rail; }},
    {"Position on the wheel", "y [mm]", "ycp_w", 1e3, 1, [](const LoadedWheel& w) { return w.y_wheel; }},
    {"Contact angle", "angle [rad]", "delta_tr", 1, 1, [](const LoadedWheel& w) { return w.angle; }},
    {"Distance from the axle", "r [mm]", "r_cyl", 1e3, 1, [](const LoadedWheel& w) { return w.radius; }},
    {"Longitudinal position", "x [mm]", "xcp_tr", 1e3, 1, [](const LoadedWheel& w) { return w.x; }},
    {"Penetration", "d [µm]", "approach", 1e6, 1e3, [](const LoadedWheel& w) { return w.penetration; }},
    {"Normal force", "F [kN]", "normal_force", 1e-3, 1e-3, [](const LoadedWheel& w) { return w.normal_force; }},
    {"Height of the wheelset centre", "z [mm]", "z_ws", 1e3, 1, [](const LoadedWheel& w) { return w.z; }}};

/// Both wheels over the lateral shift: lines from railtab every 0.05 mm, with its own roll; a gap where the position
/// jumps by more than 1 mm.
std::vector<report::Series> lines(const ManchesterWheelset& wheelset, const Quantity& q, double yaw_rate) {
  std::vector<report::Series> series;
  for (const double side : {1.0, -1.0}) {
    report::Series s{side > 0 ? "railtab, right wheel" : "railtab, left wheel", {}, {}};
    double last = std::nan("");
    for (int k = 0; k <= 200; ++k) {
      const double y = k * 0.05 * mm;
      const RigidPosition rigid = rigid_position(wheelset.search(), y, yaw_rate * y);
      const LoadedWheel wheel = wheelset.wheel(y, rigid.roll, yaw_rate * y, side);
      if (std::abs(wheel.y_wheel - last) > 1.0 * mm) {
        s.x.push_back(y / mm);
        s.y.push_back(std::nan(""));
      }
      last = wheel.y_wheel;
      s.x.push_back(y / mm);
      s.y.push_back(q.factor * q.value(wheel));
    }
    series.push_back(std::move(s));
  }
  return series;
}

std::vector<report::Series> dots(const Quantity& q, double wanted_case) {
  const auto r = testing::read_reference("manchester_loaded.csv");
  std::vector<report::Series> series{{"CONTACT, right wheel", {}, {}}, {"CONTACT, left wheel", {}, {}}};
  for (std::size_t i = 0; i < r.at("case").size(); ++i) {
    if (r.at("case")[i] != wanted_case) continue;
    report::Series& s = series[r.at("side")[i] > 0 ? 0 : 1];
    s.x.push_back(r.at("y_ws")[i]);
    s.y.push_back(q.column_factor * r.at(q.column)[i]);
  }
  return series;
}

void write_figure(const std::string& folder, int number) {
  const ManchesterWheelset wheelset;
  std::vector<report::SvgPanel> panels;
  for (const Quantity& q : quantities) {
    panels.push_back({q.title, "lateral shift of the wheelset [mm]", q.unit,
                      lines(wheelset, q, number == 2 ? yaw_per_shift : 0.0), dots(q, number == 2 ? 1.2 : 1.1)});
  }
  const std::string heading =
      fmt::format("Manchester contact benchmark, case A1.{}: S1002 on UIC60 1:40, 10 kN per wheel{}", number,
                  number == 2 ? ", yaw 2.4 mrad per mm" : "");
  write_text_file(fmt::format("{}/manchester_a1{}.svg", folder, number), report::svg_figure(heading, panels, 2));
}

}  // namespace
}  // namespace railtab

int main(int argc, char** argv) {
  if (argc != 2) {
    fmt::print(stderr, "Usage: manchester_figure FOLDER\n");
    return 2;
  }
  try {
    railtab::write_figure(argv[1], 1);
    railtab::write_figure(argv[1], 2);
  } catch (const std::exception& e) {
    fmt::print(stderr, "manchester_figure: {}\n", e.what());
    return 1;
  }
  return 0;
}
