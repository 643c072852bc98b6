#include "railtab/tables/geometry_table.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "railtab/tables/input_error.hpp"

namespace railtab {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

std::vector<double> uniform(double low, double high, int nodes) {
  std::vector<double> x;
  for (int i = 0; i < nodes; ++i) x.push_back(low + (high - low) * i / (nodes - 1));
  return x;
}

/// A table of empty grid over these axes, R0 = 0.5 m.
GeometryTableData empty_table(std::vector<double> lateral, std::vector<double> yaw_squared, std::vector<double> roll) {
  GeometryTableData data;
  data.nominal_radius = 0.5;
  data.lateral = std::move(lateral);
  data.yaw_squared = std::move(yaw_squared);
  data.roll = std::move(roll);
  const auto cells = [](const std::vector<double>& x) { return x.size() > 1 ? x.size() - 1 : 1; };
  data.trusted_lowering.assign(cells(data.lateral) * cells(data.yaw_squared) * cells(data.roll), infinity);
  return data;
}

/// A branch over the whole grid with z = f, s_wheel = 2f, s_rail = -f and their lateral derivatives from df.
template <typename F, typename DF>
GeometryBranch branch_of(const GeometryTableData& d, const F& f, const DF& df) {
  GeometryBranch b;
  b.size = {static_cast<int>(d.lateral.size()), static_cast<int>(d.yaw_squared.size()),
            static_cast<int>(d.roll.size())};
  for (double r : d.roll)
    for (double q : d.yaw_squared)
      for (double t : d.lateral) {
        b.z_touch.push_back(f(t, q, r));
        b.z_touch_dy.push_back(df(t, q, r));
        b.s_wheel.push_back(2 * f(t, q, r));
        b.s_wheel_dy.push_back(2 * df(t, q, r));
        b.s_rail.push_back(-f(t, q, r));
        b.s_rail_dy.push_back(-df(t, q, r));
      }
  return b;
}

void remove_node(GeometryBranch& b, std::size_t n) {
  for (std::vector<double>* v : {&b.z_touch, &b.z_touch_dy, &b.s_wheel, &b.s_wheel_dy, &b.s_rail, &b.s_rail_dy}) {
    (*v)[n] = nan;
  }
}

TEST(GridAxis, LocatesEveryValueInUniformAndUnevenAxes) {
  std::mt19937 random(3);
  for (const std::vector<double>& nodes :
       {uniform(-0.012, 0.012, 241), std::vector<double>{-1, -0.9, 0, 0.25, 7}, std::vector<double>{2, 3}}) {
    const GridAxis axis("test", nodes);
    std::uniform_real_distribution<double> inside(nodes.front(), nodes.back());
    for (int n = 0; n < 2000; ++n) {
      const double x = n < static_cast<int>(nodes.size()) ? nodes[n] : inside(random);
      const GridAxis::Cell cell = axis.locate(x);
      ASSERT_TRUE(cell.inside);
      ASSERT_GE(cell.index, 0);
      ASSERT_LT(cell.index, axis.cells());
      EXPECT_GE(cell.fraction, 0.0);
      EXPECT_LE(cell.fraction, 1.0);
      EXPECT_NEAR(nodes[cell.index] + cell.fraction * cell.width, x, 1e-15);
    }
    EXPECT_FALSE(axis.locate(std::nextafter(nodes.front(), -infinity)).inside);
    EXPECT_FALSE(axis.locate(std::nextafter(nodes.back(), infinity)).inside);
    EXPECT_FALSE(axis.locate(nan).inside);
  }
}

TEST(GridAxis, SingleNodeHoldsItsValueOnly) {
  const GridAxis axis("roll", {0.002});
  EXPECT_TRUE(axis.locate(0.002).inside);
  EXPECT_TRUE(axis.locate(0.002 + 0.9e-12).inside);
  EXPECT_FALSE(axis.locate(0.002 + 1.1e-12).inside);
  EXPECT_FALSE(axis.locate(nan).inside);
}

TEST(GridAxis, RefusesDisorder) {
  EXPECT_THROW(GridAxis("yaw", {}), InputError);
  EXPECT_THROW(GridAxis("yaw", {0, 1, 1}), InputError);
  EXPECT_THROW(GridAxis("yaw", {0, nan}), InputError);
}

// Cubic Hermite reproduces cubics along the lateral axis, three-point slopes reproduce parabolas across yaw² and roll.
TEST(GeometryTable, ReproducesCubicTimesParabolas) {
  const auto f = [](double t, double q, double r) {
    return (1 + 2 * t - 3 * t * t + 4 * t * t * t) * (1 + q - 2 * q * q) * (2 - r + 3 * r * r);
  };
  const auto df = [](double t, double q, double r) {
    return (2 - 6 * t + 12 * t * t) * (1 + q - 2 * q * q) * (2 - r + 3 * r * r);
  };
  GeometryTableData data = empty_table(uniform(-1, 1, 7), {0.0, 0.1, 0.3, 0.4}, {-0.2, 0.0, 0.1, 0.3});
  data.branches.push_back(branch_of(data, f, df));
  const GeometryTable table(data);
  std::mt19937 random(11);
  std::uniform_real_distribution<double> t(-1, 1), yaw(-std::sqrt(0.4), std::sqrt(0.4)), roll(-0.2, 0.3);
  for (int n = 0; n < 500; ++n) {
    const double tn = t(random), yn = yaw(random), rn = roll(random);
    const GeometryTable::Lookup lookup = table.lookup(tn + 0.5 * rn, yn, rn);
    ASSERT_EQ(lookup.status, GeometryTable::Status::inside);
    ASSERT_EQ(lookup.count, 1);
    EXPECT_EQ(lookup.trusted_lowering, infinity);
    const BranchValue& b = lookup.branch[0];
    // Rounding: values up to 30, slopes up to 60, a few hundred operations.
    EXPECT_NEAR(b.z_touch, f(tn, yn * yn, rn), 1e-13);
    EXPECT_NEAR(b.z_touch_dy, df(tn, yn * yn, rn), 1e-12);
    EXPECT_NEAR(b.s_wheel, 2 * b.z_touch, 1e-13);
    EXPECT_NEAR(b.s_rail_dy, -b.z_touch_dy, 1e-12);
  }
}

// Value and both outer derivatives continuous across nodes; the convergence order is that of cubic Hermite, 4.
TEST(GeometryTable, IsSmoothAcrossNodesAndConvergesWithFourthOrder) {
  const auto f = [](double t, double q, double) { return std::sin(3 * t) * std::exp(q); };
  const auto df = [](double t, double q, double) { return 3 * std::cos(3 * t) * std::exp(q); };
  std::vector<double> errors;
  for (int nodes : {11, 21, 41}) {
    GeometryTableData data = empty_table(uniform(-1, 1, nodes), {0.0, 0.1, 0.2, 0.3}, {0.0});
    data.branches.push_back(branch_of(data, f, df));
    const GeometryTable table(data);
    double error = 0;
    for (double t = -0.999; t < 1; t += 0.00173) {
      error = std::max(error, std::abs(table.lookup(t, 0, 0).branch[0].z_touch - f(t, 0, 0)));
    }
    errors.push_back(error);
    const double e = 1e-9;
    const double q = 0.1;  // a node of yaw²
    const auto z = [&](double square) { return table.lookup(0.317, std::sqrt(square), 0).branch[0].z_touch; };
    EXPECT_NEAR(z(q - e), z(q + e), 3e-9);
    EXPECT_NEAR((z(q) - z(q - 1e-5)) / 1e-5, (z(q + 1e-5) - z(q)) / 1e-5, 1e-3);
  }
  for (std::size_t n = 1; n < errors.size(); ++n) {
    const double order = std::log2(errors[n - 1] / errors[n]);
    EXPECT_GT(order, 3.7);
    EXPECT_LT(order, 4.3);
  }
}

TEST(GeometryTable, LeavingTheTableIsAStatus) {
  GeometryTableData data = empty_table({0, 1}, {0.0}, {0.0});
  const auto one = [](double, double, double) { return 1.0; };
  const auto zero = [](double, double, double) { return 0.0; };
  data.branches.push_back(branch_of(data, one, zero));
  const GeometryTable table(data);
  EXPECT_EQ(table.lookup(0.5, 0, 0).status, GeometryTable::Status::inside);
  EXPECT_EQ(table.lookup(0.5, 0.9e-12, 0).status, GeometryTable::Status::inside);
  for (const auto& [y, yaw, roll] :
       {std::array{-1e-9, 0.0, 0.0}, std::array{1 + 1e-9, 0.0, 0.0}, std::array{0.5, 1e-9, 0.0},
        std::array{0.5, 0.0, 1e-9}, std::array{nan, 0.0, 0.0}, std::array{0.5, nan, 0.0}, std::array{0.5, 0.0, nan}}) {
    const GeometryTable::Lookup lookup = table.lookup(y, yaw, roll);
    EXPECT_EQ(lookup.status, GeometryTable::Status::outside);
    EXPECT_EQ(lookup.count, 0);
  }
}

TEST(GeometryTable, ABranchIsServedOnlyWhereItIsWhole) {
  GeometryTableData data = empty_table(uniform(0, 4, 5), {0.0, 1.0, 2.0}, {0.0});
  const auto f = [](double t, double, double) { return t; };
  const auto df = [](double, double, double) { return 1.0; };
  data.branches.push_back(branch_of(data, f, df));
  remove_node(data.branches[0], 5 + 2);  // lateral 2, yaw² 1: the corner of cells 1 and 2 of both yaw rows
  for (const std::size_t cell : {1, 2, 5, 6}) data.trusted_lowering[cell] = 1e-4;
  const GeometryTable table(data);
  for (int row = 0; row < 2; ++row)
    for (int i = 0; i < 4; ++i) {
      const GeometryTable::Lookup lookup = table.lookup(i + 0.5, std::sqrt(row + 0.5), 0);
      const bool damaged = i == 1 || i == 2;
      EXPECT_EQ(lookup.count, damaged ? 0 : 1);
      EXPECT_EQ(lookup.trusted_lowering, damaged ? 1e-4 : infinity);
      if (!damaged) {
        EXPECT_NEAR(lookup.branch[0].z_touch, i + 0.5, 1e-14);
      }
    }
  data.trusted_lowering[6] = infinity;  // an incomplete branch must be flagged
  EXPECT_THROW(GeometryTable{data}, InputError);
}

TEST(GeometryTable, MoreBranchesThanALookUpHoldsAreNotTrusted) {
  GeometryTableData data = empty_table({0, 1}, {0.0}, {0.0});
  for (int n = 0; n < GeometryTable::max_branches + 1; ++n) {
    data.branches.push_back(branch_of(
        data, [n](double, double, double) { return 10.0 - n; }, [](double, double, double) { return 0.0; }));
  }
  const GeometryTable::Lookup lookup = GeometryTable(data).lookup(0.5, 0, 0);
  EXPECT_EQ(lookup.count, GeometryTable::max_branches);
  EXPECT_EQ(lookup.trusted_lowering, 0.0);
  EXPECT_EQ(lookup.branch[0].z_touch, 2.0);  // the lowest are kept
}

TEST(GeometryTable, ALookUpReturnsTheWindowsOfItsCell) {
  GeometryTableData data = empty_table({0, 1, 2, 3}, {0.0}, {0.0});
  data.trusted_lowering = {0.0, 1e-4, 0.0};
  data.windows = {{0, 0.01, 0.02}, {0, 0.03, 0.04}, {2, 0.05, 0.06}};
  data.searched_lowering = 1e-3;
  const GeometryTable table(data);
  const GeometryTable::Lookup first = table.lookup(0.5, 0, 0);
  ASSERT_EQ(first.windows.size(), 2u);
  EXPECT_EQ(first.windows[1].s_low, 0.03);
  EXPECT_TRUE(table.lookup(1.5, 0, 0).windows.empty());
  ASSERT_EQ(table.lookup(2.5, 0, 0).windows.size(), 1u);
  EXPECT_EQ(table.lookup(2.5, 0, 0).windows[0].s_high, 0.06);
}

TEST(GeometryTable, RefusesWindowsOutOfOrder) {
  GeometryTableData good = empty_table({0, 1, 2}, {0.0}, {0.0});
  good.windows = {{0, 0.01, 0.02}, {1, 0.01, 0.02}};
  EXPECT_NO_THROW(GeometryTable{good});
  const auto refused = [&](const std::vector<SearchWindow>& windows) {
    GeometryTableData bad = good;
    bad.windows = windows;
    EXPECT_THROW(GeometryTable{bad}, InputError);
  };
  refused({{1, 0.01, 0.02}, {0, 0.01, 0.02}});
  refused({{0, 0.01, 0.02}, {0, 0.015, 0.03}});
  refused({{2, 0.01, 0.02}});
  refused({{-1, 0.01, 0.02}});
  refused({{0, 0.02, 0.01}});
  refused({{0, 0.01, nan}});
}

TEST(GeometryTable, RefusesWrongShapesAndNumbers) {
  const auto f = [](double t, double, double) { return t; };
  const auto df = [](double, double, double) { return 1.0; };
  GeometryTableData good = empty_table({0, 1, 2}, {0.0, 1.0}, {0.0});
  good.branches.push_back(branch_of(good, f, df));
  EXPECT_NO_THROW(GeometryTable{good});
  GeometryTableData bad = good;
  bad.trusted_lowering.pop_back();
  EXPECT_THROW(GeometryTable{bad}, InputError);
  bad = good;
  bad.trusted_lowering[0] = nan;
  EXPECT_THROW(GeometryTable{bad}, InputError);
  bad = good;
  bad.branches[0].s_rail.pop_back();
  EXPECT_THROW(GeometryTable{bad}, InputError);
  bad = good;
  bad.branches[0].first[0] = 1;
  EXPECT_THROW(GeometryTable{bad}, InputError);
  bad = good;
  bad.branches[0].s_wheel[2] = nan;
  EXPECT_THROW(GeometryTable{bad}, InputError);
  bad = good;
  bad.yaw_squared[0] = -1;
  EXPECT_THROW(GeometryTable{bad}, InputError);
}

}  // namespace
}  // namespace railtab
