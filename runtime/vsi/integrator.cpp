#include "railtab/runtime/vsi/integrator.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "railtab/runtime/vehicle/static_wheel_load.hpp"
#include "railtab/runtime/vsi/simulation.hpp"

namespace railtab {

namespace {

// Mean of a vehicle's wheels [N].
double mean_wheel_load(const VehicleModel& vehicle) {
  const int wheelsets = static_cast<int>(vehicle.wheelsets.size());
  double sum = 0.0;
  for (int w = 0; w < wheelsets; ++w) sum += wheel_load_at_rest(vehicle, w);
  return sum / wheelsets;
}

}  // namespace

void record_wheel_extremes(const VsiModel& model, VsiState& state) {
  for (int wheel = 0; wheel < 2 * model.wheelsets(); ++wheel) {
    const double x = model.wheelset_x(wheel / 2, state.time);
    if (!is_judged(model.judged, x)) continue;
    const int unknown = rail_unknown(wheel);
    const double static_load = static_wheel_load(model.vehicle, (wheel / 2) % model.wheelsets_per_vehicle());
    state.wheel_extremes.add(state.time, wheel, state.contact.end_force[unknown], state.contact.end_force[unknown + 1],
                             static_load);
  }
}

void record_stops(const VsiModel& model, const ElongationRows& rows, VsiState& state) {
  const ForceElements& elements = model.vehicle.elements;
  if (elements.empty()) return;
  for (std::size_t v = 0; v < state.vehicle.size(); ++v) {
    for (std::size_t i = 0; i < elements.element.size(); ++i) {
      const ForceElement& e = elements.element[i];
      if (e.kind != ForceElementKind::stop) continue;
      double elongation = 0.0;
      for (ElongationRows::InnerIterator of(rows, e.row); of; ++of) {
        elongation += of.value() * state.vehicle[v].displacement[of.col()];
      }
      const StopEvent event{state.time, std::abs(e.curve.at(elongation).force),
                            static_cast<int>(v * elements.element.size() + i)};
      if (event.force <= 0.0) continue;
      if (!state.stops.first.found()) state.stops.first = event;
      if (event.force > state.stops.largest.force) state.stops.largest = event;
    }
  }
}

Integrator::Integrator(OperatorLevels& operators, const IntegrationParameters& parameters,
                       std::function<void(const EnergyBalance&)> energy, bool contact_energy)
    : model_(operators.model()),
      parameters_(parameters),
      wheel_load_(mean_wheel_load(model_.vehicle)),
      force_rule_(model_, parameters, wheel_load_),
      division_(parameters, force_rule_.automatic(), wheel_load_),
      retry_(model_),
      contact_law_(make_contact_law(model_)),
      workspace_(model_),
      operators_(operators),
      elongation_rows_(model_.vehicle.elements.rows.sparseView()),
      energy_(std::move(energy)),
      contact_energy_(contact_energy) {
  if (model_.structure) active_ = {0, model_.structure->dofs()};
  if (model_.window) window_.emplace(model_, parameters.time_step);
}

void Integrator::prepare(VsiState& state) {
  if (window_) active_ = window_->move(state);
  static_cast<void>(operators(0, state.time + parameters_.time_step));
}

bool Integrator::step(VsiState& state) {
  if (window_) {
    active_ = window_->move(state);
    counts_.window_error = window_->error();
  }
  counts_.active_dofs = std::max<long>(counts_.active_dofs, active_.count);
  if (!make_steps(state)) return false;
  if (window_) window_->step_inactive_spans(state);
  return true;
}

// The time step as sub-steps on a binary clock: `pending_` holds the levels of those still to be made, the next one
// last.
bool Integrator::make_steps(VsiState& state) {
  pending_.assign(1, 0);
  const auto divide = [&](int finer) {
    const int level = pending_.back();
    pending_.pop_back();
    pending_.insert(pending_.end(), std::size_t{1} << (finer - level), finer);
  };
  while (!pending_.empty()) {
    const int level = pending_.back(), coarsest = division_.coarsest_level(state);
    if (level < coarsest) {
      if (level == 0) ++counts_.impact_steps;
      divide(coarsest);
      continue;
    }
    switch (attempt(level, state).outcome) {
      case StepOutcome::accepted:
        pending_.pop_back();
        break;
      case StepOutcome::contact_state_changed:
      case StepOutcome::force_jumped:
        break;  // an impact has begun: the coarsest level is finer now
      case StepOutcome::diverged:
        if (!division_.may_halve(level, coarsest)) return false;
        ++counts_.halved_steps;
        divide(level + 1);
        break;
    }
  }
  return true;
}

// One step of a level with the geometry of the scene, and where that has no solution with the one to retry with.
StepReport Integrator::attempt(int level, VsiState& state) {
  const ContactForceRule rule = force_rule_.rule(state);
  StepLimits limits = limits_of(rule);
  limits.rejected = division_.rejected_events(level, rule);
  limits.force_jump = division_.force_jump();
  limits.light_touch = division_.light_touch();
  const double end = state.time + operators_.length(level);
  StepReport report;
  ContactForceRule used = rule;
  for (std::optional<GeometrySource> geometry = GeometrySource::model; geometry;
       geometry = retry_.after(report.outcome, *geometry)) {
    limits.geometry = *geometry;
    used = rule;
    report = solve(level, limits, state);
    if (report.outcome == StepOutcome::accepted || report.outcome == StepOutcome::diverged) continue;
    if (level < division_.begin_impact(report, end, state)) return report;
    // No division left: what the spring of a wheel that meets or leaves its rail takes up it shall give back.
    used = ContactForceRule::energy;
    StepLimits accepting = limits_of(used);
    accepting.geometry = *geometry;
    accepting.light_touch = limits.light_touch;
    report = solve(level, accepting, state);
  }
  if (report.outcome == StepOutcome::accepted) after_step(report, level, used, state);
  return report;
}

StepReport Integrator::solve(int level, const StepLimits& limits, VsiState& state) {
  const double end = state.time + operators_.length(level);
  const StepOperators& op = operators(level, end);
  const StepReport report = advance(model_, op, limits, state, *contact_law_, workspace_);
  counts_.newton_iterations += report.newton_iterations;
  counts_.back_substitutions += report.back_substitutions;
  counts_.contact += report.counts;
  times_ += report.times;
  return report;
}

void Integrator::after_step(const StepReport& report, int level, ContactForceRule rule, VsiState& state) {
  const StepOperators& op = operators_.at(level);
  division_.after_step(report.contact_change, state);
  force_rule_.after_step(report.contact_change, rule, op.scheme.time_step, state);
  if (account_) account_->step(op.scheme.gamma(), state);
  if (energy_record_) energy_record_->step(*account_, state);
  if (state.time > 0.0) {
    record_wheel_extremes(model_, state);
    record_stops(model_, elongation_rows_, state);
  }
  if (account_ && energy_) energy_(account_->balance());
}

StepLimits Integrator::limits_of(ContactForceRule rule) const {
  StepLimits limits;
  limits.contact_force = rule;
  // The residual of the contact forces adds energy: steps that keep it end by the displacement. Forces that change a
  // thousand times as fast as Hertz's, those of creep at walking pace, do in any case.
  limits.newton = {.tolerance = std::min(1e-11, 1e-3 * parameters_.tolerance),
                   .max_iterations = parameters_.max_iterations};
  // The structure's response cannot remove Newton's residual.
  limits.far_field_tolerance = std::max(limits.far_field_tolerance, 2.0 * limits.newton.tolerance);
  if (rule == ContactForceRule::endpoint) limits.newton.force_tolerance = parameters_.tolerance * wheel_load_;
  return limits;
}

const StepOperators& Integrator::operators(int level, double end) {
  const Stopwatch watch = times_.measure(Phase::setup);
  return operators_.update(level, end, active_);
}

void Integrator::reinitialise(VsiState& state) {
  contact_law_->reinitialise();
  // A resumed run begins with the motion in the unknowns' own order. Bringing it into the sections' order rounds it, so
  // this run does the same.
  static_cast<void>(state.structure.whole());
  if (force_rule_.may_keep_energy()) evaluate_contact_at(model_, state);
  if (account_ || (!energy_ && !contact_energy_) || model_.normal_contact != NormalContact::hertz) return;
  account_.emplace(model_, state);
  if (!contact_energy_) return;
  VsiState at = state;  // which wheels touch is no part of a resumed state
  if (!force_rule_.may_keep_energy()) evaluate_contact_at(model_, at);
  energy_record_.emplace(*account_, at);
}

}  // namespace railtab
