#include "railtab/runtime/results/result_size.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "railtab/runtime/drawing/drawn_records.hpp"
#include "railtab/runtime/results/result_columns.hpp"
#include "railtab/runtime/results/vtkhdf_group.hpp"

namespace railtab {

namespace {

/// Records that are drawn are kept until the run ends, the last one too.
void add_grid(ResultSize& size, const ResultHeader& header, double records, int most) {
  if (most == 0 || !drawing::has_motion(header)) return;
  const drawing::MovingGridSize grid = drawing::moving_grid_size(header);
  const double instants = DrawnRecords::count(records, most);
  const auto bytes = [](double record, std::size_t members) { return record * static_cast<double>(members); };
  const double record = sizeof(StepRecord) + bytes(sizeof(WheelRecord), header.wheel_x.size()) +
                        bytes(sizeof(MotionRecord), header.body_names.size() + header.node_names.size());
  size.grid = vtkhdf::file_bytes(grid, instants);
  size.file += size.grid;
  const double kept = std::min(records, static_cast<double>(most)) + 1.0;
  size.memory += record * kept + vtkhdf::memory_bytes(grid, instants);
}

}  // namespace

ResultSize result_size(const ResultHeader& header, double records, double state, int instants) {
  namespace columns = result_columns;
  std::vector<double> row_sizes(columns::step.size() + 1, 1.0);  // numbers per record, of each history
  const auto wheels = static_cast<double>(header.wheel_x.size());
  if (wheels > 0.0) row_sizes.insert(row_sizes.end(), columns::wheel.size() + 2, wheels);
  for (const columns::MotionGroup& group : columns::motion_groups) {
    const auto members = static_cast<double>((header.*group.names).size());
    if (members > 0.0) row_sizes.insert(row_sizes.end(), columns::motion.size(), 6.0 * members);
  }
  constexpr double number = sizeof(double);
  // as in ArrayFileWriter: chunks of 16 KiB, at least 8 records, in pages of their own; indices, names, attributes
  constexpr double chunk_values = 2048.0, fewest = 8.0, page = 4096.0, per_dataset = 16384.0, least = 262144.0;
  // HDF5 keeps chunks of each dataset, and buffers besides: a quarter of them
  constexpr double kept = 1.25, cache = kept * (1 << 20), library = 4e6;
  constexpr double between_flushes = 200.0;
  ResultSize size{.file = least, .memory = library};
  for (double row : row_sizes) {
    const double chunk = std::max(fewest, std::floor(chunk_values / row));
    const double bytes = page * std::ceil(number * row * chunk / page) * std::ceil(records / chunk);
    size.file += bytes + per_dataset;
    size.memory += std::min(kept * bytes, cache) + number * row * std::min(records, between_flushes);
  }
  constexpr double indices = 1.01;  // of chunks, and their checksums
  size.file *= indices;
  for (const columns::HeaderColumn& column : columns::header) {
    size.file += page + number * static_cast<double>((header.*column.values).size());
  }
  for (const columns::HeaderTexts& list : columns::header_text_lists) {
    size.file += page;
    for (const std::string& text : header.*list.values) size.file += static_cast<double>(text.size());
  }
  size.file += static_cast<double>(header.scene_text.size());
  for (const DeckPlaces& places : header.deck) {
    constexpr double place_columns = 6.0;
    size.file += place_columns * (number * static_cast<double>(places.x.size()) + page);
  }
  constexpr double slots = 2.0, copies = 3.0;  // packed, with its counters, and HDF5's own
  size.file += slots * number * state;
  size.memory += copies * number * state;
  add_grid(size, header, records, instants);
  return size;
}

}  // namespace railtab
