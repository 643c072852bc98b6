#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "railtab/runtime/vehicle/provenance.hpp"

namespace railtab {

/// A train as forces of constant size that move with it: no mass, no contact.
struct AxleTrain {
  std::string name;
  std::vector<double> behind;  ///< of each axle behind the first one [m], not decreasing
  std::vector<double> load;    ///< of each axle, downwards [N]
  double length = 0.0;         ///< over buffers [m], where the train may be repeated; else 0
  double front = 0.0;          ///< from the buffers to the first axle [m], with `length`
  bool only_static = false;    ///< a load model that does not move at speed
  Provenance provenance;
  /// From the first axle to the last [m].
  [[nodiscard]] double reach() const noexcept { return behind.back() - behind.front(); }
  [[nodiscard]] double total_load() const noexcept;  ///< [N]
};

/// A universal train of HSLM-A [EN1991-2, Figure 6.12]: power car, end coach, `coaches` intermediate coaches of length
/// D on articulation bogies of wheelbase d, end coach, power car; 2·coaches + 14 axles. Power cars have axles at 0, 3,
/// 14 and 17 m, the end coach's outer bogie stands 3.525 m behind, and bogies of the coaches stand about 17 + 3.525/2 +
/// i·D, i = 1 … coaches + 1.
/// @pre coaches >= 1; coach_length > wheelbase > 0 [m]; axle_load > 0 [N]
[[nodiscard]] AxleTrain hslm_a_train(int coaches, double coach_length, double wheelbase, double axle_load);

/// Equal units coupled one behind the other. @param count >= 1
/// @throws InputError where the unit has no length over buffers
[[nodiscard]] AxleTrain repeated(const AxleTrain& unit, int count);

/// Each axle as three forces of 25, 50 and 25 % on neighbouring sleepers [EN1991-2, 6.3.6.1]; the train's places stay
/// those of its axles, so that the first force stands one spacing ahead of the first axle. @pre sleeper_spacing > 0 [m]
[[nodiscard]] AxleTrain spread_over_sleepers(const AxleTrain& train, double sleeper_spacing);

/// Axles of a text file with the columns x[m], the place behind the first axle, rising, and P[kN], the load.
/// @throws InputError with file and line
[[nodiscard]] AxleTrain read_axle_file(const std::filesystem::path& file);

/// Names of the trains that come with railtab (runtime/moving_load/library), family by family.
[[nodiscard]] std::vector<std::string> train_names();

/// A train by name ("hslm-a1", "en15528-d2"), several units of it ("en15528-d2*6"), or the file of a list of axles
/// ("mine.csv"). Static load models (`only_static`) have their line loads as forces 0.1 m apart, and unlimited ones
/// reach `deck_length` beyond the rest of the model on either side. @throws InputError
[[nodiscard]] AxleTrain find_axle_train(std::string_view text, double deck_length);

/// "hslm-a" stands for its ten trains; all other texts for themselves.
[[nodiscard]] std::vector<std::string> expanded_names(const std::vector<std::string>& texts);

}  // namespace railtab
