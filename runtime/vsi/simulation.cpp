#include "railtab/runtime/vsi/simulation.hpp"

#include <fmt/format.h>

#include <cassert>
#include <cmath>

#include "railtab/runtime/vsi/derailment.hpp"
#include "railtab/runtime/vsi/integrator.hpp"

namespace railtab {

namespace {

void add_counts(const StepCounts& counts, RunSummary& summary) {
  summary.newton_iterations = counts.newton_iterations;
  summary.back_substitutions = counts.back_substitutions;
  summary.halved_steps = counts.halved_steps;
  summary.impact_steps = counts.impact_steps;
  summary.active_dofs = counts.active_dofs;
  summary.window_error = counts.window_error;
  summary.contact_queries = counts.contact.queries;
  summary.table_queries = counts.contact.table_queries;
  summary.outside_creep_table = counts.contact.outside_creep_table;
}

void add_times(const StepTimes& times, RunSummary& summary) {
  summary.seconds_setup = times.seconds(Phase::setup);
  summary.seconds_lookup = times.seconds(Phase::lookup);
  summary.seconds_contact = times.seconds(Phase::contact);
  summary.seconds_structure = times.seconds(Phase::structure);
  summary.seconds_vehicle = times.seconds(Phase::vehicle);
  summary.seconds_output = times.seconds(Phase::output);
}

std::optional<StopSummary> stop_summary(const VsiModel& model, const StopExtremes& stops) {
  if (!stops.first.found()) return std::nullopt;
  const std::vector<ForceElement>& elements = model.vehicle.elements.element;
  const auto name = [&](const StopEvent& event) {
    const auto i = static_cast<std::size_t>(event.element);
    const ForceElement& element = elements[i % elements.size()];
    const auto vehicle = static_cast<int>(i / elements.size());
    return fmt::format("coach-{}: {}", vehicle * model.vehicle.coaches + element.coach + 1, element.name);
  };
  return StopSummary{name(stops.first), name(stops.largest), stops.first.time, stops.largest.force, stops.largest.time};
}

// A run of whole time steps and those who listen to it.
class Run {
 public:
  Run(OperatorLevels& operators, const IntegrationParameters& integration, int record_every, VsiState& state,
      const RunObserver& observer)
      : model_(operators.model()),
        parameters_(integration),
        record_every_(record_every),
        state_(state),
        observer_(observer),
        integrator_(operators, integration, observer.energy, observer.contact_energy) {
    assert(integration.reinitialise_every >= 1);
  }

  void steps(long first, long last, RunSummary& summary) {
    if (first < last) integrator_.prepare(state_);
    integrator_.reinitialise(state_);
    if (observer_.ready) observer_.ready();
    bool recorded = first % record_every_ == 0;  // what has been reached
    summary.steps = summary.counted_from = first;
    if (first == 0) {
      record_wheel_extremes(model_, state_);
      record_stops(model_, model_.vehicle.elements.rows.sparseView(), state_);
      tell_state();
      emit();
    }
    while (summary.steps < last && summary.message.empty()) {
      if (!make_step(summary)) break;
      tell_state();
      recorded = summary.steps % record_every_ == 0;
      if (recorded) emit();
      summary.interrupted = observer_.stop && observer_.stop() && summary.steps < last;
      reinitialise_at_checkpoints(summary);
      summary.message = summary.interrupted ? "interrupted" : derailment(model_, state_);
      if (summary.message.empty() && observer_.progress) {
        observer_.progress(static_cast<double>(summary.steps) / static_cast<double>(last));
      }
    }
    summary.contact_energy = integrator_.contact_energy();
    summary.wheel_extremes = state_.wheel_extremes;
    summary.stops = stop_summary(model_, state_.stops);
    if (!recorded) emit();  // after a checkpoint: a resumed run leaves the record away again
    add_counts(integrator_.counts(), summary);
    add_times(integrator_.times(), summary);
  }

 private:
  void tell_state() {
    if (!observer_.state) return;
    const Stopwatch watch = integrator_.times().measure(Phase::output);
    observer_.state(state_);
  }

  void emit() {
    if (!observer_.record) return;
    const Stopwatch watch = integrator_.times().measure(Phase::output);
    fill_record(model_, state_, record_, observer_.contact_points);
    observer_.record(record_);
  }

  bool make_step(RunSummary& summary) {
    const long iterations_before = integrator_.counts().newton_iterations;
    const double end = static_cast<double>(summary.steps + 1) * parameters_.time_step;
    if (!integrator_.step(state_)) {
      summary.message = fmt::format("the step to t = {:.6f} s did not converge after {} halvings of {} s", end,
                                    parameters_.max_halvings, parameters_.time_step);
      return false;
    }
    ++summary.steps;
    state_.time = end;  // no drift over long runs
    record_.newton_iterations = static_cast<int>(integrator_.counts().newton_iterations - iterations_before);
    return true;
  }

  void reinitialise_at_checkpoints(const RunSummary& summary) {
    const bool checkpoint = summary.steps % parameters_.reinitialise_every == 0;
    if (observer_.checkpoint && (summary.interrupted || checkpoint)) {
      observer_.checkpoint(summary.steps, packed(state_));
    }
    if (checkpoint) integrator_.reinitialise(state_);
  }

  const VsiModel& model_;
  const IntegrationParameters& parameters_;
  int record_every_;
  VsiState& state_;
  const RunObserver& observer_;
  Integrator integrator_;
  StepRecord record_;
};

}  // namespace

RunSummary simulate(const VsiModel& model, const IntegrationParameters& integration, double duration, int record_every,
                    VsiState& state, const RunObserver& observer) {
  OperatorLevels operators(model, integration.alpha, integration.time_step);
  return simulate(operators, integration, duration, record_every, state, observer);
}

RunSummary simulate(OperatorLevels& operators, const IntegrationParameters& integration, double duration,
                    int record_every, VsiState& state, const RunObserver& observer) {
  const VsiModel& model = operators.model();
  RunSummary summary;
  const long first = std::lround(state.time / integration.time_step);
  const long steps = std::lround(duration / integration.time_step);
  {
    const Stopwatch watch(summary.seconds_total);
    Run(operators, integration, record_every, state, observer).steps(first, steps, summary);
  }
  summary.complete = summary.steps == steps && summary.message.empty();
  summary.vehicle_dofs = static_cast<long>(model.vehicle.dofs()) * static_cast<long>(model.vehicle_x.size());
  summary.structure_dofs = model.structure ? model.structure->dofs() : 0;
  return summary;
}

}  // namespace railtab
