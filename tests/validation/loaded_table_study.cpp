// Forces of a loaded table against CONTACT's loaded cases and against half-space solutions. Not a test:
//
//     loaded_table_study TABLE.h5 CLIMBING.h5 REFERENCE FOLDER
//
// Both are geometry tables with a loaded part of the profiles that CONTACT used (profiles/MBench_*), of steel with G =
// 82 GPa, the first with the wheels of sets A and B, the other with those of set C, whose wheelset climbs a flange:
//
//     tablegen loaded TABLE.h5 --modulus 209.92e9 --lateral=-0.0105:0.0105 --yaw 0.0105 --largest-load 420e3
//         --levels 37
//     tablegen loaded CLIMBING.h5 --modulus 209.92e9 --lateral=-0.0126:0.0126 --climb 0.75 --yaw 0.027 --yaw-nodes 6
//
// REFERENCE holds contact_loaded/. Writes FOLDER/loaded_table.csv: differences by class, of ellipses by
// their width, of two merging parts by the depth of the saddle between them, steps of the force along random lines,
// work on closed paths.

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <exception>
#include <filesystem>
#include <memory>
#include <numbers>
#include <random>
#include <span>
#include <utility>
#include <vector>

#include "contact_reference.hpp"
#include "railtab/runtime/base/text_file.hpp"
#include "railtab/runtime/contact/contact_response.hpp"
#include "railtab/runtime/contact/loaded_wheel.hpp"
#include "railtab/runtime/contact_files/creep_law_file.hpp"
#include "railtab/tablegen/loaded_rolling.hpp"
#include "railtab/tables/files/geometry_table_file.hpp"

namespace {

using namespace railtab;
using namespace railtab::contact_reference;
namespace fs = std::filesystem;

/// Creepage of the wheel in contact, mean over the pressure.
PatchCreepage mean_creepage(const LoadedContact& c, const WheelRailPair& pair, const RelativeMotion& motion,
                            double speed) {
  const ContactElements& e = c.elements;
  const WheelsetCentre centre = wheelset_centre(pair, c.pose);
  PatchCreepage mean;
  for (int k = 0; k < e.count(); ++k) {
    const SurfaceLine& line = e.line[static_cast<std::size_t>(k / e.nx)];
    const double share = c.pressure[k] * e.area() / c.normal_force;
    const ContactAxes axes(line.angle);
    const Eigen::Vector3d arm =
        Eigen::Vector3d(line.x, line.y - centre.y, line.z - centre.z) + line.overlap * axes.normal;
    const PatchCreepage here = patch_creepage(motion, arm, axes, speed);
    mean.x += share * here.x;
    mean.y += share * here.y;
    mean.spin += share * here.spin;
  }
  return mean;
}

class Study {
 public:
  /// @param differences that it adds to
  Study(const fs::path& table, const fs::path& reference, Differences& differences)
      : reference_(reference / "contact_loaded"), differences_(differences) {
    GeometryTableData data = read_geometry_table(table);
    if (!data.loaded) throw std::runtime_error(table.string() + " has no loaded part");
    loaded_ = std::make_shared<const LoadedTable>(std::move(*data.loaded));
    data.loaded.reset();
    const TableContact contact(GeometryTable(std::move(data)));
    search_ = std::make_unique<ContactSearch>(contact.search());
    geometry_ = std::make_unique<ContactGeometry>(contact, loaded_);
    model_.geometry = geometry_.get();
    model_.normal.material = {2.0 * shear_modulus * (1.0 + poisson), poisson};
    model_.creep_law = creep_law("table", poisson);
    model_.speed = 30.0;
    frictionless_ = model_;
    frictionless_.friction = 0.0;
    model_.friction = friction;
  }

  void rolling() {
    std::map<std::string, Row> patches, half_size;
    for (const Row& row : read_rows(reference_ / "A_patches.csv")) patches.emplace(row.text("case"), row);
    for (const Row& row : read_rows(reference_ / "A_half_size.csv")) half_size.emplace(row.text("case"), row);
    for (const Row& row : read_rows(reference_ / "A_cases.csv")) {
      const Row& patch = patches.at(row.text("case"));
      WheelsetMotion motion = placed(row["y"], row["roll"], row["yaw"]);
      motion.velocity[4] = row["pitch_rate"] + model_.speed / pair().nominal_radius();
      const double touch = touch_height(motion);
      const WheelForce force = at_load(model_, motion, touch, row["fz_prescribed"]);
      const std::string kind = kind_of(patch["delta"], patch["bands_1pct"]);
      const double bound = friction * patch["fn"];
      const double approach = (motion.displacement[2] - touch) / row["approach"] - 1.0;
      const Eigen::Vector2d table(force.rail_x, force.rail[0]), contact(row["fx"], row["fy"]);
      differences_.add("A", kind, "approach", approach);
      differences_.add("A", kind, "total force D2", (table - contact).norm() / bound);
      if (patch["bands_1pct"] < 1.5 && answered(motion))
        differences_.add("A", kind, "spin", spin(motion) + patch["cphi"]);
      const HalfSpaceForce solution = half_space(motion, row["fz_prescribed"]);
      differences_.add("A", kind, "total force of the half-space", (table - solution.extrapolated).norm() / bound);
      differences_.add("A", kind, "half-space from D2", (solution.extrapolated - contact).norm() / bound);
      const Eigen::Vector2d of_planar_slip = table + (solution.planar - solution.extrapolated);
      differences_.add("A", kind, "planar slip D2", (of_planar_slip - contact).norm() / bound);
      if ((table - contact).norm() > 0.03 * bound) {
        differences_.add("A", kind, "above 0.03", (table - contact).norm() / bound);
        differences_.add("A", kind, "above 0.03: planar slip D2", (of_planar_slip - contact).norm() / bound);
      }
      differences_.add("A", kind, "elements of the half-space",
                       (solution.coarse - solution.extrapolated).norm() / bound);
      if (const auto fine = half_size.find(row.text("case")); fine != half_size.end()) {
        const Eigen::Vector2d extrapolated = 2.0 * Eigen::Vector2d(fine->second["fx"], fine->second["fy"]) - contact;
        differences_.add("A", kind, "total force D2 extrapolated", (table - extrapolated).norm() / bound);
        differences_.add("A", kind, "elements of D2", (contact - extrapolated).norm() / bound);
      }
      differences_.add("A", kind, "largest pressure", force.pressure / patch["pmax"] - 1.0);
    }
  }

  void frictionless() {
    for (const Row& row : read_rows(reference_ / "B_curves.csv")) {
      WheelsetMotion motion = placed(row["y"], row["roll"], row["yaw"]);
      motion.displacement[2] = row["z_touch"] + row["approach"];
      const LoadedLookup found = lookup(motion);
      if (found.table_share < 1.0) continue;
      const std::string kind = kind_of(std::atan2(row["fy"], row["fz"]), row["bands_1pct"]);
      differences_.add("B", kind, "force",
                       std::hypot(found.force[0] - row["fy"], found.force[1] - row["fz"]) / row["fn_sum"]);
    }
  }

  void wheelset() {
    for (const Row& row : read_rows(reference_ / "C_wheels.csv")) {
      const double side = row.text("side") == "R" ? 1.0 : -1.0;
      WheelsetMotion motion = placed(side * row["y"], side * row["roll"], side * row["yaw"]);
      const double touch = touch_height(motion);
      const WheelForce force = at_load(frictionless_, motion, touch, row["load"]);
      const std::string kind = kind_of(std::atan2(row["fy"], row["load"]), row["bands_1pct"]);
      const double approach = (motion.displacement[2] - row["z_ws"]) / (row["z_ws"] - touch),
                   lateral = (side * force.rail[0] - row["fy"]) / row["load"];
      if (answered(motion)) differences_.add("C", kind, "answered by the table alone", 0.0);
      differences_.add("C", kind, "approach", approach);
      differences_.add("C", kind, "lateral force", lateral);
      differences_.add("C", kind, "largest pressure", force.pressure / row["pmax"] - 1.0);
    }
  }

  /// Two parts that merge, at random poses and creepages: as two ellipses, as one, and as runs take them.
  void merging(int count) {
    for (int n = 0; n < count; ++n) {
      WheelsetMotion motion = placed(uniform(-6e-3, 6e-3), uniform(-3e-3, 3e-3), uniform(-6e-3, 6e-3));
      const double load = std::exp(uniform(std::log(20e3), std::log(150e3)));
      motion.velocity[4] = -uniform(-3e-3, 3e-3) * model_.speed / pair().nominal_radius();
      at_load(model_, motion, touch_height(motion), load);
      LoadedLookup found = lookup(motion);
      if (found.table_share < 1.0 || found.parts != 2) continue;
      const double saddle = found.part[0].saddle / std::min(found.part[0].peak, found.part[1].peak);
      if (!(saddle > 0.0)) continue;
      const Eigen::Vector2d solution = half_space(motion, load).extrapolated;
      const auto error = [&]() {
        const LoadedWheelForce force = loaded_wheel_force(model_, WheelSide::right, motion, {}, found);
        return (Eigen::Vector2d(force.rail_x, force.rail[0]) - solution).norm() / (friction * load);
      };
      const std::string kind = saddle < 0.25   ? "0 to 0.25"
                               : saddle < 0.35 ? "0.25 to 0.35"
                               : saddle < 0.5  ? "0.35 to 0.5"
                               : saddle < 0.75 ? "0.5 to 0.75"
                                               : "0.75 to 1";
      differences_.add("merging", kind, "as in runs", error());
      found.part[0].saddle = 0.0;
      differences_.add("merging", kind, "two ellipses", error());
      found.part[0].saddle = found.part[0].peak + found.part[1].peak;
      differences_.add("merging", kind, "one ellipse", error());
    }
  }

  /// The creep force of an ellipse in place of a contact of one band on the tread, at random poses and creepages: by
  /// the second moments of its pressure, and by its mean pressure too (EllipseOfPressure). Of wide contacts also that
  /// of the ellipse that is the closest to ten solutions of the contact, which bounds what any ellipse can do.
  void ellipses(int count) {
    constexpr double wide = 6.5e-3, widest = 10e-3;
    for (int n = 0; n < count; ++n) {
      const WheelsetPose pose{uniform(-6e-3, 6e-3), 0.0, uniform(-3e-3, 3e-3), uniform(-6e-3, 6e-3)};
      const double load = std::exp(uniform(std::log(20e3), std::log(150e3)));
      const double along = uniform(-3e-3, 3e-3), across = uniform(-4e-3, 4e-3);
      LoadedContactOptions options = half_space_options();
      const LoadedContact coarse = contact_at_load(*search_, pose, load, options).contact;
      if (coarse.bands.size() != 1 || std::abs(coarse.bands[0].angle) > 0.13) continue;
      options.elements.across_narrowest *= 2;
      const OneBand contact{coarse, loaded_contact(*search_, coarse.pose, options)};
      const ContactBand& band = coarse.bands[0];
      const char* const kind = band.b < wide ? "b up to 6.5 mm" : band.b < widest ? "6.5 to 10 mm" : "10 mm on";
      const Rolling solution = rolling(contact, options, along, across);
      const EllipseOfPressure of_moments(band.moments);
      differences_.add("ellipse", kind, "second moments", error(contact, of_moments.a, of_moments.b, solution));
      differences_.add("ellipse", kind, "as in runs", error(contact, band.a, band.b, solution));
      if (band.b < wide) continue;
      std::vector<Rolling> solutions;
      std::mt19937_64 random(static_cast<std::uint64_t>(n));
      std::uniform_real_distribution<double> along_also(-3e-3, 3e-3), across_also(-4e-3, 4e-3);
      for (int k = 0; k < 10; ++k)
        solutions.push_back(rolling(contact, options, along_also(random), across_also(random)));
      const auto [a, b] = closest_ellipse(contact, solutions);
      for (const Rolling& of : solutions) {
        differences_.add("ellipse", kind, "ten creepages as in runs", error(contact, band.a, band.b, of));
        differences_.add("ellipse", kind, "ten creepages of the closest", error(contact, a, b, of));
      }
    }
  }

  /// The largest step of the force along random lines, weighted with the table's share in it, by bisection of their
  /// largest change.
  void lines(int count) {
    for (int n = 0; n < count; ++n) {
      const Eigen::Vector4d from = random_pose(), to = random_pose();
      const auto force = [&](double t) {
        const Eigen::Vector4d p = from + t * (to - from);
        const LoadedLookup found = geometry_->loaded()->lookup(p[0], p[1], p[2], p[3]);
        return Eigen::Vector2d(found.table_share * found.force.head<2>());
      };
      constexpr int points = 2000;
      double low = 0.0, high = 0.0, largest = 0.0;
      for (int i = 0; i < points; ++i) {
        const double change = (force((i + 1.0) / points) - force(static_cast<double>(i) / points)).norm();
        if (change <= largest) continue;
        largest = change;
        low = static_cast<double>(i) / points;
        high = (i + 1.0) / points;
      }
      while (high - low > 1e-13) {
        const double middle = 0.5 * (low + high);
        ((force(middle) - force(low)).norm() > (force(high) - force(middle)).norm() ? high : low) = middle;
      }
      differences_.add("lines", "all", "step of the force in N", (force(high) - force(low)).norm());
    }
  }

  /// Work of the elastic forces around ellipses in shift, roll, yaw and height above first touch, over what goes in and
  /// out. Draws until `count` of them lie within the table.
  void closed_paths(int count) {
    while (count > 0) {
      const Eigen::Vector4d centre = random_pose();
      const double height = uniform(1e-5, 1e-4);
      const Eigen::Vector4d across(uniform(0, 5e-4), uniform(0, 4e-5), uniform(0, 4e-4), uniform(0, 1e-3));
      const Eigen::Vector4d along(uniform(0, 5e-4), uniform(0, 4e-5), uniform(0, 4e-4), uniform(0, 1e-3));
      const auto pose = [&](double angle) -> Eigen::Vector4d {
        Eigen::Vector4d at = centre;
        at[1] = height;
        at += std::cos(angle) * across + std::sin(angle) * along;
        at[1] += search_->touch_height(at[0], at[2], at[3]);
        return at;
      };
      constexpr int steps = 4000;
      double work = 0.0, amount = 0.0;
      Eigen::Vector4d before = pose(0.0), force_before = loaded_force(before);
      bool inside = true;
      for (int i = 1; i <= steps && inside; ++i) {
        const Eigen::Vector4d at = pose(2.0 * std::numbers::pi * i / steps);
        const LoadedLookup found = loaded_->lookup(at[0], at[1], at[2], at[3]);
        inside = found.table_share == 1.0;
        const double step = 0.5 * (found.force + force_before).dot(at - before);
        work += step;
        amount += std::abs(step);
        before = at;
        force_before = found.force;
      }
      if (!inside) continue;
      differences_.add("closed paths", "all", "work", work / amount);
      --count;
    }
  }

  [[nodiscard]] std::string summary() const {
    return "# Forces of loaded tables: absolute differences from CONTACT's loaded cases, relative to its value\n"
           "# (forces of set A, of ellipses and of merging parts in mu F_n, of set B in the normal force, lateral\n"
           "# force of set C in the load). Sets A and C: all wheels, by the force that runs take; answered: by a\n"
           "# table alone. Steps along lines, work on closed paths over its amount. Made by\n"
           "# tests/validation/loaded_table_study, " +
           fmt::format("{:%Y-%m-%d}", fmt::gmtime(std::time(nullptr))) +
           "\nset,kind,quantity,cases,mean,p95,largest\n" + differences_.csv();
  }

 private:
  [[nodiscard]] const WheelRailPair& pair() const { return geometry_->pair(); }
  [[nodiscard]] static WheelsetMotion placed(double y, double roll, double yaw) {
    WheelsetMotion motion;
    motion.displacement << 0.0, y, 0.0, roll, 0.0, yaw;
    return motion;
  }
  [[nodiscard]] double touch_height(const WheelsetMotion& m) const {
    return search_->touch_height(m.displacement[1], m.displacement[3], m.displacement[5]);
  }
  [[nodiscard]] LoadedLookup lookup(const WheelsetMotion& m) const {
    return loaded_->lookup(m.displacement[1], m.displacement[2], m.displacement[3], m.displacement[5]);
  }
  [[nodiscard]] bool answered(const WheelsetMotion& m) const { return lookup(m).table_share == 1.0; }
  [[nodiscard]] Eigen::Vector4d loaded_force(const Eigen::Vector4d& p) const {
    return loaded_->lookup(p[0], p[1], p[2], p[3]).force;
  }
  [[nodiscard]] LoadedContactOptions half_space_options() const {
    LoadedContactOptions options;
    options.wheel = options.rail = model_.normal.material;
    options.elements.most = 1600000;
    return options;
  }
  [[nodiscard]] LoadedRollingOptions rolling_options() const {
    LoadedRollingOptions options;
    options.friction = friction;
    options.speed = model_.speed;
    return options;
  }
  /// Spin creepage of the wheel, mean over the parts' forces, over CONTACT's reference speed (V + |ω| r)/2 [1/m].
  [[nodiscard]] double spin(const WheelsetMotion& m) const {
    const WheelsetPose pose{m.displacement[1], m.displacement[2], m.displacement[3], m.displacement[5]};
    const double pitch_rate = m.velocity[4] - model_.speed / pair().nominal_radius();
    const RelativeMotion motion = running_motion(pose, model_.speed, pitch_rate);
    const LoadedLookup found = lookup(m);
    double sum = 0.0, force = 0.0, radius = 0.0;
    for (std::size_t p = 0; p < found.parts; ++p) {
      const LoadedPart& part = found.part[p];
      const ContactAxes axes(part.angle);
      const double of_part = part.share / std::cos(part.angle);
      sum += of_part * patch_creepage(motion, Eigen::Vector3d::Zero(), axes, model_.speed).spin;
      radius += of_part * part.arm_z;
      force += of_part;
    }
    return sum / force / (0.5 * (1.0 + std::abs(pitch_rate) * radius / force / model_.speed));
  }
  /// Force on the rail along x and y of the half-space solution with friction [N].
  struct HalfSpaceForce {
    Eigen::Vector2d coarse;        ///< elements of the default size
    Eigen::Vector2d extrapolated;  ///< without their error, of first order: 2 fine − coarse, with halved elements
    Eigen::Vector2d planar;        ///< the same with planar slip (LoadedRollingOptions::SlipField)
  };
  /// At the motion's shift, roll, yaw and pitch rate, under the load.
  [[nodiscard]] HalfSpaceForce half_space(const WheelsetMotion& at, double load) const {
    LoadedContactOptions options = half_space_options();
    const WheelsetPose pose{at.displacement[1], 0.0, at.displacement[3], at.displacement[5]};
    const RelativeMotion motion =
        running_motion(pose, model_.speed, at.velocity[4] - model_.speed / pair().nominal_radius());
    LoadedRollingOptions curved = rolling_options(), planar = curved;
    planar.slip = LoadedRollingOptions::SlipField::planar;
    const auto friction_of = [&](const LoadedContact& c, const LoadedRollingOptions& rolling) -> Eigen::Vector3d {
      return loaded_rolling(pair(), c, options, motion, rolling).on_rail.force;
    };
    const ContactAtLoad found = contact_at_load(*search_, pose, load, options,
                                                [&](const LoadedContact& c) { return friction_of(c, curved).z(); });
    if (!found.converged) throw std::runtime_error("no half-space solution at the load");
    const auto force = [&](const LoadedContact& c, const LoadedRollingOptions& rolling) -> Eigen::Vector2d {
      return (c.on_rail.force + friction_of(c, rolling)).head<2>();
    };
    const Eigen::Vector2d coarse = force(found.contact, curved), coarse_planar = force(found.contact, planar);
    options.elements.across_narrowest *= 2;
    const LoadedContact fine = loaded_contact(*search_, found.contact.pose, options);
    return {coarse, 2.0 * force(fine, curved) - coarse, 2.0 * force(fine, planar) - coarse_planar};
  }
  /// A contact of one band, with elements of the default size and halved ones.
  struct OneBand {
    LoadedContact coarse, fine;
  };
  /// Creep force over μF_n of the solution on its true area, without the error of its elements.
  struct Rolling {
    PatchCreepage creepage;  ///< mean over the pressure
    Eigen::Vector2d force;
  };
  /// @param along, across of the wheel's speed @param options of the halved elements
  [[nodiscard]] Rolling rolling(const OneBand& contact, const LoadedContactOptions& options, double along,
                                double across) const {
    RelativeMotion motion =
        running_motion(contact.coarse.pose, model_.speed, -model_.speed / pair().nominal_radius() * (1.0 + along));
    motion.velocity.y() = across * model_.speed;
    const auto force = [&](const LoadedContact& c) -> Eigen::Vector2d {
      const LoadedRolling r = loaded_rolling(pair(), c, options, motion, rolling_options());
      return Eigen::Vector2d(r.bands.at(0).x, r.bands.at(0).y) / (friction * c.normal_force);
    };
    return {mean_creepage(contact.coarse, pair(), motion, model_.speed),
            2.0 * force(contact.fine) - force(contact.coarse)};
  }
  /// Of the creep force of an ellipse, over μF_n.
  [[nodiscard]] double error(const OneBand& contact, double a, double b, const Rolling& solution) const {
    const double bound = friction * contact.coarse.normal_force;
    const CreepForce f =
        creep_force(model_.creep_law, a / b, normalised_creepage(solution.creepage, a, b, shear_modulus, bound));
    return (Eigen::Vector2d(f.x, f.y) - solution.force).norm();
  }
  /// Semi-axes whose forces have the least sum of squared errors, by a search over ever smaller changes of both.
  [[nodiscard]] std::pair<double, double> closest_ellipse(const OneBand& contact,
                                                          std::span<const Rolling> solutions) const {
    const auto sum = [&](double a, double b) {
      double squares = 0.0;
      for (const Rolling& of : solutions) squares += std::pow(error(contact, a, b, of), 2);
      return squares;
    };
    double a = contact.coarse.bands[0].a, b = contact.coarse.bands[0].b, least = sum(a, b);
    for (double change = 0.16; change > 2e-3; change *= 0.5) {
      for (bool nearer = true; nearer;) {
        nearer = false;
        const double of_a = a, of_b = b;
        for (const double to_a : {of_a / (1.0 + change), of_a, of_a * (1.0 + change)}) {
          for (const double to_b : {of_b / (1.0 + change), of_b, of_b * (1.0 + change)}) {
            const double squares = sum(to_a, to_b);
            if (squares >= least) continue;
            nearer = true;
            least = squares;
            a = to_a;
            b = to_b;
          }
        }
      }
    }
    return {a, b};
  }
  /// Lowers the wheel until the rail carries the load.
  WheelForce at_load(const WheelContactModel& model, WheelsetMotion& motion, double touch, double load) const {
    WheelForce force;
    const auto excess = [&](double dz) {
      motion.displacement[2] = touch + dz;
      const WheelsetPose pose = relative_pose(pair(), WheelSide::right, motion, {});
      force = wheel_force(model, WheelSide::right, motion, {}, wheel_contact(*geometry_, pose));
      return force.rail[1] - load;
    };
    boost::uintmax_t passes = 200;
    const auto close = [](double a, double b) { return std::abs(a - b) < 1e-14; };
    double deep = 1e-5;
    while (deep < 3e-3 && excess(deep) < 0.0) deep *= 2.0;
    const auto [low, high] = boost::math::tools::toms748_solve(excess, 1e-9, deep, close, passes);
    excess(0.5 * (low + high));
    return force;
  }
  double uniform(double low, double high) { return low + (high - low) * uniform_(random_); }
  Eigen::Vector4d random_pose() {
    const LoadedTableData& data = loaded_->data();
    const double reduced = 0.8 * uniform(data.roll.front(), data.roll.back()),
                 yaw = 0.8 * std::sqrt(data.yaw_squared.back());
    const double y = 0.9 * uniform(data.lateral.front(), data.lateral.back()) +
                     0.6 / (1.0 + 0.6 * data.climb) * reduced,
                 roll = data.roll_at(reduced, y), turned = uniform(-yaw, yaw);
    const TouchPoint touch = search_->first_touch(y, roll, turned);
    return {y, touch.z_touch + uniform(1e-5, 1e-4) * std::hypot(1.0, touch.z_touch_dy), roll, turned};
  }

  fs::path reference_;
  std::shared_ptr<const LoadedTable> loaded_;
  std::unique_ptr<ContactSearch> search_;
  std::unique_ptr<ContactGeometry> geometry_;
  WheelContactModel model_, frictionless_;
  Differences& differences_;
  std::mt19937_64 random_{20261122};
  std::uniform_real_distribution<double> uniform_;
};

}  // namespace

int main(int count, char** arguments) {
  if (count != 5) {
    std::fprintf(stderr, "usage: loaded_table_study TABLE.h5 CLIMBING.h5 REFERENCE FOLDER\n");
    return 2;
  }
  try {
    Differences differences;
    Study study(arguments[1], arguments[3], differences), climbing(arguments[2], arguments[3], differences);
    study.rolling();
    study.frictionless();
    study.ellipses(1000);
    study.merging(3000);
    study.lines(10000);
    study.closed_paths(1000);
    climbing.wheelset();
    write_text_file(fs::path(arguments[4]) / "loaded_table.csv", study.summary(), "# Forces of loaded tables");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "loaded_table_study: %s\n", error.what());
    return 1;
  }
  return 0;
}
