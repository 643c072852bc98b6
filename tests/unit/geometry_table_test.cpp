#include "railtab/tables/geometry_table.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <span>
#include <vector>

#include "railtab/runtime/base/input_error.hpp"
#include "small_geometry_table.hpp"

namespace railtab {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// A table of one root cell and one branch, R0 = 0.5 m.
GeometryTableData one_leaf(TableAxis yaw_squared, TableAxis roll,
                           const std::vector<std::array<float, 4>>& coefficient) {
  GeometryTableData data;
  data.nominal_radius = 0.5;
  data.lateral = {-1, 3, 1};
  data.yaw_squared = yaw_squared;
  data.roll = roll;
  data.node = {CellNode::leaf(0)};
  data.leaf_branch = {1};
  data.trusted_lowering = {1e-3F};
  for (const auto& c : coefficient) data.coefficient.insert(data.coefficient.end(), c.begin(), c.end());
  return data;
}

// What evaluate() makes of coefficients is the sum of branch_monomials() with them, on all axes.
TEST(GeometryTable, ALeafIsItsPolynomials) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (const auto& [yaw_axis, roll_axis] : {std::pair{false, false}, {true, false}, {false, true}, {true, true}}) {
    const int terms = branch_terms(yaw_axis, roll_axis);
    std::vector<std::array<float, 4>> c;
    for (int n = 0; n < terms; ++n) {
      c.push_back(
          {static_cast<float>(unit(random)), static_cast<float>(unit(random)), static_cast<float>(unit(random)), 0.0F});
    }
    const TableAxis yaw_squared = yaw_axis ? TableAxis{0.01, 0.05, 1} : TableAxis{0.04, 0.04, 1};
    const TableAxis roll = roll_axis ? TableAxis{-0.1, 0.3, 1} : TableAxis{0.2, 0.2, 1};
    const GeometryTable table(one_leaf(yaw_squared, roll, c));
    for (int n = 0; n < 200; ++n) {
      const double a = unit(random), b = yaw_axis ? unit(random) : 0.0, r = roll_axis ? unit(random) : 0.0;
      const double q = yaw_axis ? 0.03 + 0.02 * b : 0.04;
      const double phi = roll_axis ? 0.1 + 0.2 * r : 0.2;
      const GeometryTable::Lookup lookup = table.lookup(1 + 2 * a + 0.5 * phi, -10.0, -std::sqrt(q), phi);
      ASSERT_EQ(lookup.status, GeometryTable::Status::inside);
      ASSERT_EQ(lookup.count, 1);
      const auto m = branch_monomials(yaw_axis, roll_axis, a, b, r);
      std::array<double, 3> sum{};
      for (int t = 0; t < terms; ++t)
        for (int k = 0; k < 3; ++k) sum[k] += m[t] * c[t][k];
      // Single precision: up to twelve terms of size 1, a few operations each.
      EXPECT_NEAR(lookup.branch[0].z_touch, sum[0], 5e-6);
      EXPECT_NEAR(lookup.branch[0].s_wheel, sum[1], 5e-6);
      EXPECT_NEAR(lookup.branch[0].s_rail, sum[2], 5e-6);
      EXPECT_EQ(lookup.first_touch, lookup.branch[0].z_touch);
      EXPECT_FLOAT_EQ(static_cast<float>(lookup.trusted_lowering), 1e-3F);
    }
  }
}

// On a plane that rises at 30 degrees the pair of a wheel lowered by h is that of a touch h sin cos beside.
TEST(GeometryTable, ALoweredWheelStartsFromTheTouchBeside) {
  const double slope = std::tan(M_PI / 6);
  const std::array<float, 4> constant{0.0F, 0.1F, 0.2F, static_cast<float>(-0.25 * std::sqrt(3.0))};  // -sin cos
  const std::array<float, 4> linear{static_cast<float>(2 * slope), 2.0F, 4.0F, 0.0F};  // per half width of 2 m
  const GeometryTable table(one_leaf({0, 0, 1}, {0, 0, 1}, {constant, linear, {}, {}}));
  const double h = 0.01;
  const GeometryTable::Lookup lookup = table.lookup(1.0, h, 0.0, 0.0);
  const double d = h * std::cos(M_PI / 6);
  EXPECT_NEAR(lookup.branch[0].s_wheel, 0.1 + 1.0 * 0.5 * d, 1e-7);
  EXPECT_NEAR(lookup.branch[0].s_rail, 0.2 + 2.0 * 0.5 * d, 1e-7);
}

// Every point must find the leaf whose box holds it, with its local coordinates.
TEST(GeometryTable, FindsTheLeafInTheTree) {
  GeometryTableData data = small_geometry_table();
  data.leaf_branch = {1, 1, 1, 1};
  data.coefficient.assign(4 * 48, 0.0F);
  const auto leaf = [&](std::size_t n) { return data.coefficient.data() + 48 * n; };
  for (std::size_t n = 0; n < 4; ++n) {
    leaf(n)[0] = static_cast<float>(n);  // z_touch: the leaf's number
    leaf(n)[3 * 4 + 1] = 1.0F;           // s_wheel: a
    leaf(n)[8 * 4 + 2] = 1.0F;           // s_rail: c
  }
  const GeometryTable table(data);
  // Leaves 0: second root cell; 1: lower half of the first; 2, 3: its upper half, roll below and above 0.
  const auto expect = [&](double lateral, double roll, int number, double a, double c) {
    const GeometryTable::Lookup l = table.lookup(lateral + 0.46 * roll, -1.0, 0.01, roll);
    ASSERT_EQ(l.count, 1);
    EXPECT_EQ(l.branch[0].z_touch, number);
    EXPECT_NEAR(l.branch[0].s_wheel, a, 1e-6);
    EXPECT_NEAR(l.branch[0].s_rail, c, 1e-6);
  };
  expect(0.00275, 0.001, 0, 0.0, 0.5);
  expect(0.005, 0.002, 0, 1.0, 1.0);
  expect(-0.004, -0.002, 1, -1.0, -1.0);
  expect(-0.004 + 0.75 * 0.00225, 0.0, 1, 0.5, 0.0);
  expect(-0.00175 + 0.25 * 0.00225, -0.0015, 2, -0.5, -0.5);
  expect(-0.00175 + 0.25 * 0.00225, 0.0015, 3, -0.5, 0.5);
}

// The memory of what look-ups do not read goes back.
TEST(GeometryTable, HasItsCoefficientsOnce) {
  const GeometryTableData data = small_geometry_table();
  const GeometryTable table(data);
  const std::span<const float> held = table.coefficients();
  EXPECT_EQ(std::vector<float>(held.begin(), held.end()), data.coefficient);
  EXPECT_EQ(table.data().coefficient.capacity(), 0U);
  EXPECT_EQ(table.data().node, data.node);
  EXPECT_EQ(table.bytes(), GeometryTable::bytes_of(data));
  EXPECT_EQ(table.bytes(), GeometryTable::bytes_of(table.data()));
}

TEST(GeometryTable, OutsideIsAStatus) {
  const GeometryTable table(small_geometry_table());
  const auto status = [&](double y, double yaw, double roll) { return table.lookup(y, 0, yaw, roll).status; };
  EXPECT_EQ(status(0, 0, 0), GeometryTable::Status::inside);
  EXPECT_EQ(status(0, -0.02, 0), GeometryTable::Status::inside);
  EXPECT_EQ(status(0.0051, 0, 0), GeometryTable::Status::outside);
  EXPECT_EQ(status(-0.0041, 0, 0), GeometryTable::Status::outside);
  EXPECT_EQ(status(0, 0.0201, 0), GeometryTable::Status::outside);
  EXPECT_EQ(status(0, 0, 0.0021), GeometryTable::Status::outside);
  EXPECT_EQ(status(nan, 0, 0), GeometryTable::Status::outside);
  EXPECT_EQ(status(0, nan, 0), GeometryTable::Status::outside);
  EXPECT_EQ(status(0, 0, nan), GeometryTable::Status::outside);
}

TEST(GeometryTable, AFixedAxisHoldsItsValueOnly) {
  const std::vector<std::array<float, 4>> zero(4, std::array<float, 4>{});
  const GeometryTable table(one_leaf({0.0001, 0.0001, 1}, {0.002, 0.002, 1}, zero));
  const auto status = [&](double yaw, double roll) { return table.lookup(0, 0, yaw, roll).status; };
  EXPECT_EQ(status(0.01, 0.002), GeometryTable::Status::inside);
  EXPECT_EQ(status(-0.01, 0.002 + 0.9e-12), GeometryTable::Status::inside);
  EXPECT_EQ(status(0.01 + 1.1e-12, 0.002), GeometryTable::Status::outside);
  EXPECT_EQ(status(0.01, 0.002 - 1.1e-12), GeometryTable::Status::outside);
}

TEST(GeometryTable, RejectsWhatIsNoTable) {
  const auto rejected = [](const auto& change) {
    GeometryTableData data = small_geometry_table();
    change(data);
    try {
      const GeometryTable table(data);
    } catch (const InputError&) {
      return true;
    }
    return false;
  };
  EXPECT_FALSE(rejected([](GeometryTableData&) {}));
  EXPECT_TRUE(rejected([](GeometryTableData& d) { d.lateral.low = 1; }));
  EXPECT_TRUE(rejected([](GeometryTableData& d) { d.lateral.high = d.lateral.low; }));
  EXPECT_TRUE(rejected([](GeometryTableData& d) { d.lateral.cells = 0; }));
  EXPECT_TRUE(rejected([](GeometryTableData& d) { d.lateral.cells = 7; }));
  EXPECT_TRUE(rejected([](GeometryTableData& d) {
    d.lateral.cells = d.yaw_squared.cells = d.roll.cells = 2'000'000'000;
  })) << "more than can be counted";
  EXPECT_TRUE(rejected([](GeometryTableData& d) { d.yaw_squared.low = -1e-5; }));
  EXPECT_TRUE(rejected([](GeometryTableData& d) { d.shard = {1, 2}; }));
  EXPECT_TRUE(rejected([](GeometryTableData& d) { d.node[0] = CellNode::halved(0, 0); })) << "a loop";
  EXPECT_TRUE(rejected([](GeometryTableData& d) { d.node[3] = CellNode::halved(2, 2); })) << "two parents";
  EXPECT_TRUE(rejected([](GeometryTableData& d) { d.node[0] = CellNode::halved(0, 5); })) << "beyond the end";
  EXPECT_TRUE(rejected([](GeometryTableData& d) { d.node.push_back(CellNode::leaf(0)); }));
  EXPECT_TRUE(rejected([](GeometryTableData& d) { d.node[5] = CellNode::leaf(9); }));
  EXPECT_TRUE(rejected([](GeometryTableData& d) { d.leaf_branch[0] = 9; }));
  EXPECT_TRUE(rejected([](GeometryTableData& d) { d.leaf_branch[0] = 1; }));
  EXPECT_TRUE(rejected([](GeometryTableData& d) { d.trusted_lowering[1] = -1e-3F; }));
  EXPECT_TRUE(rejected([](GeometryTableData& d) { d.trusted_lowering.pop_back(); }));
  EXPECT_TRUE(rejected([](GeometryTableData& d) { d.coefficient[5] = std::numeric_limits<float>::infinity(); }));
  EXPECT_TRUE(rejected([](GeometryTableData& d) { d.coefficient.pop_back(); }));
}

}  // namespace
}  // namespace railtab
