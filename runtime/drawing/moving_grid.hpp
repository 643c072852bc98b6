#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "railtab/runtime/vsi/step_record.hpp"

namespace railtab::drawing {

/// Bridge, rails, car bodies, bogies and wheelsets as one grid: its cells stay, its points travel with the train.
/// P points and C cells, each belonging to one part; in railtab's axes.
struct MovingGrid {
  std::vector<double> times;               ///< T instants [s]
  std::vector<std::int64_t> connectivity;  ///< points of all cells
  std::vector<std::int64_t> offsets;       ///< C + 1: where each cell's points begin, and the end
  std::vector<std::uint8_t> types;         ///< C, VTK's numbers
  std::vector<std::uint8_t> part;          ///< C, index in moving_parts
  std::vector<std::uint8_t> recorded;      ///< P: 1 where the displacement is one of the records, 0 where it is drawn
  std::vector<float> points;               ///< T·P × 3: places without displacement [m]
  std::vector<float> displacement;         ///< T·P × 3 [m]
};

inline constexpr std::array<std::string_view, 4> moving_parts{"bridge", "rails", "bodies", "wheelsets"};

/// @param records instants that are drawn, of what the header names
[[nodiscard]] MovingGrid moving_grid(const ResultHeader& header, std::span<const StepRecord> records);

/// Whether something is recorded that moves: bodies or nodes.
[[nodiscard]] bool has_motion(const ResultHeader& header) noexcept;

/// Of what records of this header look like: counts do not depend on their values.
struct MovingGridSize {
  double points = 0, cells = 0, connectivity = 0;
};
[[nodiscard]] MovingGridSize moving_grid_size(const ResultHeader& header);

}  // namespace railtab::drawing
