#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "command/command_line.hpp"
#include "command/json_text.hpp"
#include "command/print.hpp"
#include "commands.hpp"
#include "hunting_case.hpp"
#include "railtab/runtime/base/in_file.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/scene/scene_model.hpp"
#include "railtab/runtime/scene/scene_parameters.hpp"
#include "railtab/runtime/stability/linear_stability.hpp"
#include "railtab/runtime/vehicle/vehicle_library.hpp"
#include "railtab/runtime/vehicle/vehicle_modes.hpp"
#include "railtab/runtime/vehicle/vehicle_plausibility.hpp"
#include "railtab/runtime/vehicle/vehicle_summary.hpp"
#include "railtab/tables/files/geometry_table_file.hpp"

namespace railtab::vsi {
namespace po = boost::program_options;
namespace {

using Json = nlohmann::ordered_json;

constexpr double to_kmh = 3.6;

/// The linear critical speed of a vehicle on a table; none up to SpeedSearch::high.
struct HuntingSpeed {
  HuntingCase on;
  SpeedSearch search;
  std::optional<LeastStableMotion> critical;
};

/// A vehicle with what follows from its data.
struct Described {
  VehicleData data;
  VehicleModel model;
  VehicleSummary summary;
  std::vector<VehicleMode> modes;
  std::vector<StaticDeflection> deflections;
  std::vector<ClosingCheck> checks;
  std::vector<std::string> warnings;
  std::optional<HuntingSpeed> hunting;  // on the table that the command names
};

// A model of the vehicle by itself on the table's profiles, as a scene has it.
VsiModel on_table(const std::string& name, const VehicleData& data, const std::string& table) {
  const auto reject = [&](const std::string& found, const std::string& expected) {
    return input_error("--table", found, expected);
  };
  if (data.motion == MotionPlane::vertical) {
    throw reject(fmt::format("{}, whose data are vertical only", data.name), "a vehicle with lateral springs");
  }
  const double radius = in_file(
      table, [&] { return TableContact(GeometryTable(read_geometry_table(table))).search().pair().nominal_radius(); });
  if (std::abs(radius - data.parts.nominal_radius) > 1e-9) {
    throw reject(fmt::format("{}, of wheels of {} m radius", table, radius),
                 fmt::format("a table for {} m, the wheels of {} (tablegen geometry --wheel-radius)",
                             data.parts.nominal_radius, data.name));
  }
  SceneParameters scene;
  scene.train.vehicle = name;
  scene.contact.table = table;
  return stability_model(scene);
}

HuntingSpeed hunting_speed(const CommandLine& line, const std::string& name, const VehicleData& data) {
  HuntingSpeed found;
  found.on.model = on_table(name, data, line.text("table"));
  set_conicity(line, found.on);
  found.critical = linear_critical_speed(found.on.model, found.search, found.on.conicity).critical;
  return found;
}

Described describe(const std::string& name, int modes) {
  Described v;
  v.data = find_vehicle(name);
  v.model = build_vehicle(v.data, v.data.motion);
  v.summary = summarise(v.model, 0);
  v.modes = natural_modes(v.model, modes);
  v.deflections = static_deflections(v.data);
  v.checks = closing_checks(v.data);
  v.warnings = implausible_values(v.data);
  return v;
}

std::string_view motion_of(const VehicleData& data) {
  return data.motion == MotionPlane::vertical ? "vertical" : "spatial";
}

void print_library() {
  for (const std::string& name : vehicle_names()) {
    const VehicleData data = library_vehicle(name);
    print_formatted("{:24} {}\n", name, data.description);
  }
}

Json library_as_json() {
  Json vehicles = Json::array();
  for (const std::string& name : vehicle_names()) {
    const VehicleData data = library_vehicle(name);
    vehicles.push_back({{"name", name},
                        {"description", data.description},
                        {"motion", motion_of(data)},
                        {"standing", standing_name(data.provenance.standing)},
                        {"source", data.provenance.source}});
  }
  return {{"vehicles", vehicles}};
}

void print_bodies(const Described& v) {
  const bool vertical = v.data.motion == MotionPlane::vertical;
  print_formatted("  {:24} {:>9} {:>10} {:>10} {:>10} {:>8} {:>7} {:>7}\n", "body", "mass kg", "Jx kg m²", "Jy kg m²",
                  "Jz kg m²", "x m", "y m", "height m");
  for (const RigidBody& body : v.data.parts.bodies) {
    const std::string side = vertical ? "" : fmt::format("{:.6g}", body.inertia.x());
    const std::string turn = vertical ? "" : fmt::format("{:.6g}", body.inertia.z());
    print_formatted("  {:24} {:9.6g} {:>10} {:10.6g} {:>10} {:8.3f} {:7.3f} {:>7}\n", body.name, body.mass, side,
                    body.inertia.y(), turn, body.position.x(), body.position.y(),
                    vertical ? "" : fmt::format("{:.3f}", -body.position.z()));
  }
}

/// "primary" of "primary.kz".
std::string section_of(const std::string& key) { return key.substr(0, key.rfind('.')); }

bool equal(const Provenance& a, const Provenance& b) {
  return a.source == b.source && a.date == b.date && a.standing == b.standing && a.note == b.note;
}

/// The file's source, and what sections and values have of their own.
void print_sources(const VehicleData& data) {
  const Provenance& p = data.provenance;
  print_formatted("  source: {}{}{}, {}\n", p.source.empty() ? "not stated" : p.source, p.date.empty() ? "" : ", ",
                  p.date, standing_name(p.standing));
  if (!p.note.empty()) print_formatted("    {}\n", p.note);
  const auto print_own = [&](const std::string& what, const Provenance& own) {
    print_formatted("    {}: {}{}{}\n", what, standing_name(own.standing),
                    own.source == p.source ? "" : fmt::format(", source: {}", own.source),
                    own.note.empty() ? "" : fmt::format(", {}", own.note));
  };
  for (const auto& [section, own] : data.sourced.sections) {
    if (!own.note.empty() || own.source != p.source || own.standing != p.standing) print_own(section, own);
  }
  for (const SourcedValue& value : data.sourced.values) {
    const auto of_section = data.sourced.sections.find(section_of(value.key));
    if (equal(value.provenance, of_section == data.sourced.sections.end() ? p : of_section->second)) continue;
    print_own(fmt::format("{} = {:.6g}{}{}", value.key, value.value, value.unit.empty() ? "" : " ", value.unit),
              value.provenance);
  }
}

void print(const HuntingSpeed& hunting) {
  print_formatted("  {}\n", name_of(hunting.on));
  if (!hunting.critical) {
    print_formatted("    no linear critical speed up to {:.6g} km/h\n", to_kmh * hunting.search.high);
    return;
  }
  const LeastStableMotion& critical = *hunting.critical;
  print_formatted("    linear critical speed {:.2f} km/h: {}\n", to_kmh * critical.speed,
                  critical.frequency > 0.0 ? fmt::format("a motion of {:.3f} Hz", critical.frequency)
                                           : std::string("a motion that grows without oscillation"));
}

void print(const Described& v) {
  const VehicleData& data = v.data;
  print_formatted("{}: {}\n", data.name, data.description);
  if (data.motion == MotionPlane::vertical) {
    print_formatted("  vertical data only: runs with contact.normal = \"rigid\"\n");
  }
  print_formatted("  {:.6g} kg, {:.6g} m over couplers, wheels of {:.6g} m radius{}\n", v.summary.mass, v.model.length,
                  v.model.wheel_radius.front(),
                  data.top_speed > 0.0 ? fmt::format(", top speed {:.6g} km/h", to_kmh * data.top_speed) : "");
  print_formatted("  {:24} {:>8} {:>12} {:>14}\n", "wheelset", "x m", "wheel kN", "axle load t");
  for (std::size_t w = 0; w < v.summary.wheel_load.size(); ++w) {
    const auto body = static_cast<std::size_t>(v.model.wheelsets[w]);
    const double load = v.summary.wheel_load[w];
    print_formatted("  {:24} {:8.3f} {:12.3f} {:14.3f}\n", v.model.bodies[body].name, v.model.bodies[body].position.x(),
                    1e-3 * load, 2e-3 * load / v.model.gravity);
  }
  print_bodies(v);
  print_formatted("  static deflections\n");
  for (const auto& [suspension, deflection] : v.deflections) {
    print_formatted("    {:8.1f} mm  {}\n", 1e3 * deflection, suspension);
  }
  print_formatted("  natural frequencies on standing wheelsets\n");
  for (const VehicleMode& mode : v.modes) {
    print_formatted("    {:8.3f} Hz, damping ratio {:5.3f}  {}{}\n", mode.frequency, mode.damping, mode.motion,
                    mode.damping < 1.0 ? "" : ", without oscillation");
  }
  if (v.hunting) print(*v.hunting);
  for (const std::string& element : data.nonlinear) print_formatted("  not linear: {}\n", element);
  for (const std::string& element : data.stand_ins) print_formatted("  {}\n", element);
  for (const std::string& element : data.linearised) {
    print_formatted("  in natural frequencies and with train.force_elements = \"linear\": {}\n", element);
  }
  for (const ClosingCheck& check : v.checks) {
    print_formatted("  {}: {} {}, stated {:.6g} to {:.6g} {}\n", check.holds() ? "within range" : "out of range",
                    check.stated.quantity,
                    check.found ? fmt::format("{:.6g} {}", *check.found, check.stated.unit) : "not found",
                    check.stated.low, check.stated.high, check.stated.unit);
  }
  print_sources(data);
}

Json as_json(const HuntingSpeed& hunting) {
  const WheelRailPair& pair = hunting.on.model.geometry->pair();
  const auto number = [](const std::optional<double>& x) { return x ? Json(*x) : Json(); };
  return {{"wheel", pair.wheel().knots().name},
          {"rail", pair.rail().knots().name},
          {"friction", hunting.on.model.contact.friction},
          {"amplitude", number(hunting.on.amplitude)},
          {"equivalent_conicity", number(hunting.on.conicity)},
          {"linear_critical_speed", hunting.critical ? Json(hunting.critical->speed) : Json()},
          {"frequency", hunting.critical ? Json(hunting.critical->frequency) : Json()},
          {"searched_to", hunting.search.high}};
}

Json bodies_as_json(const VehicleData& data) {
  Json bodies = Json::array();
  for (const RigidBody& body : data.parts.bodies) {
    Json entry{{"name", body.name}, {"mass", body.mass}};
    if (data.motion == MotionPlane::spatial) entry["Jx"] = body.inertia.x();
    entry["Jy"] = body.inertia.y();
    if (data.motion == MotionPlane::spatial) entry["Jz"] = body.inertia.z();
    entry["x"] = body.position.x();
    if (data.motion == MotionPlane::spatial) {
      entry["y"] = body.position.y();
      entry["height"] = -body.position.z();
    }
    bodies.push_back(std::move(entry));
  }
  return bodies;
}

Json values_as_json(const VehicleData& data) {
  Json values = Json::array();
  for (const SourcedValue& value : data.sourced.values) {
    values.push_back({{"key", value.key},
                      {"unit", value.unit},
                      {"value", value.value},
                      {"standing", standing_name(value.provenance.standing)},
                      {"source", value.provenance.source},
                      {"date", value.provenance.date},
                      {"note", value.provenance.note}});
  }
  return values;
}

Json as_json(const Described& v) {
  const VehicleData& data = v.data;
  Json wheelsets = Json::array(), deflections = Json::array(), modes = Json::array(), checks = Json::array();
  for (std::size_t w = 0; w < v.summary.wheel_load.size(); ++w) {
    const double load = v.summary.wheel_load[w];
    wheelsets.push_back({{"x", v.model.bodies[static_cast<std::size_t>(v.model.wheelsets[w])].position.x()},
                         {"wheel_load", load},
                         {"axle_load", 2.0 * load / v.model.gravity}});
  }
  for (const auto& [suspension, deflection] : v.deflections) {
    deflections.push_back({{"suspension", suspension}, {"deflection", deflection}});
  }
  for (const VehicleMode& mode : v.modes) {
    modes.push_back({{"frequency", mode.frequency}, {"damping_ratio", mode.damping}, {"motion", mode.motion}});
  }
  for (const ClosingCheck& check : v.checks) {
    checks.push_back({{"quantity", check.stated.quantity},
                      {"unit", check.stated.unit},
                      {"low", check.stated.low},
                      {"high", check.stated.high},
                      {"found", check.found ? Json(*check.found) : Json()},
                      {"closes", check.holds()}});
  }
  return {{"name", data.name},
          {"description", data.description},
          {"motion", motion_of(data)},
          {"mass", v.summary.mass},
          {"length", v.model.length},
          {"nominal_radius", v.model.wheel_radius.front()},
          {"top_speed", data.top_speed > 0.0 ? Json(data.top_speed) : Json()},
          {"dofs", v.model.dofs()},
          {"wheelsets", wheelsets},
          {"bodies", bodies_as_json(data)},
          {"static_deflections", deflections},
          {"modes", modes},
          {"hunting", v.hunting ? as_json(*v.hunting) : Json()},
          {"nonlinear", data.nonlinear},
          {"linearised", data.linearised},
          {"left_out", data.left_out},
          {"checks", checks},
          {"warnings", v.warnings},
          {"values", values_as_json(data)}};
}

}  // namespace

int vehicle_command(const Arguments& arguments) {
  po::options_description own("Options");
  own.add_options()("vehicle", text_value()->value_name("NAME|FILE.toml"),
                    "a vehicle of the library or of a file; none: list the library")  //
      ("modes", text_value("8")->value_name("N"), "natural frequencies on standing wheelsets, 0 for none")(
          "table", text_value()->value_name("TABLE.h5"),
          "a contact geometry table: prints the linear critical speed on its profiles, friction 0.3")(
          "amplitude", text_value()->value_name("M"),
          "with --table: lateral amplitude in m whose equivalent conicity counts; none: the contact at rest")(
          "toml", "print the vehicle's file, to copy and change");
  const CommandLine line("vsi vehicle [NAME|FILE.toml] [--modes N] [--table TABLE.h5 [--amplitude M]] [--toml]", own,
                         {"vehicle"}, arguments);
  if (line.help_printed()) return 0;
  constexpr int most_modes = 500;
  const int modes = static_cast<int>(line.whole_number("modes", 0, most_modes));
  if (!line.given("vehicle")) {
    if (line.json()) {
      print_json_line(library_as_json());
    } else {
      print_library();
    }
    return 0;
  }
  const std::string name = line.text("vehicle");
  if (line.given("toml")) {
    if (line.json()) throw input_error("--json", "--toml too", "one of them");
    print_formatted("{}", find_vehicle(name).text);
    return 0;
  }
  Described vehicle = describe(name, modes);
  if (line.given("amplitude") && !line.given("table")) {
    throw input_error("--amplitude", "no --table", "--table with it");
  }
  if (line.given("table")) vehicle.hunting = hunting_speed(line, name, vehicle.data);
  if (line.json()) {
    print_json_line(as_json(vehicle));
  } else {
    print(vehicle);
  }
  for (const std::string& warning : vehicle.warnings) line.warn(warning);
  require_closing(vehicle.data);
  return 0;
}

}  // namespace railtab::vsi
