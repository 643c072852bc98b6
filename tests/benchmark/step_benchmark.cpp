// The price of a converged step: eight coaches (64 wheels) on a viaduct of 50 spans, more than 50 000 unknowns of track
// and bridge. Says where the time goes, how many back-substitutions a step needs, and how near the step is to the limit
// that the memory sets: the bytes that it has to read over the bandwidth of a large triad in the same run.
//
//     step_benchmark [TABLE.h5 [spans [smooth|rough [none|window]]]]     without a table the contact is searched online

#include <fmt/format.h>

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "railtab/runtime/algebra/sparse_ldlt.hpp"
#include "railtab/runtime/scene/scene_model.hpp"
#include "railtab/runtime/scene/scene_parameters.hpp"
#include "railtab/runtime/start/static_equilibrium.hpp"
#include "railtab/runtime/structure/track_bridge.hpp"
#include "railtab/runtime/vsi/simulation.hpp"
#include "railtab/runtime/vsi/step.hpp"
#include "railtab/runtime/vsi/step_record.hpp"

namespace {

using namespace railtab;
using Clock = std::chrono::steady_clock;
using Sparse = Eigen::SparseMatrix<double>;

double median_seconds(int repetitions, const std::function<void()>& work) {
  std::vector<double> seconds;
  for (int i = 0; i < repetitions; ++i) {
    const Clock::time_point begin = Clock::now();
    work();
    seconds.push_back(std::chrono::duration<double>(Clock::now() - begin).count());
  }
  std::nth_element(seconds.begin(), seconds.begin() + repetitions / 2, seconds.end());
  return seconds[static_cast<std::size_t>(repetitions / 2)];
}

/// Least times of works that take turns: on a machine with other work, times are never too short.
template <std::size_t n>
std::array<double, n> least_seconds(int rounds, const std::array<std::function<void()>, n>& works) {
  std::array<double, n> least;
  least.fill(std::numeric_limits<double>::infinity());
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i < n; ++i) {
      const Clock::time_point begin = Clock::now();
      works[i]();
      least[i] = std::min(least[i], std::chrono::duration<double>(Clock::now() - begin).count());
    }
  }
  return least;
}

/// a = b + c·d over `bytes` in three arrays; reads and writes counted, [bytes/s].
double triad_bandwidth(std::size_t bytes) {
  const std::size_t n = bytes / (3 * sizeof(double));
  std::vector<double> a(n, 0.0), b(n, 1.0), c(n, 2.0);
  const double seconds = median_seconds(7, [&] {
    for (std::size_t i = 0; i < n; ++i) a[i] = b[i] + 3.0 * c[i];
  });
  return static_cast<double>(bytes) / seconds * (a[n / 2] > 0.0 ? 1.0 : 0.0);
}

SceneParameters viaduct(const std::string& table, int spans) {
  SceneParameters scene;
  scene.name = "viaduct";
  scene.train.count = 8;
  scene.train.start = 20.0;
  scene.contact.mode = table.empty() ? ContactMode::online : ContactMode::table;
  scene.contact.table = table;
  scene.track.length_before = 220.0;
  scene.track.length_after = 60.0;
  scene.spans.resize(static_cast<std::size_t>(spans));
  scene.irregularity = std::string(RAILTAB_SOURCE_DIR) + "/docs/examples/demo_irregularity.csv";
  scene.integration.duration = 0.2;
  return scene;
}

/// Ways to factor and substitute: entry by entry, as Eigen does, in the supernodes of a whole in two orders, and in the
/// sections of the steps.
void compare_factors(const VsiModel& model, const HhtScheme& scheme) {
  const StructureModel& s = *model.structure;
  const Sparse effective = effective_matrix(scheme, s.mass, s.damping, s.stiffness);
  const Eigen::VectorXd load = Eigen::VectorXd::Ones(s.dofs());
  Eigen::VectorXd x(s.dofs()), y(s.dofs());
  const DofRange all{0, s.dofs()};
  const auto supernodes = [&](EliminationOrder order) {
    return std::make_unique<SparseLdlt>(effective, all, "", order);
  };
  const Eigen::SimplicialLDLT<Sparse> entries(effective);
  const auto degree = supernodes(EliminationOrder::minimum_degree);
  const auto dissection = supernodes(EliminationOrder::nested_dissection);
  const StructureResponse response(s, scheme);
  const SubstitutionFactor& sections = response.factor();
  const TreePath nothing = [&] {
    TreePath path;
    sections.find_path({}, path);
    return path;
  }();
  Eigen::VectorXd w(sections.room()), z = Eigen::VectorXd::Zero(sections.room());
  const auto substitute = [&](const SparseLdlt& blocks) {
    blocks.into(load, y);
    blocks.forward(y);
    blocks.backward(y.data());
    blocks.out_of(y, x);
  };
  constexpr int rounds = 101, factorisations = 5;
  const auto solved = least_seconds<4>(
      rounds, {[&] { x = entries.solve(load); }, [&] { substitute(*degree); }, [&] { substitute(*dissection); },
               [&] {
                 sections.into(load, w);
                 sections.forward(w);
                 sections.backward(w, z, nothing);
                 sections.backward_off(nothing, w, z);
                 sections.out_of(z, x);
               }});
  const auto made = least_seconds<3>(factorisations, {[&] { const Eigen::SimplicialLDLT<Sparse> again(effective); },
                                                      [&] { supernodes(EliminationOrder::minimum_degree); },
                                                      [&] { supernodes(EliminationOrder::nested_dissection); }});
  const auto line = [&](const char* name, double seconds, std::size_t bytes, double made_in) {
    fmt::print("  {:<34}{:8.4f} ms {:8.1f} MB {:8.1f} GB/s", name, 1e3 * seconds, 1e-6 * static_cast<double>(bytes),
               2e-9 * static_cast<double>(bytes) / seconds);
    if (made_in > 0.0) fmt::print("   made in {:.4f} ms", 1e3 * made_in);
    fmt::print("\n");
  };
  const std::size_t entry_bytes =
      static_cast<std::size_t>(entries.matrixL().nestedExpression().nonZeros()) * (sizeof(double) + sizeof(int));
  fmt::print("one back-substitution\n");
  line("entries, minimum degree", solved[0], entry_bytes, made[0]);
  line("supernodes, minimum degree", solved[1], degree->bytes(), made[1]);
  line("supernodes, nested dissection", solved[2], dissection->bytes(), made[2]);
  if (response.in_sections()) line("sections side by side", solved[3], sections.bytes(), 0.0);
}

}  // namespace

int main(int argc, char** argv) {
  SceneParameters scene = viaduct(argc > 1 ? argv[1] : "", argc > 2 ? std::atoi(argv[2]) : 50);
  if (argc > 3 && std::string(argv[3]) == "smooth") scene.irregularity.reset();
  if (argc > 4 && std::string(argv[4]) == "window") scene.reduction.kind = Reduction::window;
  const VsiModel model = build_model(scene);
  const HhtScheme scheme{.alpha = scene.integration.alpha, .time_step = scene.integration.time_step};
  const double bandwidth = triad_bandwidth(std::size_t{768} << 20);
  fmt::print("{} degrees of freedom of the structure, {} wheels, contact: {}\n", model.structure->dofs(),
             2 * model.wheelsets(), scene.contact.table.empty() ? "online" : "table");
  fmt::print("memory, triad of 768 MiB: {:.1f} GB/s\n", 1e-9 * bandwidth);
  compare_factors(model, scheme);

  VsiState state(model);
  if (!steady_start(model, state).converged) return 1;
  const VsiState begin = state;
  RunSummary s = simulate(model, scene.integration, scene.integration.duration, 1, state, {});
  if (!s.complete) return 1;
  const auto steps = static_cast<double>(s.steps);
  const double total = s.seconds_total - s.seconds_setup;
  const auto line = [&](const char* name, double seconds) {
    fmt::print("  {:<34}{:8.3f} ms {:7.1f} %\n", name, 1e3 * seconds / steps, 100.0 * seconds / total);
  };
  fmt::print("a step ({} steps, {:.2f} Newton iterations, {:.2f} back-substitutions, {:.3f} halved)\n", s.steps,
             static_cast<double>(s.newton_iterations) / steps, static_cast<double>(s.back_substitutions) / steps,
             static_cast<double>(s.halved_steps) / steps);
  line("structure", s.seconds_structure);
  line("contact look-ups", s.seconds_lookup);
  line("contact forces, tangents, Newton", s.seconds_contact);
  line("vehicle", s.seconds_vehicle);
  line("other",
       total - s.seconds_structure - s.seconds_lookup - s.seconds_contact - s.seconds_vehicle - s.seconds_output);
  line("all", total);

  // The same steps with tangents that each step makes anew.
  IntegrationParameters forgetting = scene.integration;
  forgetting.reinitialise_every = 1;
  std::array<double, 2> contact{};
  for (int round = 0; round < 3; ++round) {
    for (std::size_t i = 0; i < 2; ++i) {
      VsiState again = begin;
      const RunSummary run =
          simulate(model, i == 0 ? scene.integration : forgetting, scene.integration.duration, 1, again, {});
      if (round == 0 || run.seconds_contact < contact[i]) contact[i] = run.seconds_contact;
    }
  }
  fmt::print("contact forces, tangents, Newton: tangents kept {:.4f} ms, made anew {:.4f} ms per step\n",
             1e3 * contact[0] / steps, 1e3 * contact[1] / steps);

  // Once through the memory: the factor twice, the lower triangles of K and C beside each other, and the vectors of the
  // structure that a step reads or writes: 3 of the motion and its load, 4 predictors, the load, the increment.
  const StructureResponse response(*model.structure, scheme);
  const double least = 2.0 * static_cast<double>(response.factor().bytes()) +
                       static_cast<double>(response.load_bytes()) + 20.0 * sizeof(double) * model.structure->dofs();
  fmt::print("memory limit of the structure's part: {:.1f} MB per step, {:.3f} ms, {:.0f} % of its time\n",
             1e-6 * least, 1e3 * least / bandwidth, 100.0 * least / bandwidth * steps / s.seconds_structure);
  return 0;
}
