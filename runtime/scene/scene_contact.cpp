#include "railtab/runtime/scene/scene_contact.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "railtab/runtime/base/in_file.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/contact_files/creep_law_file.hpp"
#include "railtab/runtime/profile/profile_file.hpp"
#include "railtab/runtime/scene/scene_wheels.hpp"
#include "railtab/runtime/scene/shared_setup.hpp"
#include "railtab/tables/files/geometry_table_file.hpp"

namespace railtab {

namespace {

constexpr int paper_points = 1000;              // of the published method's discretised profiles
constexpr double paper_curvature_floor = 1e-6;  // 1/m [MontenegroCalcada2023, section 2.2]

/// What `use` makes of the table. Its messages name the key, whose line the scene's reader adds, and the file.
template <class Use>
auto of_table(const ContactParameters& contact, const std::string& key, const Use& use) {
  return in_file(key, [&] { return in_file(contact.table.string(), use); });
}

WheelRailPair scene_pair(const ContactParameters& contact, const std::string& table_key) {
  if (!contact.table.empty()) {
    return of_table(contact, table_key,
                    [&] { return TableContact(GeometryTable(read_geometry_table(contact.table))).search().pair(); });
  }
  ProfileCurve wheel(load_profile(contact.wheel, ProfileKind::wheel, contact.rail_inclination));
  ProfileCurve rail(load_profile(contact.rail, ProfileKind::rail, contact.rail_inclination));
  return in_file("scene: contact",
                 [&] { return WheelRailPair(std::move(wheel), std::move(rail), contact.dimensions); });
}

/// The loaded contact of a table, where the scene's forces are to come from it; it leaves the table.
/// @param unused_error its certified error where that is too large to use it unasked
std::shared_ptr<const LoadedTable> loaded_contact_of(const ContactParameters& contact, GeometryTableData& table,
                                                     double& unused_error) {
  std::optional<LoadedTableData> loaded = std::move(table.loaded);
  table.loaded.reset();
  if (contact.elastic == ElasticContact::patches) return nullptr;
  if (!loaded) {
    if (contact.elastic == ElasticContact::automatic) return nullptr;
    throw input_error("scene: contact.elastic", fmt::format("\"half-space\" with {}", contact.table.string()),
                      "a table with a loaded part (tablegen loaded adds it), or \"patches\"");
  }
  const double error = loaded->certified_force_error();
  if (contact.elastic == ElasticContact::automatic && error > largest_certified_force_error) {
    unused_error = error;
    return nullptr;
  }
  if (!contact.material.has_contact_modulus(loaded->contact_modulus)) {
    throw input_error("scene: contact.material",
                      fmt::format("steel of the contact modulus E* = {:.6g} Pa", contact.material.contact_modulus()),
                      fmt::format("{:.6g} Pa, that of the loaded part of {}, or contact.elastic = \"patches\"",
                                  loaded->contact_modulus, contact.table.string()));
  }
  return std::make_shared<const LoadedTable>(std::move(*loaded));
}

constexpr double same_length = 1e-9;  // m: of radii and gauges that are meant to be equal

/// Names of the vehicles as the scene has them, front first.
std::vector<std::string> vehicle_names(const TrainParameters& train) {
  std::vector<std::string> names;
  for (const ConsistEntry& entry : train.entries())
    names.insert(names.end(), static_cast<std::size_t>(entry.count), entry.vehicle);
  return names;
}

/// The last entry of [[profiles]] that each wheelset meets, or -1: it has the profiles of [contact].
std::vector<int> entries_of_wheelsets(const SceneParameters& scene, const std::vector<PlaceInTrain>& places) {
  const std::vector<std::string> names = vehicle_names(scene.train);
  std::vector<int> entry(places.size(), -1);
  for (std::size_t e = 0; e < scene.profiles.size(); ++e) {
    const ProfileParameters& profiles = scene.profiles[e];
    bool found = false;
    for (std::size_t w = 0; w < places.size(); ++w) {
      const auto coach = static_cast<std::size_t>(places[w].coach);
      if (profiles.coach != 0 && profiles.coach != places[w].coach) continue;
      if (!profiles.vehicle.empty() && (coach > names.size() || profiles.vehicle != names[coach - 1])) continue;
      entry[w] = static_cast<int>(e);
      found = true;
    }
    if (found) continue;
    throw input_error(fmt::format("scene: [[profiles]] {} of {}", e + 1, scene.profiles.size()),
                      fmt::format("no wheelset of coach {}{}",
                                  profiles.coach == 0 ? "1 or another" : fmt::format("{}", profiles.coach),
                                  profiles.vehicle.empty() ? "" : fmt::format(" that is of {}", profiles.vehicle)),
                      "a coach and a vehicle of the train that have wheelsets of their own");
  }
  return entry;
}

/// What [contact] is for the wheelsets of an entry, whose wheels have that radius [m].
ContactParameters contact_of_entry(const ContactParameters& contact, const ProfileParameters& profiles, double radius) {
  ContactParameters own = contact;
  if (!contact.table.empty()) {
    own.table = profiles.table;
  } else {
    if (!profiles.wheel.empty()) own.wheel = profiles.wheel;
    own.dimensions.nominal_radius = radius;
  }
  return own;
}

void check_radius(const std::string& place, const WheelRailPair& pair, const VsiModel& model, int wheelset, int coach) {
  const double radius = model.wheel_radius(wheelset);
  if (std::abs(pair.nominal_radius() - radius) <= same_length) return;
  const bool alike = std::all_of(model.vehicle.wheel_radius.begin(), model.vehicle.wheel_radius.end(),
                                 [&](double other) { return std::abs(other - radius) <= same_length; });
  const std::string wheels = alike ? fmt::format("{} m, the wheels of {}", radius, model.vehicle.name)
                                   : fmt::format(
                                         "{} m, the wheels of coach {}: [[profiles]] with that coach gives it "
                                         "profiles of its own",
                                         radius, coach);
  const bool named = place.ends_with("nominal_radius");
  throw input_error(place, fmt::format("{} m{}", pair.nominal_radius(), named ? "" : " as the wheels' nominal radius"),
                    wheels);
}

/// The track has one pair of rails for all wheels.
void check_rail(const std::string& place, const WheelRailPair& pair, const WheelRailPair& first) {
  const ProfileKnots &own = pair.rail().knots(), &other = first.rail().knots();
  const PairDimensions &a = pair.dimensions(), &b = first.dimensions();
  const bool same = own.y == other.y && own.z == other.z && std::abs(a.track_gauge - b.track_gauge) <= same_length &&
                    std::abs(a.gauge_height - b.gauge_height) <= same_length;
  if (same) return;
  throw input_error(place, fmt::format("rail {} at a gauge of {} m", own.name, a.track_gauge),
                    fmt::format("{} at {} m, as of the train's first wheelset: all wheels run on the same rails",
                                other.name, b.track_gauge));
}

}  // namespace

ContactGeometry scene_geometry(const ContactParameters& contact, const std::string& table_key) {
  switch (contact.mode) {
    case ContactMode::table: {
      GeometryTableData table = of_table(contact, table_key, [&] { return read_geometry_table(contact.table); });
      double unused_error = 0.0;
      std::shared_ptr<const LoadedTable> loaded = loaded_contact_of(contact, table, unused_error);
      return of_table(contact, table_key, [&] {
        return ContactGeometry(TableContact(GeometryTable(std::move(table))), std::move(loaded), unused_error);
      });
    }
    case ContactMode::online:
      return ContactGeometry(ContactSearch(scene_pair(contact, table_key)));
    case ContactMode::paper:
      return ContactGeometry(PaperSearch(scene_pair(contact, table_key), paper_points, PaperDistance::outline));
  }
  throw InputError("contact.mode: unknown");
}

CreepLaw scene_creep_law(const ContactParameters& contact) {
  const auto law = [&] { return creep_law(contact.creep_law, contact.material.nu, contact.creep_table); };
  return contact.creep_table.empty() ? law() : in_file("scene: contact.creep_table", law);
}

void add_contact(const SceneParameters& scene, VsiModel& model, SharedSetUp* shared) {
  const ContactParameters& contact = scene.contact;
  const std::vector<PlaceInTrain> places = wheelset_places(model);
  const std::vector<int> entries = entries_of_wheelsets(scene, places);
  using Key = std::pair<int, double>;  // entry and radius
  std::map<Key, std::shared_ptr<const ContactGeometry>> made;
  std::vector<std::shared_ptr<const ContactGeometry>> of_wheelset;
  for (int w = 0; w < model.wheelsets(); ++w) {
    const int e = entries[static_cast<std::size_t>(w)];
    const Key key{e, e < 0 ? 0.0 : model.wheel_radius(w)};
    std::shared_ptr<const ContactGeometry>& geometry = made[key];
    const std::string place =
        e >= 0 ? fmt::format("scene: [[profiles]] {} of {}", e + 1, scene.profiles.size())
               : fmt::format("scene: contact.{}", contact.table.empty() ? "dimensions.nominal_radius" : "table");
    if (!geometry) {
      const ContactParameters own =
          e < 0 ? contact : contact_of_entry(contact, scene.profiles[static_cast<std::size_t>(e)], key.second);
      geometry =
          shared ? shared->geometry(own, place) : std::make_shared<const ContactGeometry>(scene_geometry(own, place));
    }
    check_radius(place, geometry->pair(), model, w, places[static_cast<std::size_t>(w)].coach);
    of_wheelset.push_back(geometry);
    check_rail(place, geometry->pair(), of_wheelset.front()->pair());
  }
  model.geometry = of_wheelset.front();
  if (made.size() > 1) model.wheelset_geometry = std::move(of_wheelset);
  model.contact.geometry = model.geometry.get();
  model.contact.normal.material = contact.material;
  model.contact.normal.curvature_floor =
      contact.mode == ContactMode::paper ? paper_curvature_floor : contact.curvature_floor;
  model.contact.creep_law = shared ? shared->creep_law(contact) : scene_creep_law(contact);
  if (auto* polach = std::get_if<PolachCreep>(&model.contact.creep_law)) {
    polach->k_adhesion = contact.k_adhesion;
    polach->k_slip = contact.k_slip;
  }
  model.contact.friction = contact.friction;
  model.contact.friction_law = contact.friction_law;
  model.contact.damping = contact.damping;
}

std::vector<std::shared_ptr<const ContactGeometry>> contact_geometries(const VsiModel& model) {
  if (model.wheelset_geometry.empty()) return {model.geometry};
  std::vector<std::shared_ptr<const ContactGeometry>> distinct;
  for (const auto& geometry : model.wheelset_geometry) {
    if (std::find(distinct.begin(), distinct.end(), geometry) == distinct.end()) distinct.push_back(geometry);
  }
  return distinct;
}

std::string coaches_on(const VsiModel& model, const ContactGeometry& geometry) {
  std::vector<std::pair<int, int>> ranges;
  const std::vector<PlaceInTrain> places = wheelset_places(model);
  for (int w = 0; w < model.wheelsets(); ++w) {
    if (&model.geometry_of(w) != &geometry) continue;
    const int coach = places[static_cast<std::size_t>(w)].coach;
    if (!ranges.empty() && coach <= ranges.back().second + 1) {
      ranges.back().second = coach;
    } else {
      ranges.emplace_back(coach, coach);
    }
  }
  std::vector<std::string> texts;
  for (const auto& [from, to] : ranges) {
    texts.push_back(from == to ? fmt::format("{}", from) : fmt::format("{} to {}", from, to));
  }
  return fmt::format("{}", fmt::join(texts, ", "));
}

}  // namespace railtab
