#include "railtab/runtime/vehicle/vehicle_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string_view>

#include "railtab/runtime/base/column_rows.hpp"

namespace railtab {

namespace {

constexpr std::string_view header = "row,body,motion,x,y,z";
constexpr std::array<std::string_view, 6> motions{"x", "y", "z", "rotx", "roty", "rotz"};

// Of one line; new bodies are added.
TableBody& body_of_line(const LineReader& reader, std::string_view name, const Eigen::Vector3d& position,
                        std::vector<TableBody>& bodies) {
  if (name.empty() || name.find_first_of("/* \t") != std::string_view::npos) {
    throw reader.error(fmt::format("body '{}'", name),
                       "a name without / and *, which results have a use for, and without blanks");
  }
  const auto known =
      std::find_if(bodies.begin(), bodies.end(), [name](const TableBody& body) { return body.name == name; });
  if (known == bodies.end()) return bodies.emplace_back(TableBody{std::string(name), reader.place(), position});
  if (known->position != position) {
    throw reader.error(fmt::format("body {} at another place", name), fmt::format("as in {}", known->place));
  }
  return *known;
}

}  // namespace

std::vector<TableBody> read_vehicle_table(const std::filesystem::path& file, int rows) {
  ColumnRows table(file, "a table of a vehicle's rows", header);
  const LineReader& reader = table.reader();
  std::vector<TableBody> bodies;
  std::vector<bool> taken(static_cast<std::size_t>(rows), false);
  while (table.next()) {
    const std::vector<std::string_view>& words = table.cells();
    const int row = reader.number<int>(words[0], "the number of a row");
    if (row < 1 || row > rows) {
      throw reader.error(fmt::format("row {}", row), fmt::format("1 to {}, the matrices' rows", rows));
    }
    if (taken[static_cast<std::size_t>(row - 1)]) throw reader.error(fmt::format("row {} again", row), "each once");
    taken[static_cast<std::size_t>(row - 1)] = true;
    const auto* const motion = std::find(motions.begin(), motions.end(), words[2]);
    if (motion == motions.end()) {
      throw reader.error(fmt::format("motion '{}'", words[2]), fmt::format("one of {}", fmt::join(motions, ", ")));
    }
    Eigen::Vector3d position;
    for (std::size_t k = 0; k < 3; ++k) {
      position[static_cast<Eigen::Index>(k)] = reader.number<double>(words[3 + k], "a position, a finite number");
    }
    TableBody& body = body_of_line(reader, words[1], position, bodies);
    int& of_motion = body.row[static_cast<std::size_t>(motion - motions.begin())];
    if (of_motion != held) throw reader.error(fmt::format("{} of body {} again", *motion, body.name), "each once");
    of_motion = row - 1;
  }
  return bodies;
}

}  // namespace railtab
