#include <fmt/format.h>

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <iterator>
#include <memory>
#include <numbers>
#include <vector>

#include "command/command_line.hpp"
#include "command/json_text.hpp"
#include "command/output_place.hpp"
#include "command/print.hpp"
#include "commands.hpp"
#include "railtab/runtime/base/column_file.hpp"
#include "railtab/runtime/base/in_file.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/text_file.hpp"
#include "railtab/runtime/contact/contact_response.hpp"
#include "railtab/tables/files/geometry_table_file.hpp"

namespace railtab::vsi {
namespace po = boost::program_options;
namespace {

constexpr const char* patch_header =
    "query,patch,y_rail,z_rail,y_wheel,z_wheel,x_contact,angle,rolling_radius,penetration,curv_wheel,curv_rail,"
    "concave,source";
constexpr const char* loaded_columns = ",normal_force,a,b,pressure";
constexpr const char* total_header = "query,dz,fy,fz,mx";
constexpr double deepest = 0.01;      // m: beyond, the profiles are through each other
constexpr double rounding = 1e-13;    // m: of the height of first touch
constexpr double largest_load = 1e7;  // N

struct Counts {
  long queries = 0, patches = 0, table = 0;
};

/// What carries a load in one patch.
struct PatchLoading {
  double normal_force = 0.0, a = 0.0, b = 0.0, pressure = 0.0;
};

/// The contacts that a table or the online search describes.
struct Queries {
  const TableContact& table;
  ContactGeometry geometry;  ///< with the loaded part where the table has one
  NumberRows rows;
  bool by_load, online;

  [[nodiscard]] ContactPatches patches(const WheelsetPose& pose) const {
    return online ? table.search().patches(pose, rounding) : table.patches(pose, rounding);
  }
};

/// Frictionless force on the rail (y, z) and its moment about the rail-head origin.
Vector3 force_on_rail(const ContactGeometry& geometry, const WheelsetPose& pose) {
  WheelContactModel model;
  model.geometry = &geometry;
  model.friction = 0.0;
  model.speed = 1.0;
  WheelsetMotion motion;
  motion.displacement << 0.0, pose.y, pose.z, pose.roll, 0.0, pose.yaw;
  return wheel_force(model, WheelSide::right, motion, {}, wheel_contact(geometry, pose)).rail;
}

/// The lowering at which the wheel carries a vertical load.
double lowering_of(const Queries& queries, WheelsetPose pose, double touch, double load, const std::string& place) {
  if (!(load > 0.0 && load <= largest_load)) {
    throw input_error(place, fmt::format("load = {}", load), fmt::format("above 0, at most {} N", largest_load));
  }
  const auto excess = [&](double dz) {
    pose.z = touch + dz;
    return force_on_rail(queries.geometry, pose)[1] - load;
  };
  double low = 0.0, high = 1e-6, at_high = excess(high), at_low = -load;
  while (at_high < 0.0 && high < deepest) {
    low = high;
    at_low = at_high;
    high = std::min(deepest, 2.0 * high);
    at_high = excess(high);
  }
  if (at_high < 0.0) {
    throw input_error(place, fmt::format("load = {} N, not carried {} m below first touch", load, deepest),
                      "a load that the contact carries");
  }
  boost::uintmax_t passes = 200;
  const auto close = [](double a, double b) { return std::abs(a - b) <= 1e-15; };
  const auto [below, above] = boost::math::tools::toms748_solve(excess, low, high, at_low, at_high, close, passes);
  return 0.5 * (below + above);
}

/// Of every patch: parts of the loaded contact count to the nearest along the rail; without a loaded part, Hertz's.
std::vector<PatchLoading> loadings(const ContactGeometry& geometry, const WheelsetPose& pose,
                                   const ContactPatches& patches) {
  std::vector<PatchLoading> result(static_cast<std::size_t>(patches.count));
  const WheelContact contact = wheel_contact(geometry, pose);
  if (contact.by_patches()) {
    const PatchLoads loads = patch_loads({}, geometry, pose, patches);
    for (std::size_t i = 0; i < loads.size(); ++i) {
      const double N = loads[i].elastic_force, a = loads[i].hertz.a1 * std::cbrt(N),
                   b = loads[i].hertz.b1 * std::cbrt(N);
      if (N > 0.0) result[i] = {N, a, b, 1.5 * N / (std::numbers::pi * a * b)};
    }
    return result;
  }
  for (std::size_t p = 0; p < contact.loaded.parts && patches.count > 0; ++p) {
    const LoadedPart& part = contact.loaded.part[p];
    const auto distance = [&](const ContactPatch& patch) { return std::abs(patch.s_rail - part.s_rail); };
    const ContactPatch* const nearest = std::min_element(
        patches.begin(), patches.end(), [&](const auto& p_, const auto& q_) { return distance(p_) < distance(q_); });
    PatchLoading& of = result[static_cast<std::size_t>(nearest - patches.begin())];
    const double N = part.share * contact.loaded.force[1] / std::cos(part.angle);
    of.pressure = std::max(of.pressure, part.pressure);
    if (N > of.normal_force) {
      of.a = part.a;
      of.b = part.b;
    }
    of.normal_force += N;
  }
  return result;
}

void append_patches(const Queries& queries, const WheelsetPose& pose, std::size_t query, std::string& text,
                    Counts& counts) {
  const ContactPatches patches = queries.patches(pose);
  const bool loaded = queries.geometry.loaded() != nullptr;
  const std::vector<PatchLoading> loads =
      loaded ? loadings(queries.geometry, pose, patches) : std::vector<PatchLoading>{};
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
    const std::string& place = queries.rows.places[i];
    WheelsetPose pose{q[0], 0.0, q[2], q[1]};
    if (!queries.by_load && !(q[3] >= 0.0 && q[3] <= deepest)) {
      throw input_error(place, fmt::format("dz = {}", q[3]), fmt::format("0 to {} m below first touch", deepest));
    }
    const double touch = queries.table.search().touch_height(pose.y, pose.roll, pose.yaw);
    if (!std::isfinite(touch)) {
      throw input_error(place,
                        fmt::format("y = {}, yaw = {}, roll = {}, where wheel and rail never meet", q[0], q[1], q[2]),
                        "a position on the rail");
    }
    const double dz = queries.by_load ? lowering_of(queries, pose, touch, q[3], place) : q[3];
    pose.z = touch + dz;
    if (total) {
      const Vector3 f = force_on_rail(queries.geometry, pose);
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
  GeometryTableData data = read_geometry_table(table);
  std::shared_ptr<const LoadedTable> loaded;
  if (data.loaded) loaded = std::make_shared<const LoadedTable>(std::move(*data.loaded));
  data.loaded.reset();
  const TableContact contact = in_file(table, [&] { return TableContact(GeometryTable(std::move(data))); });
  const bool by_load = has_column(query, "load"), total = line.given("total");
  const Queries queries{contact, ContactGeometry(contact, std::move(loaded)),
                        read_number_rows(query, {"y", "yaw", "roll", by_load ? "load" : "dz"}), by_load,
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
