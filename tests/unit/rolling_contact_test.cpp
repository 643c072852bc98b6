#include "railtab/tablegen/rolling_contact.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/tablegen/influence_numbers.hpp"
#include "railtab/tablegen/rolling_contact_product.hpp"
#include "railtab/tablegen/rolling_contact_single.hpp"

namespace railtab {
namespace {

constexpr double kNu = 0.28;

RollingContactOptions grid(int elements) {
  RollingContactOptions options;
  options.elements = elements;
  return options;
}

const std::vector<Creepage> kCreepages{{0.1, 0.05, 0.1}, {0.02, -0.1, 0.3}, {0.0, 0.0, 2.0}, {-0.3, 0.2, -0.5}};

TEST(InfluenceNumbers, FarAwayAreThoseOfAPointLoad) {
  const double x = 40.0, y = -25.0, dx = 0.3, dy = 0.2;
  const double r = std::hypot(x, y), force = dx * dy / std::numbers::pi;
  const InfluenceNumber a = influence_number(x, y, dx, dy, kNu);
  // the next term of the expansion is of the order (dx/r)²/24 = 2e-6
  EXPECT_NEAR(a.xx / (force * ((1 - kNu) / r + kNu * x * x / (r * r * r))), 1.0, 1e-5);
  EXPECT_NEAR(a.yy / (force * ((1 - kNu) / r + kNu * y * y / (r * r * r))), 1.0, 1e-5);
  EXPECT_NEAR(a.xy / (force * kNu * x * y / (r * r * r)), 1.0, 1e-5);
}

TEST(InfluenceNumbers, AnElementIsTheSumOfItsQuarters) {
  // offsets along which one corner lies left, right, below and above the observed point
  for (const auto& [x, y] : {std::pair{0.1, 0.05}, {-1.3, 0.7}, {2.2, -3.1}}) {
    const InfluenceNumber whole = influence_number(x, y, 1.0, 0.6, kNu);
    InfluenceNumber sum{0.0, 0.0, 0.0};
    for (const double i : {-0.25, 0.25}) {
      for (const double j : {-0.15, 0.15}) {
        const InfluenceNumber part = influence_number(x + i, y + j, 0.5, 0.3, kNu);
        sum.xx += part.xx;
        sum.xy += part.xy;
        sum.yy += part.yy;
      }
    }
    EXPECT_NEAR(sum.xx, whole.xx, 1e-14);
    EXPECT_NEAR(sum.xy, whole.xy, 1e-14);
    EXPECT_NEAR(sum.yy, whole.yy, 1e-14);
  }
}

/// Slip per step by elastic deformation, summed element by element.
ElementField direct_product(int nx, int ny, double dx, double dy, const ElementField& p) {
  const int m = nx * ny;
  ElementField slip = ElementField::Zero(2 * m);
  for (int k = 0; k < m; ++k) {
    for (int l = 0; l < m; ++l) {
      const double x = (k % nx - l % nx) * dx, y = (k / nx - l / nx) * dy;
      const InfluenceNumber here = influence_number(x, y, dx, dy, kNu);
      const InfluenceNumber ahead = influence_number(x + dx, y, dx, dy, kNu);
      slip[k] += (here.xx - ahead.xx) * p[l] + (here.xy - ahead.xy) * p[m + l];
      slip[m + k] += (here.xy - ahead.xy) * p[l] + (here.yy - ahead.yy) * p[m + l];
    }
  }
  return slip;
}

TEST(RollingContactProduct, IsTheDirectSum) {
  for (const auto& [nx, ny] : {std::pair{7, 7}, {12, 12}, {5, 9}, {11, 4}}) {
    const double dx = 0.13, dy = 0.31;
    RollingContactProduct product(nx, ny, dx, dy, kNu);
    ElementField p(2 * nx * ny), slip(2 * nx * ny);
    for (int i = 0; i < p.size(); ++i) p[i] = std::sin(1.7 * i * i + 0.3);
    product.apply(p, slip);
    const ElementField direct = direct_product(nx, ny, dx, dy, p);
    EXPECT_LT((slip - direct).cwiseAbs().maxCoeff(), 1e-14 * nx * ny);
    EXPECT_GT(direct.cwiseAbs().maxCoeff(), 0.01);
    RollingContactSingle single(product);
    ElementFieldSingle single_slip(2 * nx * ny);
    single.apply(p.cast<float>(), single_slip);
    EXPECT_LT((single_slip.cast<double>() - direct).cwiseAbs().maxCoeff(), 1e-6 * nx * ny);
  }
}

// A rectangle of more elements across than along, with two separate bands, obeys the same law.
TEST(RollingContact, AnyContactAreaObeysCoulombsLaw) {
  RollingContactGrid grid;
  grid.nx = 14;
  grid.ny = 23;
  grid.dx = 0.1;
  grid.dy = 0.07;
  for (int i = 0; i < grid.nx; ++i) grid.x.push_back((i - 6.5) * grid.dx);
  for (int j = 0; j < grid.ny; ++j) grid.y.push_back((j - 11.0) * grid.dy);
  grid.bound = Eigen::VectorXd::Zero(grid.count());
  for (int k = 0; k < grid.count(); ++k) {
    const double x = grid.x[k % grid.nx], y = grid.y[k / grid.nx];
    const double left = 1.0 - x * x / 0.4 - (y + 0.45) * (y + 0.45) / 0.08,
                 right = 1.0 - x * x / 0.2 - (y - 0.5) * (y - 0.5) / 0.03;
    grid.bound[k] = 0.3 * std::sqrt(std::max({0.0, left, right}));
    if (grid.bound[k] > 0.0) grid.inside.push_back(k);
  }
  const int m = grid.count();
  RigidSlip rigid{ElementField::Zero(2 * m), 0.3};
  for (int k = 0; k < m; ++k) {
    rigid.w[k] = 0.05 - 0.3 * grid.y[k / grid.nx];
    rigid.w[m + k] = -0.1 + 0.3 * grid.x[k % grid.nx];
  }
  RollingContact contact(grid, kNu, {});
  const RollingContactSolution s = contact.solve(rigid);
  ASSERT_TRUE(s.converged);
  EXPECT_FALSE(s.safe_method);
  EXPECT_GT(s.adhesion, 10);
  EXPECT_GT(s.slip, 10);
  const ElementField p = Eigen::Map<const ElementField>(s.traction.data(), 2 * m);
  const ElementField slip = direct_product(grid.nx, grid.ny, grid.dx, grid.dy, p) + rigid.w * grid.dx;
  const double scale = rigid.w.cwiseAbs().maxCoeff() * grid.dx;
  CreepForce force;
  for (int k = 0; k < m; ++k) {
    const double size = std::hypot(p[k], p[m + k]);
    EXPECT_LE(size, grid.bound[k] * (1 + 1e-12));
    force.x += p[k] * grid.area();
    force.y += p[m + k] * grid.area();
    if (grid.bound[k] == 0.0) continue;
    const double slips = std::hypot(slip[k], slip[m + k]);
    if (size < grid.bound[k] * (1 - 1e-6)) {
      EXPECT_LT(slips, 1e-4 * scale);
    } else {
      EXPECT_GT(-(p[k] * slip[k] + p[m + k] * slip[m + k]), size * slips * (1 - 1e-4) - 1e-7);
    }
  }
  EXPECT_NEAR(s.force.x, force.x, 1e-14);
  EXPECT_NEAR(s.force.y, force.y, 1e-14);
  // the safe method finds the same
  RollingContactOptions options;
  options.max_iterations = 0;
  const RollingContactSolution safe = RollingContact(grid, kNu, options).solve(rigid);
  ASSERT_TRUE(safe.converged && safe.safe_method);
  EXPECT_NEAR(safe.force.x, s.force.x, 1e-5);
  EXPECT_NEAR(safe.force.y, s.force.y, 1e-5);
}

TEST(RollingContact, ObeysCoulombsLaw) {
  // The slip of the solution, from the direct sum and the definition: none where friction is not used up, else against
  // the traction.
  const int n = 16, m = n * n;
  for (const double ratio : {0.3, 1.0, 4.0}) {
    const double a = std::sqrt(ratio), dx = 2 * a / n, dy = 2 / (a * n);
    RollingContact contact(ratio, kNu, grid(n));
    for (const Creepage& c : kCreepages) {
      const RollingContactSolution s = contact.solve(c);
      ASSERT_TRUE(s.converged);
      EXPECT_LT(s.bound_excess, 1e-12);
      const ElementField p = Eigen::Map<const ElementField>(s.traction.data(), 2 * m);
      const ElementField elastic = direct_product(n, n, dx, dy, p);
      double weight = 0.0;
      const auto depth = [&](int k) {
        return 1.0 - std::pow((2.0 * (k % n) + 1 - n) / n, 2) - std::pow((2.0 * (k / n) + 1 - n) / n, 2);
      };
      for (int k = 0; k < m; ++k) weight += depth(k) > 0.0 ? std::sqrt(depth(k)) * dx * dy : 0.0;
      for (int k = 0; k < m; ++k) {
        if (depth(k) <= 0.0) {
          EXPECT_EQ(std::hypot(p[k], p[m + k]), 0.0);
          continue;
        }
        const double x = (k % n + 0.5 - 0.5 * n + 1.0 / 6.0) * dx, y = (k / n + 0.5 - 0.5 * n) * dy;
        const double sx = elastic[k] + (c.x - c.spin * y) * dx, sy = elastic[m + k] + (c.y + c.spin * x) * dx;
        const double bound = std::sqrt(depth(k)) / weight, size = std::hypot(p[k], p[m + k]);
        const double scale = dx;  // elastic slip per traction is of the order of the element
        EXPECT_LE(size, bound * (1 + 1e-12));
        if (size < bound * (1 - 1e-9)) {
          EXPECT_LT(std::hypot(sx, sy), 1e-4 * scale);
        } else {
          EXPECT_LT(std::hypot(sx + std::hypot(sx, sy) * p[k] / size, sy + std::hypot(sx, sy) * p[m + k] / size),
                    1e-4 * scale);
        }
      }
    }
  }
}

TEST(RollingContact, SafeMethodAndNewtonAgree) {
  RollingContactOptions safe = grid(12);
  safe.max_iterations = 0;
  for (const double ratio : {0.4, 2.0}) {
    RollingContact newton(ratio, kNu, grid(12)), transient(ratio, kNu, safe);
    for (const Creepage& c : kCreepages) {
      const RollingContactSolution s = newton.solve(c), t = transient.solve(c);
      EXPECT_TRUE(s.converged && !s.safe_method);
      EXPECT_TRUE(t.converged && t.safe_method);
      EXPECT_NEAR(s.force.x, t.force.x, 1e-5);
      EXPECT_NEAR(s.force.y, t.force.y, 1e-5);
      EXPECT_NEAR(s.force.moment, t.force.moment, 1e-5);
      EXPECT_LT(t.bound_excess, 1e-12);
    }
  }
}

TEST(RollingContact, Symmetries) {
  RollingContact contact(1.7, kNu, grid(20));
  for (const Creepage& c : kCreepages) {
    const CreepForce f = contact.solve(c).force;
    const CreepForce forward = contact.solve({-c.x, c.y, c.spin}).force;
    const CreepForce across = contact.solve({c.x, -c.y, -c.spin}).force;
    EXPECT_NEAR(forward.x, -f.x, 1e-5);
    EXPECT_NEAR(forward.y, f.y, 1e-5);
    EXPECT_NEAR(forward.moment, f.moment, 1e-5);
    EXPECT_NEAR(across.x, f.x, 1e-5);
    EXPECT_NEAR(across.y, -f.y, 1e-5);
    EXPECT_NEAR(across.moment, -f.moment, 1e-5);
  }
}

TEST(RollingContact, StartDoesNotChangeTheAnswer) {
  RollingContact contact(0.6, kNu, grid(20));
  const RollingContactSolution other = contact.solve({0.3, -0.3, 1.0});
  for (const Creepage& c : kCreepages) {
    const CreepForce cold = contact.solve(c).force, warm = contact.solve(c, &other.traction).force;
    EXPECT_NEAR(cold.x, warm.x, 1e-5);
    EXPECT_NEAR(cold.y, warm.y, 1e-5);
    EXPECT_NEAR(cold.moment, warm.moment, 1e-5);
  }
}

TEST(RollingContact, NothingIsLeftOfAnotherCaseWithoutCreepage) {
  // As a sweep meets zero spin: its start is the solution of the case before, which no residual scales with.
  for (const double ratio : {1e-3, 0.112, 1.0, 1e3}) {
    for (const int n : {10, 16, 20, 40}) {
      ExtrapolatedRollingContact contact(ratio, kNu, grid(n));
      const ExtrapolatedContactSolution before = contact.solve({0.0, 0.0, -1.0 / 9.0});
      ASSERT_NE(before.force.moment, 0.0);
      const ExtrapolatedContactSolution s = contact.solve({}, &before.coarse.traction);
      EXPECT_TRUE(s.coarse.converged && s.fine.converged) << ratio << ' ' << n;
      EXPECT_FALSE(s.coarse.safe_method || s.fine.safe_method) << ratio << ' ' << n;
      EXPECT_EQ(s.force.x, 0.0);
      EXPECT_EQ(s.force.y, 0.0);
      EXPECT_EQ(s.force.moment, 0.0);
    }
  }
}

TEST(RollingContact, FullSliding) {
  for (const double ratio : {1e-3, 0.1, 1.0, 10.0, 1e3}) {
    RollingContact contact(ratio, kNu, grid(40));
    const RollingContactSolution s = contact.solve({3e60, -4e60, 0.0});
    EXPECT_NEAR(s.force.x, -0.6, 1e-9);
    EXPECT_NEAR(s.force.y, 0.8, 1e-9);
    EXPECT_EQ(s.adhesion, 0);
  }
  // spin alone on the circle: traction along the circles, moment ∫ r μp_n = 3π/16, less by the element (1/40)²
  EXPECT_NEAR(RollingContact(1.0, kNu, grid(40)).solve({0.0, 0.0, 1e6}).force.moment, -3 * std::numbers::pi / 16, 2e-3);
}

TEST(RollingContact, ExtremesAreSolved) {
  for (const double ratio : {1e-3, 0.02, 50.0, 1e3}) {
    ExtrapolatedRollingContact contact(ratio, kNu, grid(40));
    for (const Creepage& c : std::vector<Creepage>{
             {0, 0, 0}, {1e-9, 0, 0}, {0, 0, 1e-6}, {0.1, 0.1, 0.1}, {0, 0, 100}, {1e3, 1e3, 1e3}, {0, -1e60, 1}}) {
      const ExtrapolatedContactSolution s = contact.solve(c);
      EXPECT_TRUE(s.coarse.converged && s.fine.converged) << ratio << ' ' << c.x << ' ' << c.y << ' ' << c.spin;
      EXPECT_TRUE(std::isfinite(s.force.moment));
      EXPECT_LT(std::hypot(s.force.x, s.force.y), 1.01);
      EXPECT_LT(s.fine.bound_excess, 1e-12);
    }
    const CreepForce none = contact.solve({}).force;
    EXPECT_EQ(none.x, 0.0);
    EXPECT_EQ(none.y, 0.0);
    EXPECT_EQ(none.moment, 0.0);
  }
}

TEST(RollingContact, RejectsWhatItCannotDo) {
  EXPECT_THROW(RollingContact(0.0, kNu), InputError);
  EXPECT_THROW(RollingContact(std::nan(""), kNu), InputError);
  EXPECT_THROW(RollingContact(1.0, 0.6), InputError);
  EXPECT_THROW(RollingContact(1.0, kNu, grid(3)), InputError);
  EXPECT_THROW(ExtrapolatedRollingContact(1.0, kNu, grid(41)), InputError);
}

}  // namespace
}  // namespace railtab
