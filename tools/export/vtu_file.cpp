#include "vtu_file.hpp"

#include <fmt/format.h>

#include <bit>
#include <cstring>

#include "railtab/runtime/report/history_store.hpp"

namespace railtab::vtk {
namespace {

constexpr std::string_view byte_order = std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian";

constexpr std::string_view type_name(float) { return "Float32"; }
constexpr std::string_view type_name(double) { return "Float64"; }
constexpr std::string_view type_name(std::uint8_t) { return "UInt8"; }
constexpr std::string_view type_name(std::int32_t) { return "Int32"; }
constexpr std::string_view type_name(std::int64_t) { return "Int64"; }

std::string escaped(std::string_view text) {
  std::string safe;
  for (const char c : text) {
    switch (c) {
      case '<':
        safe += "&lt;";
        break;
      case '&':
        safe += "&amp;";
        break;
      case '"':
        safe += "&quot;";
        break;
      default:
        safe += c;
    }
  }
  return safe;
}

template <class Value>
std::string encoded(std::span<const Value> values) {
  const std::uint64_t bytes = values.size() * sizeof(Value);
  std::vector<unsigned char> block(sizeof bytes + bytes);
  std::memcpy(block.data(), &bytes, sizeof bytes);
  if (bytes > 0) std::memcpy(block.data() + sizeof bytes, values.data(), bytes);
  return report::base64(block);
}

template <class Value>
std::string data_array(std::string_view name, int components, const std::vector<Value>& values) {
  return fmt::format("<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"binary\">{}</DataArray>\n",
                     type_name(Value{}), escaped(name), components, encoded(std::span<const Value>(values)));
}

std::string data_arrays(const std::vector<Array>& arrays) {
  std::string text;
  for (const Array& array : arrays) {
    text +=
        std::visit([&](const auto& values) { return data_array(array.name, array.components, values); }, array.values);
  }
  return text;
}

/// VTK has no other way for texts than the numbers of their bytes, each text ended by a zero.
std::string text_array(const std::string& name, const std::vector<std::string>& texts) {
  std::string numbers;
  for (const std::string& text : texts) {
    for (const char c : text) numbers += fmt::format("{} ", static_cast<unsigned char>(c));
    numbers += "0 ";
  }
  return fmt::format("<Array type=\"String\" Name=\"{}\" NumberOfTuples=\"{}\" format=\"ascii\">{}</Array>\n",
                     escaped(name), texts.size(), numbers);
}

std::string field_data(const Grid& grid) {
  std::string text;
  for (const auto& [name, value] : grid.numbers) {
    text +=
        fmt::format("<DataArray type=\"Float64\" Name=\"{}\" NumberOfTuples=\"1\" format=\"binary\">{}</DataArray>\n",
                    escaped(name), encoded(std::span<const double>(&value, 1)));
  }
  for (const auto& [name, texts] : grid.texts) text += text_array(name, texts);
  return text;
}

}  // namespace

std::string_view vtu_mark() noexcept { return "<?xml version=\"1.0\"?>\n<!-- railtab: vsi export, a part -->\n"; }
std::string_view pvd_mark() noexcept { return "<?xml version=\"1.0\"?>\n<!-- railtab: vsi export -->\n"; }

std::string vtu_text(const Grid& grid) {
  return fmt::format(
      "{}<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"{}\" header_type=\"UInt64\">\n"
      "<UnstructuredGrid>\n<FieldData>\n{}</FieldData>\n<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n"
      "<PointData>\n{}</PointData>\n<CellData>\n{}</CellData>\n<Points>\n{}</Points>\n<Cells>\n{}{}{}</Cells>\n"
      "</Piece>\n</UnstructuredGrid>\n</VTKFile>\n",
      vtu_mark(), byte_order, field_data(grid), grid.point_count(), grid.types.size(), data_arrays(grid.point_data),
      data_arrays(grid.cell_data), data_array("Points", 3, grid.points),
      data_array("connectivity", 1, grid.connectivity), data_array("offsets", 1, grid.offsets),
      data_array("types", 1, grid.types));
}

std::string pvd_text(std::span<const CollectionEntry> entries) {
  std::string text = fmt::format("{}<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"{}\">\n<Collection>\n",
                                 pvd_mark(), byte_order);
  for (const CollectionEntry& entry : entries) {
    text += fmt::format("<DataSet timestep=\"{}\" group=\"\" part=\"{}\" name=\"{}\" file=\"{}\"/>\n", entry.time,
                        entry.part, escaped(entry.name), escaped(entry.file));
  }
  return text + "</Collection>\n</VTKFile>\n";
}

}  // namespace railtab::vtk
