// A time step with Hertz's or loaded contacts allocates nothing: calls for memory of this thread are counted, those of
// libraries too.

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

// Sanitizers have calls of their own.
#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || __has_feature(memory_sanitizer)
#define RAILTAB_INSTRUMENTED
#endif
#endif
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || !defined(__GLIBC__)
#define RAILTAB_INSTRUMENTED
#endif

namespace {
thread_local long allocations = 0;
}

#if !defined(RAILTAB_INSTRUMENTED)

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
#endif

namespace railtab {
namespace {

class StepAllocation : public ::testing::Test {
 protected:
  void SetUp() override {
#if defined(RAILTAB_INSTRUMENTED)
    GTEST_SKIP() << "calls for memory are not counted under a sanitizer or another C library";
#endif
  }
};

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

struct CountedRun {
  RunSummary summary;
  std::vector<long> of_steps;
};

/// The allocations of steps after those in which vectors grow to their sizes, and before the compliances of the rails
/// are tabulated farther on.
CountedRun counted_run(const SceneParameters& scene, const VsiModel& model) {
  constexpr int warm_up = 200, counted = 120;
  VsiState state(model);
  EXPECT_TRUE(steady_start(model, state).converged);
  std::vector<long> after;
  after.reserve(warm_up + counted + 2);
  RunObserver observer;
  observer.state = [&](const VsiState&) { after.push_back(allocations); };
  const double duration = (warm_up + counted) * scene.integration.time_step;
  CountedRun run;
  run.summary = simulate(model, scene.integration, duration, warm_up + counted, state, observer);
  EXPECT_TRUE(run.summary.complete) << run.summary.message;
  EXPECT_GT(run.summary.newton_iterations, 0);
  for (std::size_t i = warm_up + 1; i < after.size(); ++i) run.of_steps.push_back(after[i] - after[i - 1]);
  return run;
}

void expect_none(const std::vector<long>& of_steps) {
  ASSERT_FALSE(of_steps.empty());
  for (std::size_t i = 0; i < of_steps.size(); ++i) EXPECT_EQ(of_steps[i], 0) << "step " << i << " of those counted";
}

TEST_F(StepAllocation, IsCounted) {
  const long before = allocations;
  EXPECT_NE(std::make_unique<std::vector<double>>(1000), nullptr);
  EXPECT_GE(allocations, before + 2);
}

TEST_F(StepAllocation, NoneWithContactsSearched) {
  const SceneParameters scene = approach();
  const CountedRun run = counted_run(scene, build_model(scene));
  EXPECT_EQ(run.summary.table_queries, 0);
  expect_none(run.of_steps);
}

TEST_F(StepAllocation, NoneWithLoadedContacts) {
  const SceneParameters scene = approach();
  VsiModel model = build_model(scene);
  LoadedSweepOptions options = tread_options();
  options.lateral = {-1.0e-3, 1.0e-3};
  options.roll = {-6e-3, 6e-3};  // rails roll under the wheels
  options.roll_spacing = 3e-3;
  options.levels = 9;
  options.force_error = options.light_error = 0.1;
  options.contact.elements.across_narrowest = 8;
  model.geometry = std::make_shared<const ContactGeometry>(
      s1002_on_60e1(), std::make_shared<const LoadedTable>(sweep_loaded(s1002_on_60e1(), options)));
  model.contact.geometry = model.geometry.get();
  const CountedRun run = counted_run(scene, model);
  EXPECT_GT(run.summary.table_queries, run.summary.contact_queries / 2) << "the table answers";
  expect_none(run.of_steps);
}

}  // namespace
}  // namespace railtab
