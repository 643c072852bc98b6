#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "railtab/runtime/reliability/distribution.hpp"

namespace railtab::vsi {

/// A value that a variable takes.
struct StudyValue {
  double number = 0.0;                     ///< of numbers
  std::optional<std::string> other;        ///< of texts and truth values, as TOML writes them
  [[nodiscard]] std::string cell() const;  ///< in tables: a text without its quotes
};

/// A key of the scene that a variable sets: factor·x^power + offset of a number x, or what a table has for it.
struct StudyKey {
  std::string key;  ///< as KeyChange::key
  double factor = 1.0, power = 1.0, offset = 0.0;
  std::vector<std::array<double, 2>> table{};  ///< points of x and of the key, straight lines between; empty: none
  bool whole = false;                          ///< the key takes integers: a sampled number is rounded down
  [[nodiscard]] bool as_it_is() const noexcept {
    return factor == 1.0 && power == 1.0 && offset == 0.0 && table.empty();
  }
  /// The key for a number x. @pre x is within the table, where there is one
  [[nodiscard]] double value(double x) const noexcept;
};

/// "load.Fy" of "load.2.Fy", as messages about a scene name the key.
[[nodiscard]] std::string without_number(const std::string& key);

/// What a [[vary]] of a plan varies.
struct StudyVariable {
  std::string name;   ///< its column: the key, or a name of its own where it sets several keys
  std::string unit;   ///< "-" for dimensionless and texts
  std::string place;  ///< "plan.toml:12: vary.1", for messages
  std::vector<StudyKey> keys;
  std::vector<StudyValue> values;            ///< of the grid; none where it is random
  std::optional<Distribution> distribution;  ///< none where it has values
  [[nodiscard]] bool random() const noexcept { return distribution.has_value(); }
  [[nodiscard]] bool numeric() const noexcept;
};

enum class StudyMethod { table, probability, fragility, subset, peak, threshold, importance };
enum class SamplingMethod { monte_carlo, latin_hypercube };

/// Random values: the first so many samples of a seed.
struct StudySampling {
  SamplingMethod method = SamplingMethod::latin_hypercube;
  std::size_t samples = 0;  ///< 0: nothing is random
  std::uint64_t seed = 1;
};

/// A study as its TOML says it (docs/guide/studies.md).
struct StudyPlan {
  std::filesystem::path file, scene_file;
  std::string text;
  bool keep_results = false;
  std::optional<double> deck_cut_off;  ///< [Hz]
  std::vector<StudyVariable> variables;
  StudySampling sampling;
  StudyMethod method = StudyMethod::table;
  std::string measure;        ///< of all methods but `table`
  std::string measure_place;  ///< "plan.toml:12: peak", for messages
  double limit = 0.0;         ///< of probability, fragility, subset and threshold
  double confidence = 0.95;
  std::size_t replicates = 1000;   ///< of bootstraps
  std::size_t intensity = 0;       ///< variable of a fragility curve or a threshold
  double level_probability = 0.1;  ///< of subset simulation; `sampling.samples` per level
  std::size_t most_levels = 8;
  std::size_t coarse_step = 8;  ///< of the search for a peak
};

/// @throws InputError with file and line: unknown key with the nearest one, what was found and what is allowed
[[nodiscard]] StudyPlan read_study_plan(const std::filesystem::path& file);

}  // namespace railtab::vsi
