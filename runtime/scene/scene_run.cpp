#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/results/deck_envelope.hpp"
#include "railtab/runtime/scene/result_header.hpp"
#include "railtab/runtime/scene/scene_contact.hpp"
#include "railtab/runtime/scene/scene_model.hpp"
#include "railtab/runtime/scene/scene_parameters.hpp"
#include "railtab/runtime/scene/scene_run.hpp"
#include "railtab/runtime/scene/scene_warnings.hpp"
#include "railtab/runtime/scene/start_checks.hpp"
#include "railtab/runtime/scene/step_count.hpp"
#include "railtab/runtime/scene/timed_model.hpp"
#include "railtab/runtime/vsi/simulation.hpp"
#include "railtab/runtime/vsi/step_record.hpp"

namespace railtab {

namespace {

// The contact points of the published search jump as a wheel moves, and a static equilibrium has no inertia to hold the
// wheel meanwhile: it is sought with the online search, and the pre-roll removes the remaining transient.
std::optional<VsiModel> other_model_at_rest(const SceneParameters& scene, const VsiModel& model) {
  if (!model.geometry || !model.geometry->is_paper()) return std::nullopt;
  VsiModel rest = model;
  for (const std::shared_ptr<const ContactGeometry>& geometry : contact_geometries(model)) {
    const auto searched = std::make_shared<const ContactGeometry>(ContactSearch(geometry->pair()));
    if (geometry == model.geometry) rest.geometry = searched;
    std::replace(rest.wheelset_geometry.begin(), rest.wheelset_geometry.end(), geometry, searched);
  }
  rest.contact.geometry = rest.geometry.get();
  rest.contact.normal.curvature_floor = scene.contact.curvature_floor;
  return rest;
}

// The residual of the creep forces in the first steps decays within tenths of a second only, the slower the train: 100
// N of Y after the pre-roll at 40 km/h with the default tolerance. Its few steps take a tighter one.
IntegrationParameters pre_roll_parameters(const IntegrationParameters& integration) {
  constexpr double tight = 1e-7;
  IntegrationParameters parameters = integration;
  parameters.tolerance = std::min(tight, parameters.tolerance);
  return parameters;
}

// State at t = 0: steady, after a pre-roll where there is track for it, whose time is set. A pre-roll that fails is
// left out. Returns why there is no such state, or nothing.
template <class Warn>
std::string start(const SceneParameters& scene, OperatorLevels& operators, const Warn& warn, VsiState& state,
                  double& seconds_pre_roll) {
  const VsiModel& model = operators.model();
  const std::optional<VsiModel> other = other_model_at_rest(scene, model);
  const VsiModel& at_rest = other ? *other : model;
  const long before = pre_roll_steps(scene.integration, model);
  if (before > 0) {
    // pairs that jump have no solution to such a tolerance
    const bool jumps = model.geometry && model.geometry->is_paper();
    const IntegrationParameters pre_roll = jumps ? scene.integration : pre_roll_parameters(scene.integration);
    VsiState early(model);
    const double early_begin = -static_cast<double>(before) * scene.integration.time_step;
    early.time = early_begin;
    const EquilibriumReport rest = steady_start(at_rest, early);
    RunSummary rolled;
    if (rest.converged) rolled = simulate(operators, pre_roll, 0.0, 1, early, {});
    if (rolled.complete) {
      seconds_pre_roll = rolled.seconds_total - rolled.seconds_setup;
      warn(steady_start_warning(rest));
      state = std::move(early);
      return {};
    }
    warn(
        fmt::format("the pre-roll over {:.2g} s fails ({}): the run begins without it, and its first forces lack what "
                    "the sleepers excite",
                    -early_begin, rest.converged ? rolled.message : "no equilibrium where it begins"));
  }
  const EquilibriumReport rest = steady_start(at_rest, state);
  if (!rest.converged) return no_equilibrium_message(at_rest, rest, state.time);
  warn(steady_start_warning(rest));
  return {};
}

// Where a hunting study begins. @throws InputError where nothing there carries the wheels
void displace(const SceneParameters& scene, const VsiModel& model, VsiState& state) {
  const double shift = scene.train.initial_lateral_shift, yaw = scene.train.initial_yaw;
  if (displace_train(model, shift, yaw, state)) return;
  throw input_error(
      "scene: train.initial_lateral_shift", fmt::format("{} m with a yaw of {} rad", shift, yaw),
      "a place of the wheelsets at which both wheels carry their loads, no more than 40 mm above their rails");
}

// What was done to the points of measured profiles.
void note_repairs(const VsiModel& model, const RunObserver& observer) {
  if (!model.geometry) return;
  const auto note = [&](const ProfileKnots& profile) {
    for (const std::string& text : profile.notes) observer.note(text);
  };
  note(model.geometry->pair().rail().knots());
  for (const auto& geometry : contact_geometries(model)) note(geometry->pair().wheel().knots());
}

// What the scene asks to know of the whole deck, and its places for the header.
std::optional<DeckEnvelope> deck_envelope(const SceneParameters& scene, const VsiModel& model, ResultHeader& header) {
  if (!scene.output.deck_envelope) return std::nullopt;
  std::optional<DeckEnvelope> envelope(std::in_place, model, scene.output.deck_cut_off, scene.integration.time_step);
  header.deck = envelope->places();
  header.deck_cut_off = scene.output.deck_cut_off;
  return envelope;
}

// The envelope hears of every step; its numbers stand behind the solver's in checkpoints.
void follow_deck(DeckEnvelope& envelope, RunObserver& observer) {
  observer.state = [&envelope, then = std::move(observer.state)](const VsiState& state) {
    envelope.add(state);
    if (then) then(state);
  };
  if (!observer.checkpoint) return;
  observer.checkpoint = [&envelope, then = std::move(observer.checkpoint)](long step, std::span<const double> state) {
    std::vector<double> numbers(state.begin(), state.end());
    envelope.pack(numbers);
    then(step, numbers);
  };
}

void unpack(std::span<const double> numbers, VsiState& state, std::optional<DeckEnvelope>& envelope) {
  if (envelope) {
    const std::span<const double> own = numbers.last(packed_envelope(numbers));
    envelope->unpack(own);
    numbers = numbers.first(numbers.size() - own.size());
  }
  railtab::unpack(numbers, state);
}

}  // namespace

RunSummary run_scene(const SceneParameters& scene, const RunObserver& observer,
                     const std::optional<RunCheckpoint>& resume, SharedSetUp* shared) {
  if (observer.setup) observer.setup("building the model");
  const TimedModel timed(scene, shared);
  return timed.counted(run_scene(scene, timed.model(), observer, resume));
}

RunSummary run_scene(const SceneParameters& scene, const VsiModel& model, const RunObserver& observer,
                     const std::optional<RunCheckpoint>& resume) {
  const auto begin = std::chrono::steady_clock::now();
  const auto setup = [&](std::string_view part) {
    if (observer.setup) observer.setup(part);
  };
  ResultHeader header;
  const auto warn = [&](const std::string& warning) {
    if (warning.empty()) return;
    header.warnings.push_back(warning);
    if (observer.warning) observer.warning(warning);
  };
  if (observer.note) note_repairs(model, observer);
  const std::vector<std::string> of_scene = scene_warnings(scene, model);
  const double duration = run_duration(scene, model);
  static_cast<void>(step_count(scene.integration, duration));
  header = result_header(scene, model);
  for (const std::string& warning : of_scene) warn(warning);
  const OutputSelection selection(scene.output, header);
  VsiState state(model);
  std::optional<DeckEnvelope> envelope = deck_envelope(scene, model, header);
  OperatorLevels operators(model, scene.integration.alpha, scene.integration.time_step);
  std::string no_rest;
  double seconds_pre_roll = 0.0;
  if (resume) {
    unpack(resume->state, state, envelope);
  } else {
    setup("static equilibrium");
    no_rest = start(scene, operators, warn, state, seconds_pre_roll);
    if (no_rest.empty()) {
      displace(scene, model, state);
      for (const std::string& warning : start_warnings(scene, model, state)) warn(warning);
    }
  }
  if (observer.start) observer.start(selection.of(header));
  RunSummary summary;
  summary.contact_mode = contact_mode_name(scene.contact);
  if (!no_rest.empty()) {
    summary.message = no_rest;
    return summary;
  }
  RunObserver selected = observer;
  selected.contact_energy = observer.contact_energy || scene.output.energy;
  if (observer.record) {
    selected.record = [&](StepRecord& record) {
      selection.cut(record);
      observer.record(record);
    };
  }
  if (envelope) follow_deck(*envelope, selected);
  setup("factorising");
  const double set_up = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  summary = simulate(operators, scene.integration, duration, scene.output.every, state, selected);
  if (!scene.output.wheels) summary.wheel_extremes = {};
  if (envelope) summary.deck = envelope->finish();
  summary.seconds_setup += set_up;
  summary.seconds_pre_roll = seconds_pre_roll;
  summary.seconds_total += set_up;
  summary.contact_mode = contact_mode_name(scene.contact);
  return summary;
}

}  // namespace railtab
