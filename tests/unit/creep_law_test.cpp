#include "railtab/runtime/contact/creep_law.hpp"
#include "railtab/runtime/contact_files/creep_law_file.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "../fastsim_scalar.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/contact/creepage.hpp"

namespace railtab {
namespace {

using std::numbers::pi;
using Bound = FastsimCreep::Bound;

const std::vector<CreepLaw>& laws_with_friction() {
  static const std::vector<CreepLaw> laws{
      LinearCreep{.saturated = true},
      PolachCreep{},
      PolachCreep{.k_adhesion = 1.0, .k_slip = 0.4},
      FastsimCreep{},
      FastsimCreep{.strips = 7, .elements = 9, .bound = Bound::elliptic},
      FastsimCreep{.strips = 33, .elements = 5, .flexibility = FastsimCreep::Flexibility::three},
  };
  return laws;
}

CreepForce linear_force(double ratio, double nu, const Creepage& u) {
  const KalkerCoefficients c = kalker_coefficients(ratio, nu);
  return {-c.c11 * u.x, -c.c22 * u.y - c.c23 * u.spin, c.c23 * u.y - c.c33 * u.spin};
}

TEST(CreepLaw, SmallCreepageIsLinearTheory) {
  const double h = 1e-7;
  for (double ratio : {0.15, 0.7, 1.0, 3.0, 9.0}) {
    for (const Creepage& u : {Creepage{h, 0, 0}, Creepage{0, h, 0}, Creepage{0, 0, h}, Creepage{-h, 2 * h, 0}}) {
      const CreepForce expected = linear_force(ratio, 0.28, u);
      const double size = std::hypot(expected.x, expected.y);
      for (const CreepLaw& law : {CreepLaw{LinearCreep{}}, laws_with_friction()[0], laws_with_friction()[1]}) {
        // Polach's force points along the creepage: only its size is that of linear theory where two act.
        if (std::holds_alternative<PolachCreep>(law) && u.x != 0.0 && u.y != 0.0) continue;
        const CreepForce f = creep_force(law, ratio, u);
        EXPECT_NEAR(f.x, expected.x, 1e-5 * size) << creep_law_name(law);
        EXPECT_NEAR(f.y, expected.y, 1e-5 * size) << creep_law_name(law);
        EXPECT_NEAR(f.moment, expected.moment, 1e-5 * std::abs(expected.moment)) << creep_law_name(law);
      }
    }
  }
}

TEST(CreepLaw, PolachHasTheSizeOfLinearTheoryAlongTheCreepage) {
  const Creepage u{-1e-7, 2e-7, 0.0};
  const CreepForce expected = linear_force(0.4, 0.28, u);
  const CreepForce f = creep_force(PolachCreep{}, 0.4, u);
  EXPECT_NEAR(std::hypot(f.x, f.y) / std::hypot(expected.x, expected.y), 1.0, 1e-6);
  EXPECT_NEAR(f.y / f.x, u.y / u.x, 1e-12);
}

TEST(CreepLaw, FastsimIsLinearTheoryAtSmallCreepage) {
  // At 1e-7 only the outermost elements slip. The tractions' moment is that of simplified theory, not c23 and c33.
  const double h = 1e-7;
  for (Bound bound : {Bound::parabolic, Bound::elliptic}) {
    const FastsimCreep law{.strips = 100, .elements = 100, .bound = bound};
    for (double ratio : {0.15, 1.0, 9.0}) {
      for (const Creepage& u : {Creepage{h, 0, 0}, Creepage{0, h, 0}, Creepage{0, 0, h}}) {
        const CreepForce expected = linear_force(ratio, law.nu, u);
        const CreepForce f = creep_force(law, ratio, u);
        const double size = std::hypot(expected.x, expected.y);
        EXPECT_NEAR(f.x, expected.x, 5e-4 * size);
        EXPECT_NEAR(f.y, expected.y, 5e-4 * size);
      }
      // M = υy/L2 ∫∫ x² dx dy = υy (3 c22/(8a)) π a³ b/4
      const double c22 = kalker_coefficients(ratio, law.nu).c22;
      EXPECT_NEAR(creep_force(law, ratio, {0, h, 0}).moment / (3.0 * pi / 32.0 * c22 * std::sqrt(ratio) * h), 1.0,
                  1e-3);
    }
  }
}

/// Pure longitudinal creepage, parabolic bound: every strip slips over the same length d = |traction growth|/p0 from
/// its trailing edge; on a strip of half-length l the force is (4/3) l³ p0 (1 - (1 - d/2l)³), or that of full sliding.
double parabolic_strip_integral(double c11, double creepage) {
  const double p0 = 2.0 / pi;
  const double d = 0.375 * c11 * creepage / p0;
  const int n = 200000;
  double sum = 0.0;
  for (int j = 0; j < n; ++j) {
    const double theta = pi * ((j + 0.5) / n - 0.5);
    const double l = std::cos(theta);
    const double q = d < 2.0 * l ? 1.0 - d / (2.0 * l) : 0.0;
    sum += 4.0 / 3.0 * l * l * l * p0 * (1.0 - q * q * q) * l * pi / n;
  }
  return sum;
}

TEST(CreepLaw, FastsimConvergesToTheClosedFormOfPureCreepage) {
  for (double size : {0.1, 0.25, 0.5}) {
    const double exact = parabolic_strip_integral(kalker_coefficients(2.0, 0.28).c11, size);
    const auto error = [&](int n) {
      const FastsimCreep law{.strips = n, .elements = n, .flexibility = FastsimCreep::Flexibility::three};
      return std::abs(-creep_force(law, 2.0, {size, 0, 0}).x - exact);
    };
    // Second order in pure creepage, where tractions do not turn: eight times the elements, about 1/64 of the error.
    EXPECT_LT(error(20), 5e-3) << size;
    EXPECT_LT(error(160), error(20) / 16.0) << size;
    EXPECT_GT(error(20), 1e-8) << size;
  }
}

TEST(CreepLaw, NeverAboveFriction) {
  for (const CreepLaw& law : laws_with_friction()) {
    double largest = 0.0;
    for (double ratio : {1e-3, 0.1, 0.6, 1.0, 2.5, 10.0, 1e3}) {
      for (int i = 0; i < 4000; ++i) {
        const double size = std::pow(10.0, -3.0 + 7.0 * ((i * 7) % 97) / 97.0);
        const Creepage u{size * std::sin(1.0 + i * 1.1), size * std::cos(2.0 + i * 0.7),
                         size * std::sin(3.0 + i * 1.9)};
        const CreepForce f = creep_force(law, ratio, u);
        const double force = std::hypot(f.x, f.y);
        ASSERT_LE(force, 1.0 + 1e-12) << creep_law_name(law) << ' ' << ratio << ' ' << u.x << ' ' << u.y << ' '
                                      << u.spin;
        largest = std::max(largest, force);
      }
    }
    EXPECT_GT(largest, 0.99) << creep_law_name(law);
  }
}

TEST(CreepLaw, ExtremesAreFinite) {
  const double sizes[] = {0.0, 1e-320, 1e-160, 1e-12, 1.0, 1e3, 1e12, 1e60, 1e200, 1e308};
  for (const CreepLaw& law : laws_with_friction()) {
    for (double ratio : {1e-9, 1e-3, 1.0, 1e3, 1e9}) {
      for (double x : sizes) {
        for (double y : sizes) {
          for (double spin : sizes) {
            const CreepForce f = creep_force(law, ratio, {x, -y, spin});
            ASSERT_TRUE(std::isfinite(f.x) && std::isfinite(f.y) && std::isfinite(f.moment))
                << creep_law_name(law) << ' ' << ratio << ' ' << x << ' ' << y << ' ' << spin;
            ASSERT_LE(std::hypot(f.x, f.y), 1.0 + 1e-12) << creep_law_name(law);
          }
        }
      }
    }
    const CreepForce none = creep_force(law, 1.0, {});
    EXPECT_EQ(none.x, 0.0);
    EXPECT_EQ(none.y, 0.0);
    EXPECT_EQ(none.moment, 0.0);
  }
}

TEST(CreepLaw, FullSlidingOpposesTranslation) {
  for (const CreepLaw& law : laws_with_friction()) {
    const auto* fastsim = std::get_if<FastsimCreep>(&law);
    // Three flexibilities turn the sliding traction away from the slip, which is what blending mends.
    if (fastsim != nullptr && fastsim->flexibility == FastsimCreep::Flexibility::three) continue;
    const CreepForce f = creep_force(law, 1.0, {3e5, -4e5, 0.0});
    // Linear theory's own direction is kept by Vermeulen-Johnson: c22/c11 of it.
    const bool linear = std::holds_alternative<LinearCreep>(law);
    EXPECT_NEAR(f.x, -0.6, linear ? 0.1 : 1e-4) << creep_law_name(law);
    EXPECT_NEAR(f.y, 0.8, linear ? 0.1 : 1e-4) << creep_law_name(law);
    EXPECT_NEAR(f.moment, 0.0, 1e-3) << creep_law_name(law);
  }
}

TEST(CreepLaw, PureSlidingSpinOfCircle) {
  // ∫ p r dA = 3π/16 for the elliptic pressure, ∫ over the parabolic bound 2/π (1 - r²) r: 8/15.
  const FastsimCreep elliptic{.strips = 200, .elements = 200, .bound = Bound::elliptic};
  const FastsimCreep parabolic{.strips = 200, .elements = 200, .bound = Bound::parabolic};
  EXPECT_NEAR(creep_force(elliptic, 1.0, {0, 0, 1e6}).moment, -3.0 * pi / 16.0, 0.01);
  EXPECT_NEAR(creep_force(parabolic, 1.0, {0, 0, 1e6}).moment, -8.0 / 15.0, 0.01);
  EXPECT_NEAR(creep_force(PolachCreep{}, 1.0, {0, 0, 1e6}).moment, -3.0 * pi / 16.0, 1e-4);
}

TEST(CreepLaw, MirrorSymmetries) {
  const Creepage u{0.3, -0.2, 0.45};
  std::vector<CreepLaw> laws = laws_with_friction();
  laws.emplace_back(LinearCreep{});
  for (const CreepLaw& law : laws) {
    const CreepForce f = creep_force(law, 1.7, u);
    const CreepForce forward = creep_force(law, 1.7, {-u.x, u.y, u.spin});
    EXPECT_NEAR(forward.x, -f.x, 1e-14) << creep_law_name(law);
    EXPECT_NEAR(forward.y, f.y, 1e-14) << creep_law_name(law);
    EXPECT_NEAR(forward.moment, f.moment, 1e-14) << creep_law_name(law);
    const CreepForce across = creep_force(law, 1.7, {u.x, -u.y, -u.spin});
    EXPECT_NEAR(across.x, f.x, 1e-14) << creep_law_name(law);
    EXPECT_NEAR(across.y, -f.y, 1e-14) << creep_law_name(law);
    EXPECT_NEAR(across.moment, -f.moment, 1e-14) << creep_law_name(law);
  }
}

TEST(CreepLaw, NamesRoundTrip) {
  for (const char* name : {"linear", "polach", "fastsim"}) EXPECT_EQ(creep_law_name(creep_law(name, 0.3)), name);
  EXPECT_EQ(std::get<PolachCreep>(creep_law("polach", 0.31)).nu, 0.31);
  EXPECT_THROW((void)creep_law("coulomb", 0.3), InputError);
  EXPECT_THROW((void)creep_law("linear", 0.7), InputError);
}

// --- creepage ---

constexpr double kSpeed = 50.0;
constexpr double kRadius = 0.46;

RelativeMotion rolling(double rotation_factor) {
  return {{kSpeed, 0.0, 0.0}, {0.0, -kSpeed / kRadius * rotation_factor, 0.0}};
}

TEST(Creepage, PureRollingHasNone) {
  const PatchCreepage c = patch_creepage(rolling(1.0), {0.0, 0.75, kRadius}, ContactAxes(0.0), kSpeed);
  EXPECT_NEAR(c.x, 0.0, 1e-15);
  EXPECT_NEAR(c.y, 0.0, 1e-15);
  EXPECT_NEAR(c.spin, 0.0, 1e-15);
}

TEST(Creepage, TractionPushesForwardAndBrakingBackward) {
  const Eigen::Vector3d arm(0.0, 0.75, kRadius);
  const PatchCreepage driven = patch_creepage(rolling(1.002), arm, ContactAxes(0.0), kSpeed);
  EXPECT_NEAR(driven.x, -0.002, 1e-15);
  const double a = 6e-3, b = 4e-3, G = 82e9, bound = 0.3 * 60e3;
  const CreepForce f = creep_force(PolachCreep{}, a / b, normalised_creepage(driven, a, b, G, bound));
  EXPECT_GT(dimensional_creep_force(f, a, b, bound).x, 1e3);
  EXPECT_GT(patch_creepage(rolling(0.998), arm, ContactAxes(0.0), kSpeed).x, 0.0);
}

TEST(Creepage, RollingRadiusSetsLongitudinalCreepage) {
  // A larger rolling radius than nominal is as if the wheel turned too fast: υx = (R0 - r)/R0.
  const PatchCreepage c = patch_creepage(rolling(1.0), {0.0, 0.75, kRadius + 2e-3}, ContactAxes(0.0), kSpeed);
  EXPECT_NEAR(c.x, -2e-3 / kRadius, 1e-15);
}

TEST(Creepage, SpinOfARightWheelIsThatOfItsCone) {
  const double angle = -0.3;
  const PatchCreepage c = patch_creepage(rolling(1.0), {0.0, 0.72, kRadius}, ContactAxes(angle), kSpeed);
  EXPECT_NEAR(c.spin, std::sin(angle) / kRadius, 1e-15);
}

TEST(Creepage, LateralVelocityAndYaw) {
  // Sideways motion in the tangent plane; yawed wheelset: the axle's rotation has no component along the rail's track.
  RelativeMotion motion = rolling(1.0);
  motion.velocity.y() = 0.1;
  EXPECT_NEAR(patch_creepage(motion, {0.0, 0.75, kRadius}, ContactAxes(0.0), kSpeed).y, 0.1 / kSpeed, 1e-15);
  EXPECT_NEAR(patch_creepage(motion, {0.0, 0.75, kRadius}, ContactAxes(-1.2), kSpeed).y, 0.1 / kSpeed * std::cos(1.2),
              1e-15);
  // Yaw ψ to the right turns the axle to (-sin ψ, cos ψ): υy = -ψ for small ψ.
  const double yaw = 1e-3;
  motion = {{kSpeed, 0.0, 0.0}, -kSpeed / kRadius * Eigen::Vector3d(-std::sin(yaw), std::cos(yaw), 0.0)};
  EXPECT_NEAR(patch_creepage(motion, {0.0, 0.75, kRadius}, ContactAxes(0.0), kSpeed).y, -std::sin(yaw), 1e-15);
}

TEST(Creepage, NormalisationKeepsTheDimensionalLinearForce) {
  const double a = 6e-3, b = 4e-3, G = 82e9, bound = 18e3, phi = 0.4, upsilon_y = 1e-6;
  const CreepForce f = creep_force(LinearCreep{}, a / b, normalised_creepage({2e-6, upsilon_y, phi}, a, b, G, bound));
  const PatchCreepForce F = dimensional_creep_force(f, a, b, bound);
  const KalkerCoefficients c = kalker_coefficients(a / b, 0.28);
  const double root = std::sqrt(a * b);
  EXPECT_NEAR(F.x / (-G * a * b * c.c11 * 2e-6), 1.0, 1e-14);
  EXPECT_NEAR(F.y / (-G * a * b * (c.c22 * upsilon_y + root * c.c23 * phi)), 1.0, 1e-14);
  EXPECT_NEAR(F.moment / (G * a * b * (root * c.c23 * upsilon_y - a * b * c.c33 * phi)), 1.0, 1e-14);
}

TEST(Fastsim, AgreesWithOneElementAfterTheOther) {
  const testing::ScalarFastsim<20> scalar;
  for (int i = 0; i < 200; ++i) {
    const double size = std::pow(10.0, -2.0 + 0.02 * i), ratio = std::pow(10.0, 1.5 * std::sin(2.3 * i));
    const Creepage c{size * std::sin(1.1 * i), size * std::cos(0.7 * i), size * std::sin(1.9 * i)};
    const CreepForce one = scalar(ratio, 0.28, c), all = creep_force(FastsimCreep{}, ratio, c);
    EXPECT_NEAR(one.x, all.x, 1e-12);
    EXPECT_NEAR(one.y, all.y, 1e-12);
    EXPECT_NEAR(one.moment, all.moment, 1e-12 * (std::sqrt(ratio) + 1.0 / std::sqrt(ratio)));
  }
}

}  // namespace
}  // namespace railtab
