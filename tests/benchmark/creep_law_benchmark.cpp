#include <benchmark/benchmark.h>

#include <array>
#include <cmath>

#include "../fastsim_scalar.hpp"
#include "railtab/runtime/contact/creep_law.hpp"
#include "railtab/runtime/contact/hertz.hpp"
#include "railtab/runtime/contact_files/creep_law_file.hpp"

namespace railtab {
namespace {

constexpr int kCases = 256;  // a power of two: many inputs, so that no branch is learned by heart

struct Case {
  double ratio;
  Creepage creepage;
};

const std::array<Case, kCases>& cases() {
  static const std::array<Case, kCases> all = [] {
    std::array<Case, kCases> c;
    for (int i = 0; i < kCases; ++i) {
      const double size = std::pow(10.0, -1.5 + 2.5 * ((i * 37) % kCases) / kCases);
      c[i] = {std::pow(10.0, -0.9 + 1.8 * ((i * 91) % kCases) / kCases),
              {size * std::sin(1.1 * i), size * std::cos(0.7 * i), size * std::sin(1.9 * i)}};
    }
    return c;
  }();
  return all;
}

void run_law(benchmark::State& state, const CreepLaw& law) {
  int i = 0;
  for (auto _ : state) {
    const Case& c = cases()[i++ & (kCases - 1)];
    CreepForce f = creep_force(law, c.ratio, c.creepage);
    benchmark::DoNotOptimize(f);
  }
}

void creep_linear(benchmark::State& state) { run_law(state, LinearCreep{}); }
void creep_linear_saturated(benchmark::State& state) { run_law(state, LinearCreep{.saturated = true}); }
void creep_polach(benchmark::State& state) { run_law(state, PolachCreep{}); }
void creep_fastsim(benchmark::State& state) {
  const int n = static_cast<int>(state.range(0));
  run_law(state, FastsimCreep{.strips = n, .elements = n});
}
void creep_fastsim_scalar_20(benchmark::State& state) {
  static const testing::ScalarFastsim<20> fastsim;
  int i = 0;
  for (auto _ : state) {
    const Case& c = cases()[i++ & (kCases - 1)];
    CreepForce f = fastsim(c.ratio, 0.28, c.creepage);
    benchmark::DoNotOptimize(f);
  }
}
BENCHMARK(creep_linear);
BENCHMARK(creep_linear_saturated);
BENCHMARK(creep_polach);
BENCHMARK(creep_fastsim)->Arg(10)->Arg(20)->Arg(40);
BENCHMARK(creep_fastsim_scalar_20);

const CreepTable& shipped_table() {
  static const CreepLaw law = creep_law("table", 0.28);
  return *std::get<TableCreep>(law).table;
}

/// With derivatives, at cases that have nothing to do with each other.
void creep_table_random(benchmark::State& state) {
  const CreepTable& table = shipped_table();
  int i = 0;
  for (auto _ : state) {
    const Case& c = cases()[i++ & (kCases - 1)];
    CreepLookup f = table.lookup(c.ratio, {c.creepage.x, c.creepage.y, c.creepage.spin});
    benchmark::DoNotOptimize(f);
  }
}
BENCHMARK(creep_table_random);

/// With derivatives, along a smooth path, as a running wheel takes it.
void creep_table_trajectory(benchmark::State& state) {
  const CreepTable& table = shipped_table();
  double s = 0.0;
  for (auto _ : state) {
    s += 1e-3;
    const double wave = s - std::floor(s);  // no sine: its time would count
    const double path = 4.0 * wave * (1.0 - wave);
    CreepLookup f = table.lookup(0.9 + 0.6 * path, {0.3 * path - 0.15, 0.1 + 0.2 * path, 0.05 * path});
    benchmark::DoNotOptimize(f);
  }
}
BENCHMARK(creep_table_trajectory);

void kalker(benchmark::State& state) {
  int i = 0;
  for (auto _ : state) {
    KalkerCoefficients c = kalker_coefficients(cases()[i++ & (kCases - 1)].ratio, 0.28);
    benchmark::DoNotOptimize(c);
  }
}
BENCHMARK(kalker);

void hertz_table(benchmark::State& state) {
  int i = 0;
  for (auto _ : state) {
    HertzContact h = hertz_contact(1.0, cases()[i++ & (kCases - 1)].ratio, {});
    benchmark::DoNotOptimize(h);
  }
}
BENCHMARK(hertz_table);

void hertz_exact(benchmark::State& state) {
  int i = 0;
  for (auto _ : state) {
    HertzContact h = hertz_contact_exact(1.0, cases()[i++ & (kCases - 1)].ratio, {});
    benchmark::DoNotOptimize(h);
  }
}
BENCHMARK(hertz_exact);

}  // namespace
}  // namespace railtab
