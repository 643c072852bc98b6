// Rolling with friction on the true contact area.

#include "railtab/tablegen/loaded_rolling.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/profile/standard_profiles.hpp"
#include "railtab/tablegen/ellipse_of_pressure.hpp"

namespace railtab {
namespace {

ContactSearch search_of(const char* wheel) {
  return ContactSearch(WheelRailPair(ProfileCurve(standard_profile(ProfileKind::wheel, wheel, 0.0)),
                                     ProfileCurve(standard_profile(ProfileKind::rail, "60E1", 1.0 / 40.0)),
                                     PairDimensions{}));
}

// A cone on the arc R300 of the rail head: the ellipse's solution at the same creepages.
TEST(LoadedRolling, IsThatOfTheEllipseInAHertzianContact) {
  const ContactSearch search = search_of("cone-1:40");
  LoadedContactOptions options;
  options.elements.across_narrowest = 56;  // 40 across the contact
  const ContactAtLoad loaded = contact_at_load(search, {}, 2e3, options);
  ASSERT_TRUE(loaded.converged);
  const ContactBand& band = loaded.contact.bands.at(0);
  for (const auto& [pitch, lateral] : {std::pair{1.001, 0.0}, {1.0, 0.02}, {0.998, -0.01}}) {
    RelativeMotion motion = running_motion(loaded.contact.pose, 20.0, -20.0 / 0.46 * pitch);
    motion.velocity.y() = lateral;
    LoadedRollingOptions rolling;
    rolling.speed = 20.0;
    const LoadedRolling r = loaded_rolling(search.pair(), loaded.contact, options, motion, rolling);
    ASSERT_TRUE(r.solution.converged);
    const double bound = rolling.friction * band.normal_force;
    RollingContactOptions ellipse_options;
    RollingContact ellipse(band.a / band.b, 0.28, ellipse_options);
    const CreepForce expected =
        ellipse.solve(normalised_creepage(r.bands.at(0).creepage, band.a, band.b, options.wheel.shear_modulus(), bound))
            .force;
    EXPECT_GT(std::hypot(expected.x, expected.y), 0.1);
    EXPECT_NEAR(r.bands[0].x / bound, expected.x, 0.006);
    EXPECT_NEAR(r.bands[0].y / bound, expected.y, 0.006);
    EXPECT_NEAR(r.bands[0].moment / (bound * std::sqrt(band.a * band.b)), expected.moment, 0.01);
    // the force on the rail is the opposite of that on the wheel
    EXPECT_NEAR(r.on_rail.force.x(), -r.bands[0].x, 1e-9 * bound);
    EXPECT_LT((r.on_rail.force + r.bands[0].force).norm(), 1e-9 * bound);
  }
}

// Second moments a²/5, b²/5 and the mean pressure 9 N/(8 π a b), sheared.
TEST(EllipseOfPressure, IsHertzsOwn) {
  const double a = 7e-3, b = 3e-3, skew = 0.2, force = 60e3;
  PressureMoments m;
  m.ss = b * b / 5.0;
  m.xs = skew * m.ss;
  m.xx = a * a / 5.0 + skew * m.xs;
  m.mean_pressure = 9.0 * force / (8.0 * std::numbers::pi * a * b);
  const EllipseOfPressure ellipse(m, force);
  EXPECT_NEAR(ellipse.a, a, 1e-12);
  EXPECT_NEAR(ellipse.b, b, 1e-12);
  EXPECT_NEAR(ellipse.skew, skew, 1e-12);
}

/// Differences of two ellipses' creep forces from the half-space solution's, shares of the friction limit.
struct EllipseErrors {
  double as_in_runs = 0.0, by_moments = 0.0;  ///< EllipseOfPressure; second moments alone
};

/// Means over four creepages, at a pose under a load; from solutions without the elements' error.
EllipseErrors ellipse_errors(const ContactSearch& search, const WheelsetPose& at, double load) {
  LoadedContactOptions options;
  const LoadedContact coarse = contact_at_load(search, at, load, options).contact;
  options.elements.across_narrowest *= 2;
  const LoadedContact fine = loaded_contact(search, coarse.pose, options);
  const ContactBand& band = fine.bands.at(0);
  const EllipseOfPressure of_moments(band.moments);
  EllipseErrors mean;
  for (const auto& [pitch, lateral] : {std::pair{1.0, 0.0}, {1.001, 0.0}, {0.999, 0.02}, {1.0, -0.02}}) {
    RelativeMotion motion = running_motion(coarse.pose, 30.0, -30.0 / 0.46 * pitch);
    motion.velocity.y() = lateral;
    LoadedRollingOptions rolling;
    rolling.speed = 30.0;
    const auto of_band = [&](const LoadedContact& c) {
      return loaded_rolling(search.pair(), c, options, motion, rolling).bands.at(0);
    };
    const BandFriction of_fine = of_band(fine), of_coarse = of_band(coarse);
    const double bound = rolling.friction * fine.normal_force;
    const Eigen::Vector2d solution(2.0 * of_fine.x - of_coarse.x, 2.0 * of_fine.y - of_coarse.y);
    const auto error = [&](double a, double b) {
      const CreepForce f =
          ExtrapolatedRollingContact(a / b, 0.28)
              .solve(normalised_creepage(of_fine.creepage, a, b, ElasticMaterial{}.shear_modulus(), bound))
              .force;
      return (Eigen::Vector2d(f.x, f.y) - solution / bound).norm();
    };
    mean.as_in_runs += error(band.a, band.b) / 4.0;
    mean.by_moments += error(of_moments.a, of_moments.b) / 4.0;
  }
  return mean;
}

// Where two domes of pressure run into each other, the ellipse of the second moments is too wide.
TEST(EllipseOfPressure, RollsAsAContactThatIsNoEllipse) {
  const ContactSearch search = search_of("S1002");
  EllipseErrors mean;
  for (const auto& [pose, load] : {std::pair{WheelsetPose{2.26e-3, 0.0, 1.32e-3, 0.0}, 72e3},
                                   {WheelsetPose{2.88e-3, 0.0, 2.67e-3, 0.0}, 46e3},
                                   {WheelsetPose{0.03e-3, 0.0, -1.34e-3, 0.0}, 29e3},
                                   {WheelsetPose{-1.12e-3, 0.0, -2.59e-3, 0.0}, 34e3}}) {
    const EllipseErrors errors = ellipse_errors(search, pose, load);
    EXPECT_LT(errors.as_in_runs, errors.by_moments) << pose.y;
    mean.as_in_runs += 0.25 * errors.as_in_runs;
    mean.by_moments += 0.25 * errors.by_moments;
  }
  EXPECT_LT(mean.as_in_runs, 0.036);
  EXPECT_GT(mean.by_moments, 1.5 * mean.as_in_runs);
}

TEST(LoadedRolling, ABrakedWheelSlidesWithAllItsFriction) {
  const ContactSearch search = search_of("S1002");
  const ContactAtLoad loaded = contact_at_load(search, {5e-3, 0.0, -1e-4, 0.012}, 75e3);
  ASSERT_EQ(loaded.contact.bands.size(), 2u);
  LoadedRollingOptions rolling;
  rolling.friction = 0.25;
  rolling.speed = 10.0;
  const LoadedRolling r =
      loaded_rolling(search.pair(), loaded.contact, {}, running_motion(loaded.contact.pose, 10.0, 0.0), rolling);
  ASSERT_TRUE(r.solution.converged);
  EXPECT_EQ(r.solution.adhesion, 0);
  // it drags the rail along; the elastic slip across turns the tractions by 1e-4, their sum along x by its square
  EXPECT_NEAR(r.on_rail.force.x() / (0.25 * loaded.contact.normal_force), 1.0, 1e-7);
  for (std::size_t b = 0; b < 2; ++b) {
    EXPECT_NEAR(r.bands[b].x / (-0.25 * loaded.contact.bands[b].normal_force), 1.0, 1e-7);
    EXPECT_NEAR(r.bands[b].creepage.x, 1.0, 1e-12);
  }
  EXPECT_LT(r.traction_x.maxCoeff(), 1e-3);
  EXPECT_NEAR(r.traction_x.sum() * loaded.contact.elements.area(), r.bands[0].x + r.bands[1].x, 1e-6);
}

// The wheel's creepages at the centre of pressure are those of its rolling radius there and of its contact angle.
TEST(LoadedRolling, CreepagesAreThoseOfTheKinematics) {
  const ContactSearch search = search_of("S1002");
  const double yaw = 0.004, speed = 30.0, pitch = -speed / 0.46;
  const ContactAtLoad loaded = contact_at_load(search, {-3e-3, 0.0, 0.0, yaw}, 50e3);
  LoadedRollingOptions rolling;
  rolling.speed = speed;
  const LoadedRolling r =
      loaded_rolling(search.pair(), loaded.contact, {}, running_motion(loaded.contact.pose, speed, pitch), rolling);
  const ContactBand& band = loaded.contact.bands.at(0);
  // first order in yaw and contact angle; what is left out is of their squares
  EXPECT_NEAR(r.bands.at(0).creepage.x, 1.0 - band.rolling_radius / 0.46, 2e-5);
  EXPECT_NEAR(r.bands[0].creepage.y, -yaw, 1e-4);
  EXPECT_NEAR(r.bands[0].creepage.spin, std::sin(band.angle) / 0.46, 2e-3);
}

TEST(LoadedRolling, FrictionTakesItsShareOfTheLoad) {
  const ContactSearch search = search_of("S1002");
  const WheelsetPose pose{7e-3, 0.0, 0.0, 0.005};
  LoadedRollingOptions rolling;
  rolling.speed = 30.0;
  const LoadedContactOptions options;
  const RelativeMotion motion = running_motion(pose, 30.0, -30.0 / 0.46);
  const auto share = [&](const LoadedContact& contact) {
    return loaded_rolling(search.pair(), contact, options, motion, rolling).on_rail.force.z();
  };
  const ContactAtLoad found = contact_at_load(search, pose, 40e3, options, share);
  ASSERT_TRUE(found.converged);
  EXPECT_NEAR((found.contact.on_rail.force.z() + share(found.contact)) / 40e3, 1.0, 1e-5);
  EXPECT_GT(std::abs(share(found.contact)), 1e3);  // on the flange, friction counts
}

TEST(LoadedRolling, RejectsWhatItCannotDo) {
  LoadedRollingOptions options;
  options.friction = 0.0;
  EXPECT_THROW(options.validate(), InputError);
  options = {};
  options.speed = -1.0;
  EXPECT_THROW(options.validate(), InputError);
}

}  // namespace
}  // namespace railtab
