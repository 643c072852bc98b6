#include "loaded_contact_command.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <optional>

#include "command/json_text.hpp"
#include "command/output_place.hpp"
#include "command/print.hpp"
#include "geometry_options.hpp"
#include "geometry_request.hpp"
#include "railtab/runtime/base/in_file.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/text_file.hpp"
#include "railtab/runtime/base/text_lines.hpp"
#include "railtab/runtime/contact/table_contact.hpp"
#include "railtab/tablegen/loaded_rolling.hpp"
#include "railtab/tables/files/geometry_table_file.hpp"

namespace railtab {

namespace {

namespace po = boost::program_options;

constexpr double largest_lowering = 2e-3;  // below first touch [m]
constexpr double largest_load = 1e7;       // [N]

constexpr const char* csv_header = "x,s_rail,y,z,angle,overlap,pressure,traction_x,traction_y,band";

/// What was asked for and what was found.
struct Case {
  ContactSearch search;
  WheelsetPose pose;  ///< z as asked for by --dz
  LoadedContactOptions options;
  std::optional<LoadedRollingOptions> rolling;  ///< with friction
  RelativeMotion motion;
  double pitch_rate = 0.0;
  ContactAtLoad found;
  LoadedRolling friction;
};

ContactSearch requested_search(const TableCommandLine& line) {
  if (!line.given("table")) {
    require_options_of_profiles(line);
    ContactSearch search(requested_pair(line));
    if (!line.quiet()) print_notes("contact", search.pair());
    return search;
  }
  line.reject(
      {"wheel", "rail", "smoothing", "rail-inclination", "gauge", "gauge-height", "flange-back", "wheel-radius"},
      "nothing of the pair beside --table, which has its own");
  const std::string file = line.text("table");
  return in_file(file, [&] { return TableContact(GeometryTable(read_geometry_table(file))).search(); });
}

LoadedContactOptions requested_options(const TableCommandLine& line) {
  LoadedContactOptions options;
  options.wheel = options.rail = {line.number("modulus"), line.number("poisson")};
  options.elements.across_narrowest = static_cast<int>(line.whole_number("elements", 4, 1000));
  options.elements.most = static_cast<int>(line.whole_number("most-elements", 64, 4000000));
  options.validate();
  return options;
}

void set_motion(const TableCommandLine& line, Case& c) {
  const double friction = line.number("friction");
  if (friction == 0.0) {
    line.reject({"velocity", "pitch-rate", "motion"}, "only with --friction above 0");
    return;
  }
  c.rolling.emplace();
  c.rolling->friction = friction;
  c.rolling->speed = line.number("velocity");
  c.rolling->validate();
  c.pitch_rate =
      line.given("pitch-rate") ? line.number("pitch-rate") : -c.rolling->speed / c.search.pair().nominal_radius();
  c.motion = running_motion(c.pose, c.rolling->speed, c.pitch_rate);
  if (!line.given("motion")) return;
  const std::vector<double> other =
      parse_numbers("--motion", line.text("motion"), 4, "VY,VZ,ROLL,YAW, velocities of the wheelset in m/s and rad/s");
  c.motion.velocity += Eigen::Vector3d(0.0, other[0], other[1]);
  c.motion.angular_velocity += Eigen::Vector3d(other[2], 0.0, other[3]);
}

WheelsetPose requested_pose(const TableCommandLine& line) {
  const std::vector<double> numbers =
      parse_numbers("--pose", line.required("pose"), 3, "Y,YAW,ROLL of the wheelset in m and rad");
  if (!(std::abs(numbers[0]) <= 0.1 && std::abs(numbers[1]) <= 0.1 && std::abs(numbers[2]) <= 0.1)) {
    throw input_error("--pose", line.text("pose"), "Y,YAW,ROLL between -0.1 and 0.1 m, rad");
  }
  return {numbers[0], 0.0, numbers[2], numbers[1]};
}

/// The contact of half-spaces is one of small overlaps.
void require_small_lowering(const TableCommandLine& line, double lowering) {
  if (lowering <= largest_lowering) return;
  throw input_error("--load",
                    fmt::format("{} N, which lowers the wheel by {:.3g} mm", line.text("load"), 1e3 * lowering),
                    fmt::format("a load that lowers it by at most {:g} mm; is it in N?", 1e3 * largest_lowering));
}

void solve(const TableCommandLine& line, Case& c) {
  if (line.given("load") == line.given("dz")) {
    throw input_error("tablegen contact --pose",
                      line.given("load") ? "both --load and --dz" : "neither --load nor --dz",
                      "one of them: the vertical load in N, or the lowering below first touch in m");
  }
  const auto roll = [&](const LoadedContact& contact) {
    LoadedRolling found = loaded_rolling(c.search.pair(), contact, c.options, c.motion, *c.rolling);
    if (!found.solution.converged) {
      throw ComputationError(fmt::format("no tangential solution at z = {} m: residual {:.2g}, asked for {:.2g}",
                                         contact.pose.z, found.solution.residual, c.rolling->solution.tolerance));
    }
    return found;
  };
  const double touch = c.search.touch_height(c.pose.y, c.pose.roll, c.pose.yaw);
  if (!std::isfinite(touch)) {
    throw input_error("--pose", line.text("pose"),
                      "one at which wheel and rail can touch; where none is, check the profiles (axes, origin, units), "
                      "--gauge and --flange-back");
  }
  if (line.given("load")) {
    FrictionShare share;
    if (c.rolling) share = [&](const LoadedContact& contact) { return roll(contact).on_rail.force.z(); };
    const double load = line.number("load");
    if (!(load > 0.0 && load <= largest_load)) {
      throw input_error("--load", line.text("load"), fmt::format("above 0, at most {:g} N", largest_load));
    }
    c.found = contact_at_load(c.search, c.pose, load, c.options, share);
    require_small_lowering(line, c.found.contact.pose.z - touch);
  } else {
    const double dz = line.number("dz");
    if (!(dz >= 0.0 && dz <= largest_lowering)) throw input_error("--dz", line.text("dz"), "0..2e-3 m");
    c.pose.z = touch + dz;
    c.found.contact = loaded_contact(c.search, c.pose, c.options);
    c.found.evaluations = 1;
    c.found.converged = c.found.contact.converged;
  }
  if (!c.found.converged) {
    throw ComputationError(
        fmt::format("no solution after {} evaluations: vertical force {:.6g} N at z = {} m, residual "
                    "{:.2g}, asked for {:.2g}",
                    c.found.evaluations, c.found.vertical_force, c.found.contact.pose.z, c.found.contact.residual,
                    c.options.tolerance.residual));
  }
  if (c.rolling) c.friction = roll(c.found.contact);
}

nlohmann::ordered_json vector_json(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

nlohmann::ordered_json band_json(const ContactBand& b) {
  return {{"normal_force", b.normal_force},
          {"force", vector_json(b.force)},
          {"area", b.area},
          {"largest_pressure", b.largest_pressure},
          {"contact_angle", b.angle},
          {"rolling_radius", b.rolling_radius},
          {"x", b.x},
          {"s_rail", b.s_rail},
          {"y_rail", b.y_rail},
          {"z_rail", b.z_rail},
          {"s_wheel", b.s_wheel},
          {"y_wheel", b.y_wheel},
          {"z_wheel", b.z_wheel},
          {"a", b.a},
          {"b", b.b},
          {"skew", b.skew},
          {"extent", {{"x", {b.x_low, b.x_high}}, {"s_rail", {b.s_low, b.s_high}}}},
          {"elements", b.elements}};
}

nlohmann::ordered_json band_friction_json(const BandFriction& b) {
  return {{"creepage", {b.creepage.x, b.creepage.y, b.creepage.spin}},
          {"fx", b.x},
          {"fy", b.y},
          {"mz", b.moment},
          {"force", vector_json(b.force)}};
}

nlohmann::ordered_json elements_json(const LoadedContact& k) {
  const ContactElements& e = k.elements;
  return {{"nx", e.nx}, {"ns", e.ns}, {"dx", e.dx}, {"ds", e.ds}, {"rows_across_peak", k.rows_across_peak}};
}

nlohmann::ordered_json description(const Case& c) {
  const LoadedContact& k = c.found.contact;
  const double touch = c.search.touch_height(k.pose.y, k.pose.roll, k.pose.yaw);
  const Eigen::Vector3d total = k.on_rail.force + c.friction.on_rail.force;
  const Eigen::Vector3d moment = k.on_rail.moment + c.friction.on_rail.moment;
  nlohmann::ordered_json j{{"kind", "loaded contact"},
                           {"pose", {{"y", k.pose.y}, {"z", k.pose.z}, {"yaw", k.pose.yaw}, {"roll", k.pose.roll}}},
                           {"dz", k.pose.z - touch},
                           {"force_on_rail", vector_json(total)},
                           {"moment_on_rail", vector_json(moment)},
                           {"normal_force", k.normal_force},
                           {"elastic_energy", k.elastic_energy},
                           {"largest_pressure", k.largest_pressure},
                           {"area", k.area},
                           {"overlap_regions", k.regions.size()},
                           {"elements", elements_json(k)},
                           {"residual", k.residual},
                           {"iterations", k.iterations},
                           {"evaluations", c.found.evaluations}};
  j["bands"] = nlohmann::ordered_json::array();
  for (std::size_t b = 0; b < k.bands.size(); ++b) {
    j["bands"].push_back(band_json(k.bands[b]));
    if (c.rolling) j["bands"].back()["friction"] = band_friction_json(c.friction.bands[b]);
  }
  if (c.rolling) {
    const RollingContactSolution& s = c.friction.solution;
    j["friction"] = {{"coefficient", c.rolling->friction},
                     {"velocity", c.rolling->speed},
                     {"pitch_rate", c.pitch_rate},
                     {"force_on_wheel", vector_json(-c.friction.on_rail.force)},
                     {"adhesion", s.adhesion},
                     {"slip", s.slip},
                     {"residual", s.residual},
                     {"bound_excess", s.bound_excess},
                     {"safe_method", s.safe_method}};
  }
  return j;
}

void print_text_of(const Case& c) {
  const LoadedContact& k = c.found.contact;
  const Eigen::Vector3d total = k.on_rail.force + c.friction.on_rail.force;
  print_formatted("y = {:g} mm, yaw = {:g} mrad, roll = {:g} mrad: z = {:.6f} mm, {:.3f} um below first touch\n",
                  1e3 * k.pose.y, 1e3 * k.pose.yaw, 1e3 * k.pose.roll, 1e3 * k.pose.z,
                  1e6 * (k.pose.z - c.search.touch_height(k.pose.y, k.pose.roll, k.pose.yaw)));
  print_formatted(
      "force on the rail X {:.3f}, Y {:.3f}, Q {:.3f} N; normal force {:.3f} N, largest pressure {:.4g} MPa\n",
      total.x(), total.y(), total.z(), k.normal_force, 1e-6 * k.largest_pressure);
  print_formatted("{} x {} elements of {:.3g} x {:.3g} mm, residual {:.1e}\n", k.elements.nx, k.elements.ns,
                  1e3 * k.elements.dx, 1e3 * k.elements.ds, k.residual);
  for (std::size_t i = 0; i < k.bands.size(); ++i) {
    const ContactBand& b = k.bands[i];
    print_formatted(
        "  band at y_rail {:.4f} mm: {:.2f} N, angle {:.3f} mrad, r {:.4f} mm, a {:.3f}, b {:.3f} mm, area "
        "{:.3f} mm2, {:.4g} MPa\n",
        1e3 * b.y_rail, b.normal_force, 1e3 * b.angle, 1e3 * b.rolling_radius, 1e3 * b.a, 1e3 * b.b, 1e6 * b.area,
        1e-6 * b.largest_pressure);
    if (!c.rolling) continue;
    const BandFriction& f = c.friction.bands[i];
    print_formatted(
        "       creepages {:.3e}, {:.3e}, {:.4f} 1/m; on the wheel F_x {:.2f}, F_y {:.2f} N, M_z {:.4f} N m\n",
        f.creepage.x, f.creepage.y, f.creepage.spin, f.x, f.y, f.moment);
  }
}

std::string elements_csv(const Case& c) {
  const LoadedContact& k = c.found.contact;
  const ContactElements& e = k.elements;
  std::string text = fmt::format("{}\n", csv_header);
  for (int n = 0; n < e.count(); ++n) {
    if (k.pressure[n] <= 0.0) continue;
    const SurfaceLine& line = e.line[static_cast<std::size_t>(n / e.nx)];
    const double tx = c.rolling ? c.friction.traction_x[n] : 0.0, ty = c.rolling ? c.friction.traction_y[n] : 0.0;
    fmt::format_to(std::back_inserter(text), "{},{},{},{},{},{},{},{},{},{}\n", e.x[static_cast<std::size_t>(n % e.nx)],
                   line.s, line.y, line.z, line.angle, e.overlap[n], k.pressure[n], tx, ty,
                   k.band[static_cast<std::size_t>(n)]);
  }
  return text;
}

}  // namespace

std::vector<double> parse_numbers(const std::string& option, const std::string& text, std::size_t count,
                                  const std::string& expected) {
  std::vector<std::string_view> fields;
  cut(text, ',', fields);
  std::vector<double> values;
  for (std::string_view field : fields) {
    if (const std::optional<double> value = parse_number(field)) values.push_back(*value);
  }
  if (fields.size() != count || values.size() != count) {
    throw input_error(option, fmt::format("\"{}\"", text), expected);
  }
  return values;
}

po::options_description loaded_contact_options() {
  po::options_description own = pair_options("A wheel on its rail (SI units)");
  own.add_options()("table", text_value()->value_name("FILE.h5"), "a geometry table whose pair is taken")  //
      ("pose", text_value()->value_name("Y,YAW,ROLL"), "of the wheelset against the right rail")           //
      ("load", text_value()->value_name("N"), "vertical load of the wheel, friction's share included")     //
      ("dz", text_value()->value_name("M"), "in place of a load: lowering below first touch")              //
      ("friction", text_value("0")->value_name("MU"), "friction coefficient; 0: no friction")              //
      ("velocity", text_value("1")->value_name("V"), "running speed")                                      //
      ("pitch-rate", text_value()->value_name("W"),
       "about the axle, negative forward; free rolling at the nominal radius")                         //
      ("motion", text_value()->value_name("VY,VZ,ROLL,YAW"), "the wheelset's other velocities; none")  //
      ("modulus", text_value("210e9")->value_name("E"), "Young's modulus of wheel and rail")           //
      ("most-elements", text_value("60000")->value_name("N"), "allowed altogether")                    //
      ("output,o", text_value()->value_name("CSV"), "pressure and tractions of the elements in contact");
  return own;
}

void loaded_contact_command(const TableCommandLine& line) {
  line.reject({"ratio", "creepage"}, "either an ellipse or a --pose, not both");
  if (line.given("output")) {
    require_writable_place(line.text("output"), "--output");
    require_replaceable_text(line.text("output"), csv_header);
  }
  Case c{requested_search(line), requested_pose(line), requested_options(line), {}, {}, 0.0, {}, {}};
  set_motion(line, c);
  try {
    solve(line, c);
  } catch (const TooManyElements& error) {
    throw ComputationError(fmt::format("{} (--elements, --most-elements)", error.what()));
  }
  if (line.given("output")) write_text_file(line.text("output"), elements_csv(c), csv_header);
  if (line.json()) {
    print_json(description(c));
  } else if (!line.quiet()) {
    print_text_of(c);
  }
}

}  // namespace railtab
