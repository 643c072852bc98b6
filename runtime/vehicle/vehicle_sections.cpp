#include "railtab/runtime/vehicle/vehicle_sections.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <initializer_list>

#include "railtab/runtime/vehicle/joint_file.hpp"

namespace railtab {

namespace {

constexpr std::array<std::string_view, 3> axes{"x", "y", "z"};

// A key of an axis, "kx" of "k" and "x".
std::string of(std::string_view quantity, std::string_view axis) { return fmt::format("{}{}", quantity, axis); }

bool is_vertical(const VehicleData& data) { return data.motion == MotionPlane::vertical; }

// Keys that vertical data have not.
void leave_out(TomlSection& section, std::initializer_list<std::string_view> keys) {
  section.without_effect(keys, "motion = \"vertical\"");
}

void leave_out_axis(TomlSection& section, std::string_view axis) {
  for (const std::string_view quantity :
       {"k", "c", "series_k", "damper_curve_", "stop_", "friction_", "friction_ratio_", "friction_travel_"}) {
    leave_out(section, {of(quantity, axis)});
  }
}

// Absent, the damper has rigid ends; no spring has the stiffness 0.
double read_series_stiffness(TomlSection& section, std::string_view axis) {
  const std::string key = of("series_k", axis);
  if (!section.has(key)) return 0.0;
  const double stiffness = section.number(key, stiffness_kind);
  if (stiffness > 0.0) return stiffness;
  throw section.error(key, "0", fmt::format("more than 0 N/m, or no {} for a damper with rigid ends", key));
}

// A characteristic through the origin whose force does not fall.
ForceCurve read_curve(TomlSection& section, const std::string& key, std::string_view units) {
  const auto points = section.points(key, units);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double before = i == 0 ? 0.0 : points[i - 1][1];
    if (!(points[i][0] > 0.0) || points[i][1] < before) {
      throw section.error(key, fmt::format("[{:.6g}, {:.6g}]", points[i][0], points[i][1]),
                          "points beyond 0, 0, alike in both directions, whose forces do not fall");
    }
  }
  return ForceCurve(points);
}

// Damping along one axis by a linear stand-in, and what is not linear about it.
double read_damping(TomlSection& section, std::string_view axis, const std::string& name, NonlinearUnit& unit,
                    VehicleData& data) {
  const std::string key = of("c", axis), curve_key = of("damper_curve_", axis);
  const bool stated = section.has(key);
  double damping = section.number(key, damping_kind, 0.0);
  if (section.has(curve_key)) {
    unit.damper = read_curve(section, curve_key, "m/s and N");
    const auto& curve = unit.damper.points();
    if (!stated) damping = curve.front()[1] / curve.front()[0];
    data.nonlinear.push_back(fmt::format("{} along {}: damper of {} points, up to {:.6g} N at {:.6g} m/s{}", name, axis,
                                         curve.size(), curve.back()[1], curve.back()[0],
                                         section.has(of("series_k", axis)) ? ", in series" : ""));
    data.linearised.push_back(fmt::format(
        "{} along {}: its damper of {} points, up to {:.6g} N at {:.6g} m/s, runs linearly with {:.6g} N s/m", name,
        axis, curve.size(), curve.back()[1], curve.back()[0], damping));
  }
  return damping;
}

struct FrictionKinds {
  NumberKind force, travel;
};
constexpr FrictionKinds sliding{force_kind, travel_kind}, turning_friction{moment_kind, angle_kind};

// Dry friction, "friction_x", "friction_ratio_x" and "friction_travel_x" along or about an axis.
Friction read_friction(TomlSection& section, std::string_view axis, const FrictionKinds& kinds, double travel) {
  Friction friction;
  friction.force = section.number(of("friction_", axis), kinds.force, 0.0);
  friction.ratio = section.number(of("friction_ratio_", axis), friction_ratio_kind, 0.0);
  friction.travel = section.number(of("friction_travel_", axis), kinds.travel, travel);
  return friction;
}

std::string friction_text(const Friction& friction, std::string_view unit) {
  if (friction.ratio == 0.0) return fmt::format("dry friction of {:.6g} {}", friction.force, unit);
  const std::string of_load = fmt::format("dry friction of {:.6g} times the load along z", friction.ratio);
  return friction.force > 0.0 ? fmt::format("{} and {:.6g} {}", of_load, friction.force, unit) : of_load;
}

void describe_friction(const Friction& friction, const std::string& place, double damping, VehicleData& data) {
  if (!friction.acts()) return;
  const std::string text = friction_text(friction, "N");
  data.nonlinear.push_back(fmt::format("{}: {}", place, text));
  if (damping > 0.0) {
    data.linearised.push_back(fmt::format("{}: {} runs as a linear damper of {:.6g} N s/m", place, text, damping));
  } else {
    data.left_out.push_back(fmt::format("{}: {}", place, text));
  }
}

void describe_yaw_friction(const Friction& friction, const std::string& name, VehicleData& data) {
  if (!friction.acts()) return;
  const std::string text = fmt::format("{} about z: {}", name, friction_text(friction, "N m"));
  data.nonlinear.push_back(text);
  data.left_out.push_back(text);
}

ForceCurve read_stop(TomlSection& section, std::string_view axis, const std::string& name, VehicleData& data) {
  const std::string key = of("stop_", axis);
  if (!section.has(key)) return {};
  ForceCurve stop = read_curve(section, key, "m and N");
  const auto& points = stop.points();
  if (points.front()[1] != 0.0 || points.size() < 2) {
    throw section.error(key, fmt::format("{} points, first {:.6g} N", points.size(), points.front()[1]),
                        "at least two points, the first with 0 N: there the free travel ends");
  }
  const std::string text = fmt::format("from {:.6g} N at {:.3g} mm to {:.6g} N at {:.3g} mm", points.front()[1],
                                       1e3 * points.front()[0], points.back()[1], 1e3 * points.back()[0]);
  data.nonlinear.push_back(fmt::format("{} along {}: stop {}", name, axis, text));
  data.left_out.push_back(fmt::format("{} along {}: its stop, {}", name, axis, text));
  return stop;
}

RigidBody make_body(std::string name, const BodyInertia& inertia, const Eigen::Vector3d& position) {
  return {std::move(name), inertia.mass, {inertia.Jx, inertia.Jy, inertia.Jz}, position};
}

void add_body(TomlSection& section, VehicleData& data, RigidBody body) {
  const auto same = [&](const RigidBody& other) { return other.name == body.name; };
  if (std::any_of(data.parts.bodies.begin(), data.parts.bodies.end(), same)) {
    throw section.error("name", fmt::format("a second body {}", body.name), "a name of its own for each body");
  }
  data.parts.bodies.push_back(std::move(body));
}

// A joint names bodies of its neighbours, which stand for themselves at the middle between them.
int body_index(const TomlSection& section, VehicleData& data, const std::string& name) {
  std::vector<RigidBody>& bodies = data.parts.bodies;
  const auto found = std::find_if(bodies.begin(), bodies.end(), [&](const RigidBody& b) { return b.name == name; });
  if (found != bodies.end()) return static_cast<int>(found - bodies.begin());
  if (data.is_joint && (name.starts_with(of_vehicle_ahead) || name.starts_with(of_vehicle_behind))) {
    bodies.push_back({name, 0.0, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()});
    return static_cast<int>(bodies.size()) - 1;
  }
  std::vector<std::string> names;
  for (const RigidBody& body : bodies) names.push_back(body.name);
  if (data.is_joint) names.insert(names.end(), {"ahead/car-body", "behind/car-body"});
  throw section.error("joins", fmt::format("body '{}'", name), fmt::format("one of {}", fmt::join(names, ", ")));
}

// "side-frame-1-left" of "side-frame-1-*".
std::string on_side(std::string name, std::string_view side) {
  const std::size_t star = name.find('*');
  return star == name.npos ? name : name.replace(star, 1, side);
}

bool acts(const SuspensionUnit& unit) {
  const auto nonlinear = [](const NonlinearUnit& n) { return n.replaces_damper() || !n.stop.empty(); };
  return unit.kx + unit.ky + unit.kz + unit.cx + unit.cy + unit.cz > 0.0 ||
         std::any_of(unit.nonlinear.begin(), unit.nonlinear.end(), nonlinear);
}

void read_connection(TomlSection& section, VehicleData& data) {
  const bool vertical = is_vertical(data);
  if (vertical) {
    leave_out(section, {"y", "height", "both_sides", "friction_yaw", "friction_ratio_yaw", "friction_travel_yaw",
                        "k_roll", "k_yaw"});
  }
  const std::string name = section.text("name");
  const auto joins = section.pairs("joins");
  const double ahead = section.number("x", position_kind, 0.0);
  const double y = vertical ? 0.0 : section.number("y", position_kind, 0.0);
  const double height =
      vertical ? data.parts.nominal_radius : section.number("height", height_kind, data.parts.nominal_radius);
  const bool both_sides = !vertical && section.flag("both_sides");
  const SuspensionUnit unit = read_unit(section, name, data);
  Eigen::Vector3d turning = Eigen::Vector3d::Zero();
  Friction yaw_friction;
  if (!vertical) {
    constexpr double yaw_travel = 1e-3;  // rad
    yaw_friction = read_friction(section, "yaw", turning_friction, yaw_travel);
    describe_yaw_friction(yaw_friction, name, data);
    turning.x() = section.number("k_roll", bending_kind, 0.0);
    turning.z() = section.number("k_yaw", bending_kind, 0.0);
  }
  turning.y() = section.number("k_pitch", bending_kind, 0.0);
  if (section.has("stand_in_for")) {
    const std::string stand_in = fmt::format("{}: a linear stand-in for {}", name, section.text("stand_in_for"));
    data.stand_ins.push_back(stand_in);
    data.linearised.push_back(stand_in);
  }
  section.reject_others();
  if (!acts(unit) && turning.isZero() && !yaw_friction.acts()) {
    throw section.error("name", fmt::format("'{}' without stiffness, damping, friction and stop", name),
                        "one of them: what the connection does");
  }
  if (both_sides && y == 0.0) throw section.error("y", "0 with both_sides", "the distance from the track's centre");
  for (const auto& [first, second] : joins) {
    for (const double side : both_sides ? std::vector<double>{-1.0, 1.0} : std::vector<double>{1.0}) {
      const std::string_view word = side < 0.0 ? "left" : "right";
      Suspension joint;
      joint.body_a = body_index(section, data, both_sides ? on_side(first, word) : first);
      joint.body_b = body_index(section, data, both_sides ? on_side(second, word) : second);
      if (joint.body_a == joint.body_b) throw section.error("joins", first + " twice", "two different bodies");
      const double x = data.parts.bodies[static_cast<std::size_t>(joint.body_a)].position.x() + ahead;
      joint.point = {x, side * y, -height};
      joint.stiffness = {unit.kx, unit.ky, unit.kz};
      joint.damping = {unit.cx, unit.cy, unit.cz};
      joint.rotational_stiffness = turning;
      joint.series_stiffness = {unit.series_kx, unit.series_ky, unit.series_kz};
      joint.couple_share = unit.couple_share;
      joint.name = name;
      joint.nonlinear = unit.nonlinear;
      joint.yaw_friction = yaw_friction;
      data.parts.suspension.push_back(joint);
    }
  }
}

}  // namespace

SuspensionUnit read_unit(TomlSection& section, const std::string& name, VehicleData& data) {
  SuspensionUnit unit;
  std::array<double, 3> k{}, c{}, series{};
  for (std::size_t i = 0; i < 3; ++i) {
    if (is_vertical(data) && i < 2) {
      leave_out_axis(section, axes[i]);
      continue;
    }
    NonlinearUnit& nonlinear = unit.nonlinear[i];
    k[i] = section.number(of("k", axes[i]), stiffness_kind, 0.0);
    c[i] = read_damping(section, axes[i], name, nonlinear, data);
    series[i] = read_series_stiffness(section, axes[i]);
    if (series[i] > 0.0 && c[i] < 1.0) {
      throw section.error(of("series_k", axes[i]), "a stiffness in series without damper",
                          fmt::format("{} too", of("c", axes[i])));
    }
    nonlinear.friction = read_friction(section, axes[i], sliding, Friction{}.travel);
    if (nonlinear.friction.acts() && (series[i] > 0.0 || !nonlinear.damper.empty())) {
      throw section.error(of("friction_", axes[i]), "dry friction in a connection with a damper of its own",
                          "a [[connection]] for each");
    }
    describe_friction(nonlinear.friction, fmt::format("{} along {}", name, axes[i]), c[i], data);
    nonlinear.stop = read_stop(section, axes[i], name, data);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    if (unit.nonlinear[i].friction.ratio == 0.0 || k[2] > 0.0) continue;
    throw section.error(of("friction_ratio_", axes[i]), "no spring whose load presses it together", "kz too");
  }
  unit.kx = k[0], unit.ky = k[1], unit.kz = k[2];
  unit.cx = c[0], unit.cy = c[1], unit.cz = c[2];
  unit.series_kx = series[0], unit.series_ky = series[1], unit.series_kz = series[2];
  unit.couple_share = section.number("couple_share", ratio_kind, unit.couple_share);
  return unit;
}

BodyInertia read_inertia(TomlSection& section, const VehicleData& data) {
  BodyInertia inertia;
  inertia.mass = section.number("mass", mass_kind);
  if (is_vertical(data)) {
    leave_out(section, {"Jx", "Jz"});
    inertia.Jx = inertia.Jy = inertia.Jz = section.number("Jy", inertia_kind);
  } else {
    inertia.Jx = section.number("Jx", inertia_kind);
    inertia.Jy = section.number("Jy", inertia_kind);
    inertia.Jz = section.number("Jz", inertia_kind);
  }
  return inertia;
}

BodyInertia read_wheelset(TomlSection& section, const VehicleData& data) {
  if (!is_vertical(data)) return read_inertia(section, data);
  leave_out(section, {"Jx", "Jy", "Jz"});
  const double mass = section.number("mass", mass_kind), radius = data.parts.nominal_radius;
  const double J = mass * radius * radius;  // acts on nothing: the rotations of vertical wheelsets are held
  return {mass, J, J, J};
}

void read_further_bodies(TomlSection& root, VehicleData& data) {
  const bool vertical = is_vertical(data);
  for (TomlSection& section : root.sections("body")) {
    if (vertical) leave_out(section, {"y", "height", "both_sides"});
    const std::string name = section.text("name");
    if (name.find_first_of("/* \t,") != name.npos || name == "car-body" || name.starts_with("wheelset")) {
      throw section.error("name", fmt::format("'{}'", name),
                          "a name without blanks, commas, / and *, other than car-body and wheelset");
    }
    const std::vector<double> x = section.numbers("x", position_kind);
    const double y = vertical ? 0.0 : section.number("y", position_kind, 0.0);
    const double height = vertical ? data.parts.nominal_radius : section.number("height", height_kind);
    const bool both_sides = !vertical && section.flag("both_sides");
    const BodyInertia inertia = read_inertia(section, data);
    section.reject_others();
    for (std::size_t i = 0; i < x.size(); ++i) {
      const std::string numbered = x.size() == 1 ? name : fmt::format("{}-{}", name, i + 1);
      if (both_sides) {
        add_body(section, data, make_body(numbered + "-left", inertia, {x[i], -y, -height}));
        add_body(section, data, make_body(numbered + "-right", inertia, {x[i], y, -height}));
      } else {
        add_body(section, data, make_body(numbered, inertia, {x[i], y, -height}));
      }
    }
  }
}

void read_heading(TomlSection& root, VehicleData& data) {
  data.name = root.text("name");
  data.description = root.text("description");
  data.provenance = root.provenance();
  if (root.has("motion") && root.text_of("motion", {"spatial", "vertical"}) == "vertical") {
    data.motion = MotionPlane::vertical;
  }
  data.parts.name = data.name;
  data.parts.nominal_radius = root.number("nominal_radius", radius_kind);
}

void read_wheelsets(TomlSection& section, VehicleData& data) {
  const BodyInertia inertia = read_wheelset(section, data);
  const std::vector<double> x = section.numbers("x", position_kind);
  section.reject_others();
  for (std::size_t w = 0; w < x.size(); ++w) {
    if (w > 0 && !(x[w] < x[w - 1])) {
      throw section.error("x", fmt::format("{} m after {} m", x[w], x[w - 1]), "positions in order from the front");
    }
    data.parts.wheelsets.push_back(static_cast<int>(data.parts.bodies.size()));
    add_body(section, data,
             make_body(fmt::format("wheelset-{}", w + 1), inertia, {x[w], 0.0, -data.parts.nominal_radius}));
  }
}

void read_bodies(TomlSection& root, VehicleData& data) {
  const double radius = data.parts.nominal_radius;
  TomlSection car = root.section("car_body");
  const double car_x = car.number("x", position_kind, 0.0);
  if (is_vertical(data)) leave_out(car, {"height"});
  const double height = is_vertical(data) ? radius : car.number("height", height_kind);
  add_body(car, data, make_body("car-body", read_inertia(car, data), {car_x, 0.0, -height}));
  car.reject_others();
  read_further_bodies(root, data);

  if (data.stands_on_joints && !root.has("wheelset")) return;
  TomlSection wheelset = root.section("wheelset");
  read_wheelsets(wheelset, data);
}

void read_two_bogie(TomlSection& root, VehicleData& data) {
  const bool vertical = is_vertical(data);
  CoachParameters p;
  p.name = data.name;
  p.nominal_radius = data.parts.nominal_radius;
  p.length = data.parts.length;
  // a number that vertical data have not, and which then acts on nothing
  const auto spatial = [&](TomlSection& section, std::string_view key, const NumberKind& kind, double& member) {
    if (vertical) leave_out(section, {key});
    member = vertical ? p.nominal_radius : section.number(key, kind);
  };
  TomlSection car = root.section("car_body");
  p.car_body = read_inertia(car, data);
  spatial(car, "height", distance_kind, p.car_body_height);
  TomlSection bogie = root.section("bogie");
  p.bogie = read_inertia(bogie, data);
  spatial(bogie, "height", distance_kind, p.bogie_height);
  TomlSection wheelset = root.section("wheelset");
  p.wheelset = read_wheelset(wheelset, data);
  TomlSection layout = root.section("layout");
  p.half_wheelbase = layout.number("half_wheelbase", distance_kind);
  p.half_bogie_distance = layout.number("half_bogie_distance", distance_kind);
  p.axles_per_bogie = layout.whole_number("axles_per_bogie", 2, 3, 2);
  TomlSection primary = root.section("primary");
  p.primary = read_unit(primary, "primary suspension", data);
  spatial(primary, "half_distance", distance_kind, p.primary_half_distance);
  TomlSection secondary = root.section("secondary");
  p.secondary = read_unit(secondary, "secondary suspension", data);
  spatial(secondary, "half_distance", distance_kind, p.secondary_half_distance);
  spatial(secondary, "height", distance_kind, p.secondary_height);
  if (vertical) {
    leave_out(secondary, {"bending"});
    leave_out(root, {"roll_bar"});
  } else {
    p.secondary_bending = secondary.number("bending", bending_kind, 0.0);
  }
  for (const TomlSection* section : {&car, &bogie, &wheelset, &layout, &primary, &secondary}) section->reject_others();
  if (std::optional<TomlSection> bar = vertical ? std::nullopt : root.find_section("roll_bar")) {
    p.roll_bar = bar->number("stiffness", bending_kind);
    bar->reject_others();
  }
  try {
    data.parts = describe_coach(p);
  } catch (const InputError& wrong) {
    throw InputError(fmt::format("{}: {}", data.place, wrong.what()));
  }
  data.coach = p;
  read_further_bodies(root, data);
}

void read_connections(TomlSection& root, VehicleData& data) {
  for (TomlSection& section : root.sections("connection")) read_connection(section, data);
}

}  // namespace railtab
