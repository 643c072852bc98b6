// Set-up of a track with a bridge for one time-step size: factor, and compliance of the rails.

#include <benchmark/benchmark.h>

#include "railtab/runtime/structure/track_bridge.hpp"
#include "railtab/runtime/vsi/structure_response.hpp"

namespace {

using namespace railtab;

StructureModel track(double length) {
  TrackParameters parameters;
  parameters.length_before = parameters.length_after = 0.5 * (length - 32.0);
  return build_track_bridge(parameters, {BridgeParameters{}});
}

constexpr HhtScheme scheme{.alpha = -0.05, .time_step = 5e-4};

void factorise(benchmark::State& state) {
  const StructureModel structure = track(static_cast<double>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(StructureResponse(structure, scheme));
  state.counters["dofs"] = structure.dofs();
}
BENCHMARK(factorise)->Arg(180)->Arg(1000)->Arg(4000)->Unit(benchmark::kMillisecond);

// For the whole length; a run does it where its train is.
void factorise_and_tabulate(benchmark::State& state) {
  const auto length = static_cast<double>(state.range(0));
  const StructureModel structure = track(length);
  for (auto _ : state) {
    StructureResponse response(structure, scheme);
    response.tabulate_compliance(5.0, -length, length);
  }
  state.counters["dofs"] = structure.dofs();
}
BENCHMARK(factorise_and_tabulate)->Arg(180)->Arg(1000)->Arg(4000)->Unit(benchmark::kMillisecond);

void back_substitution(benchmark::State& state) {
  const StructureModel structure = track(static_cast<double>(state.range(0)));
  const StructureResponse response(structure, scheme);
  const Eigen::VectorXd load = Eigen::VectorXd::Ones(structure.dofs());
  for (auto _ : state) benchmark::DoNotOptimize(response.solve(load));
}
BENCHMARK(back_substitution)->Arg(180)->Arg(1000)->Arg(4000)->Unit(benchmark::kMillisecond);

}  // namespace
