// Equivalent conicity and rolling radius difference against closed forms.

#include "railtab/runtime/contact/equivalent_conicity.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/contact/contact_search.hpp"
#include "railtab/runtime/profile/standard_profiles.hpp"

namespace railtab {
namespace {

constexpr double mm = 1e-3;
constexpr double pi = std::numbers::pi;

// Δr as straight lines over equal steps from -a to a.
template <class F>
RadiusDifferenceCurve sampled(F difference, double a, int steps) {
  std::vector<double> y, r;
  for (int i = 0; i <= steps; ++i) {
    y.push_back(-a + 2.0 * a * i / steps);
    r.push_back(difference(y.back()));
  }
  return {y, r};
}

TEST(EquivalentConicity, OfAConeIsItsConicityAtEveryAmplitude) {
  for (const double gamma : {0.025, 0.2}) {
    const RadiusDifferenceCurve curve = sampled([&](double y) { return 2.0 * gamma * y; }, 10 * mm, 7);
    for (const double amplitude : {0.1 * mm, 3.0 * mm, 10.0 / 7.0 * mm, 9.99 * mm}) {
      const EquivalentConicity wave = conicity_of_wave(curve, amplitude);
      ASSERT_EQ(wave.status, ConicityStatus::found) << amplitude;
      EXPECT_NEAR(wave.tan_gamma, gamma, 1e-9 * gamma) << amplitude;
      EXPECT_NEAR(wave.y_high - wave.y_low, 2.0 * amplitude, 1e-15);
      EXPECT_NEAR(conicity_of_regression(curve, amplitude).tan_gamma, gamma, 1e-9 * gamma);
    }
  }
}

TEST(EquivalentConicity, OfAConeWithUnequalDiametersIsTheSameAboutAShiftedCentre) {
  const RadiusDifferenceCurve curve = sampled([](double y) { return 0.1 * y + 0.2 * mm; }, 10 * mm, 9);
  const EquivalentConicity wave = conicity_of_wave(curve, 3.0 * mm);
  EXPECT_NEAR(wave.tan_gamma, 0.05, 1e-9);
  EXPECT_NEAR(wave.y_low, -5.0 * mm, 1e-12);
  EXPECT_EQ(conicity_of_wave(curve, 8.5 * mm).status, ConicityStatus::outside);
}

// A step of Δr at y = 0: uniformly accelerated motion, ŷ = c x²/2 over a quarter of the wave, tan γe = π² c/(16 ŷ).
TEST(EquivalentConicity, OfAStepInTheRadiusDifference) {
  constexpr double c = 2.0 * mm;
  const RadiusDifferenceCurve curve({-10 * mm, -1e-12, 1e-12, 10 * mm}, {-c, -c, c, c});
  for (const double amplitude : {1.0 * mm, 5.0 * mm}) {
    EXPECT_NEAR(conicity_of_wave(curve, amplitude).tan_gamma, pi * pi * c / (16.0 * amplitude), 1e-7);
    // Least squares: slope 3c/(2ŷ).
    EXPECT_NEAR(conicity_of_regression(curve, amplitude).tan_gamma, 0.75 * c / amplitude, 1e-7);
  }
}

// Δr = k y³: wavelength 4 K(1/√2)/(√k ŷ) in units of √(e r0) with the complete elliptic integral K, of second order in
// the spacing of the samples.
TEST(EquivalentConicity, OfACubicRadiusDifferenceConvergesWithSecondOrder) {
  constexpr double k = 1e4;  // [1/m²]
  constexpr double amplitude = 4.0 * mm;
  const double wavelength = 4.0 * std::comp_ellint_1(std::numbers::sqrt2 / 2.0) / (std::sqrt(k) * amplitude);
  const double exact = 2.0 * pi * pi / (wavelength * wavelength);
  const auto error = [&](int steps) {
    const RadiusDifferenceCurve curve = sampled([](double y) { return k * y * y * y; }, 10 * mm, steps);
    return std::abs(conicity_of_wave(curve, amplitude).tan_gamma / exact - 1.0);
  };
  const double coarse = error(100);
  const double fine = error(400);
  EXPECT_LT(fine, 0.05 * 0.05 / (4.0 * 4.0)) << "(spacing/amplitude)²";
  EXPECT_GT(std::log2(coarse / fine) / 2.0, 1.7);
  EXPECT_LT(std::log2(coarse / fine) / 2.0, 2.3);
}

TEST(EquivalentConicity, NegativeConicityHasNoWaveAndANegativeRegression) {
  const RadiusDifferenceCurve curve = sampled([](double y) { return -0.04 * y; }, 10 * mm, 8);
  const EquivalentConicity wave = conicity_of_wave(curve, 3.0 * mm);
  EXPECT_NE(wave.status, ConicityStatus::found);
  EXPECT_TRUE(std::isnan(wave.tan_gamma));
  EXPECT_NEAR(conicity_of_regression(curve, 3.0 * mm).tan_gamma, -0.02, 1e-12);
  // Driven away from the centre to ±4.7 mm: small waves about one of these, large ones about the centre, none between.
  const RadiusDifferenceCurve walls({-10 * mm, -4 * mm, 0.0, 4 * mm, 10 * mm}, {-8 * mm, 1 * mm, 0.0, -1 * mm, 8 * mm});
  EXPECT_EQ(conicity_of_wave(walls, 9.0 * mm).status, ConicityStatus::found);
  EXPECT_EQ(conicity_of_wave(walls, 5.0 * mm).status, ConicityStatus::no_wave);
  const EquivalentConicity aside = conicity_of_wave(walls, 2.0 * mm);
  EXPECT_EQ(aside.status, ConicityStatus::found);
  EXPECT_GT(aside.y_low * aside.y_high, 0.0);
}

TEST(EquivalentConicity, RejectsCurvesThatAreNone) {
  EXPECT_THROW(RadiusDifferenceCurve({0.0, 0.0}, {0.0, 1.0}), InputError);
  EXPECT_THROW(RadiusDifferenceCurve({0.0, 1.0}, {0.0, std::nan("")}), InputError);
  EXPECT_THROW(RadiusDifferenceCurve({0.0}, {0.0}), InputError);
  EXPECT_THROW(RadiusDifferenceCurve({0.0, 1.0}, {0.0}), InputError);
}

// ------------------------------------------------------------------------------------------ from the contact geometry

// Arc of a circle about (centre_y, centre_z), angle phi from +z towards +y.
ProfileKnots arc(ProfileKind kind, double centre_y, double centre_z, double radius, double phi0, double phi1) {
  ProfileKnots k{kind, "arc", {}, {}, {}, {}, {}};
  constexpr int n = 400;
  for (int i = 0; i <= n; ++i) {
    const double phi = phi0 + (phi1 - phi0) * i / n;
    const double sign = phi1 > phi0 ? 1.0 : -1.0;
    k.s.push_back(radius * std::abs(phi - phi0));
    k.y.push_back(centre_y + radius * std::sin(phi));
    k.z.push_back(centre_z + radius * std::cos(phi));
    k.dy.push_back(sign * std::cos(phi));
    k.dz.push_back(-sign * std::sin(phi));
  }
  return k;
}

std::vector<WheelsetContact> contacts(const ContactSearch& search, WheelsetRoll roll, double difference = 0.0) {
  WheelsetContactOptions options;
  options.y_low = -6.0 * mm;
  options.y_high = 6.0 * mm;
  options.roll = roll;
  options.diameter_difference = difference;
  return wheelset_contacts(search, options);
}

// A concave wheel (arc of 500 mm, slope 1:20 at the tape circle) on a rail of 300 mm radius. The common normal is the
// line of the two centres: sin θ = (y − y0)/(500 − 300 mm), and the wheel's radius there R0 + z_c + 500 cos θ.
TEST(RollingRadiusDifference, OfArcOnArcFollowsTheLineOfCentres) {
  constexpr double wheel_radius = 0.5, rail_radius = 0.3, slope = 0.05;
  const double tilt = std::atan(slope);  // of the tread at the tape circle
  const double centre_y = wheel_radius * std::sin(tilt);
  const double centre_z = wheel_radius * std::cos(tilt);  // both centres of curvature are below the running surface
  const ProfileKnots wheel =
      arc(ProfileKind::wheel, centre_y, centre_z, wheel_radius, pi + 0.12 + tilt, pi - 0.12 + tilt);
  const ProfileKnots rail = arc(ProfileKind::rail, 0.0, rail_radius, rail_radius, pi + 0.17, pi - 0.17);
  PairDimensions dimensions;
  dimensions.gauge_height = 1e-3;
  WheelRailPair trial{ProfileCurve(wheel), ProfileCurve(rail), dimensions};
  dimensions.track_gauge += 2.0 * (trial.tape_circle_offset() - trial.rail_offset());
  const ContactSearch search(WheelRailPair(ProfileCurve(wheel), ProfileCurve(rail), dimensions));
  // Both centres and the contact lie on one line.
  const auto radius = [&](double y) {
    const double sine = (centre_y + y) / (wheel_radius - rail_radius);
    return centre_z - wheel_radius * std::sqrt(1.0 - sine * sine);
  };
  const auto wheelset = contacts(search, WheelsetRoll::off);
  ASSERT_FALSE(wheelset.empty());
  EXPECT_NEAR(wheelset.front().y, -6.0 * mm, 1e-12);
  EXPECT_NEAR(wheelset.back().y, 6.0 * mm, 1e-12);
  for (const WheelsetContact& c : wheelset) {
    EXPECT_NEAR(c.radius_difference, radius(c.y) - radius(-c.y), 1e-9) << c.y;
  }
}

TEST(RollingRadiusDifference, OfConesWithFreeRollIsKlingelsConicity) {
  const ContactSearch search(WheelRailPair(ProfileCurve(standard_profile(ProfileKind::wheel, "cone-1:40", 0.0)),
                                           ProfileCurve(standard_profile(ProfileKind::rail, "60E1", 0.0)),
                                           PairDimensions{}));
  const double gamma = 1.0 / 40.0;
  const double half = search.pair().rail_offset();
  const double r0 = search.pair().nominal_radius();
  const EquivalentConicity off = conicity_of_wave(RadiusDifferenceCurve(contacts(search, WheelsetRoll::off)), 3 * mm);
  EXPECT_NEAR(off.tan_gamma, gamma, 1e-6);
  // Half the rolling radius difference of a wheelset that rolls by −yγ/(L − r0 γ) on crowns of radius R is
  // γ(L + Rγ)/(L − r0 γ), to first order in γ².
  const EquivalentConicity free = conicity_of_wave(RadiusDifferenceCurve(contacts(search, WheelsetRoll::free)), 3 * mm);
  EXPECT_NEAR(free.tan_gamma, gamma * (half + 0.3 * gamma) / (half - r0 * gamma), 2e-3 * gamma);
  EXPECT_GT(free.tan_gamma, off.tan_gamma * 1.01);
}

TEST(RollingRadiusDifference, DiameterDifferenceAddsHalfOfItself) {
  const ContactSearch search(WheelRailPair(ProfileCurve(standard_profile(ProfileKind::wheel, "S1002", 0.0)),
                                           ProfileCurve(standard_profile(ProfileKind::rail, "60E1", 1.0 / 40.0)),
                                           PairDimensions{}));
  const RadiusDifferenceCurve equal(contacts(search, WheelsetRoll::off));
  const RadiusDifferenceCurve unequal(contacts(search, WheelsetRoll::off, 2.0 * mm));
  for (double y = -6.0 * mm; y <= 6.0 * mm; y += 0.37 * mm) {
    EXPECT_NEAR(unequal.at(y), equal.at(y) + 1.0 * mm, 1e-12);
  }
  // With free roll the larger wheel also lifts its side: the roll follows from the diameters alone, 2 mm/2 over 1.5 m.
  const auto free = contacts(search, WheelsetRoll::free, 2.0 * mm);
  const auto centre = std::min_element(free.begin(), free.end(),
                                       [](const auto& a, const auto& b) { return std::abs(a.y) < std::abs(b.y); });
  EXPECT_NEAR(centre->roll, -1.0 * mm / 1.5, 0.1e-3);
}

TEST(RollingRadiusDifference, FreeRollIsThatOfTheRigidPosition) {
  const ContactSearch search(WheelRailPair(ProfileCurve(standard_profile(ProfileKind::wheel, "S1002", 0.0)),
                                           ProfileCurve(standard_profile(ProfileKind::rail, "60E1", 1.0 / 40.0)),
                                           PairDimensions{}));
  const auto wheelset = contacts(search, WheelsetRoll::free);
  ASSERT_GT(wheelset.size(), 100u);
  for (std::size_t i = 0; i < wheelset.size(); i += 50) {
    const RigidPosition position = rigid_position(search, wheelset[i].y, 0.0);
    ASSERT_TRUE(position.converged);
    EXPECT_NEAR(wheelset[i].roll, position.roll, 1e-11) << wheelset[i].y;
    EXPECT_NEAR(wheelset[i].z_right, position.z, 1e-11);
  }
}

std::vector<WheelsetContact> contacts_of_sides(const ContactSearch& right, const ContactSearch& left,
                                               const WheelsetContactOptions& options) {
  return wheelset_contacts(searched_side(right), searched_side(left), options);
}

ContactSearch cone_search(const char* cone) {
  return ContactSearch(WheelRailPair(ProfileCurve(standard_profile(ProfileKind::wheel, cone, 0.0)),
                                     ProfileCurve(standard_profile(ProfileKind::rail, "60E1", 0.0)), PairDimensions{}));
}

// Unlike cones touch fixed points of their rails: Δr grows by the sum of their slopes. The mirror image of the wheelset
// has Δr(−y) and the roll −φ(−y).
TEST(RollingRadiusDifference, UnlikeWheelsCountEachOnItsSide) {
  const ContactSearch steep = cone_search("cone-1:20");
  const ContactSearch flat = cone_search("cone-1:40");
  WheelsetContactOptions options;
  options.y_low = -4.0 * mm;
  options.y_high = 4.0 * mm;
  const RadiusDifferenceCurve curve(contacts_of_sides(steep, flat, options));
  EXPECT_NEAR(curve.at(3.0 * mm) - curve.at(-3.0 * mm), (1.0 / 20.0 + 1.0 / 40.0) * 6.0 * mm, 1e-9);
  const RadiusDifferenceCurve mirrored(contacts_of_sides(flat, steep, options));
  for (const double y : {-3.0 * mm, 0.0, 1.3 * mm}) EXPECT_NEAR(mirrored.at(y), -curve.at(-y), 1e-11) << y;
  options.roll = WheelsetRoll::free;
  options.sampling = ShiftSampling::even;
  options.step = 1.0 * mm;
  const auto free = contacts_of_sides(steep, flat, options);
  const auto free_mirrored = contacts_of_sides(flat, steep, options);
  ASSERT_EQ(free.size(), 9u);
  ASSERT_EQ(free_mirrored.size(), 9u);
  EXPECT_GT(std::abs(free[7].roll), 1e-5);
  for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(free_mirrored[i].roll, -free[8 - i].roll, 1e-11) << i;
}

// Even samples are the multiples of the step and lie on the refined curve.
TEST(RollingRadiusDifference, EvenSamplesAreMultiplesOfTheStep) {
  const ContactSearch search(WheelRailPair(ProfileCurve(standard_profile(ProfileKind::wheel, "S1002", 0.0)),
                                           ProfileCurve(standard_profile(ProfileKind::rail, "60E1", 1.0 / 40.0)),
                                           PairDimensions{}));
  const RadiusDifferenceCurve refined(contacts(search, WheelsetRoll::off));
  WheelsetContactOptions options;
  options.y_low = -2.25 * mm;
  options.y_high = 6.0 * mm;
  options.sampling = ShiftSampling::even;
  options.step = 0.5 * mm;
  const auto even = contacts_of_sides(search, search, options);
  ASSERT_EQ(even.size(), 17u);
  for (std::size_t i = 0; i < even.size(); ++i) {
    EXPECT_NEAR(even[i].y, (static_cast<double>(i) - 4.0) * 0.5 * mm, 1e-15);
    EXPECT_NEAR(even[i].radius_difference, refined.at(even[i].y), 2e-7) << even[i].y;
  }
}

TEST(RollingRadiusDifference, RejectsOptionsOutOfRange) {
  WheelsetContactOptions options;
  options.y_low = 1e-3;
  EXPECT_THROW(options.validate(), InputError);
  options = {};
  options.diameter_difference = 0.1;
  EXPECT_THROW(options.validate(), InputError);
  options = {};
  options.tolerance = 0.0;
  EXPECT_THROW(options.validate(), InputError);
  options = {};
  options.step = 2e-3;
  EXPECT_THROW(options.validate(), InputError);
}

}  // namespace
}  // namespace railtab
