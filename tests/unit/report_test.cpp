#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "headline.hpp"
#include "railtab/runtime/report/axis_ticks.hpp"
#include "railtab/runtime/report/chart.hpp"
#include "railtab/runtime/report/html_text.hpp"
#include "railtab/runtime/report/polyline.hpp"
#include "report_run.hpp"

namespace railtab::report {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

TEST(AxisTicks, StandAtRoundNumbersAndEncloseTheData) {
  const Axis axis = rounded_axis(-0.37, 4.1, 5);
  EXPECT_DOUBLE_EQ(axis.low, -1.0);
  EXPECT_DOUBLE_EQ(axis.high, 5.0);
  ASSERT_EQ(axis.ticks.size(), 7u);
  EXPECT_EQ(axis.ticks[0].label, "−1");
  EXPECT_EQ(axis.ticks[1].label, "0");
  EXPECT_EQ(axis.ticks[6].label, "5");
}

TEST(AxisTicks, TightAxisEndsWithTheData) {
  const Axis axis = tight_axis(0.03, 0.47, 5);
  EXPECT_EQ(axis.low, 0.03);
  EXPECT_EQ(axis.high, 0.47);
  ASSERT_EQ(axis.ticks.size(), 4u);
  EXPECT_EQ(axis.ticks.front().label, "0.1");
  EXPECT_EQ(axis.ticks.back().label, "0.4");
}

TEST(AxisTicks, ConstantDataGetAnAxis) {
  for (const double value : {0.0, 5.0, -3e-7, 1e9}) {
    const Axis axis = rounded_axis(value, value, 5);
    EXPECT_LT(axis.low, axis.high);
    EXPECT_LE(axis.low, value);
    EXPECT_GE(axis.high, value);
    EXPECT_GE(axis.ticks.size(), 2u);
    EXPECT_LE(axis.ticks.size(), 12u);
  }
}

TEST(Polyline, KeepsEveryPeakOfALongSignal) {
  const int n = 100000;
  std::vector<double> x(n), y(n, 0.0);
  for (int i = 0; i < n; ++i) x[i] = i;
  y[12345] = 7.0;
  y[12346] = -9.0;
  const std::vector<Point> points = decimated(x, y, tight_axis(0, n - 1, 5), 500);
  EXPECT_LE(points.size(), 2004u);
  EXPECT_NE(std::find_if(points.begin(), points.end(), [](Point p) { return p.x == 12345 && p.y == 7.0; }),
            points.end());
  EXPECT_NE(std::find_if(points.begin(), points.end(), [](Point p) { return p.x == 12346 && p.y == -9.0; }),
            points.end());
  EXPECT_TRUE(std::is_sorted(points.begin(), points.end(), [](Point a, Point b) { return a.x < b.x; }));
}

TEST(Polyline, ShortSignalIsKeptAsItIs) {
  const std::vector<double> x{0, 1, 2, 3}, y{4, 1, 3, 2};
  const std::vector<Point> points = decimated(x, y, tight_axis(0, 3, 5), 500);
  ASSERT_EQ(points.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(points[i].y, y[i]);
}

TEST(Polyline, GapStartsANewLine) {
  const std::vector<double> x{0, 1, 2, 3, 4}, y{0, 1, nan, nan, 1};
  const Axis axis{0, 4, {}}, up{0, 1, {}};
  EXPECT_EQ(path_data(decimated(x, y, axis, 100), axis, up), "M0.0 1000.0L250.0 0.0M1000.0 0.0");
}

TEST(HtmlText, EscapesAndRounds) {
  EXPECT_EQ(escaped("a<b & \"c\" 'd'>"), "a&lt;b &amp; &quot;c&quot; &#39;d&#39;&gt;");
  EXPECT_EQ(escaped("tab\tline\nm²"), "tab\tline\nm²");
  EXPECT_EQ(escaped("\x1b[2J\xff\x7f"), "\\x1B[2J\\xFF\\x7F");
  EXPECT_EQ(shown(1234.56), "1235");
  EXPECT_EQ(shown(0.012345), "0.0123");
  EXPECT_EQ(shown(-2.0), "−2.00");
  EXPECT_EQ(shown(0.0), "0");
  EXPECT_EQ(shown(nan), "–");
}

TEST(Chart, LimitIsInsideTheAxisAndNamed) {
  const std::string html = chart_html({"T", "", "x", "y", {{"line", {0, 1}, {0.0, 0.1}}}, {}, {{0.8, "0.8 – limit"}}});
  EXPECT_NE(html.find("0.8 – limit"), std::string::npos);
  EXPECT_NE(html.find("data-y=\"0,1\""), std::string::npos);
  EXPECT_EQ(chart_html({"T", "", "x", "y", {{"line", {0, 1}, {nan, nan}}}, {}, {}}), "");
}

TEST(Headline, TakesTheExtremesOfTheRightBodiesAndWheels) {
  const Headline headline = headline_of(small_run());
  EXPECT_EQ(headline.deck_acceleration.value, 3.0);
  EXPECT_EQ(headline.deck_acceleration.where, "deck-midspan-1");
  EXPECT_EQ(headline.deck_acceleration.time, 0.1);
  EXPECT_EQ(headline.deck_displacement.value, 0.004);
  EXPECT_EQ(headline.car_body_vertical.value, 0.5);
  EXPECT_EQ(headline.car_body_lateral.value, 0.25);
  EXPECT_EQ(headline.car_body_lateral.where, "coach-1");
  EXPECT_DOUBLE_EQ(headline.derailment.value, 0.2);
  EXPECT_EQ(headline.derailment.where, "wheelset 1 left");
  EXPECT_DOUBLE_EQ(headline.unloading.value, 0.2);
  EXPECT_EQ(headline.largest_Q.value, 60e3);
  EXPECT_EQ(headline.smallest_Q.value, 40e3);
  EXPECT_EQ(headline.distance, 5.0);
  EXPECT_EQ(headline.table_share, 0.75);
  EXPECT_DOUBLE_EQ(headline.real_time_factor, 2.0);
}

TEST(Headline, TakesTheWheelsExtremesOfAllStepsWhereTheSummaryHasThem) {
  RunResults run = small_run();
  const Headline recorded = headline_of(run);
  WheelExtremes& all = run.summary.wheel_extremes;
  all.largest_Q = {recorded.largest_Q.value + 1.0, 0.125, 1};
  all.unloading = {recorded.unloading.value + 0.5, 0.25, 0};
  const Headline headline = headline_of(run);
  EXPECT_EQ(headline.largest_Q.value, recorded.largest_Q.value + 1.0);
  EXPECT_EQ(headline.largest_Q.time, 0.125);
  EXPECT_EQ(headline.largest_Q.where, "wheelset 1 right");
  EXPECT_EQ(headline.unloading.value, recorded.unloading.value + 0.5);
  EXPECT_EQ(headline.unloading.where, "wheelset 1 left");
  EXPECT_EQ(headline.smallest_Q.value, recorded.smallest_Q.value);
  EXPECT_EQ(headline.derailment_2m.value, recorded.derailment_2m.value);
}

// Wheels without a profile have no lateral forces, and a train in the vertical plane no lateral motion.
TEST(Headline, RigidWheelsHaveNoLateralExtremes) {
  RunResults run = long_run(200, 2);
  ASSERT_TRUE(headline_of(run).derailment_2m.found());
  run.header.wheel_y.clear();
  run.header.wheel_z.clear();
  run.summary.wheel_extremes.largest_Q = {60e3, 0.1, 0};
  for (StepRecord& step : run.steps) {
    for (WheelRecord& wheel : step.wheels) wheel.Y = 0.0;
    for (MotionRecord& body : step.bodies) body.acceleration[1] = 0.0;
  }
  const Headline headline = headline_of(run);
  EXPECT_FALSE(headline.derailment.found() || headline.derailment_2m.found() || headline.track_shift_2m.found());
  EXPECT_FALSE(headline.car_body_lateral.found());
  EXPECT_TRUE(headline.largest_Q.found() && headline.unloading.found() && headline.car_body_vertical.found());
  EXPECT_EQ(headline.extent, "the recorded steps; Q and unloading of all steps");
}

TEST(Headline, SlidingMeansAreOverTwoMetresOfWay) {
  RunResults run = small_run();
  const StepRecord pattern = run.steps[1];
  run.steps.clear();
  for (int i = 0; i < 12; ++i) {  // half a metre apart: four intervals in 2 m
    StepRecord step = pattern;
    step.position = 0.5 * i;
    step.time = 0.01 * i;
    step.wheels[0] = {.Q = 50e3, .Y = i == 4 ? -40e3 : 0.0};
    step.wheels[1] = {.Q = 50e3, .Y = 5e3};
    run.steps.push_back(step);
  }
  const Headline headline = headline_of(run);
  EXPECT_DOUBLE_EQ(headline.derailment.value, 0.8);
  EXPECT_DOUBLE_EQ(headline.derailment_2m.value, 0.2);
  EXPECT_EQ(headline.derailment_2m.where, "wheelset 1 left");
  EXPECT_DOUBLE_EQ(headline.track_shift_2m.value, 5e3);  // with the peak it is (3·5 kN − 35 kN)/4
  run.steps.back().position += 0.1;                      // fewer records than make a mean
  EXPECT_FALSE(headline_of(run).derailment_2m.found());
  EXPECT_FALSE(headline_of(run).track_shift_2m.found());
}

// Wheels and car bodies where each of them stands, the deck throughout.
TEST(Headline, CountsOnTheJudgedStretch) {
  RunResults run = small_run();
  const std::size_t wheels = run.header.wheel_x.size();
  ASSERT_EQ(wheels, 2u);
  ASSERT_EQ(run.steps.size(), 2u);
  const double ahead = 1.0 - run.header.wheel_x[0];  // of the wheelset at the second record, when it is at x = 1 m
  run.steps[0].position = ahead - 2.0;
  run.steps[1].position = ahead;
  EXPECT_TRUE(headline_of(run).extent.ends_with("the recorded steps"));
  run.header.judged = {0.0, 1e6};
  const Headline headline = headline_of(run);
  const WheelRecord &left = run.steps[1].wheels[0], &right = run.steps[1].wheels[1];
  EXPECT_EQ(headline.largest_Q.value, std::max(left.Q, right.Q));
  EXPECT_EQ(headline.largest_Q.time, run.steps[1].time);
  EXPECT_EQ(headline.smallest_Q.value, std::min(left.Q, right.Q));
  EXPECT_EQ(headline.car_body_vertical.time, run.steps[1].time);
  EXPECT_EQ(headline.deck_acceleration.value, 3.0);
  EXPECT_TRUE(headline.extent.ends_with("wheels and car bodies from x = 0 m")) << headline.extent;
  run.header.judged = {2.0, 3.0};
  EXPECT_FALSE(headline_of(run).largest_Q.found());
  EXPECT_FALSE(headline_of(run).car_body_vertical.found());
  EXPECT_TRUE(headline_of(run).deck_acceleration.found());
}

TEST(Headline, LiftOffIsNoDerailmentCoefficientButWholeUnloading) {
  RunResults run = small_run();
  run.steps[1].wheels[0].Q = 0.0;
  run.steps[1].wheels[0].Y = 0.0;
  const Headline headline = headline_of(run);
  EXPECT_EQ(headline.unloading.value, 1.0);
  EXPECT_DOUBLE_EQ(headline.derailment.value, 0.16);  // of the first record
}

}  // namespace
}  // namespace railtab::report
