#include "railtab/runtime/scene/scene_warnings.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "railtab/runtime/assessment/dynamic_need.hpp"
#include "railtab/runtime/contact_files/contact_table_file.hpp"
#include "railtab/runtime/profile/point_noise.hpp"
#include "railtab/runtime/scene/key_table.hpp"
#include "railtab/runtime/scene/scene_case.hpp"
#include "railtab/runtime/scene/scene_contact.hpp"
#include "railtab/runtime/scene/scene_model.hpp"
#include "railtab/runtime/scene/start_checks.hpp"

namespace railtab {
namespace scene {

std::string text(const Interval& interval, std::string_view name, std::string_view unit) {
  return fmt::format("{} = {:.6g} to {:.6g} {}", name, interval.low, interval.high, unit);
}

double first_frequency(const BridgeParameters& span) {
  return 0.5 * std::numbers::pi / (span.length * span.length) * std::sqrt(span.E * span.Iy / span.mass);
}

namespace {

/// Of a profile that the contact search takes through its points.
void warn_of_noise(const ProfileKnots& profile, Warnings& list) {
  const PointNoise noise = point_noise(profile);
  const std::string warning = noise_warning(profile.name, noise);
  if (warning.empty()) return;
  list.push_back(fmt::format("{}; make a table by tablegen geometry --smoothing {:.1g} and name it in contact.table",
                             warning, noise.smoothing));
}

/// Whether the scene names its profiles itself; those of a table were checked when it was made.
bool has_own_profiles(const SceneCase& at) { return at.model.geometry && at.scene.contact.table.empty(); }

constexpr std::string_view with_noise = "its points scatter: they bend the curve through them by more than 3 1/m";

}  // namespace

const Warning noisy_wheel_profile{with_noise, [](const SceneCase& at, Warnings& list) {
                                    if (!has_own_profiles(at)) return;
                                    for (const auto& geometry : contact_geometries(at.model))
                                      warn_of_noise(geometry->pair().wheel().knots(), list);
                                  }};

const Warning noisy_rail_profile{with_noise, [](const SceneCase& at, Warnings& list) {
                                   if (has_own_profiles(at))
                                     warn_of_noise(at.model.geometry->pair().rail().knots(), list);
                                 }};

const Warning energy_rule_with_paper_search{
    "it is \"energy\" with contact.mode = \"paper\"", [](const SceneCase& at, Warnings& list) {
      const ContactParameters& contact = at.scene.contact;
      if (contact.normal != NormalContact::hertz || contact.mode != ContactMode::paper) return;
      if (at.scene.integration.contact_force != ContactForceRule::energy) return;
      list.emplace_back(
          "integration.contact_force = \"energy\" with contact.mode = \"paper\": its contact points jump, no force "
          "conserves the energy of the contact springs over a jump, and a step may have no solution; use "
          "\"automatic\", which is then \"endpoint\"");
    }};

const Warning inaccurate_loaded_table{
    "a loaded part of a contact table is certified worse than 5 %, and is not used",
    [](const SceneCase& at, Warnings& list) {
      for (const auto& geometry : contact_geometries(at.model)) {
        const std::string unused = geometry ? unused_loaded_part(*geometry) : "";  // wheels without profiles have none
        if (unused.empty()) continue;
        list.push_back(fmt::format("contact: {}; contact.elastic = \"half-space\" uses it nevertheless", unused));
      }
    }};

const Warning structure_unlike_a_bridge{
    "mass per metre or first natural frequency is implausible for a bridge, its deck ends before x = 0 or begins "
    "beyond 1000 m, or modes lack more than 5 % of the static flexibility",
    [](const SceneCase& at, Warnings& list) {
      list.insert(list.end(), at.model.structure_warnings.begin(), at.model.structure_warnings.end());
    }};

const Warning span_unlike_a_bridge{
    "the first natural frequency of a span of 4 m to 100 m is below a third of the lower or above three times the "
    "upper limit of EN 1991-2, Figure 6.10",
    [](const SceneCase& at, Warnings& list) {
      for (const BridgeParameters& span : at.scene.spans) {
        const std::string unlike = frequency_unlike_a_bridge(span.length, first_frequency(span));
        if (unlike.empty()) continue;
        list.push_back(unlike + ": are bridge.mass (per metre) and E Iy meant so?");
        return;
      }
    }};

const Warning start_on_flanges{"flanges carry wheels at t = 0", nullptr, displacement_warning};

namespace {

/// Where the train's wheelsets run.
Interval wheel_way(const VsiModel& model, double duration) {
  return {model.wheelset_x(model.wheelsets() - 1, 0.0), model.wheelset_x(0, duration)};
}

SceneCase case_of(const SceneParameters& scene, const VsiModel& model) {
  const double duration = run_duration(scene, model);
  SceneCase result{scene, model, duration, wheel_way(model, duration), {}};
  for (const GroundMotionParameters& ground : scene.ground_motion) {
    result.records.push_back(read_ground_record(ground.file));
  }
  return result;
}

}  // namespace
}  // namespace scene

std::vector<std::string> scene_warnings(const SceneParameters& scene, const VsiModel& model) {
  const scene::SceneCase at = scene::case_of(scene, model);
  std::vector<std::string> list;
  for (const scene::KeyRow& row : scene::all_keys()) {
    for (const scene::Warning* warning : row.warns) {
      if (warning->check) warning->check(at, list);
    }
  }
  return list;
}

std::vector<std::string> start_warnings(const SceneParameters& scene, const VsiModel& model, const VsiState& start) {
  std::vector<std::string> list;
  for (const scene::KeyRow& row : scene::all_keys()) {
    for (const scene::Warning* warning : row.warns) {
      if (!warning->check_start) continue;
      std::string sentence = warning->check_start(scene, model, start);
      if (!sentence.empty()) list.push_back(std::move(sentence));
    }
  }
  return list;
}

}  // namespace railtab
