// A time step allocates nothing: every call of this program and its libraries for memory is counted.

#include <gtest/gtest.h>

#include <cerrno>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "loaded_table_fixture.hpp"
#include "railtab/runtime/scene/scene_model.hpp"
#include "railtab/runtime/scene/scene_run.hpp"
#include "railtab/runtime/start/static_equilibrium.hpp"
#include "railtab/runtime/vsi/simulation.hpp"

#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__)

namespace {
thread_local long allocations = 0;
}

// NOLINTBEGIN: names of the C library
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* block, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);

void* malloc(std::size_t size) {
  ++allocations;
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) {
  ++allocations;
  return __libc_calloc(count, size);
}
void* realloc(void* block, std::size_t size) {
  ++allocations;
  return __libc_realloc(block, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  ++allocations;
  return __libc_memalign(alignment, size);
}
int posix_memalign(void** block, std::size_t alignment, std::size_t size) {
  ++allocations;
  *block = __libc_memalign(alignment, size);
  return *block ? 0 : ENOMEM;
}
}
// NOLINTEND

namespace railtab {
namespace {

/// A coach on the approach to a bridge, on a rough track.
SceneParameters approach() {
  SceneParameters scene;
  scene.contact.mode = ContactMode::online;
  scene.train.start = 0.0;
  scene.train.speed = 30.0;
  scene.track.length_before = 60.0;
  scene.track.length_after = 40.0;
  scene.spans.resize(1);
  scene.spans.front().length = 16.0;
  scene.integration.time_step = 1e-3;
  return scene;
}

/// Of steps of a run, after those in which vectors grow to their sizes, and before the compliances of the rails are
/// tabulated farther on.
std::vector<long> allocations_of_steps(const SceneParameters& scene, const VsiModel& model) {
  constexpr int warm_up = 200, counted = 120;
  VsiState state(model);
  EXPECT_TRUE(steady_start(model, state).converged);
  std::vector<long> after;
  after.reserve(warm_up + counted + 2);
  RunObserver observer;
  observer.state = [&](const VsiState&) { after.push_back(allocations); };
  const double duration = (warm_up + counted) * scene.integration.time_step;
  const RunSummary run = simulate(model, scene.integration, duration, warm_up + counted, state, observer);
  EXPECT_TRUE(run.complete) << run.message;
  EXPECT_GT(run.newton_iterations, 0);
  std::vector<long> of_steps;
  for (std::size_t i = warm_up + 1; i < after.size(); ++i) of_steps.push_back(after[i] - after[i - 1]);
  return of_steps;
}

void expect_none(const std::vector<long>& of_steps) {
  ASSERT_FALSE(of_steps.empty());
  for (std::size_t i = 0; i < of_steps.size(); ++i) EXPECT_EQ(of_steps[i], 0) << "step " << i << " of those counted";
}

TEST(StepAllocation, IsCounted) {
  const long before = allocations;
  EXPECT_NE(std::make_unique<std::vector<double>>(1000), nullptr);
  EXPECT_GE(allocations, before + 2);
}

TEST(StepAllocation, NoneWithContactsSearched) {
  const SceneParameters scene = approach();
  expect_none(allocations_of_steps(scene, build_model(scene)));
}

TEST(StepAllocation, NoneWithLoadedContacts) {
  const SceneParameters scene = approach();
  VsiModel model = build_model(scene);
  LoadedSweepOptions options = tread_options();
  options.lateral = {-1.0e-3, 1.0e-3};
  options.levels = 9;
  options.force_error = options.light_error = 0.1;
  options.contact.elements.across_narrowest = 8;
  model.geometry = std::make_shared<const ContactGeometry>(
      s1002_on_60e1(), std::make_shared<const LoadedTable>(sweep_loaded(s1002_on_60e1(), options)));
  model.contact.geometry = model.geometry.get();
  const std::vector<long> of_steps = allocations_of_steps(scene, model);
  expect_none(of_steps);
}

}  // namespace
}  // namespace railtab

#endif
