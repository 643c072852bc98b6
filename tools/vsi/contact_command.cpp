#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <vector>

#include "command/command_line.hpp"
#include "command/json_text.hpp"
#include "command/output_place.hpp"
#include "command/print.hpp"
#include "commands.hpp"
#include "railtab/runtime/base/column_file.hpp"
#include "railtab/runtime/base/column_rows.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/text_file.hpp"
#include "railtab/runtime/contact/frictionless_contact.hpp"
#include "railtab/runtime/contact_files/contact_table_file.hpp"

namespace railtab::vsi {
namespace po = boost::program_options;
namespace {

constexpr const char* patch_header =
    "query,patch,y_rail,z_rail,y_wheel,z_wheel,x_contact,angle,rolling_radius,penetration,curv_wheel,curv_rail,"
    "concave,source";
constexpr const char* loaded_columns = ",normal_force,a,b,pressure";
constexpr const char* total_header = "query,dz,fy,fz,mx";

struct Counts {
  long queries = 0, patches = 0, table = 0;
};

/// The contacts that a table or the online search describes.
struct Queries {
  const TableContact& table;
  const ContactGeometry& geometry;  ///< with the loaded part where the table has one
  NormalContactModel normal;        ///< of its steel
  NumberRows rows;
  bool by_load, online;

  [[nodiscard]] ContactPatches patches(const WheelsetPose& pose) const {
    return online ? table.search().patches(pose, touch_rounding) : table.patches(pose, touch_rounding);
  }
};

void append_patches(const Queries& queries, const WheelsetPose& pose, std::size_t query, std::string& text,
                    Counts& counts) {
  const ContactPatches patches = queries.patches(pose);
  const bool loaded = queries.geometry.loaded() != nullptr;
  std::array<PatchLoading, ContactPatches::capacity> loads;
  if (loaded) loads = patch_loadings(queries.geometry, pose, patches, queries.normal);
  std::size_t number = 0;
  for (const ContactPatch& p : patches) {
    // x + 0.0 turns -0 into 0
    const bool from_table = p.source == PatchSource::table;
    fmt::format_to(std::back_inserter(text), "{},{},{},{},{},{},{},{},{},{},{},{},{},{}", query, number, p.y_rail,
                   p.z_rail, p.y_wheel, p.z_wheel, p.x + 0.0, p.angle, p.rolling_radius, std::max(0.0, p.penetration),
                   p.curv_wheel, p.curv_rail, p.concave ? 1 : 0, from_table ? "table" : "online");
    if (loaded) {
      const PatchLoading& l = loads[number];
      fmt::format_to(std::back_inserter(text), ",{},{},{},{}", l.normal_force, l.a, l.b, l.pressure);
    }
    text += '\n';
    ++number;
    ++counts.patches;
    counts.table += from_table ? 1 : 0;
  }
}

/// Whether the poses have a load in place of a lowering. @throws InputError
bool has_loads(const std::string& query) {
  constexpr const char* expected = "the columns y,yaw,roll and one of dz and load, separated by commas";
  const ColumnRows rows(query, "a CSV file");
  rows.require_commas(expected);
  const auto has = [&](const char* name) {
    return std::find(rows.header().begin(), rows.header().end(), name) != rows.header().end();
  };
  if (has("load") != has("dz")) return has("load");
  throw rows.reader().error(has("load") ? "columns dz and load" : "no column dz or load", expected);
}

std::string header(const Queries& queries, bool total) {
  if (total) return fmt::format("{}\n", total_header);
  return fmt::format("{}{}\n", patch_header, queries.geometry.loaded() ? loaded_columns : "");
}

/// One row per patch of every query, or one per query. dz is measured from the first touch, which the online search
/// gives exactly.
std::string answer(const Queries& queries, bool total, Counts& counts) {
  std::string text = header(queries, total);
  for (std::size_t i = 0; i < queries.rows.rows.size(); ++i) {
    const std::vector<double>& q = queries.rows.rows[i];
    const auto [pose, dz] = lowered_pose(queries.table.search(), queries.geometry, {q[0], 0.0, q[2], q[1]},
                                         queries.by_load ? Lowering::under_load : Lowering::given, q[3], queries.normal,
                                         [&] { return queries.rows.places[i]; });
    if (total) {
      const Vector3 f = frictionless_force(queries.geometry, pose, queries.normal);
      fmt::format_to(std::back_inserter(text), "{},{},{},{},{}\n", i, dz, f[0] + 0.0, f[1] + 0.0, f[2] + 0.0);
    } else {
      append_patches(queries, pose, i, text, counts);
    }
    ++counts.queries;
  }
  return text;
}

}  // namespace

int contact_command(const Arguments& arguments) {
  po::options_description own("Options");
  own.add_options()("table", text_value()->value_name("TABLE.h5"), "a contact geometry table")  //
      ("query", text_value()->value_name("Q.csv"),
       "columns y,yaw,roll,dz [m, rad, rad, m]: pose of the wheelset against the right rail, dz below first touch; or "
       "y,yaw,roll,load: at the height at which the wheel carries this vertical load [N]")  //
      ("output,o", text_value()->value_name("R.csv"), "one row per contact patch")          //
      ("total",
       "one row per query: lowering, frictionless force on the rail and its moment about the rail-head origin")  //
      ("online", "patches by the online search on the table's pair");
  const CommandLine line("vsi contact TABLE.h5 --query Q.csv -o R.csv [--total] [--online]", own, {"table"}, arguments);
  if (line.help_printed()) return 0;
  const std::string table = line.required("table"), query = line.required("query"), output = line.required("output");
  require_writable_place(output, "-o");
  require_no_input(output, {query, table});
  const ContactTable contact = read_contact_table(table);
  if (const std::string unused = unused_loaded_part(contact.geometry); !unused.empty()) {
    line.warn(fmt::format("{}: {}", table, unused));
  }
  const bool by_load = has_loads(query), total = line.given("total");
  const Queries queries{contact.patches,
                        contact.geometry,
                        table_material(contact.geometry),
                        read_number_rows(query, {"y", "yaw", "roll", by_load ? "load" : "dz"}),
                        by_load,
                        line.given("online")};
  const char* const mark = total ? total_header : patch_header;
  require_replaceable_text(output, mark);
  Counts counts;
  write_text_file(output, answer(queries, total, counts), mark);
  if (line.json()) {
    print_json_line({{"queries", counts.queries},
                     {"patches", counts.patches},
                     {"patches_from_table", counts.table},
                     {"output", output}});
  } else if (!line.quiet() && total) {
    print_formatted("{} queries: {}\n", counts.queries, output);
  } else if (!line.quiet()) {
    print_formatted("{} queries, {} patches, {} of them from the table: {}\n", counts.queries, counts.patches,
                    counts.table, output);
  }
  return 0;
}

}  // namespace railtab::vsi
