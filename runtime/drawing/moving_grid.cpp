#include "railtab/runtime/drawing/moving_grid.hpp"

#include <algorithm>

#include "railtab/runtime/drawing/run_parts.hpp"

namespace railtab::drawing {
namespace {

template <class Value>
const std::vector<Value>& point_values(const Grid& grid, std::string_view name) {
  const auto found = std::ranges::find(grid.point_data, name, &Array::name);
  return std::get<std::vector<Value>>(found->values);
}

template <class Value>
void append(std::vector<Value>& all, const std::vector<Value>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

/// Cells, and what is said of points and cells that does not change.
void append_cells(MovingGrid& all, const Grid& grid, std::uint8_t part) {
  const auto first_point = static_cast<std::int64_t>(all.recorded.size());
  const auto first_corner = static_cast<std::int64_t>(all.connectivity.size());
  for (const std::int64_t point : grid.connectivity) all.connectivity.push_back(first_point + point);
  for (const std::int64_t end : grid.offsets) all.offsets.push_back(first_corner + end);
  append(all.types, grid.types);
  all.part.resize(all.types.size(), part);
  append(all.recorded, point_values<std::uint8_t>(grid, "recorded"));
}

}  // namespace

MovingGrid moving_grid(const ResultHeader& header, std::span<const StepRecord> records) {
  std::vector<Part> parts = structure_parts(header, records);
  for (Part& part : train_parts(header, records)) parts.push_back(std::move(part));
  MovingGrid all;
  all.offsets.push_back(0);
  for (const StepRecord& record : records) {
    const bool first = all.times.empty();
    all.times.push_back(record.time);
    for (const Part& part : parts) {
      const auto name = std::ranges::find(moving_parts, part.name);
      if (name == moving_parts.end()) continue;  // nodes, which lie on the bridge and the rails, and forces
      const Grid grid = part.grid(record);
      if (first) append_cells(all, grid, static_cast<std::uint8_t>(name - moving_parts.begin()));
      append(all.points, grid.points);
      append(all.displacement, point_values<float>(grid, "displacement"));
    }
  }
  return all;
}

bool has_motion(const ResultHeader& header) noexcept {
  return !header.body_names.empty() || !header.node_names.empty();
}

MovingGridSize moving_grid_size(const ResultHeader& header) {
  StepRecord record;
  record.wheels.resize(header.wheel_x.size());
  record.bodies.resize(header.body_names.size());
  record.nodes.resize(header.node_names.size());
  const MovingGrid grid = moving_grid(header, {&record, 1});
  return {static_cast<double>(grid.recorded.size()), static_cast<double>(grid.types.size()),
          static_cast<double>(grid.connectivity.size())};
}

}  // namespace railtab::drawing
