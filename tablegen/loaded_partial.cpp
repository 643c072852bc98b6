// The file of a loaded table while it is solved: one record per column.

#include <fmt/format.h>

#include <chrono>
#include <optional>

#include "railtab/runtime/base/in_file.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/contact/table_contact.hpp"
#include "railtab/tablegen/loaded_sweep.hpp"
#include "railtab/tablegen/loaded_verification.hpp"
#include "railtab/tables/files/array_file.hpp"
#include "railtab/tables/files/geometry_table_file.hpp"

namespace railtab {

namespace {

constexpr std::string_view filetype = "railtab-loaded-partial";
constexpr int format_version = 4;
constexpr auto flush_every = std::chrono::milliseconds(500);
constexpr std::size_t heading = 7, node_heading = 4;

/// What the columns depend on of the options that commands set.
std::string request(const GeometryTableData& table, const LoadedSweepOptions& o, const std::string& version) {
  std::uint64_t sum = checksum_seed;
  for (const ProfileKnots* profile : {&table.wheel, &table.rail})
    for (const auto* values : {&profile->s, &profile->y, &profile->z, &profile->dy, &profile->dz})
      sum = checksum(*values, sum);
  const std::vector<double> numbers{table.track_gauge,
                                    table.gauge_height,
                                    table.flange_back,
                                    table.nominal_radius,
                                    o.lateral.low,
                                    o.lateral.high,
                                    o.roll.low,
                                    o.roll.high,
                                    o.climb,
                                    o.yaw,
                                    o.largest_load,
                                    static_cast<double>(o.levels),
                                    o.roll_spacing,
                                    static_cast<double>(o.yaw_nodes),
                                    o.force_error,
                                    o.light_error,
                                    o.least_interval,
                                    o.contact.wheel.E,
                                    o.contact.wheel.nu,
                                    o.contact.rail.E,
                                    o.contact.rail.nu,
                                    static_cast<double>(o.contact.elements.across_narrowest)};
  return fmt::format("{} {:016x}", version, checksum(numbers, sum));
}

std::vector<double> row_of(const LoadedSweepColumn& column) {
  const std::vector<LoadedNode>& level = column.solution.level;
  std::vector<double> row{column.y0,
                          static_cast<double>(column.roll),
                          static_cast<double>(column.yaw),
                          column.shift.y,
                          column.shift.slope,
                          static_cast<double>(column.solution.solutions),
                          static_cast<double>(level.front().part.size())};
  for (const LoadedNode& node : level) {
    row.insert(row.end(), {node.z, node.z_w, node.z_y, node.force});
    for (const LoadedPart& part : node.part) {
      const auto values = part.values();
      row.insert(row.end(), values.begin(), values.end());
    }
  }
  return row;
}

LoadedSweepColumn column_of(std::span<const double> row) {
  LoadedSweepColumn column;
  column.y0 = row[0];
  column.roll = static_cast<std::size_t>(row[1]);
  column.yaw = static_cast<std::size_t>(row[2]);
  column.shift = {row[3], row[4]};
  column.solution.solutions = static_cast<long>(row[5]);
  const auto parts = static_cast<std::size_t>(row[6]);
  const std::size_t size = node_heading + parts * LoadedPart::quantities;
  for (std::size_t at = heading; at + size <= row.size(); at += size) {
    LoadedNode node;
    node.z = row[at];
    node.z_w = row[at + 1];
    node.z_y = row[at + 2];
    node.force = row[at + 3];
    for (std::size_t p = 0; p < parts; ++p) {
      std::array<double, LoadedPart::quantities> values{};
      std::copy_n(row.begin() + static_cast<std::ptrdiff_t>(at + node_heading + p * values.size()), values.size(),
                  values.begin());
      node.part.push_back(LoadedPart::of(values));
    }
    column.solution.level.push_back(std::move(node));
  }
  return column;
}

/// What an earlier run has left, where it asked for the same.
std::vector<LoadedSweepColumn> earlier_columns(const std::filesystem::path& partial, const std::string& wanted) {
  std::vector<LoadedSweepColumn> columns;
  if (!std::filesystem::exists(partial) || std::filesystem::is_symlink(partial)) return columns;
  try {
    const ArrayFileReader file(partial, filetype, format_version);
    if (file.text("", "request") != wanted) return columns;
    const Array rows = file.read("columns");
    const std::size_t size = rows.shape.at(1);
    for (std::size_t i = 0; i < rows.shape[0]; ++i)
      columns.push_back(column_of(std::span(rows.values).subspan(i * size, size)));
  } catch (const InputError&) {  // of another version, or damaged: solved again
    columns.clear();
  }
  return columns;
}

void certify(const ContactSearch& search, const LoadedSweepOptions& options, LoadedTableData& table) {
  LoadedVerificationOptions check;
  check.material = options.contact.wheel;
  const LoadedVerification found = verify_loaded_table(search, LoadedTable(table), check);
  if (found.above_5_kn == 0) {
    throw ComputationError(
        fmt::format("loaded table: none of the {} random poses of its check carries more than 5 kN within the table: a "
                    "greater --largest-load, or wider ranges; the columns solved are kept",
                    found.samples));
  }
  table.statistics.emplace_back("certified.samples", found.samples);
  table.statistics.emplace_back("certified.answered", found.answered);
  add_certified_errors(found, table.statistics);
}

}  // namespace

void add_loaded_table(const std::filesystem::path& file, const LoadedSweepOptions& options,
                      const TableProvenance& provenance, const Progress& progress) {
  options.validate();
  const std::string made_of = array_file_checksum(file);
  GeometryTableData table = read_geometry_table(file);
  if (!table.shard.whole()) throw input_error(file.string(), "a part of a table", "a whole one: merge the parts first");
  const TableContact contact = in_file(file.string(), [&table] { return TableContact(GeometryTable(table)); });
  std::filesystem::path partial = file;
  partial += ".loaded-partial";
  require_replaceable(partial, {filetype});
  const std::string wanted = request(table, options, provenance.program_version);
  LoadedColumnStore store{.known = earlier_columns(partial, wanted), .keep = {}};
  std::optional<ArrayFileWriter> out;
  if (!store.known.empty()) {  // the earlier file itself goes on: at no moment does a kill find fewer columns
    out.emplace(ArrayFileWriter::reopen(partial, filetype, format_version));
    out->truncate(store.known.size());  // to what was read, should another call have added to it since
  }
  auto flushed = std::chrono::steady_clock::now();
  store.keep = [&](const LoadedSweepColumn& column) {
    const std::vector<double> row = row_of(column);
    if (!out) {
      out.emplace(partial, filetype, format_version, ArrayFileWriter::Mode::growing);
      out->attribute("", "request", wanted);
      out->create_growing("columns", {row.size()}, "1", "columns of a loaded table under way");
    }
    out->append("columns", row);
    const auto now = std::chrono::steady_clock::now();
    if (now - flushed < flush_every) return;
    out->flush();
    flushed = now;
  };
  table.loaded = sweep_loaded(contact.search(), options, std::move(store), progress);
  certify(contact.search(), options, *table.loaded);
  if (array_file_checksum(file) != made_of) {
    throw input_error(file.string(), "another table than when the command began",
                      "that table until the command ends: the same command makes the loaded part of the new one");
  }
  write_geometry_table(file, table);
  if (out) out->close();
  std::filesystem::remove(partial);
}

}  // namespace railtab
