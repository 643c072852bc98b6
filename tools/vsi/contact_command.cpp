#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "command/command_line.hpp"
#include "command/json_text.hpp"
#include "command/output_place.hpp"
#include "command/print.hpp"
#include "commands.hpp"
#include "railtab/runtime/base/column_file.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/text_file.hpp"
#include "railtab/runtime/contact/table_contact.hpp"
#include "railtab/tables/files/geometry_table_file.hpp"

namespace railtab::vsi {
namespace po = boost::program_options;
namespace {

constexpr const char* result_header =
    "query,patch,y_rail,z_rail,y_wheel,z_wheel,x_contact,angle,rolling_radius,penetration,curv_wheel,curv_rail,"
    "concave,source\n";

struct Counts {
  long queries = 0, patches = 0, table = 0;
};

void append_patches(const ContactPatches& patches, std::size_t query, std::string& text, Counts& counts) {
  int number = 0;
  for (const ContactPatch& p : patches) {
    // x + 0.0 turns -0 into 0
    const bool from_table = p.source == PatchSource::table;
    fmt::format_to(std::back_inserter(text), "{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", query, number++, p.y_rail,
                   p.z_rail, p.y_wheel, p.z_wheel, p.x + 0.0, p.angle, p.rolling_radius, p.penetration, p.curv_wheel,
                   p.curv_rail, p.concave ? 1 : 0, from_table ? "table" : "online");
    ++counts.patches;
    counts.table += from_table ? 1 : 0;
  }
}

/// One row per patch of every query. dz is measured from the first touch, which the online search gives exactly.
std::string answer(const TableContact& contact, const NumberRows& queries, bool online, Counts& counts) {
  std::string text = result_header;
  for (std::size_t i = 0; i < queries.rows.size(); ++i) {
    const std::vector<double>& q = queries.rows[i];
    const std::string& place = queries.places[i];
    constexpr double deepest = 0.01;  // m: beyond, the profiles are through each other
    if (!(q[3] >= 0.0 && q[3] <= deepest)) {
      throw input_error(place, fmt::format("dz = {}", q[3]), fmt::format("0 to {} m below first touch", deepest));
    }
    WheelsetPose pose{q[0], 0.0, q[2], q[1]};
    const double touch = contact.search().touch_height(pose.y, pose.roll, pose.yaw);
    if (!std::isfinite(touch)) {
      throw input_error(place,
                        fmt::format("y = {}, yaw = {}, roll = {}, where wheel and rail never meet", q[0], q[1], q[2]),
                        "a position on the rail");
    }
    pose.z = touch + q[3];
    append_patches(online ? contact.search().patches(pose) : contact.patches(pose), i, text, counts);
    ++counts.queries;
  }
  return text;
}

}  // namespace

int contact_command(const Arguments& arguments) {
  po::options_description own("Options");
  own.add_options()("table", text_value()->value_name("TABLE.h5"), "a contact geometry table")  //
      ("query", text_value()->value_name("Q.csv"),
       "columns y,yaw,roll,dz [m, rad, rad, m]: pose of the wheelset against the right rail, dz below first touch")  //
      ("output,o", text_value()->value_name("R.csv"), "one row per contact patch")                                   //
      ("online", "use the online search on the table's pair");
  const CommandLine line("vsi contact TABLE.h5 --query Q.csv -o R.csv [--online]", own, {"table"}, arguments);
  if (line.help_printed()) return 0;
  const std::string table = line.required("table"), query = line.required("query"), output = line.required("output");
  require_writable_place(output, "-o");
  require_no_input(output, {query, table});
  require_replaceable_text(output, result_header);
  const TableContact contact(GeometryTable(read_geometry_table(table)));
  const NumberRows queries = read_number_rows(query, {"y", "yaw", "roll", "dz"});
  Counts counts;
  write_text_file(output, answer(contact, queries, line.given("online"), counts));
  if (line.json()) {
    print_json_line({{"queries", counts.queries},
                     {"patches", counts.patches},
                     {"patches_from_table", counts.table},
                     {"output", output}});
  } else if (!line.quiet()) {
    print_formatted("{} queries, {} patches, {} of them from the table: {}\n", counts.queries, counts.patches,
                    counts.table, output);
  }
  return 0;
}

}  // namespace railtab::vsi
