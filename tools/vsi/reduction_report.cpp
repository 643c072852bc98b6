#include "reduction_report.hpp"

#include <fmt/format.h>

#include "command/json_text.hpp"
#include "command/print.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/scene/reduction_check.hpp"

namespace railtab::vsi {
namespace {

double step_ms(const RunSummary& s) { return 1e3 * (s.seconds_total - s.seconds_setup) / static_cast<double>(s.steps); }

void print_as_json(const SceneParameters& scene, const ReductionError& e) {
  print_json_line({{"reduction", reduction_name(scene.reduction.kind)},
                   {"seconds", e.duration},
                   {"force_max", e.force_max},
                   {"force_rms", e.force_rms},
                   {"force_of_static", e.force_static},
                   {"force_dynamic", e.dynamic_force},
                   {"deck_max", e.deck_max},
                   {"deck_rms", e.deck_rms},
                   {"deck_acceleration", e.deck_acceleration},
                   {"peak_force", e.peak_force},
                   {"peak_deck", e.peak_deck},
                   {"rms_Q", e.rms_Q},
                   {"rms_Y", e.rms_Y},
                   {"rms_deck", e.rms_deck},
                   {"unknowns", e.reduced.active_dofs},
                   {"unknowns_none", e.whole.active_dofs},
                   {"step_ms", step_ms(e.reduced)},
                   {"step_ms_none", step_ms(e.whole)}});
}

/// Errors are relative to the largest values, which say nothing before the train has moved anything.
void print_text(const SceneParameters& scene, const ReductionError& e) {
  constexpr double still_force = 1.0, still_deck = 1e-3;  // [N], [m/s²]: beside 1e3 N and 0.1 m/s² of a crossing
  print_formatted("{}: reduction \"{}\" against \"none\" over {} s\n", scene.name, reduction_name(scene.reduction.kind),
                  e.duration);
  if (e.dynamic_force > still_force) {
    print_formatted(
        "  {:<28}{:>9.3g} % largest {:>9.3g} % rms  of its dynamic part, {:.3g} kN; {:.3g} % of the static load\n",
        "vertical contact force", 100.0 * e.force_max, 100.0 * e.force_rms, 1e-3 * e.dynamic_force,
        100.0 * e.force_static);
  } else {
    print_formatted("  {:<28}{:>9.3g} % of the static load; its dynamic part is less than {} N, nothing to compare\n",
                    "vertical contact force", 100.0 * e.force_static, still_force);
  }
  if (e.deck_acceleration > still_deck) {
    print_formatted("  {:<28}{:>9.3g} % largest {:>9.3g} % rms  of its largest value, {:.3g} m/s²\n",
                    "deck acceleration", 100.0 * e.deck_max, 100.0 * e.deck_rms, e.deck_acceleration);
    print_formatted("  {:<28}{:>9.3g} % of the largest Q, {:.3g} % of the largest deck acceleration\n", "peaks",
                    100.0 * e.peak_force, 100.0 * e.peak_deck);
  } else {
    print_formatted("  {:<28} less than {} m/s², nothing to compare: compare until the train is on the bridge\n",
                    "deck acceleration", still_deck);
    print_formatted("  {:<28}{:>9.3g} % of the largest Q\n", "peaks", 100.0 * e.peak_force);
  }
  if (e.dynamic_force > still_force) {
    print_formatted("  {:<28}{:>9.3g} % Q {:>9.3g} % Y, rms of what differs from the mean\n", "dynamic parts",
                    100.0 * e.rms_Q, 100.0 * e.rms_Y);
  }
  if (const double left = scene.integration.tolerance; e.force_static < left) {
    print_formatted(
        "  {:<28} differ by less than the residual of Newton's method (integration.tolerance, {:g} of the static "
        "load)\n",
        "the forces", left);
  }
  print_formatted("  {:<28}{:>9.4g} ms with {} degrees of freedom, {:.4g} ms with {}\n", "a step", step_ms(e.reduced),
                  e.reduced.active_dofs, step_ms(e.whole), e.whole.active_dofs);
}

}  // namespace

int print_reduction_error(const SceneParameters& scene, double seconds, bool json) {
  if (scene.reduction.kind == Reduction::none) {
    throw input_error("--check-reduction", "a scene whose structure.reduction is \"none\"", "a reduction to check");
  }
  if (seconds < scene.integration.time_step) {
    throw input_error("--check-reduction", fmt::format("{} s", seconds),
                      fmt::format("at least a step, {} s", scene.integration.time_step));
  }
  const ReductionError e = check_reduction(scene, seconds);
  if (json) {
    print_as_json(scene, e);
  } else {
    print_text(scene, e);
  }
  return 0;
}

}  // namespace railtab::vsi
