#include "railtab/runtime/vsi/simulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <map>

#include "railtab/runtime/base/stopwatch.hpp"
#include "railtab/runtime/vehicle/static_wheel_load.hpp"
#include "railtab/runtime/vsi/contact_energy_record.hpp"
#include "railtab/runtime/vsi/contact_touch.hpp"
#include "railtab/runtime/vsi/derailment.hpp"
#include "railtab/runtime/vsi/step.hpp"

namespace railtab {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

// Mean of a vehicle's wheels [N].
double mean_wheel_load(const VehicleModel& vehicle) {
  const int wheelsets = static_cast<int>(vehicle.wheelsets.size());
  double sum = 0.0;
  for (int w = 0; w < wheelsets; ++w) sum += static_wheel_load(vehicle, w);
  return sum / wheelsets;
}

void add_wheel_extremes(const VsiModel& model, VsiState& state) {
  for (int wheel = 0; wheel < 2 * model.wheelsets(); ++wheel) {
    const int unknown = rail_unknown(wheel);
    const double static_load = static_wheel_load(model.vehicle, (wheel / 2) % model.wheelsets_per_vehicle());
    state.wheel_extremes.add(state.time, wheel, state.contact.end_force[unknown], state.contact.end_force[unknown + 1],
                             static_load);
  }
}

// The step that bisects itself where Newton does not converge. Operators of halved steps are made when first needed.
class Integrator {
 public:
  Integrator(const VsiModel& model, const IntegrationParameters& p, const RunObserver& observer, double& seconds_setup)
      : model_(model),
        parameters_(p),
        workspace_(model),
        energy_(observer.energy),
        contact_energy_(observer.contact_energy),
        wheel_load_(mean_wheel_load(model.vehicle)) {
    if (model.structure) active_ = {0, model.structure->dofs()};
    if (model.window) window_.emplace(model, p.time_step);
    // What Newton leaves of the forces makes energy: steps that keep it end by the displacement.
    // Forces that change a thousand times as fast as Hertz's, those of creep at walking pace, do in any case.
    energy_limits_.newton = {.tolerance = std::min(1e-11, 1e-3 * p.tolerance), .max_iterations = p.max_iterations};
    // What Newton leaves the structure's answer cannot take away.
    energy_limits_.far_field_tolerance =
        std::max(energy_limits_.far_field_tolerance, 2.0 * energy_limits_.newton.tolerance);
    endpoint_limits_ = energy_limits_;
    endpoint_limits_.newton.force_tolerance = p.tolerance * wheel_load_;
    rule_ = p.contact_force;
    // Contacts that jump keep no energy; a constraint has none.
    const bool springs = model.normal_contact == NormalContact::hertz;
    if (!springs || (!rule_ && model.contact.geometry->is_paper())) rule_ = ContactForceRule::endpoint;
    const auto longer = [&](int level, double step) {
      return !rule_ && std::ldexp(p.time_step, -level) > step * (1.0 + 1e-9);
    };
    while (longer(impact_level_, impact_to_landing * p.impact_step)) ++impact_level_;
    landing_level_ = impact_level_;
    while (longer(landing_level_, p.impact_step)) ++landing_level_;
    static_cast<void>(operators(0, p.time_step, seconds_setup));
  }

  bool step(VsiState& state, RunSummary& summary) {
    if (window_) active_ = window_->move(state);
    summary.active_dofs = std::max<long>(summary.active_dofs, active_.count);
    if (!step(0, state, summary)) return false;
    if (window_) window_->vibrate(state);
    return true;
  }
  /// From here on as a run that begins here: nothing of earlier steps but the numbers of a checkpoint.
  void begin(VsiState& state) {
    workspace_.newton.inverse.clear();
    if (rule_ != ContactForceRule::endpoint) remember_contact(model_, state);
    if (account_ || (!energy_ && !contact_energy_) || model_.normal_contact != NormalContact::hertz) return;
    account_.emplace(model_, state);
    if (contact_energy_) energy_record_.emplace(*account_, state);
  }
  [[nodiscard]] std::optional<ContactEnergy> contact_energy() const {
    return energy_record_ ? std::optional(energy_record_->summary()) : std::nullopt;
  }

 private:
  // Operators of a step that ends at `time`.
  StepOperators& operators(int level, double time, double& seconds_setup) {
    const Stopwatch watch(seconds_setup);
    auto found = operators_.find(level);
    if (found == operators_.end()) {
      const HhtScheme scheme{.alpha = parameters_.alpha, .time_step = std::ldexp(parameters_.time_step, -level)};
      found = operators_.emplace(level, StepOperators(model_, scheme)).first;
    }
    found->second.follow(model_, time, active_);
    return found->second;
  }

  bool step(int level, VsiState& state, RunSummary& summary) {
    const int coarsest = coarsest_level(state);
    if (level < coarsest) {
      if (level == 0) ++summary.impact_steps;
      return divided(level, coarsest, state, summary);
    }
    const double end = state.time + std::ldexp(parameters_.time_step, -level);
    StepOperators& step_operators = operators(level, end, summary.seconds_setup);
    const ContactForceRule rule = rule_at(state);
    StepLimits limits = limits_of(rule);
    limits.smooth_only = !rule_ && (rule == ContactForceRule::endpoint || level < landing_level_);
    if (limits.smooth_only && level < landing_level_) limits.largest_change = hit * wheel_load_;
    StepReport report;
    // Where a table misses a patch, its forces jump, and there may be no solution on either side: then without it.
    for (const bool without_table : {false, true}) {
      if (without_table && (report.converged || !has_table())) break;
      limits.without_table = without_table;
      report = advance(rule, limits, step_operators, state, summary);
      if (report.converged || (report.touch_change == TouchChange::none && !report.hits)) continue;
      if (level < begin_impact(report, end, state)) return step(level, state, summary);
      // What the spring of a wheel that meets or leaves its rail takes up it shall give back.
      StepLimits accepting = limits_of(ContactForceRule::energy);
      accepting.without_table = without_table;
      report = advance(ContactForceRule::energy, accepting, step_operators, state, summary);
    }
    if (report.converged) {
      if (!rule_) follow_impact(report, step_operators.scheme, state);
      if (account_) account_->step(step_operators.scheme.gamma(), state);
      if (energy_record_) energy_record_->step(*account_, state);
      if (state.time > 0.0) add_wheel_extremes(model_, state);
      if (account_ && energy_) energy_(account_->balance());
      return true;
    }
    if (level - coarsest >= parameters_.max_halvings) return false;
    ++summary.halved_steps;
    return divided(level, level + 1, state, summary);
  }

  [[nodiscard]] int coarsest_level(const VsiState& state) const {
    if (state.time < state.landing_until) return landing_level_;
    return state.time < state.impact_until ? impact_level_ : 0;
  }

  // A step of one level as steps of a finer one.
  bool divided(int level, int finer, VsiState& state, RunSummary& summary) {
    for (int part = 0; part < 1 << (finer - level); ++part) {
      if (!step(finer, state, summary)) return false;
    }
    return true;
  }

  // The level of a step that ends at `end`, with what has happened in it; steps until then take it. A wheel that runs
  // upon a kink stays on its rail, but its force vibrates as after a landing.
  int begin_impact(const StepReport& report, double end, VsiState& state) const {
    if (report.touch_change == TouchChange::met) {
      state.landing_until = std::max(state.landing_until, end);
      return landing_level_;
    }
    if (report.hits) {
      state.landing_until = std::max(state.landing_until, end + longest_landing);
      state.impact_until = std::max(state.impact_until, end + longest_impact);
      return landing_level_;
    }
    state.impact_until = std::max(state.impact_until, end);
    return impact_level_;
  }

  // How long from the end of a step on steps are those of an impact, and contacts keep their energy.
  void follow_impact(const StepReport& report, const HhtScheme& scheme, VsiState& state) const {
    if (report.touch_change == TouchChange::met) state.landing_until = state.time + longest_landing;
    if (report.touch_change != TouchChange::none) state.impact_until = state.energy_until = state.time + longest_impact;
    if (scheme.contact_force == ContactForceRule::energy && swings(state)) {
      state.energy_until = std::max(state.energy_until, state.time + 0.5 * scheme.time_step);
    }
  }

  // After an impact the contacts' part p of Eq. 12 alternates about the force, and a change of the rule would leave an
  // impulse behind: whether it still does.
  [[nodiscard]] bool swings(const VsiState& state) const {
    constexpr double share = 1e-3;  // of the static wheel load
    double largest = 0.0;
    for (int wheel = 0; wheel < 2 * model_.wheelsets(); ++wheel) {
      const auto force = [wheel](const Eigen::VectorXd& f) { return f.segment<2>(rail_unknown(wheel)); };
      largest =
          std::max(largest, (force(state.contact.step_load) - force(state.contact.end_force)).cwiseAbs().maxCoeff());
    }
    return largest > share * wheel_load_;
  }

  [[nodiscard]] ContactForceRule rule_at(const VsiState& state) const {
    return rule_.value_or(state.time < state.energy_until ? ContactForceRule::energy : ContactForceRule::endpoint);
  }

  [[nodiscard]] bool has_table() const {
    return model_.normal_contact == NormalContact::hertz && model_.contact.geometry->is_table();
  }

  [[nodiscard]] const StepLimits& limits_of(ContactForceRule rule) const {
    return rule == ContactForceRule::energy ? energy_limits_ : endpoint_limits_;
  }
  StepReport advance(ContactForceRule rule, const StepLimits& limits, StepOperators& step_operators, VsiState& state,
                     RunSummary& summary) {
    step_operators.scheme.contact_force = rule;
    const StepReport report = railtab::advance(model_, step_operators, limits, state, workspace_);
    summary.newton_iterations += report.newton_iterations;
    summary.back_substitutions += report.back_substitutions;
    summary.contact_queries += report.counts.queries;
    summary.table_queries += report.counts.table_queries;
    summary.outside_creep_table += report.counts.outside_creep_table;
    summary.seconds_lookup += report.counts.seconds_lookup;
    summary.seconds_contact += report.seconds_contact;
    summary.seconds_structure += report.seconds_structure;
    summary.seconds_vehicle += report.seconds_vehicle;
    return report;
  }

  const VsiModel& model_;
  IntegrationParameters parameters_;
  StepLimits endpoint_limits_, energy_limits_;
  std::optional<ContactForceRule> rule_;  // none: automatic
  int impact_level_ = 0;                  // halvings of a step of an impact
  int landing_level_ = 0;                 // and of one just after a wheel has met its rail
  StepWorkspace workspace_;
  std::map<int, StepOperators> operators_;
  std::function<void(const EnergyBalance&)> energy_;
  bool contact_energy_;
  double wheel_load_;  // static [N]
  std::optional<EnergyAccount> account_;
  std::optional<ContactEnergyRecord> energy_record_;
  DofRange active_;  // unknowns of the structure that take part
  std::optional<MovingWindow> window_;
};

}  // namespace

RunSummary simulate(const VsiModel& model, const IntegrationParameters& integration, double duration, int record_every,
                    VsiState& state, const RunObserver& observer, long first_step) {
  RunSummary summary;
  const Clock::time_point begin = Clock::now();
  Integrator integrator(model, integration, observer, summary.seconds_setup);
  const auto steps = std::lround(duration / integration.time_step);
  StepRecord record;
  const auto emit = [&] {
    if (!observer.record) return;
    const Clock::time_point output_begin = Clock::now();
    fill_record(model, state, record);
    observer.record(record);
    summary.seconds_output += seconds_since(output_begin);
  };

  integrator.begin(state);
  if (observer.ready) observer.ready();
  bool recorded = true;  // what has been reached
  summary.steps = summary.counted_from = first_step;
  if (first_step == 0) {
    add_wheel_extremes(model, state);
    emit();
  }
  while (summary.steps < steps) {
    const long iterations_before = summary.newton_iterations;
    if (!integrator.step(state, summary)) {
      summary.message = fmt::format("the step to t = {:.6f} s did not converge after {} halvings of {} s",
                                    static_cast<double>(summary.steps + 1) * integration.time_step,
                                    integration.max_halvings, integration.time_step);
      break;
    }
    ++summary.steps;
    state.time = static_cast<double>(summary.steps) * integration.time_step;  // no drift over long runs
    record.newton_iterations = static_cast<int>(summary.newton_iterations - iterations_before);
    recorded = summary.steps % record_every == 0;
    if (recorded) emit();
    summary.interrupted = observer.stop && observer.stop() && summary.steps < steps;
    if (observer.checkpoint && (summary.interrupted || summary.steps % observer.checkpoint_every == 0)) {
      observer.checkpoint(summary.steps, packed(state));
    }
    if (summary.steps % observer.checkpoint_every == 0) integrator.begin(state);
    if (summary.interrupted) {
      summary.message = "interrupted";
      break;
    }
    summary.message = derailment(model, state);
    if (!summary.message.empty()) break;
    if (observer.progress) observer.progress(static_cast<double>(summary.steps) / static_cast<double>(steps));
  }
  summary.contact_energy = integrator.contact_energy();
  summary.wheel_extremes = state.wheel_extremes;
  if (!recorded) emit();  // after a checkpoint: a resumed run leaves the record away again
  summary.complete = summary.steps == steps && summary.message.empty();
  summary.seconds_total = seconds_since(begin);
  summary.vehicle_dofs = static_cast<long>(model.vehicle.dofs()) * static_cast<long>(model.vehicle_x.size());
  summary.structure_dofs = model.structure ? model.structure->dofs() : 0;
  return summary;
}

}  // namespace railtab
