// The half-space solution of a wheel on its rail, with friction, against CONTACT's loaded cases. Not a test:
//
//     loaded_contact_study REFERENCE FOLDER
//
// REFERENCE holds contact_loaded/ (sets A, B, C; README.md there) and profiles/ (the profiles CONTACT used). Writes
// FOLDER/loaded_contact.csv, differences by class, and FOLDER/loaded_contact_cases.csv, the rolling cases one by one:
// the numbers of docs/validation/loaded_contact.md.

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <exception>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "contact_reference.hpp"
#include "railtab/runtime/base/text_file.hpp"
#include "railtab/runtime/profile/profile_file.hpp"
#include "railtab/tablegen/loaded_rolling.hpp"

namespace {

using namespace railtab;
using namespace railtab::contact_reference;
namespace fs = std::filesystem;

const ContactBand& largest_band(const LoadedContact& contact) {
  return *std::max_element(contact.bands.begin(), contact.bands.end(),
                           [](const ContactBand& a, const ContactBand& b) { return a.normal_force < b.normal_force; });
}

class Study {
 public:
  explicit Study(const fs::path& reference)
      : reference_(reference / "contact_loaded"),
        search_(WheelRailPair(
            ProfileCurve(load_profile((reference / "profiles/MBench_S1002_v3.prw").string(), ProfileKind::wheel, 0.0)),
            ProfileCurve(load_profile((reference / "profiles/MBench_UIC60_v3.prr").string(), ProfileKind::rail, 0.0)),
            PairDimensions{})) {
    options_.wheel = options_.rail = {2.0 * shear_modulus * (1.0 + poisson), poisson};
    options_.elements.most = 400000;
    fine_ = options_;
    fine_.elements.across_narrowest *= 2;
    planar_.slip = LoadedRollingOptions::SlipField::planar;
    curved_.friction = planar_.friction = friction;
  }

  void rolling() {
    std::map<std::string, Row> patches, curved_reference;
    for (const Row& row : read_rows(reference_ / "A_patches.csv")) patches.emplace(row.text("case"), row);
    for (const Row& row : read_rows(reference_ / "A_conformal.csv")) {
      if (row["npatch"] > 0.0) curved_reference.emplace(row.text("case"), row);
    }
    for (const Row& row : read_rows(reference_ / "A_cases.csv")) {
      const auto curved = curved_reference.find(row.text("case"));
      rolling_case(row, patches.at(row.text("case")), curved == curved_reference.end() ? nullptr : &curved->second);
    }
  }

  void frictionless() {
    std::map<std::string, Row> patches;
    for (const Row& row : read_rows(reference_ / "B_patches.csv")) {
      patches.emplace(row.text("case") + row.text("approach"), row);
    }
    for (const Row& row : read_rows(reference_ / "B_curves.csv")) {
      const Row& patch = patches.at(row.text("case") + row.text("approach"));
      const std::string kind = kind_of(patch["delta"], row["bands_1pct"]);
      const WheelsetPose pose{row["y"], row["z_touch"] + row["approach"], row["roll"], row["yaw"]};
      const LoadedContact c = loaded_contact(search_, pose, options_);
      differences_.add("B", kind, "normal force", c.normal_force / row["fn_sum"] - 1.0);
      differences_.add("B", kind, "vertical force", c.on_rail.force.z() / row["fz"] - 1.0);
      differences_.add("B", kind, "largest pressure", c.largest_pressure / row["pmax"] - 1.0);
      differences_.add("B", kind, "contact angle",
                       std::atan2(c.on_rail.force.y(), c.on_rail.force.z()) - std::atan2(row["fy"], row["fz"]));
      const double halved = loaded_contact(search_, pose, fine_).normal_force;
      differences_.add("B", kind, "normal force of halved elements", c.normal_force / halved - 1.0);
    }
  }

  void wheelset() {
    for (const Row& row : read_rows(reference_ / "C_wheels.csv")) {
      const double side = row.text("side") == "R" ? 1.0 : -1.0;
      const ContactAtLoad found = contact_at_load(
          search_, {side * row["y"], 0.0, side * row["roll"], side * row["yaw"]}, row["load"], options_);
      const LoadedContact& c = found.contact;
      const std::string kind = kind_of(largest_band(c).angle, row["bands_1pct"]);
      const double touch = search_.touch_height(c.pose.y, c.pose.roll, c.pose.yaw);
      differences_.add("C", kind, "approach", (c.pose.z - row["z_ws"]) / (row["z_ws"] - touch));
      differences_.add("C", kind, "height", c.pose.z - row["z_ws"]);
      differences_.add("C", kind, "lateral force", (side * c.on_rail.force.y() - row["fy"]) / row["load"]);
      differences_.add("C", kind, "largest pressure", c.largest_pressure / row["pmax"] - 1.0);
    }
  }

  [[nodiscard]] std::string summary() const {
    return "# Absolute differences from CONTACT's loaded cases (S1002 on 60E1 1:40), relative to its value; height in "
           "m,\n"
           "# contact angle in rad, spin in 1/m, forces of set A as vector in mu F_n, lateral force of set C in the "
           "load.\n"
           "# D2: CONTACT's planar, D4: its curved reference; made by tests/validation/loaded_contact_study, " +
           fmt::format("{:%Y-%m-%d}", fmt::gmtime(std::time(nullptr))) +
           "\nset,kind,quantity,cases,mean,p95,largest\n" + differences_.csv();
  }
  [[nodiscard]] std::string cases() const {
    return "# Set A one by one: as loaded_contact.csv\n"
           "case,kind,y_mm,load_kN,bands,approach,pressure,force_D2,planar_slip_D2,force_D4,D2_D4,angle_mrad\n" +
           cases_;
  }

 private:
  void rolling_case(const Row& row, const Row& patch, const Row* curved_reference) {
    const WheelsetPose at{row["y"], 0.0, row["roll"], row["yaw"]};
    curved_.speed = planar_.speed = 30.0;
    const RelativeMotion motion = running_motion(at, curved_.speed, row["pitch_rate"]);
    const auto roll = [&](const LoadedContact& c, const LoadedContactOptions& o, const LoadedRollingOptions& r) {
      return loaded_rolling(search_.pair(), c, o, motion, r);
    };
    const auto share = [&](const LoadedContact& c) { return roll(c, options_, curved_).on_rail.force.z(); };
    const ContactAtLoad found = contact_at_load(search_, at, row["fz_prescribed"], options_, share);
    if (!found.converged) throw std::runtime_error("no solution of case " + row.text("case"));
    const LoadedContact& c = found.contact;
    const LoadedRolling curved = roll(c, options_, curved_), planar = roll(c, options_, planar_);
    const ContactBand& band = largest_band(c);
    const std::string kind = kind_of(patch["delta"], patch["bands_1pct"]);
    const double bound = friction * patch["fn"];
    const Eigen::Vector3d total = c.on_rail.force + curved.on_rail.force;
    const double force = std::hypot(total.x() - row["fx"], total.y() - row["fy"]) / bound;
    // in the contact axes of each: without the angle between the two references
    const auto creep = [&](const LoadedRolling& r) {
      double x = 0.0, y = 0.0;
      for (const BandFriction& b : r.bands) {
        x += b.x;
        y += b.y;
      }
      const double scale = friction * c.normal_force;
      return std::hypot(x / scale + patch["fx"] / bound, y / scale + patch["fs"] / bound);
    };
    const double touch = search_.touch_height(at.y, at.roll, at.yaw);
    const double approach = (c.pose.z - touch) / row["approach"] - 1.0;
    const double pressure = c.largest_pressure / patch["pmax"] - 1.0;
    const double vref = 0.5 * (1.0 + std::abs(row["pitch_rate"]) * band.rolling_radius / curved_.speed);
    differences_.add("A", kind, "approach", approach);
    differences_.add("A", kind, "largest pressure", pressure);
    differences_.add("A", kind, "force D2", force);
    differences_.add("A", kind, "creep force D2", creep(curved));
    differences_.add("A", kind, "creep force of planar slip D2", creep(planar));
    differences_.add("A", kind, "contact angle", band.angle - patch["delta"]);
    // of the normal force's direction, as CONTACT's
    const double spin =
        patch_creepage(motion, Eigen::Vector3d::Zero(), ContactAxes(band.angle), curved_.speed).spin / vref;
    if (c.bands.size() == 1) differences_.add("A", kind, "spin", spin + patch["cphi"]);
    constexpr double flank = 1.15;  // rad; steeper contacts touch on the flange alone
    if (std::abs(band.angle) > flank) {
      const double cosine = patch["penetration"] / row["approach"];  // of d = z cos(angle)
      differences_.add("A", "flank", "cosine here", std::cos(band.angle) / cosine - 1.0);
      differences_.add("A", "flank", "cosine D2", std::cos(patch["delta"]) / cosine - 1.0);
    }
    double force_d4 = NAN, d2_d4 = NAN;
    if (curved_reference) {
      const Row& d4 = *curved_reference;
      force_d4 = std::hypot(total.x() - d4["fx"], total.y() - d4["fy"]) / bound;
      d2_d4 = std::hypot(row["fx"] - d4["fx"], row["fy"] - d4["fy"]) / bound;
      differences_.add("A", kind, "force D4", force_d4);
      differences_.add("A", kind, "D2 against D4", d2_d4);
      differences_.add("A", kind, "largest pressure D4", c.largest_pressure / d4["pmax"] - 1.0);
    }
    halved(c, curved, motion, kind);
    cases_ += fmt::format("{},{},{:.3f},{:.2f},{},{:.5f},{:.4f},{:.4f},{:.4f},{:.4f},{:.4f},{:.2f}\n", row.text("case"),
                          kind, 1e3 * at.y, 1e-3 * row["fz_prescribed"], c.bands.size(), approach, pressure, force,
                          creep(planar), force_d4, d2_d4, 1e3 * (band.angle - patch["delta"]));
  }

  /// The same pose with elements of half the size.
  void halved(const LoadedContact& c, const LoadedRolling& curved, const RelativeMotion& motion,
              const std::string& kind) {
    const LoadedContact fine = loaded_contact(search_, c.pose, fine_);
    const LoadedRolling rolling = loaded_rolling(search_.pair(), fine, fine_, motion, curved_);
    differences_.add("A", kind, "normal force of halved elements", c.normal_force / fine.normal_force - 1.0);
    differences_.add(
        "A", kind, "creep force of halved elements",
        (curved.on_rail.force / c.normal_force - rolling.on_rail.force / fine.normal_force).norm() / friction);
  }

  fs::path reference_;
  ContactSearch search_;
  LoadedContactOptions options_, fine_;
  LoadedRollingOptions curved_, planar_;
  Differences differences_;
  std::string cases_;
};

}  // namespace

int main(int count, char** arguments) {
  if (count != 3) {
    std::fprintf(stderr, "usage: loaded_contact_study REFERENCE FOLDER\n");
    return 2;
  }
  try {
    Study study(arguments[1]);
    study.rolling();
    study.frictionless();
    study.wheelset();
    write_text_file(fs::path(arguments[2]) / "loaded_contact.csv", study.summary(), "# Absolute differences");
    write_text_file(fs::path(arguments[2]) / "loaded_contact_cases.csv", study.cases(), "# Set A one by one");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "loaded_contact_study: %s\n", error.what());
    return 1;
  }
  return 0;
}
