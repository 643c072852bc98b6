#include <benchmark/benchmark.h>

#include <cmath>
#include <random>

#include "railtab/runtime/contact/table_contact.hpp"
#include "railtab/runtime/profile/standard_profiles.hpp"
#include "railtab/tablegen/geometry_sweep.hpp"

// Contact patches of one wheel at random positions that the table answers: S1002 on 60E1 1:40, y ±12 mm, yaw ±30 mrad,
// 0..0.3 mm below first touch. "LookUp" is the leaf and its polynomials alone, "Table" with the Newton on the profiles,
// "Online" the search that the table stands for.
namespace {

using namespace railtab;

struct Case {
  TableContact contact;
  std::vector<WheelsetPose> poses;
};

Case make_case(double roll) {
  const ContactSearch search(WheelRailPair(ProfileCurve(standard_profile(ProfileKind::wheel, "S1002", 1.0 / 40)),
                                           ProfileCurve(standard_profile(ProfileKind::rail, "60E1", 1.0 / 40)),
                                           PairDimensions{}));
  GeometrySweepOptions options;
  options.roll = {-roll, roll};
  Case c{TableContact(GeometryTable(sweep_geometry(search, options))), {}};
  std::mt19937 random(1);
  std::uniform_real_distribution<double> y(-0.012, 0.012), yaw(-0.03, 0.03), rolls(-roll, roll), dz(0, 3e-4);
  while (c.poses.size() < 4096) {
    WheelsetPose pose{y(random), 0, roll > 0 ? rolls(random) : 0.0, yaw(random)};
    pose.z = search.touch_height(pose.y, pose.roll, pose.yaw) + dz(random);
    ContactPatches answer;
    if (std::isfinite(pose.z) && c.contact.patches_from_table(pose, 0.0, answer)) c.poses.push_back(pose);
  }
  return c;
}

const Case& flat() {
  static const Case c = make_case(0.0);
  return c;
}
const Case& rolled() {
  static const Case c = make_case(0.010);
  return c;
}

template <typename Query>
void run(benchmark::State& state, const Case& c, const Query& query) {
  std::size_t n = 0;
  for (auto _ : state) benchmark::DoNotOptimize(query(c.poses[n++ & 4095]));
  state.counters["table_MiB"] = static_cast<double>(c.contact.table().bytes()) / 1048576.0;
}

void look_up(benchmark::State& state, const Case& c) {
  run(state, c, [&](const WheelsetPose& p) { return c.contact.table().lookup(p.y, p.z, p.yaw, p.roll); });
}
void table(benchmark::State& state, const Case& c) {
  run(state, c, [&](const WheelsetPose& p) { return c.contact.patches(p); });
}
void online(benchmark::State& state, const Case& c) {
  run(state, c, [&](const WheelsetPose& p) { return c.contact.search().patches(p); });
}

BENCHMARK_CAPTURE(look_up, without_roll, flat());
BENCHMARK_CAPTURE(table, without_roll, flat());
BENCHMARK_CAPTURE(online, without_roll, flat());
BENCHMARK_CAPTURE(look_up, with_roll, rolled());
BENCHMARK_CAPTURE(table, with_roll, rolled());
BENCHMARK_CAPTURE(online, with_roll, rolled());

}  // namespace
