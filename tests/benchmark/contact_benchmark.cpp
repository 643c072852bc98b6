// The time of a wheel's contact, on the queries of a run over a viaduct and on random ones: geometry look-up and force
// of an ellipse per patch, look-up and force of the loaded table, each without and with the derivative in a time step;
// the latter also of wheels side by side (WheelLanes).
//
//     contact_benchmark LOADED_TABLE.h5 [seconds]     the table as `tablegen loaded` leaves it

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "railtab/runtime/contact/contact_response.hpp"
#include "railtab/runtime/scene/scene_contact.hpp"
#include "railtab/runtime/scene/scene_model.hpp"
#include "railtab/runtime/scene/scene_parameters.hpp"
#include "railtab/runtime/start/static_equilibrium.hpp"
#include "railtab/runtime/vsi/simulation.hpp"

namespace {

using namespace railtab;
using Clock = std::chrono::steady_clock;

using Query = WheelState;

/// Every wheel at every 20th step of the example viaduct, and the step's rates.
std::vector<Query> viaduct_queries(const VsiModel& model, const IntegrationParameters& integration, double duration) {
  std::vector<Query> queries;
  VsiState state(model);
  if (!steady_start(model, state).converged) throw std::runtime_error("no static equilibrium");
  RunObserver observer;
  long step = 0;
  observer.state = [&](const VsiState& s) {
    if (step++ % 20 != 0) return;
    const ContactProblem problem = present_contact(model, s);
    for (int w = 0; w < model.wheelsets(); ++w) {
      for (int side = 0; side < 2; ++side) {
        queries.push_back({wheel_sides[static_cast<std::size_t>(side)],
                           wheelset_motion(problem, s.contact.displacement, w),
                           rail_motion(problem, s.contact.displacement, w, side)});
      }
    }
  };
  const RunSummary run = simulate(model, integration, duration, 1000, state, observer);
  if (!run.complete) throw std::runtime_error("the run failed");
  return queries;
}

/// Poses all over the loaded table, each at a load of 10 to 150 kN or so.
std::vector<Query> random_queries(const ContactSearch& search, int count) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> y(-0.007, 0.007), roll(-3e-3, 3e-3), yaw(-8e-3, 8e-3), lowering(3e-5, 1e-4),
      slip(-0.05, 0.05);
  std::vector<Query> queries;
  while (static_cast<int>(queries.size()) < count) {
    Query q{WheelSide::right, {}, {}};
    auto& d = q.wheelset.displacement;
    d << 0.0, y(random), 0.0, roll(random), 0.0, yaw(random);
    d[2] = search.touch_height(d[1], d[3], d[5]) + lowering(random);
    q.wheelset.velocity << slip(random), slip(random), 0.0, 0.0, slip(random), 0.0;
    if (std::isfinite(d[2])) queries.push_back(q);
  }
  return queries;
}

/// Least time of a query [µs]; the works take turns.
std::vector<double> least_microseconds(const std::vector<std::function<double()>>& works, std::size_t queries) {
  std::vector<double> least(works.size(), 1e300);
  double sum = 0.0;
  for (int round = 0; round < 15; ++round) {
    for (std::size_t i = 0; i < works.size(); ++i) {
      const Clock::time_point begin = Clock::now();
      sum += works[i]();
      const double seconds = std::chrono::duration<double>(Clock::now() - begin).count();
      least[i] = std::min(least[i], 1e6 * seconds / static_cast<double>(queries));
    }
  }
  if (std::isnan(sum)) fmt::print("a force is no number\n");
  return least;
}

void measure(const char* name, const std::vector<Query>& queries, const WheelContactModel& loaded,
             const WheelContactModel& patches, const StepRates& rates) {
  const auto over = [&queries](auto&& of) {
    return [&queries, of] {
      double sum = 0.0;
      for (const Query& q : queries) sum += of(q);
      return sum;
    };
  };
  const auto look_up = [](const WheelContactModel& m) {
    return [&m](const Query& q) {
      const WheelContact c = wheel_contact(*m.geometry, relative_pose(m.geometry->pair(), q.side, q.wheelset, q.rail));
      return c.loaded.energy + c.patches.count;
    };
  };
  const auto force = [](const WheelContactModel& m) {
    return [&m](const Query& q) {
      const WheelContact c = wheel_contact(*m.geometry, relative_pose(m.geometry->pair(), q.side, q.wheelset, q.rail));
      return wheel_force(m, q.side, q.wheelset, q.rail, c).wheelset[2];
    };
  };
  const auto response = [&rates](const WheelContactModel& m) {
    return [&m, &rates](const Query& q) {
      const WheelResponse r = wheel_response(m, q.side, q.wheelset, q.rail, rates);
      return r.force.wheelset[2] + r.tangent(2, 2);
    };
  };
  struct Answer {
    WheelsetPose pose;
    LoadedLookup lookup;
    LoadedWheelForce force;
  };
  std::vector<Answer> answers(WheelLanes::count);
  std::vector<LoadedAnswer> to;
  for (Answer& a : answers) to.push_back({&a.pose, &a.lookup, &a.force});
  const auto eight_forces = [&] {
    double sum = 0.0;
    for (std::size_t first = 0; first < queries.size(); first += WheelLanes::count) {
      static_cast<void>(loaded_wheel_forces(loaded, {&queries[first], WheelLanes::count}, to));
      for (const Answer& a : answers) sum += a.force.wheelset[2];
    }
    return sum;
  };
  std::vector<WheelResponse> responses(WheelLanes::count);
  const auto eight = [&] {
    double sum = 0.0;
    for (std::size_t first = 0; first < queries.size(); first += WheelLanes::count) {
      wheel_responses(loaded, {&queries[first], WheelLanes::count}, rates, responses);
      for (const WheelResponse& r : responses) sum += r.force.wheelset[2] + r.tangent(2, 2);
    }
    return sum;
  };
  const std::vector<double> t =
      least_microseconds({over(look_up(patches)), over(force(patches)), over(response(patches)), over(look_up(loaded)),
                          over(force(loaded)), over(response(loaded)), eight_forces, eight},
                         queries.size());
  fmt::print("{}, {} queries [µs each]\n", name, queries.size());
  fmt::print("  an ellipse per patch: look-up {:.3f}, and force {:.3f}, and derivative {:.3f}\n", t[0], t[1], t[2]);
  fmt::print("  loaded table:         look-up {:.3f}, and force {:.3f}, and derivative {:.3f}\n", t[3], t[4], t[5]);
  fmt::print("  side by side:         look-up and force {:.3f}; look-up, force and derivative {:.3f}\n", t[6], t[7]);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    fmt::print(stderr, "contact_benchmark: found no argument, expected LOADED_TABLE.h5 [seconds]\n");
    return 2;
  }
  SceneParameters scene = read_scene(std::string(RAILTAB_SOURCE_DIR) + "/docs/examples/viaduct.toml");
  scene.contact.table = argv[1];
  const VsiModel model = build_model(scene);
  if (!model.geometry->loaded()) {
    fmt::print(stderr, "contact_benchmark: {}: found no loaded part, expected one (tablegen loaded)\n", argv[1]);
    return 2;
  }
  const std::vector<Query> viaduct = viaduct_queries(model, scene.integration, argc > 2 ? std::atof(argv[2]) : 2.0);
  const HhtScheme scheme{.alpha = scene.integration.alpha, .time_step = scene.integration.time_step};
  const double rate = scheme.gamma() / (scheme.beta() * scheme.time_step);
  const StepRates rates{Vector6::Constant(rate), rate, nullptr};
  ContactParameters apart = scene.contact;
  apart.elastic = ElasticContact::patches;
  const ContactGeometry without = scene_geometry(apart);
  WheelContactModel patches = model.contact;
  patches.geometry = &without;
  measure("viaduct", viaduct, model.contact, patches, rates);
  measure("random", random_queries(ContactSearch(model.geometry->pair()), 4096), model.contact, patches, rates);
  return 0;
}
