#include "railtab/tables/files/creep_table_file.hpp"

#include <fmt/format.h>

#include <array>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/tables/files/file_fields.hpp"
#include "railtab/tables/files/table_statements.hpp"

namespace railtab {
namespace {

constexpr int creep_format_version = 1;

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

Field axis_field(const AxisText& axis) {
  return {fmt::format("axes/{}", axis.name), {axis.name}, axis.unit, axis.description, Field::Values::increasing};
}

Field values_field(CreepTableLayout layout) {
  Field field{"values",
              {},
              "1",
              layout == CreepTableLayout::smooth
                  ? "F_x/t, F_y/t, M_z/(t m) at the nodes, m^2 = (a/b + b/a)/2; at t = 0 the limit of linear theory"
                  : "F_x, F_y, M_z at the nodes"};
  for (const AxisText& axis : axes(layout)) field.shape.emplace_back(axis.name);
  field.shape.emplace_back("3");
  return field;
}

/// Over every number of the table, every array after its length.
std::string content_checksum(const CreepTableData& table) {
  std::uint64_t sum = checksum({});
  const auto add = [&sum](std::span<const double> values) { sum = counted_checksum(values, sum); };
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

}  // namespace

void write_creep_table(const std::filesystem::path& file, const CreepTableData& table) {
  const std::vector<float> values = rounded(table.values);
  CreepTableData stored = table;  // as it will be read, for the checksum
  stored.values.assign(values.begin(), values.end());
  ArrayFileWriter out(file, creep_table_filetype, creep_format_version);
  out.attribute("", "description",
                "Forces of exact rolling contact (Kalker), normalised: G = 1, mu F_n = 1, sqrt(ab) = 1; on the wheel, "
                "x forward, y right, z down. Layout: docs/file_formats/creep_table.md");
  FieldWriter arrays(out);
  for (std::size_t i = 0; i < 4; ++i) arrays.write(axis_field(axes(table.layout)[i]), table.nodes[i]);
  arrays.write(values_field(table.layout), values);
  out.attribute("options", "layout", creep_table_layout_name(table.layout));
  out.attribute("options", "poisson", table.poisson);
  out.attribute("options", "elements", static_cast<std::int64_t>(table.elements));
  if (table.layout == CreepTableLayout::smooth) {
    out.attribute("options", "ratio_stretch", table.ratio_stretch);
    out.attribute("options", "radius_unit", table.radius_unit);
  }
  write_statements(out, table.provenance, table.statistics, content_checksum(stored));
  out.close();
}

CreepTableData read_creep_table(const std::filesystem::path& name) {
  const ArrayFileReader file(name, creep_table_filetype, creep_format_version);
  FieldReader in(file);
  CreepTableData table;
  const std::string layout = file.text("options", "layout");
  if (layout != "default" && layout != "paper") {
    throw input_error(fmt::format("{}: options: layout", name.string()), fmt::format("\"{}\"", layout),
                      "default or paper");
  }
  table.layout = creep_table_layout(layout);
  table.poisson = in.number("options", "poisson", 0.0, 0.5);
  table.elements = static_cast<int>(file.whole_number("options", "elements", 8, 240));
  for (std::size_t i = 0; i < 4; ++i) table.nodes[i] = in.numbers(axis_field(axes(table.layout)[i]));
  table.values = in.numbers(values_field(table.layout));
  if (table.layout == CreepTableLayout::smooth) {
    table.ratio_stretch = in.number("options", "ratio_stretch", 1e-3, 1e3);
    table.radius_unit = in.number("options", "radius_unit", 1e-3, 1e3);
  }
  table.statistics = read_statistics(file);
  table.provenance = read_provenance(file);
  require_checksum(file, content_checksum(table));
  return table;
}

}  // namespace railtab
