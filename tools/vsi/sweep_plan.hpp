#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "command/command_line.hpp"
#include "headline.hpp"
#include "railtab/runtime/scene/scene_parameters.hpp"
#include "run_pool.hpp"

namespace railtab::vsi {

/// Equally spaced values LO, LO + STEP, … up to HI, which is one of them where it is reached but for rounding.
/// @param text "LO:HI:STEP", or one number. @throws InputError naming the option, and the forms that it permits
[[nodiscard]] std::vector<double> values_of_range(const std::string& option, const std::string& text,
                                                  std::string_view forms = "LO:HI:STEP, three numbers, or one number");

/// The speeds of --speed or --speed-kmh [m/s]; none without either.
/// @throws InputError naming the option, in its own unit
[[nodiscard]] std::vector<double> speeds_of_options(const CommandLine& line);

/// One run of a sweep.
struct SweepRun {
  double speed = 0.0;  ///< [m/s]
  int seed = 0;        ///< of the random track; counts only with one
  std::string name;    ///< of its files, without their suffix: "v055.556-s001"
};

/// Every speed with every seed, seeds first. Without a random track there is one seed only.
/// @throws InputError where there are seeds and no random track, or speeds too near to each other for their names
[[nodiscard]] std::vector<SweepRun> sweep_runs(const SceneParameters& scene, const std::vector<double>& speeds,
                                               int seeds);

/// The scene of one run; its text says what was changed, so that results tell their own scene.
[[nodiscard]] SceneParameters scene_of(const SceneParameters& scene, const SweepRun& run);

/// A run with scene_of() and summary_row(). @param scene outlives it
[[nodiscard]] PooledRun pooled(const SceneParameters& scene, const SweepRun& run);

/// Names of the columns of the summary, and one row, which begins with the cells of row_begin().
[[nodiscard]] std::string summary_columns();
[[nodiscard]] std::string row_begin(const SweepRun& run);
[[nodiscard]] std::string summary_row(const SweepRun& run, const report::Headline& headline, const RunSummary& summary);

}  // namespace railtab::vsi
