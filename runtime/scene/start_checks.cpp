#include "railtab/runtime/scene/start_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "railtab/runtime/start/wheelset_placement.hpp"
#include "railtab/runtime/vehicle/static_wheel_load.hpp"

namespace railtab {

namespace {

bool has_rest(const VsiModel& model, double time) {
  VsiState state(model);
  state.time = time;
  return static_equilibrium(model, state).converged;
}

/// The train under its weight alone, and its acceleration where that stays.
VsiModel without_loads(const VsiModel& model, double time, bool keep_acceleration) {
  VsiModel bare = model;
  bare.loads.clear();
  if (keep_acceleration || !bare.speed_profile) return bare;
  bare.contact.speed = model.speed(time);
  bare.speed_profile.reset();
  return bare;
}

VsiModel with_steel(const VsiModel& model) {
  VsiModel steel = model;
  steel.contact.normal.material = {};
  return steel;
}

/// How far the rails under the train are out of place, where that alone holds it from rest.
std::optional<std::string> no_rest_for_deviations(const VsiModel& model, double share, double time) {
  if (model.irregularity.empty() && !model.span_deviation) return std::nullopt;
  if (share == 0.0) {
    VsiModel smooth = model;
    smooth.irregularity = {};
    smooth.span_deviation.reset();
    if (!has_rest(smooth, time)) return std::nullopt;
  }
  double y = 0.0, z = 0.0;
  for (int w = 0; w < model.wheelsets(); ++w) {
    for (const RailSide side : {RailSide::left, RailSide::right}) {
      const RailDeviation d = model.rail_line(side, model.wheelset_x(w, time));
      y = std::max(y, std::abs(d.y));
      z = std::max(z, std::abs(d.z));
    }
  }
  const std::string until =
      share > 0.0 ? fmt::format("up to {:.0f} % of", 100.0 * share) : "on the smooth track, but hardly with any of";
  return fmt::format(
      "no state of rest where the train stands: there is one {} the deviations of the rails under it ({:.3g} m along "
      "y, "
      "{:.3g} m along z), beyond that a wheelset leaves its rails; begin elsewhere (train.start) or with less of them",
      until, y, z);
}

}  // namespace

std::string no_rest_message(const VsiModel& model, const EquilibriumReport& rest, double time) {
  if (auto deviations = no_rest_for_deviations(model, rest.deviation_share, time)) return *deviations;
  const std::string what =
      fmt::format("no state of rest, also on the smooth track, after {} iterations", rest.iterations);
  const double acceleration = model.acceleration(time);
  const bool loads = !model.loads.empty();
  if (acceleration != 0.0 && has_rest(without_loads(model, time, false), time)) {
    const bool alone = !loads || !has_rest(without_loads(model, time, true), time);
    return fmt::format(
        "{}; there is one without {}: the train cannot bear {:.3g} m/s² at t = {:.3g} s, let train.speed_file begin "
        "with less",
        what, alone ? "the acceleration" : "acceleration and loads together", acceleration, time);
  }
  if (loads && has_rest(without_loads(model, time, true), time)) {
    return fmt::format("{}; there is one without the loads that act at t = {:.3g} s: let them begin later or be less",
                       what, time);
  }
  if (!model.geometry) return what;
  if (has_rest(with_steel(model), time)) {
    return fmt::format("{}; there is one with wheels and rails of steel, not with contact.material.E = {:.3g} Pa", what,
                       model.contact.normal.material.E);
  }
  const WheelRailPair& pair = model.geometry->pair();
  return fmt::format(
      "{}, {}: do the wheels fit on the rails ({} on {}, track gauge {} m, flange backs {} m apart, origins of profile "
      "files)?",
      what, loads || acceleration != 0.0 ? "nor is there one without the loads at t = 0" : "under its weight alone",
      pair.wheel().knots().name, pair.rail().knots().name, pair.dimensions().track_gauge,
      pair.dimensions().flange_back);
}

std::string start_warning(const EquilibriumReport& start) {
  if (start.steady) return {};
  return "the deflection that travels with the train is far from that at rest (a track so soft that its dampers bear "
         "more than its springs, or a train near the track's critical speed): the run begins with the one at rest, and "
         "the first seconds are not those of a train that has long been running";
}

std::string displacement_warning(const SceneParameters& scene, const VsiModel& model, const VsiState& state) {
  const bool displaced = scene.train.initial_lateral_shift != 0.0 || scene.train.initial_yaw != 0.0;
  if (!displaced || !model.geometry) return {};
  const ContactProblem present = present_contact(model, state);
  const WheelContactModel contact = contact_at_rest(model.contact);
  const double b = model.geometry->pair().tape_circle_offset();
  double largest = 0.0, load = 0.0, lift = 0.0;
  for (int w = 0; w < model.wheelsets(); ++w) {
    load = std::max(load, static_wheel_load(model.vehicle, w % model.wheelsets_per_vehicle()));
    for (const WheelSide side : {WheelSide::left, WheelSide::right}) {
      const bool left = side == WheelSide::left;
      const WheelsetMotion motion = wheelset_motion(present, present.predicted, w);
      const RailHeadMotion rail = rail_motion(present, present.predicted, w, left ? 0 : 1);
      const ContactPatches patches = model.geometry->patches(relative_pose(model.geometry->pair(), side, motion, rail));
      const double lateral = wheel_force(contact, side, motion, rail, patches).wheelset[1];
      largest = std::max(largest, std::abs(lateral));
      const double below = motion.displacement[2] + (left ? -b : b) * motion.displacement[3];
      lift = std::max(lift, rail.displacement[1] - below);
    }
  }
  constexpr double steepest = 0.4;  // of the wheel load: treads and flange roots stay below 0.3
  constexpr double highest = 5e-3;  // m: treads stay within 1 mm; on the tips of flanges nothing is steep
  if (largest <= steepest * load && lift <= highest) return {};
  return fmt::format(
      "the train begins {:.3g} mm aside with a yaw of {:.3g} mrad, where flanges carry wheels, up to {:.2g} mm above "
      "their place, and push their rails by {:.3g} kN (static wheel load {:.3g} kN): the run begins with an impact",
      1e3 * scene.train.initial_lateral_shift, 1e3 * scene.train.initial_yaw, 1e3 * std::max(lift, 0.0), 1e-3 * largest,
      1e-3 * load);
}

}  // namespace railtab
