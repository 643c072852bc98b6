// The Manchester benchmark's wheelset like Figs. 9 to 13 of [MontenegroCalcada2023]: rolling radius difference and
// contact angles under load, creepages and creep forces of a wheelset that a run has brought to its own place. Usage:
// manchester_rolling_figure FOLDER, which writes manchester_angle.csv, manchester_rolling.csv and
// manchester_rolling.svg there.

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <exception>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "../reference_table.hpp"
#include "manchester_rolling.hpp"
#include "manchester_run.hpp"
#include "railtab/runtime/base/constants.hpp"
#include "railtab/runtime/base/text_file.hpp"
#include "railtab/runtime/report/svg_figure.hpp"

namespace railtab {
namespace {

constexpr double yaw_per_shift = 2.4;  // in cases A1.2 and A2.2 [rad/m]
constexpr int shifts = 21;             // of 0.5 mm
constexpr std::array sides{-1.0, 1.0};
constexpr std::array side_names{"left", "right"};

using Reference = decltype(testing::read_reference(""));

/// Row of the case, side and shift.
std::size_t row_of(const Reference& r, double wanted_case, double side, double y_mm) {
  for (std::size_t i = 0; i < r.at("case").size(); ++i) {
    if (r.at("case")[i] == wanted_case && r.at("side")[i] == side && std::abs(r.at("y_ws")[i] - y_mm) < 1e-9) return i;
  }
  throw std::runtime_error(fmt::format("reference without case {}, y = {} mm", wanted_case, y_mm));
}

/// Contact angles and rolling radius difference under load, without friction, as Figs. 9 and 10 have them, and the
/// angles of programs that leave the roll out or count them from the wheelset's axes.
class Angles {
 public:
  Angles(const ManchesterWheelset& wheelset, const Reference& reference) {
    for (int k = 0; k < shifts; ++k) {
      const double y_mm = 0.5 * k, y = y_mm * mm, yaw = yaw_per_shift * y;
      const auto roll_at = [&](double turned) { return rigid_position(wheelset.search(), y, turned).roll; };
      const double straight = roll_at(0.0), turned = roll_at(yaw);
      const double radius =
          (wheelset.wheel(y, straight, 0.0, 1.0).radius - wheelset.wheel(y, straight, 0.0, -1.0).radius) / mm;
      const auto radius_of = [&](double side) { return reference.at("r_cyl")[row_of(reference, 1.1, side, y_mm)]; };
      const double theirs = radius_of(1.0) - radius_of(-1.0);
      csv += fmt::format("{:.1f},{:.4f},{:.4f},{:.4f}", y_mm, radius, theirs, std::abs(radius - theirs));
      add(radius_lines, 0, y_mm, radius);
      add(radius_dots, 0, y_mm, theirs);
      for (std::size_t i = 0; i < sides.size(); ++i) {
        const double angle = wheelset.wheel(y, turned, yaw, sides[i]).angle;
        const double no_roll = wheelset.wheel(y, 0.0, yaw, sides[i]).angle;
        const double contact = reference.at("delta_tr")[row_of(reference, 1.2, sides[i], y_mm)];
        csv += fmt::format(",{:.5f},{:.5f},{:.5f},{:.5f}", angle, no_roll, angle - turned, contact);
        add(lines[i], 0, y_mm, angle);
        add(lines[i], 1, y_mm, no_roll);
        add(lines[i], 2, y_mm, angle - turned);
        add(dots[i], 0, y_mm, contact);
      }
      csv += '\n';
    }
  }

  std::string csv =
      "# Manchester benchmark, 10 kN per wheel without friction: rolling radius difference of case A1.1, contact "
      "angles\n"
      "# of case A1.2 in the track's axes, without the wheelset's roll, in the wheelset's axes, and CONTACT's; made "
      "by\n"
      "# tests/validation/manchester_rolling_figure\n"
      "y_mm,radius_difference_mm,radius_difference_CONTACT_mm,d_radius_mm,left,left_no_roll,left_wheelset_axes,left_"
      "CONTACT,"
      "right,right_no_roll,right_wheelset_axes,right_CONTACT\n";
  std::vector<report::Series> radius_lines{{"railtab", {}, {}}}, radius_dots{{"CONTACT", {}, {}}};
  std::array<std::vector<report::Series>, 2> lines{angle_lines(), angle_lines()};
  std::array<std::vector<report::Series>, 2> dots{{{{"CONTACT", {}, {}}}, {{"CONTACT", {}, {}}}}};

 private:
  static std::vector<report::Series> angle_lines() {
    return {{"railtab", {}, {}}, {"without roll", {}, {}}, {"wheelset's axes", {}, {}}};
  }
  static void add(std::vector<report::Series>& series, std::size_t i, double x, double y) {
    series[i].x.push_back(x);
    series[i].y.push_back(y);
  }
};

/// A quantity of a rolling wheel over the shift: railtab, the same without yaw in the creepage, CONTACT.
struct Curve {
  report::Series own{"railtab", {}, {}}, no_yaw{"without yaw", {}, {}}, contact{"CONTACT", {}, {}};
  void add(double y_mm, double own_value, double no_yaw_value, double contact_value) {
    for (report::Series* series : {&own, &no_yaw, &contact}) series->x.push_back(y_mm);
    own.y.push_back(own_value);
    no_yaw.y.push_back(no_yaw_value);
    contact.y.push_back(contact_value);
  }
  [[nodiscard]] report::SvgPanel panel(const std::string& title, const std::string& unit, bool with_no_yaw) const {
    report::SvgPanel result{title, "lateral shift of the wheelset [mm]", unit, {own}, {contact}};
    if (with_no_yaw) result.lines.push_back(no_yaw);
    return result;
  }
};

/// Of one case and side: creepages along, across, spin [1/m], creep force along and across of friction.
using Wheel = std::array<Curve, 5>;

class Rolling {
 public:
  explicit Rolling(const ManchesterWheelset& wheelset) : wheelset_(wheelset) {
    for (std::size_t c = 0; c < 2; ++c) {
      for (int k = 0; k < shifts; ++k) add(c, 0.5 * k);
    }
  }

  std::string csv =
      "# Manchester benchmark, rolling: railtab at the place to which its own run of 1 s has brought the wheelset,\n"
      "# beside CONTACT. Right-wheel axes (left wheel mirrored), wheel against rail, creep forces on the wheel of\n"
      "# mu F_n; shift: from that of the case; height, roll: from CONTACT's; drift of the height in the last 0.1 s;\n"
      "# d_: differences, d_total: of the right less the left longitudinal creepage; no_yaw: without yaw in the\n"
      "# creepage; made by tests/validation/manchester_rolling_figure\n"
      "case,side,elliptic,y_mm,shift_um,height_um,roll_urad,drift_nm,normal_kN,creepage_x,creepage_y,spin,fx,fy,"
      "normal_CONTACT_kN,creepage_x_CONTACT,creepage_y_CONTACT,spin_CONTACT,fx_CONTACT,fy_CONTACT,d_creepage,d_spin,"
      "d_force,d_total,creepage_y_no_yaw,spin_no_yaw\n";
  std::array<std::array<Wheel, 2>, 2> wheel;  // of case and side

 private:
  void add(std::size_t c, double y_mm) {
    const double yaw = c == 0 ? 0.0 : yaw_per_shift * y_mm * mm;
    const HeldRun run(wheelset_, y_mm * mm, yaw);
    const VsiModel& model = run.model;
    const double* const u = run.rest.motion.displacement;
    const double pitch_rate = -manchester_speed / model.vehicle.wheel_radius.front() + run.rest.motion.velocity[4];
    double left_difference = 0.0;  // of the longitudinal creepages
    for (std::size_t i = 0; i < sides.size(); ++i) {
      const double side = sides[i];
      const WheelsetPose pose{side * u[1], u[2], side * u[3], side * u[5]};
      const auto at_yaw = [&](double axle_yaw) {
        return rolling_wheel(wheelset_.geometry(), wheelset_.model(), model.contact.creep_law, pose, pitch_rate,
                             axle_yaw);
      };
      const RollingWheel own = at_yaw(pose.yaw), no_yaw = at_yaw(0.0);
      const std::size_t row = row_of(reference_, c == 0 ? 2.1 : 2.2, side, y_mm);
      const auto value = [&](const char* column) { return reference_.at(column)[row]; };
      // CONTACT gives the rail against the wheel, and forces on the rail.
      const double bound = manchester_friction * value("normal_force");
      const std::array theirs{-value("creepage_x"), -side * value("creepage_s"), -1e3 * side * value("spin"),
                              -value("fx") / bound, -side * value("fs") / bound};
      const std::array ours{own.creepage.x, own.creepage.y, own.creepage.spin, own.fx, own.fy};
      const std::array without{no_yaw.creepage.x, no_yaw.creepage.y, no_yaw.creepage.spin, no_yaw.fx, no_yaw.fy};
      for (std::size_t q = 0; q < ours.size(); ++q) wheel[c][i][q].add(y_mm, ours[q], without[q], theirs[q]);
      const double ellipse = M_PI * value("half_x") * value("half_s");
      csv += fmt::format(
          "{},{},{},{:.1f},{:.2f},{:.2f},{:.2f},{:.3f},{:.4f},{:.4e},{:.4e},{:.4f},{:.4f},{:.4f},{:.4f},"
          "{:.4e},{:.4e},{:.4f},{:.4f},{:.4f},{:.2e},{:.2e},{:.4f},{},{:.4e},{:.4f}\n",
          c == 0 ? "A2.1" : "A2.2", side_names[i], std::abs(value("area") / ellipse - 1.0) < 0.1 ? 1 : 0, y_mm,
          1e6 * u[1] - 1e3 * y_mm, 1e6 * u[2] - 1e3 * value("z_ws"), 1e6 * (u[3] - value("roll_ws")),
          1e9 * run.rest.drift, 1e-3 * own.normal_force, ours[0], ours[1], ours[2], ours[3], ours[4],
          1e-3 * value("normal_force"), theirs[0], theirs[1], theirs[2], theirs[3], theirs[4],
          std::max(std::abs(ours[0] - theirs[0]), std::abs(ours[1] - theirs[1])), std::abs(ours[2] - theirs[2]),
          std::hypot(ours[3] - theirs[3], ours[4] - theirs[4]),
          i == 0 ? "" : fmt::format("{:.2e}", std::abs(ours[0] - theirs[0] - left_difference)), without[1], without[2]);
      left_difference = ours[0] - theirs[0];
    }
  }

  const ManchesterWheelset& wheelset_;
  Reference reference_ = testing::read_reference("manchester_rolling.csv");
};

void write(const std::string& folder) {
  const ManchesterWheelset wheelset;
  const Angles angles(wheelset, testing::read_reference("manchester_loaded.csv"));
  write_text_file(folder + "/manchester_angle.csv", angles.csv);
  const Rolling rolling(wheelset);
  write_text_file(folder + "/manchester_rolling.csv", rolling.csv);

  const std::string shift = "lateral shift of the wheelset [mm]";
  const auto wheel = [&](std::size_t c, std::size_t side, std::size_t quantity) -> const Curve& {
    return rolling.wheel[c][side][quantity];
  };
  const std::vector<report::SvgPanel> panels{
      {"Fig. 9: rolling radius difference, A1.1", shift, "Δr [mm]", angles.radius_lines, angles.radius_dots},
      wheel(1, 1, 1).panel("Fig. 12: lateral creepage, A2.2, right", "creepage [-]", true),
      {"Fig. 10a: contact angle, A1.2, left", shift, "angle [rad]", angles.lines[0], angles.dots[0]},
      {"Fig. 10b: contact angle, A1.2, right", shift, "angle [rad]", angles.lines[1], angles.dots[1]},
      wheel(0, 0, 0).panel("Fig. 11a: longitudinal creepage, A2.1, left", "creepage [-]", false),
      wheel(0, 1, 0).panel("Fig. 11b: longitudinal creepage, A2.1, right", "creepage [-]", false),
      wheel(1, 0, 2).panel("Fig. 13a: spin creepage, A2.2, left", "spin [1/m]", true),
      wheel(1, 1, 2).panel("Fig. 13b: spin creepage, A2.2, right", "spin [1/m]", true),
      wheel(0, 0, 3).panel("Longitudinal creep force, A2.1, left", "of friction [-]", false),
      wheel(0, 1, 3).panel("Longitudinal creep force, A2.1, right", "of friction [-]", false),
      wheel(1, 0, 3).panel("Longitudinal creep force, A2.2, left", "of friction [-]", false),
      wheel(1, 1, 3).panel("Longitudinal creep force, A2.2, right", "of friction [-]", false),
      wheel(1, 0, 4).panel("Lateral creep force, A2.2, left", "of friction [-]", false),
      wheel(1, 1, 4).panel("Lateral creep force, A2.2, right", "of friction [-]", false)};
  write_text_file(folder + "/manchester_rolling.svg",
                  report::svg_figure("Manchester contact benchmark: S1002 on UIC60 1:40, 10 kN per wheel", panels, 2));
}

}  // namespace
}  // namespace railtab

int main(int argc, char** argv) {
  if (argc != 2) {
    fmt::print(stderr, "Usage: manchester_rolling_figure FOLDER\n");
    return 2;
  }
  try {
    railtab::write(argv[1]);
  } catch (const std::exception& e) {
    fmt::print(stderr, "manchester_rolling_figure: {}\n", e.what());
    return 1;
  }
  return 0;
}
