// The common-normal equations with dual numbers: the derivatives that are written out must be those of the residuals.
#include "railtab/runtime/contact/common_normal.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "contact_test_pairs.hpp"

namespace railtab {
namespace {

/// A number with its derivative by one parameter.
struct Dual {
  double value, rate;
  Dual(double v = 0.0, double r = 0.0) : value(v), rate(r) {}  // NOLINT(google-explicit-constructor): a constant
};
Dual operator+(const Dual& a, const Dual& b) { return {a.value + b.value, a.rate + b.rate}; }
Dual operator-(const Dual& a, const Dual& b) { return {a.value - b.value, a.rate - b.rate}; }
Dual operator*(const Dual& a, const Dual& b) { return {a.value * b.value, a.rate * b.value + a.value * b.rate}; }
Dual operator/(const Dual& a, const Dual& b) {
  return {a.value / b.value, (a.rate * b.value - a.value * b.rate) / (b.value * b.value)};
}
Dual sqrt(const Dual& a) { return {std::sqrt(a.value), 0.5 * a.rate / std::sqrt(a.value)}; }

constexpr double per_arc_length = 1.0;

/// The silhouette from the equations of wheel_silhouette.hpp alone, moving with s_wheel at `rate`.
struct DualSilhouette {
  PlaneVector<Dual> at, tangent;

  DualSilhouette(const WheelRailPair& pair, const WheelsetPose& pose, double s, double rate) {
    const PoseTrigonometry trig(pose);
    const CurvePoint w = pair.wheel().at(s);
    const Dual a(pair.tape_circle_offset() + w.y, w.dy * rate), R(pair.nominal_radius() + w.z, w.dz * rate);
    const Dual dy(w.dy, w.ddy * rate), dz(w.dz, w.ddz * rate);
    const Dual m = dz / dy;
    const Dual cosine = sqrt(silhouette_cosine2(m, trig));
    at = in_rail_head(silhouette_y(a, R, m, trig), R * cosine, wheelset_centre(pair, pose), trig);
    tangent = in_rail_head<Dual>(dy * cosine, dz * Dual(trig.inverse_cos_yaw), {0.0, 0.0}, trig);
  }
};

/// Residuals alone: their derivatives come with the dual numbers.
PairEquations<Dual> residuals(const DualSilhouette& S, const CurvePoint& C, double rail_rate) {
  const PlaneVector<Dual> tangent{{C.dy, C.ddy * rail_rate}, {C.dz, C.ddz * rail_rate}};
  const PlaneVector<Dual> e{S.at.y - Dual(C.y, C.dy * rail_rate), S.at.z - Dual(C.z, C.dz * rail_rate)};
  return common_normal<Dual>({S.tangent, {}, {}, {}}, {tangent, {}, {}}, e);
}

TEST(CommonNormal, DerivativesAreThoseOfDualNumbers) {
  const WheelRailPair& pair = contact_test::s1002_on_60e1();
  const WheelsetPose pose{0.004, 1e-3, -0.007, 0.03};
  const PoseTrigonometry trig(pose);
  for (const double y : {-0.0385, -0.0365, -0.0321, -0.021, -0.003, 0.0131}) {
    const double s_wheel = pair.wheel().s_at_y(y), s_rail = pair.rail().s_at_y(y);
    const CurvePoint C = pair.rail().at(s_rail);
    const SilhouettePoint S =
        placed(silhouette_point(pair.wheel().at(s_wheel), pair.tape_circle_offset(), pair.nominal_radius(), trig),
               wheelset_centre(pair, pose), trig);
    const PlaneVector<double> e{S.y - C.y, S.z - C.z};
    const PairEquations<double> equations = common_normal(wheel_tangent(S), rail_tangent(C), e);
    const PairEquations<Dual> by_wheel = residuals({pair, pose, s_wheel, per_arc_length}, C, 0.0);
    const PairEquations<Dual> by_rail = residuals({pair, pose, s_wheel, 0.0}, C, per_arc_length);
    constexpr double rounding = 1e-12;  // of curvatures up to 1e3 1/m
    EXPECT_NEAR(equations.f, by_wheel.f.value, 1e-14) << y;
    EXPECT_NEAR(equations.g, by_wheel.g.value, 1e-14) << y;
    EXPECT_NEAR(equations.f_w, by_wheel.f.rate, rounding) << y;
    EXPECT_NEAR(equations.g_w, by_wheel.g.rate, rounding * 1e3) << y;
    EXPECT_NEAR(equations.f_r, by_rail.f.rate, rounding) << y;
    EXPECT_NEAR(equations.g_r, by_rail.g.rate, rounding * 1e3) << y;

    const FootOfNormal<double> foot({C.dy, C.dz}, {C.ddy, C.ddz}, e);
    EXPECT_NEAR(-foot.fall, by_rail.f.rate, rounding) << y;
    const PairEquations<double> touch = common_tangent(wheel_tangent(S), rail_tangent(C), e.y);
    const DualSilhouette moved(pair, pose, s_wheel, per_arc_length);
    EXPECT_NEAR(touch.f_w, moved.at.y.rate, rounding) << y;
    EXPECT_EQ(touch.f_r, -C.dy) << y;
  }
}

// The step solves the linear system, so that residuals after it are of second order.
TEST(CommonNormal, StepRemovesTheResidualsToFirstOrder) {
  const PairEquations<double> e{0.3e-3, -0.2e-3, 0.9, -1.1, 4.0, 7.0};
  const PlaneVector<double> scaled = e.scaled_step();
  const double w = scaled.y / e.determinant(), r = scaled.z / e.determinant();
  EXPECT_NEAR(e.f + e.f_w * w + e.f_r * r, 0.0, 1e-18);
  EXPECT_NEAR(e.g + e.g_w * w + e.g_r * r, 0.0, 1e-18);
}

}  // namespace
}  // namespace railtab
