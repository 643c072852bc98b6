#include "railtab/runtime/results/output_selection.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <fnmatch.h>

#include <algorithm>

#include "railtab/runtime/base/input_error.hpp"

namespace railtab {

namespace {

std::vector<std::size_t> chosen(const std::vector<std::string>& patterns, const std::vector<std::string>& names,
                                std::string_view key) {
  std::vector<bool> wanted(names.size(), false);
  for (const std::string& pattern : patterns) {
    bool fits = false;
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (fnmatch(pattern.c_str(), names[i].c_str(), 0) != 0) continue;
      wanted[i] = fits = true;
    }
    if (!fits && !names.empty() && pattern != "*") {
      throw input_error(fmt::format("scene: {}", key), fmt::format("\"{}\"", pattern),
                        fmt::format("a pattern that fits one of {}", fmt::join(names, ", ")));
    }
  }
  std::vector<std::size_t> result;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (wanted[i]) result.push_back(i);
  }
  return result;
}

// Moves the chosen elements to the front and drops the rest: nothing is allocated.
template <class T>
void keep(const std::vector<std::size_t>& indices, std::vector<T>& values) {
  for (std::size_t i = 0; i < indices.size(); ++i) {
    if (indices[i] != i) values[i] = std::move(values[indices[i]]);
  }
  values.resize(indices.size());
}

}  // namespace

OutputSelection::OutputSelection(const OutputParameters& output, const ResultHeader& header)
    : wheels_(output.wheels),
      bodies_(chosen(output.bodies, header.body_names, "output.bodies")),
      nodes_(chosen(output.nodes, header.node_names, "output.nodes")) {}

ResultHeader OutputSelection::of(ResultHeader header) const {
  if (!wheels_) {
    header.wheel_x.clear();
    header.static_wheel_load.clear();
  }
  keep(bodies_, header.body_names);
  for (auto* values : {&header.body_x, &header.body_y, &header.body_z}) {
    if (!values->empty()) keep(bodies_, *values);
  }
  keep(nodes_, header.node_names);
  for (auto* values : {&header.node_x, &header.node_y, &header.node_z}) {
    if (!values->empty()) keep(nodes_, *values);
  }
  return header;
}

void OutputSelection::cut(StepRecord& record) const {
  if (!wheels_) record.wheels.clear();
  keep(bodies_, record.bodies);
  keep(nodes_, record.nodes);
}

}  // namespace railtab
