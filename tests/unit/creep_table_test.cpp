#include "railtab/tables/creep_table.hpp"

#include <gtest/gtest.h>

#include <unistd.h>

#include <atomic>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <new>
#include <random>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/contact/creep_law.hpp"
#include "railtab/tablegen/creep_layout.hpp"
#include "railtab/tables/creep_coordinates.hpp"
#include "railtab/tables/files/creep_table_file.hpp"

namespace {
std::atomic<long> allocations{0};
}

// Every allocation of this program is counted, to show that look-ups make none.
[[gnu::noinline]] void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace railtab {
namespace {

/// Stands in for the exact solution: linear at small creepage, saturating, with its symmetries.
CreepForce smooth_law(double ratio, const Creepage& c) {
  const CreepScale scale = creep_scale(ratio);
  const double x = scale.x * c.x, y = scale.y * c.y, spin = scale.spin * c.spin;
  const double size = std::sqrt(1.0 + x * x + y * y + spin * spin);
  return {-x / size, -(y + 0.3 * spin) / size, scale.moment * (0.3 * y - 0.4 * spin) / size};
}

CreepLayoutOptions small_layout(CreepTableLayout layout = CreepTableLayout::smooth) {
  CreepLayoutOptions options;
  options.layout = layout;
  options.nodes = {7, 9, 8, 10};
  return options;
}

CreepTableData small_table(CreepTableLayout layout = CreepTableLayout::smooth) {
  const CreepLayoutOptions options = small_layout(layout);
  std::vector<CreepForce> forces;
  for (const CreepCase& c : creep_cases(options)) forces.push_back(smooth_law(c.ratio, c.creepage));
  CreepTableData table = assemble_creep_table(options, forces);
  table.statistics = {{"cases", static_cast<double>(forces.size())}, {"worst_residual", 1e-7}};
  table.provenance = {"0.1.0", "a test", "2026-01-01T00:00:00Z"};
  return table;
}

const CreepTable& table() {
  static const CreepTable built(small_table());
  return built;
}

std::vector<CreepCase> random_cases(int count) {
  std::mt19937_64 generator(3);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::vector<CreepCase> cases;
  for (int i = 0; i < count; ++i) {
    const double size = std::pow(10.0, 1.5 * uniform(generator) - 0.5);
    cases.push_back({std::pow(10.0, 2.0 * uniform(generator)),
                     {size * uniform(generator), size * uniform(generator), size * uniform(generator)}});
  }
  return cases;
}

CreepLookup lookup(const CreepTable& t, const CreepCase& c) {
  return t.lookup(c.ratio, {c.creepage.x, c.creepage.y, c.creepage.spin});
}

TEST(CreepTable, ReturnsWhatWasSolvedAtTheNodes) {
  int checked = 0;
  for (const CreepCase& c : creep_cases(small_layout())) {
    const CreepForce f = smooth_law(c.ratio, c.creepage);
    const CreepLookup found = lookup(table(), c);
    ASSERT_TRUE(found.inside);
    const double moment = creep_scale(c.ratio).moment;
    EXPECT_NEAR(found.force[0], f.x, 3e-6);
    EXPECT_NEAR(found.force[1], f.y, 3e-6);
    EXPECT_NEAR(found.force[2], f.moment, 3e-6 * (1.0 + std::abs(f.moment) + moment));
    ++checked;
  }
  EXPECT_EQ(checked, 7 * (3 + 7 * (1 + 7 * 10)));
}

TEST(CreepTable, CoordinatesAndCreepagesAreInversesOfEachOther) {
  // A table whose values depend on one coordinate only shows where a query lands: here V_x = cos α, F_x = t V_x.
  CreepTableData data = small_table();
  std::size_t i = 0;
  for (std::size_t ratio = 0; ratio < data.nodes[0].size(); ++ratio) {
    for (std::size_t t = 0; t < data.nodes[1].size(); ++t) {
      for (const double alpha : data.nodes[2]) {
        for (std::size_t beta = 0; beta < data.nodes[3].size(); ++beta, ++i) data.values[3 * i] = std::cos(alpha);
      }
    }
  }
  const CreepTable shown(data);
  for (const double ratio : {0.004, 0.3, 1.0, 40.0}) {
    for (const CreepPoint& p : {CreepPoint{0.31, 0.4, 2.9}, CreepPoint{0.9, 1.3, 0.2}, CreepPoint{0.01, 0.9, 1.6}}) {
      const CreepLookup found = shown.lookup(ratio, creepage_at(p, creep_scale(ratio), data.radius_unit));
      EXPECT_NEAR(found.force[0], p.t * std::cos(p.alpha), 2e-4 * p.t) << ratio;
    }
  }
  EXPECT_NEAR(ratio_at(squeezed_ratio(0.37, 4.0), 4.0), 0.37, 1e-14);
}

TEST(CreepTable, NeighbouringQueriesDifferByTheDerivative) {
  // What Newton's method needs near its end: over a step of 1e-6 the chord is the slope to the curvature (the step
  // squared) and rounding of doubles; with sums of floats it would be off by 1e-7 over the step.
  for (const CreepCase& c : random_cases(500)) {
    const CreepScale scale = creep_scale(c.ratio);
    const std::array<double, 3> unit{scale.x, scale.y, scale.spin};
    const std::array<double, 3> u{c.creepage.x, c.creepage.y, c.creepage.spin};
    const double rho = std::hypot(unit[0] * u[0], unit[1] * u[1], unit[2] * u[2]);
    for (std::size_t j = 0; j < 3; ++j) {
      const double step = 1e-6 * rho / unit[j];
      std::array<double, 3> next = u;
      next[j] += step;
      const CreepLookup here = lookup(table(), c), there = table().lookup(c.ratio, next);
      for (std::size_t i = 0; i < 3; ++i) {
        const double mean = 0.5 * (here.derivative[i][j] + there.derivative[i][j]);
        EXPECT_NEAR(there.force[i] - here.force[i], mean * (next[j] - u[j]), 2e-14 * scale.moment)
            << i << j << " at " << c.ratio << ": " << u[0] << ", " << u[1] << ", " << u[2];
      }
    }
  }
}

TEST(CreepTable, DerivativesWithRespectToTheRatioAreThoseOfTheForce) {
  for (const CreepCase& c : random_cases(500)) {
    const std::array<double, 3> u{c.creepage.x, c.creepage.y, c.creepage.spin};
    const CreepLookup found = table().jet(c.ratio, u);
    const double step = 1e-5 * c.ratio, moment = creep_scale(c.ratio).moment;
    const CreepLookup above = table().lookup(c.ratio + step, u), below = table().lookup(c.ratio - step, u);
    EXPECT_EQ(found.force, lookup(table(), c).force);
    if (!above.inside || !below.inside) continue;
    for (std::size_t i = 0; i < 3; ++i) {
      const double difference = (above.force[i] - below.force[i]) / (2.0 * step);
      EXPECT_NEAR(found.by_ratio[i] * c.ratio, difference * c.ratio, 1e-5 * (i == 2 ? 1.0 + moment : 1.0)) << c.ratio;
    }
  }
}

TEST(CreepTable, QueriesSideBySideAreThoseOfSingleOnes) {
  constexpr int count = WheelLanes::count;
  constexpr std::array<double, 8> x{0.1, -0.2, 0.0, 0.3, 0.0, -0.1, 0.2, 1e-9},
      y{0.2, 0.1, -0.3, 0.0, 0.0, -0.2, 0.1, 0.0}, spin{-0.1, 0.2, 0.1, -0.2, 0.0, 0.3, 0.0, 0.2};
  for (const CreepTableLayout layout : {CreepTableLayout::smooth, CreepTableLayout::paper}) {
    const CreepTable table(small_table(layout));
    for (std::size_t first = 0; first < x.size(); first += count) {
      WheelLanes ratio;
      std::array<WheelLanes, 3> creepage;
      for (int i = 0; i < count; ++i) {
        const std::size_t k = first + static_cast<std::size_t>(i);
        ratio[i] = 0.6 + 0.15 * static_cast<double>(k);
        creepage[0][i] = x[k];
        creepage[1][i] = y[k];
        creepage[2][i] = spin[k];
      }
      const CreepLookupOf<WheelLanes> jet = table.jet(ratio, creepage);
      const std::array<WheelLanes, 3> force = table.force(ratio, creepage);
      for (int i = 0; i < count; ++i) {
        const std::array<double, 3> at{creepage[0][i], creepage[1][i], creepage[2][i]};
        const CreepLookup one = table.jet(ratio[i], at);
        const std::array<double, 3> alone = table.force(ratio[i], at);
        ASSERT_TRUE(one.inside);
        for (std::size_t k = 0; k < 3; ++k) {
          EXPECT_NEAR(jet.force[k][i], one.force[k], 1e-14);
          EXPECT_NEAR(force[k][i], one.force[k], 1e-14);
          EXPECT_NEAR(alone[k], one.force[k], 1e-14);
          EXPECT_NEAR(jet.by_ratio[k][i], one.by_ratio[k], 1e-13);
          for (std::size_t j = 0; j < 3; ++j) EXPECT_NEAR(jet.derivative[k][j][i], one.derivative[k][j], 1e-12);
        }
      }
    }
  }
}

TEST(CreepTable, DerivativesAreThoseOfTheForce) {
  for (const CreepCase& c : random_cases(500)) {
    const CreepLookup found = lookup(table(), c);
    const CreepScale scale = creep_scale(c.ratio);
    const std::array<double, 3> unit{scale.x, scale.y, scale.spin};
    const std::array<double, 3> u{c.creepage.x, c.creepage.y, c.creepage.spin};
    const double rho = std::hypot(unit[0] * u[0], unit[1] * u[1], unit[2] * u[2]);
    for (std::size_t j = 0; j < 3; ++j) {
      const double step = 2e-3 * (0.05 + rho) / unit[j];
      std::array<double, 3> up = u, down = u;
      up[j] += step;
      down[j] -= step;
      const CreepLookup above = table().lookup(c.ratio, up), below = table().lookup(c.ratio, down);
      for (std::size_t i = 0; i < 3; ++i) {
        const double difference = (above.force[i] - below.force[i]) / (2.0 * step);
        const double size = (i == 2 ? scale.moment : 1.0) * unit[j] / (1.0 + rho);
        EXPECT_NEAR(found.derivative[i][j], difference, 5e-3 * size)
            << i << j << " at " << c.ratio << ": " << u[0] << ", " << u[1] << ", " << u[2];
      }
    }
  }
}

TEST(CreepTable, HasTheExactSymmetries) {
  for (const CreepCase& c : random_cases(200)) {
    const CreepLookup f = lookup(table(), c);
    const CreepLookup x = table().lookup(c.ratio, {-c.creepage.x, c.creepage.y, c.creepage.spin});
    EXPECT_EQ(x.force[0], -f.force[0]);
    EXPECT_EQ(x.force[1], f.force[1]);
    EXPECT_EQ(x.force[2], f.force[2]);
    EXPECT_EQ(x.derivative[1][0], -f.derivative[1][0]);
    const CreepLookup yz = table().lookup(c.ratio, {c.creepage.x, -c.creepage.y, -c.creepage.spin});
    EXPECT_EQ(yz.force[0], f.force[0]);
    EXPECT_EQ(yz.force[1], -f.force[1]);
    EXPECT_EQ(yz.force[2], -f.force[2]);
    EXPECT_EQ(yz.derivative[0][1], -f.derivative[0][1]);
    EXPECT_EQ(yz.derivative[1][2], f.derivative[1][2]);
  }
}

TEST(CreepTable, IsContinuousWhereTheSymmetriesFold) {
  // Across spin = 0, across υx = 0, and through pure longitudinal creepage.
  const double h = 1e-9;
  for (const double ratio : {0.02, 1.0, 30.0}) {
    for (const std::array<double, 3>& u :
         {std::array{0.3, 0.2, 0.0}, std::array{0.3, -0.2, 0.0}, std::array{0.0, 0.2, 0.4}, std::array{0.5, 0.0, 0.0},
          std::array{0.0, 0.7, 0.0}}) {
      for (std::size_t j = 0; j < 3; ++j) {
        std::array<double, 3> up = u, down = u;
        up[j] += h;
        down[j] -= h;
        const CreepLookup above = table().lookup(ratio, up), below = table().lookup(ratio, down);
        for (std::size_t i = 0; i < 3; ++i) {
          EXPECT_NEAR(above.force[i], below.force[i], 1e-5 * creep_scale(ratio).moment);
          for (std::size_t k = 0; k < 3; ++k) {
            const CreepScale s = creep_scale(ratio);
            const double size = std::array{s.x, s.y, s.spin}[k] * (i == 2 ? s.moment : 1.0);
            EXPECT_NEAR(above.derivative[i][k], below.derivative[i][k], 2e-3 * size) << ratio << ' ' << i << k << j;
          }
        }
      }
    }
  }
}

TEST(CreepTable, LimitIsLinearTheoryAtZeroCreepage) {
  const double ratio = table().data().nodes[0][3];
  const CreepLookup zero = table().lookup(ratio, {0.0, 0.0, 0.0});
  ASSERT_TRUE(zero.inside);
  for (const double f : zero.force) EXPECT_EQ(f, 0.0);
  const double h = 1e-6;
  const CreepForce x = smooth_law(ratio, {h, 0, 0}), y = smooth_law(ratio, {0, h, 0}), s = smooth_law(ratio, {0, 0, h});
  const auto& d = zero.derivative;
  EXPECT_NEAR(d[0][0] * h / x.x, 1.0, 1e-5);
  // Along α and β the directions are interpolated: by cubics through sines.
  EXPECT_NEAR(d[1][1] * h / y.y, 1.0, 5e-3);
  EXPECT_NEAR(d[1][2] * h / s.y, 1.0, 5e-3);
  EXPECT_NEAR(d[2][1] * h / y.moment, 1.0, 5e-3);
  EXPECT_NEAR(d[2][2] * h / s.moment, 1.0, 5e-3);
  EXPECT_NEAR(d[0][1], 0.0, 1e-6);
  const CreepLookup small = table().lookup(ratio, {0.0, 1e-12, 0.0});
  EXPECT_NEAR(small.force[1] / (1e-12 * y.y / h), 1.0, 5e-3);
}

TEST(CreepTable, LimitIsFullSlidingAtInfiniteCreepage) {
  const double ratio = table().data().nodes[0][3];
  for (const double size : {1e9, 1e150, 1e308}) {
    const CreepLookup x = table().lookup(ratio, {size, 0.0, 0.0});
    EXPECT_NEAR(x.force[0], -1.0, 1e-6);
    EXPECT_NEAR(x.force[1], 0.0, 1e-6);
    const CreepLookup spin = table().lookup(ratio, {0.0, 0.0, -size});
    // Pure spin of the circle: ∫ p r dA = 3π/16 (a/b = 1 is the axis' middle).
    EXPECT_NEAR(ratio, 1.0, 1e-12);
    EXPECT_NEAR(spin.force[2], 3.0 * 3.14159265358979 / 16.0, 5e-3);
    for (const auto& row : spin.derivative) {
      for (const double d : row) EXPECT_TRUE(std::isfinite(d));
    }
  }
}

TEST(CreepTable, OutsideIsAStatus) {
  for (const double ratio : {0.5e-3, 2e3, std::nan("")}) EXPECT_FALSE(table().lookup(ratio, {0.1, 0, 0}).inside);
  EXPECT_TRUE(table().lookup(1e-3, {0.1, 0, 0}).inside);
  EXPECT_TRUE(table().lookup(1e3, {0.1, 0, 0}).inside);
}

// The memory of what look-ups do not read goes back.
TEST(CreepTable, TheSplineStandsInPlaceOfTheValues) {
  EXPECT_EQ(table().data().values.capacity(), 0U);
  EXPECT_FALSE(CreepTable(small_table(CreepTableLayout::paper)).data().values.empty());
}

TEST(CreepTable, LooksUpWithoutAllocation) {
  const std::vector<CreepCase> cases = random_cases(100);
  static_cast<void>(table());
  const CreepTable paper(small_table(CreepTableLayout::paper));
  const long before = allocations;
  double sum = 0.0;
  for (const CreepCase& c : cases) sum += lookup(table(), c).force[0] + lookup(paper, c).force[0];
  EXPECT_EQ(allocations, before);
  EXPECT_TRUE(std::isfinite(sum));
}

TEST(CreepTable, PaperLayoutHasItsNodesAndIsLinearBetweenThem) {
  const CreepTableData data = small_table(CreepTableLayout::paper);
  EXPECT_EQ(data.nodes[0].size(), 20U);
  EXPECT_EQ(data.nodes[1].size(), 20U);
  EXPECT_EQ(data.nodes[2].size(), 20U);
  EXPECT_EQ(data.nodes[3].size(), 39U) << "20 of each sign, zero once";
  EXPECT_DOUBLE_EQ(data.nodes[0].front(), 1e-3);
  EXPECT_NEAR(data.nodes[3].back(), 1e3, 1e-9);
  const CreepTable paper(data);
  const auto at = [&](double ratio, double x, double y, double spin) { return paper.lookup(ratio, {x, y, spin}); };
  const double r0 = data.nodes[0][12], r1 = data.nodes[0][13], x0 = data.nodes[1][2], x1 = data.nodes[1][3];
  const CreepForce corner = smooth_law(r0, {x0, 0.0, -1.0});
  EXPECT_NEAR(at(r0, x0, 0.0, -1.0).force[0], corner.x, 1e-12);
  EXPECT_NEAR(at(r0, x0, 0.0, -1.0).force[2], corner.moment, 1e-12);
  const double middle = at(0.5 * (r0 + r1), 0.5 * (x0 + x1), 0.0, -1.0).force[0];
  const double mean = 0.25 * (smooth_law(r0, {x0, 0, -1}).x + smooth_law(r1, {x0, 0, -1}).x +
                              smooth_law(r0, {x1, 0, -1}).x + smooth_law(r1, {x1, 0, -1}).x);
  EXPECT_NEAR(middle, mean, 1e-12);
  const double h = 1e-6;
  const double slope = (at(2.0, 0.4 + h, -0.3, 0.7).force[1] - at(2.0, 0.4 - h, -0.3, 0.7).force[1]) / (2 * h);
  EXPECT_NEAR(at(2.0, 0.4, -0.3, 0.7).derivative[1][0], slope, 1e-8);
  EXPECT_FALSE(at(1.0, 1.1e3, 0, 0).inside);
}

TEST(CreepTable, RejectsWhatIsNotATable) {
  const auto rejected = [](const auto& spoil) {
    CreepTableData data = small_table();
    spoil(data);
    EXPECT_THROW(CreepTable{data}, InputError);
  };
  rejected([](CreepTableData& d) { d.values.pop_back(); });
  rejected([](CreepTableData& d) { d.values[7] = std::nan(""); });
  rejected([](CreepTableData& d) { std::swap(d.nodes[1][2], d.nodes[1][3]); });
  rejected([](CreepTableData& d) { d.nodes[2][3] += 1e-3; });
  rejected([](CreepTableData& d) { d.radius_unit = 0.0; });
  rejected([](CreepTableData& d) {
    for (double& ratio : d.nodes[0]) ratio = ratio_at(1.1 * squeezed_ratio(ratio, d.ratio_stretch), d.ratio_stretch);
  });
  CreepTableData single = small_table(CreepTableLayout::paper);
  single.values.resize(single.values.size() / single.nodes[2].size());
  single.nodes[2].resize(1);
  EXPECT_THROW(CreepTable{single}, InputError) << "a cell has two ends";
  EXPECT_THROW(static_cast<void>(assemble_creep_table(small_layout(), std::vector<CreepForce>(5))), InputError);
}

class CreepTableFile : public ::testing::Test {
 protected:
  ~CreepTableFile() override { std::filesystem::remove(file_); }
  std::filesystem::path file_ =
      std::filesystem::temp_directory_path() / ("railtab_creep_table_" + std::to_string(::getpid()) + ".h5");
};

TEST_F(CreepTableFile, ReturnsTheTableWithValuesOf32Bits) {
  for (const CreepTableLayout layout : {CreepTableLayout::smooth, CreepTableLayout::paper}) {
    const CreepTableData written = small_table(layout);
    write_creep_table(file_, written);
    const CreepTableData read = read_creep_table(file_);
    EXPECT_EQ(read.layout, written.layout);
    EXPECT_EQ(read.nodes, written.nodes);
    EXPECT_EQ(read.poisson, written.poisson);
    EXPECT_EQ(read.elements, written.elements);
    EXPECT_EQ(read.ratio_stretch, written.ratio_stretch);
    EXPECT_EQ(read.radius_unit, written.radius_unit);
    EXPECT_EQ(read.statistics, written.statistics);
    EXPECT_EQ(read.provenance.command_line, written.provenance.command_line);
    ASSERT_EQ(read.values.size(), written.values.size());
    for (std::size_t i = 0; i < read.values.size(); ++i) {
      EXPECT_EQ(read.values[i], static_cast<double>(static_cast<float>(written.values[i])));
    }
  }
}

TEST_F(CreepTableFile, RejectsDamageAndOtherFiles) {
  EXPECT_THROW(static_cast<void>(read_creep_table("absent.h5")), InputError);
  write_creep_table(file_, small_table());
  const auto size = std::filesystem::file_size(file_);
  {
    std::fstream bytes(file_, std::ios::binary | std::ios::in | std::ios::out);
    bytes.seekp(static_cast<std::streamoff>(size / 2));
    bytes.put('\x55');
  }
  EXPECT_THROW(static_cast<void>(read_creep_table(file_)), InputError);
  std::filesystem::resize_file(file_, size / 2);
  EXPECT_THROW(static_cast<void>(read_creep_table(file_)), InputError);
}

}  // namespace
}  // namespace railtab
