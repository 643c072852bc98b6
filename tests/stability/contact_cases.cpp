#include <unistd.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "railtab/runtime/contact/creep_law.hpp"
#include "railtab/runtime/contact/hertz.hpp"
#include "railtab/runtime/contact_files/creep_law_file.hpp"
#include "railtab/runtime/profile/profile_file.hpp"
#include "railtab/runtime/profile/standard_profiles.hpp"
#include "railtab/runtime/scene/scene_model.hpp"
#include "watched_run.hpp"

namespace railtab::stability {
namespace {

using Cases = std::vector<StabilityCase>;

/// K_h from the table of ellipses against the exact elliptic integrals.
CaseResult hertz_against_exact(double ratio_of_curvatures) {
  const double B = 1.0, A = ratio_of_curvatures;
  const HertzContact exact = hertz_contact_exact(A, B, {}), fast = hertz_contact(A, B, {});
  CaseResult result{.outcome = Outcome::converged};
  result.error = std::max(std::abs(fast.stiffness / exact.stiffness - 1.0), std::abs(fast.ratio / exact.ratio - 1.0));
  if (!std::isfinite(result.error)) result.outcome = Outcome::wrong;
  result.note = fmt::format("a/b = {:.3g}", exact.ratio);
  return result;
}

/// Excess of the force over the friction bound, and at full sliding its distance from it; at vanishing creepage, what
/// the force departs from being proportional.
CaseResult creep_bound(const CreepLaw& law, double ratio, double creepage) {
  CaseResult result{.outcome = Outcome::converged};
  for (const Creepage& direction : {Creepage{1.0, 0.0, 0.0}, Creepage{0.0, -1.0, 0.0}, Creepage{0.6, 0.8, 0.0}}) {
    const Creepage c{creepage * direction.x, creepage * direction.y, 0.0};
    const CreepForce force = creep_force(law, ratio, c);
    const double size = std::hypot(force.x, force.y);
    if (!std::isfinite(size + force.moment)) return {.outcome = Outcome::wrong, .note = "not finite"};
    if (creepage == 0.0)
      result.error = std::max(result.error, size);
    else if (creepage < 1e-6) {
      constexpr double larger = 1e3;
      const CreepForce far = creep_force(law, ratio, {larger * c.x, larger * c.y, 0.0});
      const double distance = std::hypot(larger * force.x - far.x, larger * force.y - far.y);
      result.error = std::max(result.error, distance / std::hypot(far.x, far.y));
    } else {
      result.error = std::max(result.error, size - 1.0);
      if (creepage >= 1e3 && std::min(ratio, 1.0 / ratio) > 0.05) result.error = std::max(result.error, 1.0 - size);
    }
  }
  return result;
}

void add_part_cases(Cases& cases) {
  for (const double ratio : {1e-6, 1e-3, 1.0, 1e3, 1e6}) {
    cases.push_back({"Hertz's ellipse", fmt::format("A/B = {:g}", ratio), "K_h and a/b against elliptic integrals",
                     1e-8, Outcome::converged, true, [=](double) { return hertz_against_exact(ratio); }});
  }
  for (const char* name : {"polach", "fastsim", "table"}) {
    for (const double ratio : {1e-3, 1.0, 1e3}) {
      for (const double creepage : {0.0, 1e-12, 1.0, 1e3}) {
        const double allowed = creepage == 0.0 ? 1e-15 : creepage < 1e-6 ? 1e-6 : 2e-3;
        cases.push_back({"creep law", fmt::format("{}, a/b = {:g}, creepage {:g}", name, ratio, creepage),
                         creepage > 0.0 && creepage < 1e-6 ? "proportional to creepage" : "beyond the friction bound",
                         allowed, Outcome::converged, true,
                         [=, law = creep_law(name, 0.28)](double) { return creep_bound(law, ratio, creepage); }});
      }
    }
  }
}

/// A tread of this cone angle, or round with this radius about the rail head's middle, as a profile file of its own.
std::filesystem::path wheel_file(const std::string& name, const std::function<double(double)>& z) {
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / ("railtab_stability_" + std::to_string(getpid()) + name + ".txt");
  std::ofstream out(file);
  out << "# units: m\n";
  for (int i = -35; i <= 35; ++i) {
    const double y = 1e-3 * i;
    out << fmt::format("{} {:.12f}\n", y, z(y) - z(0.0));
  }
  return file;
}

CaseResult profile_run(const std::string& wheel, const std::string& rail, double inclination, double shift) {
  SceneParameters scene = coach_on_rigid_track();
  scene.contact.wheel = wheel;
  scene.contact.rail = rail;
  scene.contact.rail_inclination = inclination;
  if (rail == "knife-edge") scene.contact.dimensions.gauge_height = 0.0;  // it has no gauge face
  const VsiModel model = build_model(scene);
  return judged(watched_run(model, scene.integration, scene.integration.duration, [&](VsiState& state) {
    for (LinearMotion& motion : state.vehicle) {
      for (const DofIndices& dof : model.vehicle.dof) {
        if (dof[1] != held) motion.displacement[dof[1]] += shift;
      }
    }
  }));
}

void add_profile_cases(Cases& cases) {
  constexpr const char* impulse = "impulse balance";
  for (const double conicity : {0.0, -0.025, -0.2}) {
    cases.push_back(
        {"conicity", fmt::format("{:g}", conicity), impulse, 1e-3, Outcome::ended, conicity == 0.0, [=](double) {
           const auto file = wheel_file(fmt::format("cone_{}", conicity), [=](double y) { return -conicity * y; });
           CaseResult result = profile_run(file.string(), "60E1", 0.025, 2e-3);
           std::filesystem::remove(file);
           return result;
         }});
  }
  for (const double excess : {1e-2, 1e-3, 1e-4}) {
    cases.push_back(
        {"near-conformal profiles", fmt::format("tread of radius 300 mm x {:g} on a head of 300 mm", 1.0 + excess),
         impulse, 1e-3, Outcome::converged, excess == 1e-3, [=](double) {
           const double R = 0.3 * (1.0 + excess);
           const auto file =
               wheel_file(fmt::format("round_{}", excess), [=](double y) { return R - std::sqrt(R * R - y * y); });
           CaseResult result = profile_run(file.string(), "60E1", 0.0, 0.0);
           std::filesystem::remove(file);
           return result;
         }});
  }
  cases.push_back({"knife-edge rail", "S1002", impulse, 1e-3, Outcome::rejected, true,
                   [](double) { return profile_run("S1002", "knife-edge", 0.0, 0.0); }});
}

}  // namespace

std::vector<StabilityCase> contact_cases() {
  Cases cases;
  add_part_cases(cases);
  add_profile_cases(cases);
  return cases;
}

}  // namespace railtab::stability
