// Friction that falls with the slip velocity and third bodies: forces of runs by the creep table against exact rolling
// contact in SI units, with the same law at the slip velocity of the patch's centre, and at that of every element.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>

#include "../measured.hpp"
#include "railtab/runtime/contact/creepage.hpp"
#include "railtab/runtime/contact/patch_loads.hpp"
#include "railtab/runtime/contact/wheel_contact.hpp"
#include "railtab/runtime/contact_files/creep_law_file.hpp"
#include "railtab/runtime/profile/standard_profiles.hpp"
#include "railtab/tablegen/random_number.hpp"
#include "railtab/tablegen/rolling_contact.hpp"
#include "railtab/tablegen/rolling_contact_product.hpp"
#include "railtab/tablegen/table_verification.hpp"

namespace railtab {
namespace {

struct RailCondition {
  const char* name;
  double friction;  // without slip
  FrictionLaw law;
};
/// [Polach2005]; for wet rails, k_A as the share of the initial slope.
constexpr RailCondition dry{"dry", 0.55, {.limit = 0.40, .decay = 0.60, .initial_slope = 1.0}};
constexpr RailCondition wet{"wet", 0.30, {.limit = 0.40, .decay = 0.20, .initial_slope = 0.30}};

/// One patch of a right wheel, level with the track.
struct Patch {
  double a, b, normal, speed;  // semi-axes [m], force [N], running speed [m/s]
  PatchCreepage slip;
};

/// In units of μ_0 F_n, and the moment of that times √(ab).
CreepForce over_friction(const PatchCreepForce& f, const Patch& patch, double friction) {
  const double bound = friction * patch.normal;
  return {f.x / bound, f.y / bound, f.moment / (bound * std::sqrt(patch.a * patch.b))};
}

double difference(const CreepForce& a, const CreepForce& b) { return std::hypot(a.x - b.x, a.y - b.y); }

/// a/b 0.3 … 3, √(ab) 4 … 7 mm, 30 … 120 kN, 5 … 80 m/s; creepages from a twentieth to thirty times those that the
/// linear theory needs for full friction, in any direction.
std::vector<Patch> random_patches(int count, double friction, double G) {
  std::mt19937_64 generator(7);
  const auto between = [&](double low, double high) { return low * std::pow(high / low, uniform(generator)); };
  std::vector<Patch> patches;
  for (int i = 0; i < count; ++i) {
    const double ratio = between(0.3, 3.0), c = between(4e-3, 7e-3), size = between(0.05, 30.0);
    Patch p{c * std::sqrt(ratio), c / std::sqrt(ratio), between(30e3, 120e3), between(5.0, 80.0), {}};
    const double z = 2.0 * uniform(generator) - 1.0, around = 2.0 * std::numbers::pi * uniform(generator);
    const double across = std::sqrt(1.0 - z * z), unit = friction * p.normal / (G * c * c);
    const KalkerCoefficients k = kalker_coefficients(ratio, ElasticMaterial{}.nu);
    p.slip = {3.0 * size * across * std::cos(around) / k.c11 * unit,
              3.0 * size * across * std::sin(around) / k.c22 * unit, size * z / k.c23 * unit / c};
    patches.push_back(p);
  }
  return patches;
}

/// As runs have it: by wheel_force(), the wheelset moved so that the patch has its creepages.
class RunForce {
 public:
  explicit RunForce(const RailCondition& rail)
      : geometry_(ContactSearch(WheelRailPair(ProfileCurve(standard_profile(ProfileKind::wheel, "S1002", 1.0 / 40)),
                                              ProfileCurve(standard_profile(ProfileKind::rail, "60E1", 1.0 / 40)),
                                              PairDimensions{}))) {
    model_.geometry = &geometry_;
    model_.creep_law = creep_law("table", ElasticMaterial{}.nu);
    model_.friction = rail.friction;
    model_.friction_law = rail.law;
  }
  [[nodiscard]] CreepForce of(const Patch& patch) {
    model_.speed = patch.speed;
    model_.constant_ellipse = {patch.a, patch.b};
    PatchLoads loads(1);
    loads[0] = {};
    loads[0].elastic_force = patch.normal;
    loads[0].contact.y_rail = -geometry_.pair().rail_offset();  // below the wheelset's centre
    WheelsetMotion wheelset;
    wheelset.velocity << patch.speed * patch.slip.x, patch.speed * patch.slip.y, 0.0, 0.0, 0.0,
        patch.speed * patch.slip.spin;
    const WheelForce force = wheel_force(model_, WheelSide::right, wheelset, {}, loads);
    EXPECT_EQ(force.outside_creep_table, 0);
    return over_friction({force.wheelset[0], force.wheelset[1], force.wheelset[5]}, patch, model_.friction);
  }

 private:
  ContactGeometry geometry_;
  WheelContactModel model_;
};

/// Exact rolling contact in SI units, a third body as a softer material, extrapolated to elements of size zero.
class ExactForce {
 public:
  static constexpr int elements = 40;
  ExactForce(const RailCondition& rail, const Patch& patch, double G)
      : rail_(rail), patch_(patch), G_(rail.law.initial_slope * G) {}

  /// The law at the slip velocity of the patch's centre.
  [[nodiscard]] CreepForce by_centre() {
    const double velocity = patch_.speed * std::hypot(patch_.slip.x, patch_.slip.y);
    return extrapolated([&](int n) { return force(bounded(n, rail_.law.share(velocity)), nullptr).force; });
  }

  /// The law at the slip velocity of every element: bounds by the slip of the solution before, until neither changes.
  [[nodiscard]] CreepForce by_elements() {
    return extrapolated([&](int n) {
      RollingContactGrid grid = bounded(n, 1.0);
      const Eigen::VectorXd clean = grid.bound;
      RollingContactProduct product(n, n, grid.dx, grid.dy, ElasticMaterial{}.nu);
      RollingContactSolution solution;
      double change = 1.0;
      for (int i = 0; i < 100 && change > 1e-5; ++i) {
        solution = force(grid, i == 0 ? nullptr : &solution.traction);
        ElementField slip(2 * grid.count());
        product.apply(Eigen::Map<const ElementField>(solution.traction.data(), slip.size()), slip);
        slip /= grid.dx;
        slip += rigid_slip(grid).w;
        change = 0.0;
        for (const int k : grid.inside) {
          const double velocity = patch_.speed * std::hypot(slip[k], slip[grid.count() + k]);
          const double bound = rail_.law.share(velocity) * clean[k];
          change = std::max(change, std::abs(bound / grid.bound[k] - 1.0));
          grid.bound[k] = bound;
        }
      }
      largest_change_ = std::max(largest_change_, change);
      return solution.force;
    });
  }
  [[nodiscard]] double largest_change() const { return largest_change_; }

 private:
  template <typename Solve>
  CreepForce extrapolated(const Solve& solve) const {
    const CreepForce coarse = solve(elements / 2), fine = solve(elements);
    return over_friction({2.0 * fine.x - coarse.x, 2.0 * fine.y - coarse.y, 2.0 * fine.moment - coarse.moment}, patch_,
                         rail_.friction);
  }
  [[nodiscard]] RollingContactGrid bounded(int n, double share) const {
    const double c = std::sqrt(patch_.a * patch_.b);
    RollingContactGrid grid = ellipse_grid(patch_.a / patch_.b, n, ElementSize::equal_area);
    grid.dx *= c;
    grid.dy *= c;
    for (double& x : grid.x) x *= c;
    for (double& y : grid.y) y *= c;
    grid.bound *= share * rail_.friction * patch_.normal / (G_ * c * c);
    return grid;
  }
  [[nodiscard]] RigidSlip rigid_slip(const RollingContactGrid& grid) const {
    const int m = grid.count();
    const PatchCreepage& slip = patch_.slip;
    RigidSlip rigid{ElementField::Zero(2 * m), slip.spin};
    for (const int k : grid.inside) {
      rigid.w[k] = slip.x - slip.spin * grid.y[k / grid.nx];
      rigid.w[m + k] = slip.y + slip.spin * (grid.x[k % grid.nx] + options().slip_ahead * grid.dx);
    }
    return rigid;
  }
  [[nodiscard]] static RollingContactOptions options() {
    RollingContactOptions o;
    o.direction = RollingContactOptions::SlipDirection::averaged;
    return o;
  }
  [[nodiscard]] RollingContactSolution force(const RollingContactGrid& grid, const std::vector<double>* start) const {
    RollingContact contact(grid, ElasticMaterial{}.nu, options());
    RollingContactSolution s = contact.solve(rigid_slip(grid), start);
    EXPECT_TRUE(s.converged);
    s.force = {G_ * s.force.x, G_ * s.force.y, G_ * s.force.moment};
    return s;
  }

  RailCondition rail_;
  Patch patch_;
  double G_;
  double largest_change_ = 0.0;
};

class FallingFriction : public ::testing::TestWithParam<RailCondition> {};

TEST_P(FallingFriction, OfThePatchIsServedByScalingTheCreepTable) {
  const RailCondition& rail = GetParam();
  const double G = ElasticMaterial{}.shear_modulus();
  RunForce run(rail);
  std::vector<double> force, moment;
  for (const Patch& patch : random_patches(150, rail.friction, G)) {
    const CreepForce found = run.of(patch), exact = ExactForce(rail, patch, G).by_centre();
    force.push_back(difference(found, exact));
    moment.push_back(std::abs(found.moment - exact.moment));
  }
  const ErrorStatistics of_force = error_statistics(force), of_moment = error_statistics(moment);
  std::printf("%s, law at the patch's slip velocity: force mean %.5f p99 %.5f max %.5f, moment mean %.5f max %.5f\n",
              rail.name, of_force.mean, of_force.p99, of_force.max, of_moment.mean, of_moment.max);
  testing::measured(std::string("falling_friction.") + rail.name + ".scaled.mean", of_force.mean);
  testing::measured(std::string("falling_friction.") + rail.name + ".scaled.max", of_force.max);
  testing::measured(std::string("falling_friction.") + rail.name + ".scaled.moment_max", of_moment.max);
  EXPECT_LT(of_force.mean, 0.001);
  EXPECT_LT(of_force.max, 0.02);
  EXPECT_LT(of_moment.max, 0.02);
}

// Friction falls where surfaces slide, and not where they stick; with spin they slide past each other where the patch's
// centre does not. What a law for whole patches leaves out.
TEST_P(FallingFriction, OfEveryElementIsThatOfThePatchButForSpin) {
  const RailCondition& rail = GetParam();
  const double G = ElasticMaterial{}.shear_modulus();
  RunForce run(rail);
  std::vector<double> all, little_spin;
  double unfinished = 0.0, excess = 0.0;
  for (const Patch& patch : random_patches(150, rail.friction, G)) {
    ExactForce exact(rail, patch, G);
    const CreepForce local = exact.by_elements(), found = run.of(patch);
    unfinished = std::max(unfinished, exact.largest_change());
    all.push_back(difference(found, local));
    excess += std::hypot(found.x, found.y) - std::hypot(local.x, local.y);
    const double centre = std::hypot(patch.slip.x, patch.slip.y);
    if (std::sqrt(patch.a * patch.b) * std::abs(patch.slip.spin) < centre / 3) little_spin.push_back(all.back());
  }
  excess /= static_cast<double>(all.size());
  const ErrorStatistics of_all = error_statistics(all), of_little = error_statistics(little_spin);
  std::printf(
      "%s, law at every element's slip velocity: mean %.4f p99 %.4f max %.4f; %zu cases of little spin: "
      "mean %.4f max %.4f; forces of runs are %.4f larger\n",
      rail.name, of_all.mean, of_all.p99, of_all.max, little_spin.size(), of_little.mean, of_little.max, excess);
  const std::string name = std::string("falling_friction.") + rail.name + ".local.";
  testing::measured(name + "mean", of_all.mean);
  testing::measured(name + "max", of_all.max);
  testing::measured(name + "little_spin_mean", of_little.mean);
  testing::measured(name + "little_spin_max", of_little.max);
  testing::measured(name + "excess", excess);
  EXPECT_LE(unfinished, 1e-5);
  EXPECT_GT(little_spin.size(), 40U);
  EXPECT_LT(of_all.mean, 0.02);
  EXPECT_LT(of_all.max, 0.12);
  EXPECT_LT(of_little.max, 0.03);
}

INSTANTIATE_TEST_SUITE_P(Polach, FallingFriction, ::testing::Values(dry, wet),
                         [](const auto& rail) { return rail.param.name; });

}  // namespace
}  // namespace railtab
