#include "railtab/runtime/fe/mode_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "railtab/runtime/base/column_file.hpp"
#include "railtab/runtime/base/input_error.hpp"

namespace railtab {

namespace {

int whole(double value, const std::string& place, const char* what) {
  if (value >= 1.0 && value <= std::numeric_limits<int>::max() && value == std::floor(value)) {
    return static_cast<int>(value);
  }
  throw input_error(place, fmt::format("{} {}", what, value), "a whole number from 1 on");
}

double between(double value, double low, double high, const std::string& place, const char* what, const char* unit) {
  if (value >= low && value <= high) return value;
  throw input_error(place, fmt::format("{} {}", what, value), fmt::format("{:g} to {:g}{}", low, high, unit));
}

}  // namespace

std::vector<FeMode> read_mode_table(const std::filesystem::path& file) {
  std::vector<std::string> columns{"mode", "frequency", "mass"};
  const bool damped = has_column(file, "damping");
  if (damped) columns.emplace_back("damping");
  const NumberRows table = read_number_rows(file, columns);
  constexpr std::size_t most_modes = 2000;
  if (table.rows.size() > most_modes) {
    throw input_error(file.string(), fmt::format("{} modes", table.rows.size()), fmt::format("at most {}", most_modes));
  }
  std::vector<FeMode> modes;
  std::map<int, std::string> known;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const std::vector<double>& row = table.rows[i];
    const std::string& place = table.places[i];
    FeMode mode{whole(row[0], place, "mode"), between(row[1], 1e-3, 1e5, place, "frequency", " Hz"),
                between(row[2], 1e-12, 1e15, place, "modal mass", ", in the model's unit of mass")};
    if (damped) mode.damping = between(row[3], 0.0, most_damping_ratio, place, "damping ratio", " of critical");
    const auto [first, is_new] = known.emplace(mode.number, place);
    if (!is_new) {
      throw input_error(place, fmt::format("mode {} again", mode.number), "each once, first in " + first->second);
    }
    modes.push_back(mode);
  }
  std::stable_sort(modes.begin(), modes.end(),
                   [](const FeMode& a, const FeMode& b) { return a.frequency < b.frequency; });
  return modes;
}

FeShapes read_mode_shapes(const std::filesystem::path& file, const std::vector<FeMode>& modes) {
  std::vector<std::string> columns{"mode", "node"};
  std::vector<int> motions;
  for (std::size_t k = 0; k < shape_columns.size(); ++k) {
    if (!has_column(file, shape_columns[k])) continue;
    columns.emplace_back(shape_columns[k]);
    motions.push_back(static_cast<int>(k));
  }
  if (motions.empty() || motions.front() > 2) {
    throw input_error(file.string(), "no column ux, uy or uz",
                      "mode,node,ux,uy,uz, and where there are, rotx,roty,rotz");
  }
  std::map<int, std::size_t> column_of_mode;
  for (std::size_t m = 0; m < modes.size(); ++m) column_of_mode.emplace(modes[m].number, m);
  const NumberRows table = read_number_rows(file, columns);
  std::map<int, std::vector<std::vector<double>>> shapes;  // by node: modes × motions
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const std::vector<double>& row = table.rows[i];
    const int mode = whole(row[0], table.places[i], "mode"), node = whole(row[1], table.places[i], "node");
    const auto column = column_of_mode.find(mode);
    if (column == column_of_mode.end()) continue;  // a table of modes that was cut to fewer
    std::vector<std::vector<double>>& of_node = shapes[node];
    of_node.resize(modes.size());
    if (!of_node[column->second].empty()) {
      throw input_error(table.places[i], fmt::format("node {} in mode {} again", node, mode), "each once");
    }
    for (std::size_t k = 2; k < row.size(); ++k) {
      of_node[column->second].push_back(between(row[k], -1e12, 1e12, table.places[i], columns[k].c_str(), ""));
    }
  }
  FeShapes result;
  for (const auto& [node, of_node] : shapes) {
    for (std::size_t m = 0; m < modes.size(); ++m) {
      if (!of_node[m].empty()) continue;
      throw input_error(file.string(), fmt::format("node {} without mode {}", node, modes[m].number),
                        fmt::format("each node in all {} modes of structure.mode_table", modes.size()));
    }
    for (std::size_t k = 0; k < motions.size(); ++k) {
      result.rows.push_back({node, motions[k]});
      std::vector<double>& values = result.values.emplace_back();
      for (std::size_t m = 0; m < modes.size(); ++m) values.push_back(of_node[m][k]);
    }
  }
  if (result.rows.empty()) throw input_error(file.string(), "no mode of structure.mode_table", "shapes of its modes");
  return result;
}

std::map<int, double> read_flexibility(const std::filesystem::path& file) {
  const NumberRows table = read_number_rows(file, {"node", "flexibility"});
  std::map<int, double> flexibility;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const int node = whole(table.rows[i][0], table.places[i], "node");
    const double value =
        between(table.rows[i][1], 1e-18, 1.0, table.places[i], "flexibility", ", in the model's length per force");
    if (!flexibility.emplace(node, value).second) {
      throw input_error(table.places[i], fmt::format("node {} again", node), "each once");
    }
  }
  return flexibility;
}

}  // namespace railtab
