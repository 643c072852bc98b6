#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/scene/scene_model.hpp"
#include "railtab/runtime/start/static_equilibrium.hpp"
#include "watched_run.hpp"

namespace railtab::stability {
namespace {

constexpr const char* impulse = "impulse balance";
using Cases = std::vector<StabilityCase>;
using Disturb = std::function<void(VsiState&)>;

/// Both rails with the same vertical deviation, given by points.
Irregularity vertical(const std::vector<double>& x, const std::vector<double>& z) {
  const std::vector<double> none(x.size(), 0.0);
  return {x, none, z, none, z};
}

/// A wave on both rails, faded in over its first metre, and 80 m at least.
Irregularity wave(double length, double amplitude, double points_per_wave, double extent = 0.0) {
  std::vector<double> x, z;
  const auto points = static_cast<long>(std::max(extent, 80.0) / length * points_per_wave);
  for (long i = 0; i < points; ++i) {
    const double at = static_cast<double>(i) * length / points_per_wave;
    x.push_back(at);
    z.push_back(amplitude * std::min(1.0, at) * std::sin(2.0 * std::numbers::pi * at / length));
  }
  return vertical(x, z);
}

/// A change of height over 50 mm, at x = 3 m; positive: down.
Irregularity step_down(double height) {
  std::vector<double> x, z;
  for (int i = -2000; i <= 4000; ++i) {
    x.push_back(0.025 * i);
    z.push_back(height * std::clamp((x.back() - 2.95) / 0.05, 0.0, 1.0));
  }
  return vertical(x, z);
}

CaseResult run_of(const SceneParameters& scene, const Irregularity& rough = {}, const Disturb& disturb = {}) {
  VsiModel model = build_model(scene);
  model.irregularity = rough;
  return judged(watched_run(model, scene.integration, scene.integration.duration, disturb));
}

/// K_h goes with Young's modulus; so does the creep forces' stiffness.
void scale_stiffness(SceneParameters& scene, double factor) { scene.contact.material.E *= factor; }

/// At most so many steps: fine steps see a shorter time.
void set_step(SceneParameters& scene, double time_step, double most_steps) {
  scene.integration.time_step = time_step;
  scene.integration.duration = std::min(scene.integration.duration, most_steps * time_step);
}

void add_stiffness_cases(Cases& cases) {
  for (const double stiffness : {1e-3, 1e-2, 1e-1, 1.0, 1e1, 1e2, 1e3}) {
    for (const double dt : {1e-6, 1e-5, 1e-4, 5e-4, 1e-3, 1e-2}) {
      const bool quick = stiffness == 1.0 ? dt == 5e-4 : (stiffness == 1e-3 || stiffness == 1e3) && dt >= 1e-3;
      cases.push_back({"contact stiffness and time step", fmt::format("K_h x {:g}, {:g} s", stiffness, dt), impulse,
                       1e-2, stiffness == 1e-3 ? Outcome::ended : Outcome::converged, quick, [=](double) {
                         SceneParameters scene = coach_on_rigid_track();
                         scale_stiffness(scene, stiffness);
                         set_step(scene, dt, 1500.0);
                         return run_of(scene, wave(3.0, 1e-3, 12.0));
                       }});
    }
  }
  for (const double stiffness : {1.0, 1e2, 1e3}) {
    for (const double dt : {5e-4, 1e-3, 1e-2}) {
      // A wheel that bounces within a few steps leaves the rail with many times the energy that it came with.
      cases.push_back({"contact_force \"endpoint\"", fmt::format("K_h x {:g}, {:g} s", stiffness, dt), impulse, 1e-2,
                       stiffness >= 1e2 && dt == 1e-2 ? Outcome::ended : Outcome::converged, dt == 1e-2, [=](double) {
                         SceneParameters scene = coach_on_rigid_track();
                         scene.integration.contact_force = ContactForceRule::endpoint;
                         scale_stiffness(scene, stiffness);
                         set_step(scene, dt, 1500.0);
                         return run_of(scene, wave(3.0, 1e-3, 12.0));
                       }});
    }
  }
  for (const double alpha : {-1.0 / 3.0, -0.1, -0.05, 0.0}) {
    for (const double stiffness : {1e-3, 1.0, 1e3}) {
      cases.push_back({"HHT alpha", fmt::format("alpha {:.3g}, K_h x {:g}", alpha, stiffness), impulse, 1e-3,
                       stiffness == 1e-3 ? Outcome::ended : Outcome::converged, stiffness == 1.0, [=](double) {
                         SceneParameters scene = coach_on_rigid_track();
                         scale_stiffness(scene, stiffness);
                         scene.integration.alpha = alpha;
                         return run_of(scene, wave(3.0, 1e-3, 12.0));
                       }});
    }
  }
}

void add_speed_cases(Cases& cases) {
  for (const double kmh : {0.01, 1.0, 80.0, 300.0, 500.0}) {
    cases.push_back({"speed", fmt::format("{:g} km/h, rigid track", kmh), impulse, 1e-3,
                     kmh < 0.1 ? Outcome::ended : Outcome::converged, true, [=](double) {
                       SceneParameters scene = coach_on_rigid_track();
                       scene.train.speed = kmh / 3.6;
                       return run_of(scene, wave(3.0, 1e-3, 12.0));
                     }});
    cases.push_back({"speed", fmt::format("{:g} km/h, ballasted track and bridge", kmh), impulse, 1e-3,
                     kmh < 0.1 ? Outcome::ended : Outcome::converged, kmh >= 500.0, [=](double) {
                       SceneParameters scene = coach_on_bridge();
                       scene.train.speed = kmh / 3.6;
                       scene.integration.duration = 0.2;
                       return run_of(scene);
                     }});
  }
  cases.push_back({"speed", "standing train", impulse, 1e-3, Outcome::rejected, true, [](double) {
                     SceneParameters scene = coach_on_rigid_track();
                     scene.train.speed = 0.0;
                     return run_of(scene);
                   }});
}

CaseResult loaded(double factor) {
  SceneParameters scene = coach_on_rigid_track();
  VsiModel model = build_model(scene);
  model.vehicle.static_load *= factor;
  return judged(watched_run(model, scene.integration, scene.integration.duration));
}

void add_load_cases(Cases& cases) {
  for (const double factor : {0.0, 0.1, 10.0}) {
    cases.push_back({"wheel load", fmt::format("x {:g}", factor), impulse, 1e-3, Outcome::converged, true,
                     [=](double) { return loaded(factor); }});
  }
  for (const double height : {0.005, 0.02, -0.02}) {
    cases.push_back({"rail step over 50 mm",
                     fmt::format("{:g} mm {}", 1e3 * std::abs(height), height > 0 ? "down" : "up"), impulse, 1e-3,
                     Outcome::converged, height > 0.01,
                     [=](double) { return run_of(coach_on_rigid_track(), step_down(height)); }});
  }
}

/// A lateral load on the first wheelset.
CaseResult pushed(double force) {
  SceneParameters scene = coach_on_rigid_track();
  scene.integration.duration = 0.6;
  VsiModel model = build_model(scene);
  const auto wheelset = static_cast<std::size_t>(model.vehicle.wheelsets.front());
  // The start is that without the load: the force sets in at once.
  VsiModel under_load = model;
  under_load.vehicle.static_load[model.vehicle.dof[wheelset][1]] += force;
  const WatchedRun run = watched_run(model, under_load, scene.integration, scene.integration.duration);
  CaseResult result = judged(run);
  result.note += fmt::format("{}shift up to {:.1f} mm", result.note.empty() ? "" : "; ", 1e3 * run.largest_shift);
  return result;
}

void add_lateral_cases(Cases& cases) {
  for (const double yaw : {2e-3, 5e-3, 1e-2}) {
    cases.push_back({"flange impact at 400 km/h", fmt::format("wheelsets yawed by {:g} mrad", 1e3 * yaw), impulse, 1e-3,
                     Outcome::converged, yaw == 5e-3, [=](double) {
                       SceneParameters scene = coach_on_rigid_track();
                       scene.train.speed = 400.0 / 3.6;
                       const VsiModel model = build_model(scene);
                       return run_of(scene, {}, [&](VsiState& state) {
                         for (LinearMotion& motion : state.vehicle) {
                           for (const int body : model.vehicle.wheelsets) {
                             motion.displacement[model.vehicle.dof[static_cast<std::size_t>(body)][5]] += yaw;
                           }
                         }
                       });
                     }});
  }
  for (const double force : {2e4, 1e5, 3e5, 1e6}) {
    cases.push_back({"lateral force on one wheelset", fmt::format("{:g} kN", 1e-3 * force), impulse, 1e-3,
                     force > 2e5 ? Outcome::ended : Outcome::converged, force == 1e6,
                     [=](double) { return pushed(force); }});
  }
}

void add_structure_cases(Cases& cases) {
  const auto add = [&](const char* setting, bool quick, const std::function<void(SceneParameters&)>& change) {
    cases.push_back({"structure", setting, impulse, 1e-3, Outcome::converged, quick, [change](double) {
                       SceneParameters scene = coach_on_bridge();
                       scene.integration.duration = 0.2;
                       change(scene);
                       return run_of(scene);
                     }});
  };
  add("stiffness of pads to that of ballast 1e9", true, [](SceneParameters& s) {
    s.track.pad.kz = 5e16;
    s.track.ballast_deck.kz = s.track.ballast_ground.kz = 5e7;
  });
  add("stiffness of ballast to that of pads 1e9", false, [](SceneParameters& s) {
    s.track.pad.kz = 5e7;
    s.track.ballast_deck.kz = s.track.ballast_ground.kz = 5e16;
  });
  add("sleepers of 1e-9 kg", true, [](SceneParameters& s) {
    s.track.sleeper.mass = s.track.sleeper.Jx = s.track.sleeper.Jy = s.track.sleeper.Jz = 1e-9;
  });
  add("two elements in the bridge", false, [](SceneParameters& s) { s.spans[0].elements = 2; });
  cases.push_back({"structure", "one element in the bridge", impulse, 1e-3, Outcome::rejected, true, [](double) {
                     SceneParameters scene = coach_on_bridge();
                     scene.spans[0].elements = 1;
                     return run_of(scene);
                   }});
  cases.push_back({"structure", "no mass at all", impulse, 1e-3, Outcome::converged, true, [](double) {
                     SceneParameters scene = coach_on_bridge();
                     scene.integration.duration = 0.2;
                     VsiModel model = build_model(scene);
                     StructureModel structure = *model.structure;
                     structure.mass *= 0.0;
                     model.structure = share(std::move(structure));
                     return judged(watched_run(model, scene.integration, scene.integration.duration));
                   }});
  cases.push_back({"structure", "no mass in every other node", impulse, 1e-3, Outcome::converged, true, [](double) {
                     SceneParameters scene = coach_on_bridge();
                     scene.integration.duration = 0.2;
                     VsiModel model = build_model(scene);
                     StructureModel structure = *model.structure;
                     Eigen::VectorXd kept = Eigen::VectorXd::Ones(structure.dofs());
                     for (std::size_t n = 0; n < structure.nodes.size(); n += 2) {
                       for (const int dof : structure.nodes[n].dof) {
                         if (dof != held) kept[dof] = 0.0;
                       }
                     }
                     structure.mass = kept.asDiagonal() * structure.mass * kept.asDiagonal();
                     model.structure = share(std::move(structure));
                     return judged(watched_run(model, scene.integration, scene.integration.duration));
                   }});
  const double element = coach_on_bridge().track.sleeper_spacing;  // one rail element per bay
  for (const double length : {0.2, 0.06}) {
    cases.push_back({"irregularity shorter than an element",
                     fmt::format("wave of {:g} m on elements of {:g} m", length, element), impulse, 1e-3,
                     Outcome::converged, length < 0.1, [=](double) {
                       SceneParameters scene = coach_on_bridge();
                       scene.integration.duration = 0.2;
                       return run_of(scene, wave(length, 5e-5, 8.0));
                     }});
  }
}

void add_long_cases(Cases& cases) {
  const auto add = [&](const char* setting, NormalContact normal, double duration) {
    cases.push_back({"many steps", setting, impulse, 1e-3, Outcome::converged, false, [=](double) {
                       SceneParameters scene = coach_on_rigid_track();
                       scene.contact.normal = normal;
                       scene.integration.duration = duration;
                       scene.integration.time_step = 1e-4;
                       return run_of(scene, wave(3.0, 1e-3, 12.0, scene.train.speed * duration));
                     }});
  };
  add("1e6 of 1e-4 s, wheels that follow the rails", NormalContact::rigid, 100.0);
  add("2e4 of 1e-4 s", NormalContact::hertz, 2.0);
  cases.push_back({"many steps", "1e6 of 1e-4 s, a wheelset with a sprung mass", impulse, 1e-3, Outcome::converged,
                   false, [](double) {
                     IntegrationParameters integration;
                     integration.time_step = 1e-4;
                     VsiModel model = sprung_wheelset();
                     constexpr double duration = 100.0;
                     model.irregularity = wave(3.0, 1e-3, 12.0, model.contact.speed * duration);
                     return judged(watched_run(model, integration, duration));
                   }});
}

}  // namespace

std::vector<StabilityCase> run_cases() {
  Cases cases;
  add_stiffness_cases(cases);
  add_speed_cases(cases);
  add_load_cases(cases);
  add_lateral_cases(cases);
  add_structure_cases(cases);
  add_long_cases(cases);
  return cases;
}

}  // namespace railtab::stability
