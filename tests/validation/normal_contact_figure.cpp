// Normal contact: error of the force against time per evaluation, by method. Not a test:
//
//     normal_contact_figure FOLDER
//
// S1002 on 60E1 1:40 at random poses and loads. Writes FOLDER/normal_contact.csv and normal_contact.svg, shown in
// docs/validation/loaded_contact.md. Processor times, medians over rounds in which the methods are measured in turn.
// The table takes about three minutes on one core.

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <exception>
#include <functional>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "error_time_panels.hpp"
#include "kik_piotrowski.hpp"
#include "railtab/runtime/base/text_file.hpp"
#include "railtab/runtime/contact/contact_geometry.hpp"
#include "railtab/runtime/contact/patch_loads.hpp"
#include "railtab/runtime/profile/standard_profiles.hpp"
#include "railtab/tablegen/geometry_sweep.hpp"
#include "railtab/tablegen/loaded_contact.hpp"
#include "railtab/tablegen/loaded_sweep.hpp"

namespace {

using namespace railtab;

constexpr double shift = 7e-3, roll = 3e-3, yaw = 1e-2;    // of random poses [m, rad]
constexpr double least_load = 10e3, largest_load = 150e3;  // [N]
constexpr std::size_t cases_of_region = 35;
constexpr int reference_elements = 80;    // across the narrowest overlap
constexpr double published_floor = 1e-6;  // of the curvature [1/m]
constexpr std::array regions{"one patch", "several patches", "root and flange"};
constexpr std::array titles{"Tread, one patch", "Tread, several patches", "Root and flange"};

ContactSearch s1002_on_60e1() {
  return ContactSearch(WheelRailPair(ProfileCurve(standard_profile(ProfileKind::wheel, "S1002", 1.0 / 40)),
                                     ProfileCurve(standard_profile(ProfileKind::rail, "60E1", 1.0 / 40)),
                                     PairDimensions{}));
}

/// Poses up to the border of the range are looked up inside the margin in which the table blends.
Interval wider(double half) { return {-1.12 * half, 1.12 * half}; }

ContactGeometry geometry_with_table(const ContactSearch& search) {
  GeometrySweepOptions geometry;
  geometry.lateral = {-0.012, 0.012};
  geometry.roll = wider(roll);
  geometry.yaw = {0.0, yaw};
  LoadedSweepOptions loaded;
  loaded.lateral = wider(shift);
  loaded.roll = wider(roll);
  loaded.yaw = 1.12 * yaw;
  loaded.levels = 21;
  loaded.roll_spacing = 0.1;
  loaded.yaw_nodes = 3;
  loaded.largest_load = 4.0 * largest_load;  // at y = 0: on the flange the same load has more energy
  loaded.force_error = 5e-3;
  loaded.light_error = 2e-2;
  loaded.contact.elements.across_narrowest = 14;
  return ContactGeometry(TableContact(GeometryTable(sweep_geometry(search, geometry))),
                         std::make_shared<const LoadedTable>(sweep_loaded(search, loaded)));
}

LoadedContactOptions elements(int across) {
  LoadedContactOptions options;
  options.elements.across_narrowest = across;
  options.elements.most = 4000000;
  return options;
}

struct Case {
  WheelsetPose pose;
  double reference, halved;  // resultant of the pressure [N]
};

double half_space_force(const ContactSearch& search, const WheelsetPose& pose, int across) {
  const LoadedContact contact = loaded_contact(search, pose, elements(across));
  if (!contact.converged) throw std::runtime_error("a pressure that does not converge");
  return contact.on_rail.force.norm();
}

/// On the tread by the patches of the search; root and flange wherever a band is that steep. Every pose has its region.
std::size_t region_of(const ContactSearch& search, const LoadedContact& contact) {
  for (const ContactBand& band : contact.bands) {
    if (std::abs(band.angle) > 0.13) return 2;
  }
  return search.patches(contact.pose).count > 1 ? 1 : 0;
}

/// Random poses at the height at which the half-space solution carries a random load, until every region has its
/// number; those of a region that is full are left out.
std::array<std::vector<Case>, regions.size()> random_cases(const ContactSearch& search, const LoadedTable& table) {
  std::mt19937_64 random(20261126);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0), load(least_load, largest_load);
  std::array<std::vector<Case>, regions.size()> cases;
  const auto full = [](const auto& of) { return of.size() >= cases_of_region; };
  while (!std::all_of(cases.begin(), cases.end(), full)) {
    WheelsetPose pose{0.0, 0.0, roll * uniform(random), yaw * uniform(random)};
    pose.y = 0.95 * shift * uniform(random) + 0.6 * pose.roll;
    const ContactAtLoad found = contact_at_load(search, pose, load(random), elements(10));
    if (!found.contact.converged) throw std::runtime_error("no contact at a load");
    auto& of = cases[region_of(search, found.contact)];
    if (full(of)) continue;
    pose.z = found.contact.pose.z;
    if (table.lookup(pose.y, pose.z, pose.roll, pose.yaw).table_share < 1.0) {
      throw std::runtime_error(fmt::format("a pose beyond the table: y = {} m, roll = {} rad, yaw = {} rad, load {} N",
                                           pose.y, pose.roll, pose.yaw, found.vertical_force));
    }
    of.push_back({pose, half_space_force(search, pose, reference_elements),
                  half_space_force(search, pose, 2 * reference_elements)});
  }
  return cases;
}

/// A way to the size of the normal forces' resultant [N].
struct Method {
  std::string name, setting;
  std::function<double(const WheelsetPose&)> force;
  int repeats;  ///< of all poses, in one timed pass
};

Eigen::Vector2d along_normal(const ContactPatch& patch, double force) {
  return force * Eigen::Vector2d(-std::sin(patch.angle), std::cos(patch.angle));
}

std::vector<Method> methods(const ContactSearch& search, const ContactGeometry& geometry) {
  const NormalContactModel model;
  std::vector<Method> all;
  constexpr int quick = 100;
  all.push_back({"curvature at the point", "",
                 [&geometry, model](const WheelsetPose& pose) {
                   Eigen::Vector2d sum = Eigen::Vector2d::Zero();
                   for (const ContactPatch& p : geometry.patches(pose)) {
                     const double B = std::max(0.5 * (p.curv_wheel + p.curv_rail), published_floor);
                     const HertzContact hertz = hertz_contact(0.5 * p.curv_rolling, B, model.material);
                     sum += along_normal(p, hertz.stiffness * std::pow(p.penetration, 1.5));
                   }
                   return sum.norm();
                 },
                 quick});
  all.push_back({"overlap ellipse", "",
                 [&geometry, model](const WheelsetPose& pose) {
                   Eigen::Vector2d sum = Eigen::Vector2d::Zero();
                   for (const PatchLoad& l : patch_loads(model, geometry, pose, geometry.patches(pose))) {
                     sum += along_normal(l.contact, l.elastic_force);
                   }
                   return sum.norm();
                 },
                 quick});
  all.push_back({"Kik–Piotrowski", "",
                 [&geometry, model](const WheelsetPose& pose) {
                   return kik_piotrowski::force(geometry.pair(), pose, geometry.patches(pose), model.material).norm();
                 },
                 quick});
  all.push_back({"loaded table", "",
                 [&geometry](const WheelsetPose& p) {
                   return geometry.loaded()->lookup(p.y, p.z, p.roll, p.yaw).force.head<2>().norm();
                 },
                 quick});
  for (const int across : {5, 10, 20, 40}) {
    all.push_back({"half-space", fmt::format("{} elements", across),
                   [&search, across](const WheelsetPose& p) { return half_space_force(search, p, across); }, 1});
  }
  return all;
}

/// Processor time of each pass [s].
std::vector<double> median_times(const std::vector<std::function<double()>>& passes) {
  constexpr std::size_t rounds = 7;
  std::vector<std::vector<double>> seconds(passes.size());
  for (std::size_t round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i < passes.size(); ++i) {
      const std::clock_t begin = std::clock();
      volatile double used = passes[i]();
      static_cast<void>(used);
      seconds[i].push_back(static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
    }
  }
  std::vector<double> medians;
  for (std::vector<double>& s : seconds) {
    std::nth_element(s.begin(), s.begin() + rounds / 2, s.end());
    medians.push_back(s[rounds / 2]);
  }
  return medians;
}

struct Error {
  double mean, p95, largest;
};

Error error_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  double sum = 0.0;
  for (const double v : values) sum += v;
  return {sum / static_cast<double>(values.size()), values[std::min(values.size() - 1, values.size() * 95 / 100)],
          values.back()};
}

void write(const std::string& folder) {
  const auto begin = std::chrono::steady_clock::now();
  const auto told = [&](const char* what) {
    fmt::print(stderr, "{:6.0f} s  {}\n",
               std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(), what);
  };
  const ContactSearch search = s1002_on_60e1();
  const ContactGeometry geometry = geometry_with_table(search);
  told("tables");
  const auto cases = random_cases(search, *geometry.loaded());
  told("references");
  const std::vector<Method> all = methods(search, geometry);
  std::string csv =
      "# Normal force of S1002 on 60E1 1:40 at given height, by method: error against the half-space solution with " +
      fmt::format("{}\n# elements across the narrowest overlap, relative; processor time per evaluation, median. ",
                  reference_elements) +
      "Made by\n# tests/validation/normal_contact_figure, " +
      fmt::format("{:%Y-%m-%d}", fmt::gmtime(std::time(nullptr))) +
      "\nregion,method,setting,poses,mean,p95,largest,time_ns\n";
  std::vector<error_time_panels::Panel> panels;
  for (std::size_t r = 0; r < regions.size(); ++r) {
    std::vector<std::function<double()>> passes;
    for (const Method& method : all) {
      passes.push_back([&of = cases[r], &method] {
        double sum = 0.0;
        for (int i = 0; i < method.repeats; ++i) {
          for (const Case& c : of) sum += method.force(c.pose);
        }
        return sum;
      });
    }
    const std::vector<double> seconds = median_times(passes);
    const auto error = [&](const auto& difference) {
      std::vector<double> values;
      for (const Case& c : cases[r]) values.push_back(std::abs(difference(c)));
      return error_of(std::move(values));
    };
    const auto row = [&](const std::string& method, const std::string& setting, const Error& e, double ns) {
      csv += fmt::format("\"{}\",\"{}\",\"{}\",{},{:.4g},{:.4g},{:.4g},{:.4g}\n", regions[r], method, setting,
                         cases[r].size(), e.mean, e.p95, e.largest, ns);
    };
    const Error halved = error([](const Case& c) { return c.halved / c.reference - 1.0; });
    error_time_panels::Panel panel{titles[r], halved.p95, {}};
    for (std::size_t m = 0; m < all.size(); ++m) {
      const Error e = error([&](const Case& c) { return all[m].force(c.pose) / c.reference - 1.0; });
      const double time = seconds[m] / static_cast<double>(cases[r].size()) / all[m].repeats;
      row(all[m].name, all[m].setting, e, 1e9 * time);
      panel.points.push_back({all[m].name, all[m].setting.substr(0, all[m].setting.find(' ')), time, e.p95});
    }
    row("reference, halved elements", "", halved, 0.0);
    panels.push_back(std::move(panel));
    told(regions[r]);
  }
  write_text_file(folder + "/normal_contact.csv", csv, "# Normal force of S1002");
  std::vector<std::string> names;
  for (const Method& method : all) {
    if (std::find(names.begin(), names.end(), method.name) == names.end()) names.push_back(method.name);
  }
  write_text_file(folder + "/normal_contact.svg",
                  error_time_panels::figure("Normal force at given height: S1002 on 60E1 1:40",
                                            "error of the force, 95th percentile", names, panels),
                  "<svg");
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) {
    std::fprintf(stderr, "usage: normal_contact_figure FOLDER\n");
    return 2;
  }
  try {
    write(arguments[1]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "normal_contact_figure: %s\n", error.what());
    return 1;
  }
  return 0;
}
