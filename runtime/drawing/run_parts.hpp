#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "railtab/runtime/drawing/grid.hpp"
#include "railtab/runtime/vsi/step_record.hpp"

namespace railtab::drawing {

/// What is drawn of a run: one file per instant, and a collection of its own.
struct Part {
  std::string name;
  std::function<Grid(const StepRecord&)> grid;  ///< points at rest, in railtab's axes; refers to the header
};

/// bridge, rails and nodes, as far as the results have them.
/// @param records of the run, those that are drawn and its first and last: the rails reach as far as the train gets
[[nodiscard]] std::vector<Part> structure_parts(const ResultHeader& header, std::span<const StepRecord> records);
/// car bodies and bogies, wheelsets, contact forces, as far as the results have them.
[[nodiscard]] std::vector<Part> train_parts(const ResultHeader& header, std::span<const StepRecord> records);

/// What the results do not hold, and the scene's key that records it.
[[nodiscard]] std::vector<std::string> not_recorded(const ResultHeader& header);
/// What is drawn of it that no result says: sizes, and the places of older files.
[[nodiscard]] std::vector<std::string> drawn_only(const ResultHeader& header);

/// Track centre to rail-head centre: of the recorded nodes of the rails, or else the standard track's [m].
[[nodiscard]] double half_rail_distance(const ResultHeader& header);
[[nodiscard]] bool is_left_rail(std::string_view node_name) noexcept;
[[nodiscard]] bool is_right_rail(std::string_view node_name) noexcept;

}  // namespace railtab::drawing
