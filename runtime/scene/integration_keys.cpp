#include "railtab/runtime/scene/key_table.hpp"

namespace railtab::scene {
namespace {

template <auto member>
auto& of_integration(SceneDraft& draft) {
  return draft.parameters.integration.*member;
}
template <auto member>
auto& of_output(SceneDraft& draft) {
  return draft.parameters.output.*member;
}

ChoiceKey contact_force_rules() {
  using Rule = std::optional<ContactForceRule>;
  return choice<Rule>(of_integration<&IntegrationParameters::contact_force>,
                      {{"automatic", Rule()},
                       {"endpoint", Rule(ContactForceRule::endpoint)},
                       {"energy", Rule(ContactForceRule::energy)}});
}

std::vector<KeyRow> time_step_keys() {
  return {
      {"integration.time_step",
       "s",
       "time step",
       NumberKey{of_integration<&IntegrationParameters::time_step>, {1e-9, 0.1}},
       {},
       {&steps_too_long}},
      {"integration.duration", "s", "0: until the last wheelset has left the last span",
       NumberKey{of_integration<&IntegrationParameters::duration>, {1e-9, 1e5, true}}},
      {"integration.free_vibration",
       "s",
       "how long a run goes on after the last wheelset has left",
       NumberKey{of_integration<&IntegrationParameters::free_vibration>, {1e-9, 1e3, true}},
       {&without_duration}},
      {"integration.alpha", "1", "α of the HHT method; 0: trapezoidal rule",
       NumberKey{of_integration<&IntegrationParameters::alpha>, {-1.0 / 3.0, 0.0}}},
      {"integration.contact_force",
       "",
       "force of a step: at its end (endpoint), or conserving energy, always or at impacts (automatic)",
       contact_force_rules(),
       {&with_hertz_contact},
       {&energy_rule_with_paper_search}},
      {"integration.impact_step",
       "s",
       "longest step in the first millisecond of an impact",
       NumberKey{of_integration<&IntegrationParameters::impact_step>, {1e-6, 0.1}},
       {&with_hertz_contact, &with_automatic_contact_force, &with_smooth_search}},
      {"integration.tolerance", "1",
       "of Newton's method: change of the contact forces relative to the static wheel load",
       NumberKey{of_integration<&IntegrationParameters::tolerance>, {1e-12, 1e-2}}},
      {"integration.max_iterations", "1", "Newton iterations before a step is halved",
       IntegerKey{of_integration<&IntegrationParameters::max_iterations>, 2, 1000}},
      {"integration.max_halvings", "1", "halvings of a step that does not converge",
       IntegerKey{of_integration<&IntegrationParameters::max_halvings>, 0, 30}},
  };
}

std::vector<KeyRow> output_keys() {
  return {
      {"output.every",
       "1",
       "steps between records",
       IntegerKey{of_output<&OutputParameters::every>, 1, 1000000},
       {},
       {&records_too_few}},
      {"output.wheels", "", "record contact forces and positions", SwitchKey{of_output<&OutputParameters::wheels>}},
      {"output.energy", "", "energy balance of the normal contacts, for the summary",
       SwitchKey{of_output<&OutputParameters::energy>}},
      {"output.deck_envelope", "", "extremes all over the decks, for report and assessment",
       SwitchKey{of_output<&OutputParameters::deck_envelope>}},
      {"output.deck_cut_off",
       "Hz",
       "low-pass of the envelope's filtered acceleration",
       NumberKey{of_output<&OutputParameters::deck_cut_off>, {0.1, 1e4}},
       {&with_deck_envelope}},
      {"output.paraview_instants", "1", "most instants that ParaView shows of the results, beside the last; 0: none",
       IntegerKey{of_output<&OutputParameters::paraview_instants>, 0, 10000}},
      {"output.bodies", "", "names to record; * stands for any letters",
       TextListKey{of_output<&OutputParameters::bodies>}},
      {"output.nodes", "", "names to record; * stands for any letters",
       TextListKey{of_output<&OutputParameters::nodes>}},
  };
}

}  // namespace

std::vector<KeyRow> integration_keys() { return all_of({time_step_keys(), output_keys()}); }

}  // namespace railtab::scene
