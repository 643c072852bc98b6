#include "railtab/runtime/scene/start_checks.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "railtab/runtime/base/motion_names.hpp"
#include "railtab/runtime/profile/standard_profiles.hpp"
#include "railtab/runtime/scene/scene_wheels.hpp"
#include "railtab/runtime/start/wheelset_placement.hpp"
#include "railtab/runtime/vehicle/static_wheel_load.hpp"

namespace railtab {

namespace {

bool has_equilibrium(const VsiModel& model, double time) {
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

VsiModel with_full_slope(const VsiModel& model) {
  VsiModel clean = model;
  clean.contact.friction_law.initial_slope = 1.0;
  return clean;
}

/// The train with the weight of each wheelset in the middle between its rails.
VsiModel with_weight_in_the_middle(const VsiModel& model) {
  VsiModel centred = model;
  VehicleModel& vehicle = centred.vehicle;
  for (const int wheelset : vehicle.wheelsets) {
    const int roll = vehicle.dof[static_cast<std::size_t>(wheelset)][roll_dof];
    if (roll != held) vehicle.static_load[roll] = 0.0;
  }
  return centred;
}

/// Of the wheelset with the least loaded wheel, where weights beside the middle alone prevent the train's equilibrium.
std::optional<std::string> one_sided_weight(const VsiModel& model, double time) {
  constexpr double rounding = 1e-6;  // of a wheel's load
  const double half_distance = model.geometry->pair().tape_circle_offset();
  int worst = 0;
  double least = 1.0;  // load of a wheel over the mean of both
  WheelLoads of_worst{0.0, 0.0};
  for (int w = 0; w < model.wheelsets_per_vehicle(); ++w) {
    const WheelLoads wheel = static_wheel_loads(model.vehicle, w, half_distance);
    const double share = 2.0 * std::min(wheel.left, wheel.right) / (wheel.left + wheel.right);
    if (!(share < least)) continue;
    least = share;
    worst = w;
    of_worst = wheel;
  }
  if (least > 1.0 - rounding || !has_equilibrium(with_weight_in_the_middle(model), time)) return std::nullopt;
  const PlaceInTrain place = wheelset_places(model)[static_cast<std::size_t>(worst)];
  return fmt::format(
      "there is one with the weight in the middle between the rails: at wheelset {} of vehicle {} the left wheel would "
      "carry {:.3g} kN and the right one {:.3g} kN; check y of bodies and connections in the vehicle's data",
      place.wheelset, place.coach, 1e-3 * of_worst.left, 1e-3 * of_worst.right);
}

/// Of profile files that the online search takes as they are: curves through noisy points have bumps, between which the
/// search for an equilibrium goes to and fro.
std::string noise_hint(const ContactGeometry& geometry) {
  if (geometry.is_table()) return {};
  std::vector<std::string> files;
  for (const ProfileCurve* profile : {&geometry.pair().wheel(), &geometry.pair().rail()}) {
    const ProfileKnots& knots = profile->knots();
    const std::vector<std::string> built_in = standard_profile_names(knots.kind);
    if (std::find(built_in.begin(), built_in.end(), knots.name) == built_in.end()) files.push_back(knots.name);
  }
  if (files.empty()) return {};
  return fmt::format(
      "; if the points of {} are measured, their noise may be the cause: make a table by tablegen geometry --smoothing "
      "SIGMA (3e-6 for 3 um) and name it in contact.table",
      fmt::join(files, " and "));
}

/// The deviations of the rails under the train, where they alone prevent its equilibrium.
std::optional<std::string> too_large_deviations(const VsiModel& model, double share, double time) {
  if (model.irregularity.empty() && !model.span_deviation) return std::nullopt;
  if (share == 0.0) {
    VsiModel smooth = model;
    smooth.irregularity = {};
    smooth.span_deviation.reset();
    if (!has_equilibrium(smooth, time)) return std::nullopt;
  }
  double y = 0.0, z = 0.0;
  for (int w = 0; w < model.wheelsets(); ++w) {
    for (const RailSide side : {RailSide::left, RailSide::right}) {
      const RailDeviation d = model.rail_line(side, model.wheelset_x(w, time));
      y = std::max(y, std::abs(d.y));
      z = std::max(z, std::abs(d.z));
    }
  }
  const std::string share_text =
      share > 0.0 ? fmt::format("{:.0f} % of the", 100.0 * share) : "the smooth track, but with hardly any of the";
  return fmt::format(
      "no static equilibrium at the start: the train has one on {} deviations of the rails under it ({:.3g} m along y, "
      "{:.3g} m along z), with larger ones a wheelset leaves its rails; begin elsewhere (train.start), or reduce the "
      "deviations",
      share_text, y, z);
}

}  // namespace

std::string no_equilibrium_message(const VsiModel& model, const EquilibriumReport& rest, double time) {
  if (auto deviations = too_large_deviations(model, rest.deviation_share, time)) return *deviations;
  const std::string what =
      fmt::format("no static equilibrium after {} iterations, also not on the smooth track", rest.iterations);
  const double acceleration = model.acceleration(time);
  const bool loads = !model.loads.empty();
  if (acceleration != 0.0 && has_equilibrium(without_loads(model, time, false), time)) {
    const bool alone = !loads || !has_equilibrium(without_loads(model, time, true), time);
    return fmt::format(
        "{}; there is one without {}: {:.3g} m/s² at t = {:.3g} s is too much, let train.speed_file "
        "begin with less",
        what, alone ? "the acceleration" : "acceleration and loads together", acceleration, time);
  }
  if (loads && has_equilibrium(without_loads(model, time, true), time)) {
    const std::string share =
        rest.load_share > 0.0 ? fmt::format("with {:.0f} % of", 100.0 * rest.load_share) : "without";
    return fmt::format("{}; there is one {} the loads that act at t = {:.3g} s: reduce them, or let them begin later",
                       what, share, time);
  }
  if (model.lateral_acceleration != 0.0) {
    VsiModel straight = without_loads(model, time, false);
    straight.lateral_acceleration = 0.0;
    if (has_equilibrium(straight, time)) {
      return fmt::format(
          "{}; there is one without the lateral acceleration of {:.3g} m/s² in the track's plane: reduce "
          "train.lateral_acceleration, or balance it by train.cant",
          what, model.lateral_acceleration);
    }
  }
  if (!model.geometry) return what;
  if (has_equilibrium(with_steel(model), time)) {
    return fmt::format("{}; there is one with wheels and rails of steel, but not with contact.material.E = {:.3g} Pa",
                       what, model.contact.normal.material.E);
  }
  if (const double slope = model.contact.friction_law.initial_slope;
      slope < 1.0 && has_equilibrium(with_full_slope(model), time)) {
    return fmt::format("{}; there is one with contact.initial_slope = 1, but not with {:.3g}", what, slope);
  }
  if (const auto weight = one_sided_weight(model, time)) return fmt::format("{}; {}", what, *weight);
  const WheelRailPair& pair = model.geometry->pair();
  return fmt::format(
      "{}, {}; check that the wheels fit the rails: {} on {}, track gauge {} m, flange backs {} m apart, and the "
      "origins of the profile files{}",
      what, loads || acceleration != 0.0 ? "nor without the loads at t = 0" : "under its weight alone",
      pair.wheel().knots().name, pair.rail().knots().name, pair.dimensions().track_gauge, pair.dimensions().flange_back,
      noise_hint(*model.geometry));
}

std::string steady_start_warning(const EquilibriumReport& start) {
  if (start.steady) return {};
  return "the track's deflection under the moving train is far from the static one (a track so soft that its dampers "
         "carry more than its springs, a train near the track's critical speed, or a [[wheel]] on a steep part of its "
         "deviation): the run begins with the static deflection, and its first seconds are a transient";
}

std::string displacement_warning(const SceneParameters& scene, const VsiModel& model, const VsiState& state) {
  const bool displaced = scene.train.initial_lateral_shift != 0.0 || scene.train.initial_yaw != 0.0;
  if (!displaced || !model.geometry) return {};
  const ContactProblem present = present_contact(model, state);
  const TrainContact contact = contact_at_rest(model);
  double largest = 0.0, load = 0.0, lift = 0.0;
  for (int w = 0; w < model.wheelsets(); ++w) {
    const ContactGeometry& geometry = *contact[w].geometry;
    const double b = geometry.pair().tape_circle_offset();
    load = std::max(load, wheel_load_at_rest(model.vehicle, w % model.wheelsets_per_vehicle()));
    for (const WheelSide side : {WheelSide::left, WheelSide::right}) {
      const bool left = side == WheelSide::left;
      const WheelsetMotion motion = wheelset_motion(present, present.predicted, w);
      const RailHeadMotion rail = rail_motion(present, present.predicted, w, left ? 0 : 1);
      const WheelContact found = wheel_contact(geometry, relative_pose(geometry.pair(), side, motion, rail));
      const double lateral = wheel_force(contact[w], side, motion, rail, found).wheelset[1];
      largest = std::max(largest, std::abs(lateral));
      const double below = motion.displacement[2] + (left ? -b : b) * motion.displacement[3];
      lift = std::max(lift, rail.displacement[1] - below);
    }
  }
  constexpr double steepest = 0.4;  // of the wheel load: treads and flange roots stay below 0.3
  constexpr double highest = 5e-3;  // m: treads stay within 1 mm; on the tips of flanges nothing is steep
  if (largest <= steepest * load && lift <= highest) return {};
  return fmt::format(
      "the train begins {:.3g} mm aside with a yaw of {:.3g} mrad, where flanges carry wheels, lifted by up to {:.2g} "
      "mm, and push against their rails with {:.3g} kN (static wheel load {:.3g} kN): the run begins with an impact",
      1e3 * scene.train.initial_lateral_shift, 1e3 * scene.train.initial_yaw, 1e3 * std::max(lift, 0.0), 1e-3 * largest,
      1e-3 * load);
}

}  // namespace railtab
