#include "railtab/runtime/scene/plan_memory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <system_error>
#include <utility>

#include "railtab/runtime/base/process_memory.hpp"
#include "railtab/runtime/results/deck_envelope.hpp"
#include "railtab/runtime/scene/result_header.hpp"
#include "railtab/runtime/start/static_equilibrium.hpp"
#include "railtab/runtime/vsi/moving_window.hpp"
#include "railtab/runtime/vsi/operator_room.hpp"
#include "railtab/runtime/vsi/simulation.hpp"
#include "railtab/runtime/vsi/step.hpp"
#include "railtab/runtime/vsi/structure_response.hpp"

namespace railtab {

namespace {

constexpr double number = sizeof(double);

// Vectors of all degrees of freedom of the structure.
constexpr double state_vectors = 5.0;                        // LinearMotion
constexpr double start_vectors = 6.0 * state_vectors + 8.0;  // states of steady_start(), loads and solutions
// StepWorkspace, the state that the run begins with, and the motion in the order of its sections
constexpr double step_vectors = 2.0 * state_vectors + 13.0 + 3.0;
constexpr double energy_vectors = 2.0 * state_vectors;  // EnergyAccount
constexpr double small = 1 << 20;    // bytes: vectors that the allocator keeps when they are freed, in pieces
constexpr double most_pieces = 8e6;  // bytes: of what the start has freed, where it is not used again
constexpr double allocator = 1.03;   // of what is asked of it: ends of pages and pieces
// Bytes of program and libraries that a run is the first to touch, at most; less where a table has been read by HDF5.
constexpr double program_without_hdf5 = 4.6e6, program_with_hdf5 = 1.5e6;

/// Whether making the model reads a file of HDF5.
bool reads_tables(const ContactParameters& contact) {
  return contact.normal == NormalContact::hertz && (contact.mode == ContactMode::table || contact.creep_law == "table");
}

/// Beside the structure: couplings of wheels at rest, each with each, and the vehicles' matrices.
double train_bytes(const VsiModel& model) {
  const double wheelsets = model.wheelsets(), n = model.vehicle.dofs();
  const double tables = 1.0 + kept_couplings(2 * static_cast<std::size_t>(model.wheelsets()));
  const double rest = wheelsets * wheelsets * (tables * sizeof(RailCoupling) + 2.0 * sizeof(RailHeadsCompliance));
  constexpr double vehicle_matrices = 8.0;
  return (model.structure ? rest : 0.0) + vehicle_matrices * number * n * n;
}

}  // namespace

ResultSize planned_results(const SceneParameters& scene, const VsiModel& model, double duration) {
  const IntegrationParameters& integration = scene.integration;
  const double steps = duration / integration.time_step;
  const OutputSelection selection(scene.output, model_header(model));
  const bool checkpoints = steps >= static_cast<double>(integration.reinitialise_every);
  ResultHeader header = selection.of(result_header(scene, model));
  double envelope = 0.0;  // numbers
  if (scene.output.deck_envelope) {
    const DeckEnvelope deck(model, scene.output.deck_cut_off, integration.time_step);
    header.deck = deck.places();
    envelope = static_cast<double>(deck.capacity());
  }
  const double state = checkpoints ? static_cast<double>(packed(VsiState(model)).size()) + envelope : 0.0;
  ResultSize results =
      result_size(header, std::floor(steps / scene.output.every) + 2.0, state, scene.output.paraview_instants);
  results.memory += number * envelope;
  return results;
}

std::string bytes_text(double bytes) {
  for (const auto& [unit, name] : {std::pair(1e12, "TB"), std::pair(1e9, "GB")}) {
    if (bytes >= unit) return fmt::format("{:.4g} {}", bytes / unit, name);
  }
  return fmt::format("{:.4g} MB", 1e-6 * bytes);
}

std::string room_warning(const std::filesystem::path& file, double results) {
  std::error_code unknown;
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
  const std::filesystem::space_info room = std::filesystem::space(folder, unknown);
  if (unknown || results <= static_cast<double>(room.available)) return {};
  return fmt::format("the results take {}, and {} are free in {}; output.every writes fewer records",
                     bytes_text(results), bytes_text(static_cast<double>(room.available)), folder.string());
}

PlannedMemory planned_memory(const SceneParameters& scene, const VsiModel& model, double duration) {
  return_freed_memory();
  const double program = reads_tables(scene.contact) ? program_with_hdf5 : program_without_hdf5;
  const double built = resident_memory() + program, peak = peak_resident_memory() + program;
  PlannedMemory plan;
  const IntegrationParameters& integration = scene.integration;
  const ResultSize results = planned_results(scene, model, duration);
  plan.results = results.file;
  plan.grid = results.grid;
  const double train = train_bytes(model), operators = StepOperators::vehicle_bytes(model);
  plan.undivided = allocator * std::max(peak, built + train + operators + results.memory);
  plan.most = plan.undivided + allocator * OperatorRoom::of_others(operators);
  if (!model.structure) return plan;

  const StructureModel& s = *model.structure;
  const double n = static_cast<double>(s.dofs());
  const HhtScheme hht{.alpha = integration.alpha, .time_step = integration.time_step};
  const DofRange active =
      model.window ? MovingWindow(model, integration.time_step).largest(duration) : DofRange{0, s.dofs()};
  const StructureResponse response(s, hht, active);
  const StructureResponse::Memory m = response.memory(), at_rest = StructureResponse(s).memory();
  const double table = StepOperators::largest_table(model, response, duration, integration.time_step);
  const double one = m.kept + m.low + table;
  const double while_made =
      m.shared + std::max(m.shared_setup, m.kept + std::max(m.setup, m.low + std::max(m.low_setup, table)));
  const double start = number * n * start_vectors + at_rest.kept + at_rest.setup;
  const double vectors = number * n * (step_vectors + (scene.output.energy ? energy_vectors : 0.0)) + results.memory;
  const double pieces = number * n < small ? std::min(most_pieces, number * n * start_vectors) : 0.0;
  const double common = built + train;
  const double undivided = common + pieces + vectors + operators + while_made;
  plan.undivided = allocator * std::max({peak, common + start, undivided});
  plan.most = plan.undivided + allocator * OperatorRoom::of_others(operators + one);
  plan.step_reads = 2.0 * static_cast<double>(response.factor().bytes()) + static_cast<double>(response.load_bytes());
  plan.entries_per_dof = m.low_entries / m.low_unknowns;
  return plan;
}

}  // namespace railtab
