#pragma once

#include <filesystem>
#include <string>

#include "railtab/runtime/results/result_size.hpp"
#include "railtab/runtime/scene/scene_parameters.hpp"
#include "railtab/runtime/vsi/vsi_model.hpp"

namespace railtab {

/// Memory and results of a run [bytes].
struct PlannedMemory {
  double undivided = 0.0;        ///< most that the process occupies while no step is divided
  double most = 0.0;             ///< where steps are divided: operators of several sizes at once, OperatorRoom
  double results = 0.0;          ///< of the results file
  double grid = 0.0;             ///< of it, the group for ParaView
  double step_reads = 0.0;       ///< what one step reads of the structure's factor and matrices
  double entries_per_dof = 0.0;  ///< of the factor that rail compliances come from
};

/// An upper bound of what a run occupies. What there is when the model is built (program, libraries, tables, matrices)
/// is what this process occupies; what start and steps add is counted from the factors' patterns.
/// @param model  built in this process; `duration` of the run [s]
[[nodiscard]] PlannedMemory planned_memory(const SceneParameters& scene, const VsiModel& model, double duration);

/// Of it, the results.
[[nodiscard]] ResultSize planned_results(const SceneParameters& scene, const VsiModel& model, double duration);

/// Warning of results [bytes] that the disk of their file has no room for; empty where it has.
[[nodiscard]] std::string room_warning(const std::filesystem::path& file, double results);

/// "12.5 GB"
[[nodiscard]] std::string bytes_text(double bytes);

}  // namespace railtab
