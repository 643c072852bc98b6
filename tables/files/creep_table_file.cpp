#include "railtab/tables/files/creep_table_file.hpp"

#include <fmt/format.h>

#include <cmath>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/tables/files/array_file.hpp"
#include "railtab/tables/files/table_statements.hpp"

namespace railtab {
namespace {

constexpr int format_version = 1;

struct AxisText {
  const char* name;
  const char* unit;
  const char* description;
};
constexpr std::array<AxisText, 4> smooth_axes{{
    {"ratio", "1", "a/b; uniform in x/sqrt(1 + x^2), x = ln(a/b)/ratio_stretch"},
    {"t", "1", "rho/(rho + radius_unit), rho the length of the scaled creepages"},
    {"alpha", "rad", "angle of the scaled creepages to pure longitudinal creepage"},
    {"beta", "rad", "angle of the scaled lateral creepage and spin in their plane"},
}};
constexpr std::array<AxisText, 4> paper_axes{{
    {"ratio", "1", "a/b"},
    {"x", "1", "normalised longitudinal creepage"},
    {"y", "1", "normalised lateral creepage"},
    {"spin", "1", "normalised spin"},
}};

const std::array<AxisText, 4>& axes(CreepTableLayout layout) {
  return layout == CreepTableLayout::smooth ? smooth_axes : paper_axes;
}

std::string axis_path(const AxisText& axis) { return fmt::format("axes/{}", axis.name); }

/// Over every number of the table, every array after its length.
std::string content_checksum(const CreepTableData& table) {
  std::uint64_t sum = checksum({});
  const auto add = [&sum](std::span<const double> values) {
    const double length = static_cast<double>(values.size());
    sum = checksum(values, checksum({&length, 1}, sum));
  };
  for (const std::vector<double>& nodes : table.nodes) add(nodes);
  add(table.values);
  const std::array<double, 4> options{table.poisson, static_cast<double>(table.elements), table.ratio_stretch,
                                      table.radius_unit};
  add(options);
  for (const auto& [name, value] : table.statistics) add({&value, 1});
  return fmt::format("{:016x}", sum);
}

/// With 32 bits each: what is left of the exact solution's error is a hundred times larger.
std::vector<float> rounded(const std::vector<double>& values) {
  std::vector<float> result;
  result.reserve(values.size());
  for (const double v : values) result.push_back(static_cast<float>(v));
  return result;
}

class Reading {
 public:
  explicit Reading(const std::filesystem::path& name)
      : name_(name), file_(name, creep_table_filetype, format_version) {}

  [[nodiscard]] CreepTableData table() const {
    CreepTableData table;
    const std::string layout = file_.text("options", "layout");
    if (layout != "default" && layout != "paper") {
      throw input_error(place("options: layout"), fmt::format("\"{}\"", layout), "default or paper");
    }
    table.layout = creep_table_layout(layout);
    table.poisson = option("poisson", 0.0, 0.5);
    table.elements = static_cast<int>(option("elements", 1.0, 1e6));
    std::vector<long> shape;
    for (std::size_t i = 0; i < 4; ++i) {
      table.nodes[i] = numbers(axis_path(axes(table.layout)[i]), {-1});
      shape.push_back(static_cast<long>(table.nodes[i].size()));
    }
    shape.push_back(3);
    table.values = numbers("values", shape);
    if (table.layout == CreepTableLayout::smooth) {
      table.ratio_stretch = option("ratio_stretch", 1e-3, 1e3);
      table.radius_unit = option("radius_unit", 1e-3, 1e3);
    }
    table.statistics = read_statistics(file_);
    table.provenance = read_provenance(file_);
    require_checksum(file_, name_, content_checksum(table));
    return table;
  }

 private:
  [[nodiscard]] std::string place(std::string_view path) const { return fmt::format("{}: {}", name_.string(), path); }

  [[nodiscard]] double option(std::string_view name, double low, double high) const {
    const double value = file_.number("options", name);
    if (!(value >= low && value <= high)) {
      throw input_error(place(fmt::format("options: {}", name)), fmt::format("{}", value),
                        fmt::format("{} to {}", low, high));
    }
    return value;
  }

  [[nodiscard]] std::vector<double> numbers(const std::string& path, const std::vector<long>& shape) const {
    std::vector<double> values = file_.read(path, shape);
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (!std::isfinite(values[i])) {
        throw input_error(place(path), fmt::format("{} as value {}", values[i], i), "a finite number");
      }
    }
    return values;
  }

  std::filesystem::path name_;
  ArrayFileReader file_;
};

}  // namespace

void write_creep_table(const std::filesystem::path& file, const CreepTableData& table) {
  const std::vector<float> values = rounded(table.values);
  CreepTableData stored = table;  // as it will be read, for the checksum
  stored.values.assign(values.begin(), values.end());
  ArrayFileWriter out(file, creep_table_filetype, format_version);
  out.attribute("", "description",
                "Forces of exact rolling contact (Kalker), normalised: G = 1, mu F_n = 1, sqrt(ab) = 1; on the wheel, "
                "x forward, y right, z down. Layout: docs/file_formats/creep_table.md");
  std::vector<std::size_t> shape;
  for (std::size_t i = 0; i < 4; ++i) {
    const AxisText& axis = axes(table.layout)[i];
    const std::vector<double>& nodes = table.nodes[i];
    out.write(axis_path(axis), nodes, {nodes.size()}, axis.unit, axis.description);
    shape.push_back(nodes.size());
  }
  shape.push_back(3);
  const bool smooth = table.layout == CreepTableLayout::smooth;
  out.write("values", values, shape, "1",
            smooth ? "F_x/t, F_y/t, M_z/(t m) at the nodes, m^2 = (a/b + b/a)/2; at t = 0 the limit of linear theory"
                   : "F_x, F_y, M_z at the nodes");
  out.attribute("options", "layout", creep_table_layout_name(table.layout));
  out.attribute("options", "poisson", table.poisson);
  out.attribute("options", "elements", static_cast<std::int64_t>(table.elements));
  if (smooth) {
    out.attribute("options", "ratio_stretch", table.ratio_stretch);
    out.attribute("options", "radius_unit", table.radius_unit);
  }
  write_statements(out, table.provenance, table.statistics, content_checksum(stored));
  out.close();
}

CreepTableData read_creep_table(const std::filesystem::path& file) { return Reading(file).table(); }

}  // namespace railtab
