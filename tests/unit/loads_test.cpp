// Histories of speed, load and ground motion, and rails over turning spans.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>
#include <vector>

#include "../folder_fixture.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/line/body_load.hpp"
#include "railtab/runtime/line/ground_motion.hpp"
#include "railtab/runtime/line/span_deviation.hpp"
#include "railtab/runtime/line/speed_profile.hpp"
#include "railtab/runtime/line/wind_load.hpp"

namespace railtab {
namespace {

constexpr double pi = std::numbers::pi;

class HistoryFile : public testing::InFolder {
 protected:
  [[nodiscard]] std::filesystem::path file(const std::string& text) const {
    std::ofstream(folder_ / "h.csv") << text;
    return folder_ / "h.csv";
  }
  template <class Reader>
  [[nodiscard]] std::string message(const std::string& text, Reader&& read) const {
    try {
      static_cast<void>(read(file(text)));
    } catch (const InputError& wrong) {
      std::string what = wrong.what();
      return what.substr(what.find("h.csv"));
    }
    return "no error";
  }
};

TEST(LoadHistory, PulsesAreRisesWithTheirFalls) {
  const auto pulses = [](std::vector<double> points, const std::vector<double>& lateral) {
    std::vector<ForceAndMoment> loads;
    for (const double Fy : lateral) {
      loads.emplace_back(ForceAndMoment::Zero());
      loads.back()[1] = Fy;
    }
    return LoadHistory(LoadArgument::time, std::move(points), std::move(loads)).pulses();
  };
  // a level, a spike of two lines each way, a level, and a dent of a fifteenth, which is too small
  const auto spike = pulses({0, 1, 1.5, 2, 3, 4, 6, 7, 8}, {1, 1, 10, 16, 8, 1, 1, 0, 1});
  ASSERT_EQ(spike.size(), 1U);
  EXPECT_EQ(spike[0].component, 1);
  EXPECT_DOUBLE_EQ(spike[0].begin, 1.0);
  EXPECT_DOUBLE_EQ(spike[0].end, 4.0);
  EXPECT_DOUBLE_EQ(spike[0].height, 15.0);
  // a level at the top belongs to it; a ramp has none; each of two halves of a wave back and forth
  const auto block = pulses({0, 1, 2, 3}, {0, -5, -5, 0});
  ASSERT_EQ(block.size(), 1U);
  EXPECT_DOUBLE_EQ(block[0].end - block[0].begin, 3.0);
  EXPECT_TRUE(pulses({0, 1, 2, 3}, {0, 1, 2, 2}).empty());
  EXPECT_EQ(pulses({0, 1, 2, 3}, {0, 2, -2, 0}).size(), 2U);
  ForceAndMoment peak = ForceAndMoment::Zero();
  peak[2] = -1e4;
  const auto gust = gust_history(peak, 3.0, 0.5).pulses();
  ASSERT_EQ(gust.size(), 1U);
  EXPECT_DOUBLE_EQ(gust[0].begin, 3.0);
  EXPECT_DOUBLE_EQ(gust[0].end, 3.5);
  EXPECT_DOUBLE_EQ(gust[0].height, 1e4);
}

TEST(SpeedProfile, DistanceIsTheIntegralOfTheSpeed) {
  const SpeedProfile profile({-1.0, 2.0, 5.0, 6.0}, {40.0, 40.0, 10.0, 25.0});
  EXPECT_DOUBLE_EQ(profile.speed(-9.0), 40.0);
  EXPECT_DOUBLE_EQ(profile.speed(3.5), 25.0);
  EXPECT_DOUBLE_EQ(profile.speed(9.0), 25.0);
  EXPECT_DOUBLE_EQ(profile.acceleration(3.0), -10.0);
  EXPECT_DOUBLE_EQ(profile.acceleration(5.0), 15.0);  // after the jump
  EXPECT_DOUBLE_EQ(profile.acceleration(7.0), 0.0);
  EXPECT_DOUBLE_EQ(profile.distance(0.0), 0.0);
  EXPECT_DOUBLE_EQ(profile.distance(-2.0), -80.0);
  EXPECT_DOUBLE_EQ(profile.distance(6.0), 80.0 + 75.0 + 17.5);
  for (double t = -3.0; t < 8.0; t += 0.37) {
    constexpr double h = 1e-4;
    EXPECT_NEAR((profile.distance(t + h) - profile.distance(t - h)) / (2.0 * h), profile.speed(t), 1e-3);
    EXPECT_NEAR(profile.time_at(profile.distance(t)), t, 1e-12);
  }
}

TEST_F(HistoryFile, SpeedIsReadInItsUnit) {
  EXPECT_DOUBLE_EQ(read_speed_profile(file("# braking\nt[s],V[km/h]\n0,180\n10,90\n")).speed(5.0), 37.5);
  const auto read = [](const auto& f) { return read_speed_profile(f); };
  EXPECT_EQ(message("t[s],V[m/s]\n0,10\n1,-1\n", read), "h.csv:3: column V: found -1 m/s, expected 0 to 200 m/s");
  EXPECT_EQ(message("t[s],V[m/s]\n0,10\n0,20\n", read),
            "h.csv:3: column t: found 0, expected more than 0 of the row before");
  EXPECT_EQ(message("t[s],V[m/s]\n0,10\n1e-300,20\n", read),
            "h.csv:3: column t: found 1e-300, expected at least 1e-09 more than 0 of the row before");
  EXPECT_EQ(message("t[s],V[m/s]\n-1e308,10\n0,20\n", read),
            "h.csv:2: column t: found -1e+308 s, expected -1e+09 to 1e+09 s");
  EXPECT_EQ(message("t[s],V[mph]\n0,10\n1,20\n", read),
            "h.csv:1: column V: found unit [mph], expected V[m/s], V[km/h]");
  EXPECT_EQ(message("t[s],V[m/s]\n0,10\n1,ten\n", read), "h.csv:3: column V: found 'ten', expected a finite number");
}

TEST_F(HistoryFile, LoadsAreReadOverTimeOrPosition) {
  const LoadHistory gust = read_load_history(file("t[s],Fy[kN],Mx[kN m]\n1,0,0\n3,40,-8\n"), 0.5);
  EXPECT_EQ(gust.argument(), LoadArgument::time);
  EXPECT_DOUBLE_EQ(gust.at(2.5)[1], 20e3);
  EXPECT_DOUBLE_EQ(gust.at(2.5)[3], -4e3);
  EXPECT_DOUBLE_EQ(gust.at(99.0)[1], 40e3);
  EXPECT_EQ(gust.at(0.0), ForceAndMoment::Zero());
  EXPECT_TRUE(gust.acting()[1] && gust.acting()[3] && !gust.acting()[0] && !gust.acting()[2]);
  EXPECT_EQ(read_load_history(file("x[m],Fz[N]\n0,0\n9,9\n")).argument(), LoadArgument::position);
  const auto read = [](const auto& f) { return read_load_history(f); };
  EXPECT_EQ(message("t[s],F[N]\n0,1\n1,1\n", read),
            "h.csv:1: column F: found column 'F', expected each of Fx, Fy, Fz, Mx, My, Mz at most once");
  EXPECT_EQ(message("Fy[N],t[s]\n0,1\n1,1\n", read),
            "h.csv:1: column Fy: found column 'Fy', expected t[s] or x[m] first");
  EXPECT_EQ(message("t[s],Fy[N]\n0,1\n1,1,5\n", read), "h.csv:3: found 3 columns, expected 2, as in the header");
}

TEST(GustHistory, IsOneMinusCosine) {
  const ForceAndMoment peak = (ForceAndMoment() << 0, 30e3, 0, 5e3, 0, 0).finished();
  const LoadHistory gust = gust_history(peak, 2.0, 8.0);
  double worst = 0.0;
  for (double t = 2.0; t <= 10.0; t += 0.0013) {
    worst = std::max(worst, std::abs(gust.at(t)[1] / peak[1] - 0.5 * (1.0 - std::cos(2.0 * pi * (t - 2.0) / 8.0))));
  }
  EXPECT_LT(worst, 2e-5);
  EXPECT_GT(worst, 1e-6);  // straight lines, not the function
  EXPECT_EQ(gust.at(1.9), ForceAndMoment::Zero());
  EXPECT_EQ(gust.at(10.1), ForceAndMoment::Zero());
}

constexpr const char* coefficients =
    "yaw[deg],C_Fy[1],C_Fz[1],C_Mx[1],C_My[1],C_Mz[1]\n0,0,-0.1,0,0,0\n20,1,-0.7,0.6,0.1,0.3\n50,3,-2,1.7,0.3,0.5\n"
    "90,4,-1.5,2,0.2,0.1\n";

// A train at 40 m/s in wind of 30 m/s from the left meets 50 m/s at the angle of the triangle 3-4-5.
TEST_F(HistoryFile, WindActsByItsSpeedRelativeToTheTrain) {
  const Aerodynamics vehicle = read_aerodynamics(file(coefficients));
  const Wind left{0.5 * pi};
  const RelativeWind met = relative_wind(left, 40.0, 30.0);
  EXPECT_DOUBLE_EQ(met.speed, 50.0);
  EXPECT_DOUBLE_EQ(met.yaw, std::asin(0.6));
  const double share = (std::asin(0.6) * 180.0 / pi - 20.0) / 30.0, force = 0.5 * 1.225 * 50.0 * 50.0 * 10.0;
  const double C_Fy = 1.0 + 2.0 * share, C_Mx = 0.6 + 1.1 * share, height = 1.8;
  const ForceAndMoment load = wind_load(vehicle, left, 40.0, 30.0, height);
  EXPECT_EQ(load[0], 0.0);
  EXPECT_NEAR(load[1], force * C_Fy, 1e-9 * force);
  EXPECT_NEAR(load[2], force * (-0.7 - 1.3 * share), 1e-9 * force);
  EXPECT_NEAR(load[4], force * 3.0 * (0.1 + 0.2 * share), 1e-9 * force);
  EXPECT_NEAR(load[5], force * 3.0 * (0.3 + 0.2 * share), 1e-9 * force);
  // Wind from the left rolls a vehicle to the right, by C_Mx about the rails: about a point above them by less.
  EXPECT_NEAR(load[3], force * (3.0 * C_Mx - height * C_Fy), 1e-9 * force);
  EXPECT_NEAR(wind_load(vehicle, left, 40.0, 30.0, 0.0)[3], force * 3.0 * C_Mx, 1e-9 * force);

  const ForceAndMoment right = wind_load(vehicle, {-0.5 * pi}, 40.0, 30.0, height);
  for (const int k : {1, 3, 5}) EXPECT_EQ(right[k], -load[k]);
  for (const int k : {0, 2, 4}) EXPECT_EQ(right[k], load[k]);
  // Wind from behind at the train's speed is calm.
  EXPECT_NEAR(wind_load(vehicle, {pi}, 40.0, 40.0, height).norm(), 0.0, 1e-9);
}

// Straight lines between the points of the load, through gusts, braking and the kinks of coefficients.
TEST_F(HistoryFile, WindBetweenPointsIsOffByATenThousandth) {
  const Aerodynamics vehicle = read_aerodynamics(file(coefficients));
  const SpeedProfile profile({0.0, 10.0, 20.0}, {60.0, 60.0, 2.0});
  const auto train_speed = [&](double time) { return profile.speed(time); };
  for (const double direction : {0.5 * pi, -0.6, 2.2}) {
    const Wind wind{direction};
    for (const WindHistory& plain : {wind_gust(28.0, 5.0, 12.0), WindHistory{LoadArgument::time, {3, 4}, {0, 20}}}) {
      if (direction == 2.2 && plain.speed.back() > 0.0) continue;  // beyond 90 degrees as the train brakes
      const WindHistory history = with_points(plain, profile.points());
      const auto exact = [&](double t) {
        const auto gust = with_points(plain, {t});
        const auto at = std::lower_bound(gust.points.begin(), gust.points.end(), t) - gust.points.begin();
        return wind_load(vehicle, wind, profile.speed(t), gust.speed[static_cast<std::size_t>(at)], 1.8);
      };
      const LoadHistory load = wind_load_history(vehicle, wind, history, train_speed, 1.8);
      double worst = 0.0, largest = 0.0;
      for (double t = 0.0; t <= 20.0; t += 0.0037) {
        worst = std::max(worst, (load.at(t) - exact(t)).norm());
        largest = std::max(largest, exact(t).norm());
      }
      EXPECT_GT(largest, 1e4);
      EXPECT_LT(worst, 1e-4 * largest) << direction;
    }
  }
}

TEST_F(HistoryFile, WindIsReadOverTimeOrPosition) {
  const WindHistory history = read_wind_history(file("t[s],U[km/h]\n0,36\n2,72\n"), 1.0);
  EXPECT_EQ(history.points, (std::vector<double>{1.0, 3.0}));
  EXPECT_DOUBLE_EQ(history.speed[1], 20.0);
  EXPECT_EQ(read_wind_history(file("x[m],U[m/s]\n0,1\n2,2\n")).argument, LoadArgument::position);
  const auto read = [](const auto& f) { return read_wind_history(f); };
  EXPECT_EQ(message("t[s],U[m/s]\n0,1\n1,-2\n", read),
            "h.csv:3: column U: found -2 m/s, expected a speed of the wind, at least 0; load.wind_direction says from "
            "where");
  EXPECT_EQ(message("t[s],V[m/s]\n0,1\n1,2\n", read),
            "h.csv:1: column t: found columns t, V, expected t[s] or x[m], and U[m/s], the speed of the wind");
}

TEST_F(HistoryFile, CoefficientsThatDoNotHoldAreNamed) {
  const auto read = [](const auto& f) { return read_aerodynamics(f); };
  EXPECT_EQ(message("angle[deg],C_Fy[1]\n0,0\n9,1\n", read),
            "h.csv:1: column angle: found column 'angle', expected yaw[deg] first");
  EXPECT_EQ(message("yaw[deg],C_Fy[1]\n5,0\n9,1\n", read),
            "h.csv:2: column yaw: found 5 deg, expected 0: wind from the left, from ahead to behind");
  EXPECT_EQ(message("yaw[deg],C_Fy[1]\n0,0\n190,1\n", read),
            "h.csv:3: column yaw: found 190 deg, expected at most 180°");
  EXPECT_EQ(message("yaw[deg],C_Fx[1]\n0,0\n90,1\n", read),
            "h.csv:1: column C_Fx: found column 'C_Fx', expected each of C_Fy, C_Fz, C_Mx, C_My, C_Mz at most once");
  EXPECT_EQ(message("yaw,C_Fy\n0,0\n90,1\n", read),
            "h.csv:1: found header 'yaw', expected name[unit], as in "
            "yaw[deg],C_Fy[1],C_Fz[1],C_Mx[1],C_My[1],C_Mz[1]; columns that are 0 may be absent");
  // A yaw angle that the tunnel did not reach: the largest of the gust, not the first beyond the table.
  const Aerodynamics vehicle = read_aerodynamics(file("yaw[deg],C_Fy[1]\n0,0\n30,1\n"));
  const WindHistory gust = wind_gust(30.0, 0.0, 1.0);
  const auto slow = [](double) { return 40.0; };
  EXPECT_TRUE(message("", [&](const auto&) {
                return wind_load_history(vehicle, {0.5 * pi}, gust, slow, 1.8);
              }).starts_with("h.csv: found coefficients up to a yaw angle of 30°, expected up to 36.87°, the largest"));
  EXPECT_NO_THROW(static_cast<void>(wind_load_history(vehicle, {0.5 * pi}, wind_gust(20, 0, 1), slow, 1.8)));
}

// Displacement, velocity and acceleration belong together everywhere, by differences.
void expect_consistent(const GroundRecord& record, double from, double to) {
  constexpr double h = 1e-5;
  for (double t = from; t < to; t += 0.0377) {
    const GroundState s = record.at(t), after = record.at(t + h), before = record.at(t - h);
    for (int k = 0; k < 2; ++k) {
      EXPECT_NEAR((after.displacement[k] - before.displacement[k]) / (2.0 * h), s.velocity[k], 1e-7) << t;
      EXPECT_NEAR((after.velocity[k] - before.velocity[k]) / (2.0 * h), s.acceleration[k], 1e-3) << t;
    }
  }
}

TEST(GroundRecord, AccelerationsEndAtRestWhereTheyBegan) {
  std::vector<double> time;
  std::vector<GroundVector> acceleration;
  for (int i = 0; i <= 400; ++i) {
    time.push_back(1.0 + 0.01 * i);
    const double tau = 0.01 * i;
    acceleration.emplace_back(2.0 * std::sin(3.0 * tau) + 0.05, std::cos(7.0 * tau) * std::exp(-tau));
  }
  const GroundRecord record = GroundRecord::from_acceleration(time, acceleration);
  EXPECT_LT(record.at(record.end()).displacement.norm(), 1e-12);
  EXPECT_LT(record.at(record.end() - 1e-9).velocity.norm(), 1e-7);
  EXPECT_EQ(record.at(0.5).displacement, GroundVector::Zero());
  expect_consistent(record, 1.01, 4.99);
  // What is added is one straight line in time, no larger than said.
  const auto added = [&](std::size_t i) -> double { return record.at(time[i]).acceleration[0] - acceleration[i][0]; };
  EXPECT_NEAR(added(1) - 2.0 * added(200) + added(399), 0.0, 1e-12);
  EXPECT_NEAR(std::max(std::abs(added(1)), std::abs(added(399))), record.drift_correction()[0],
              0.01 * record.drift_correction()[0]);
  EXPECT_GT(record.drift_correction()[0], 0.05);
}

TEST(GroundRecord, DisplacementsGiveTheSplinesAcceleration) {
  // (1 − cos ωt): begins and ends at rest; a cubic spline's second derivative is second-order accurate.
  const double omega = 2.0 * pi;
  std::array<double, 2> error{};
  for (int pass = 0; pass < 2; ++pass) {
    const int n = pass == 0 ? 40 : 80;
    std::vector<double> time;
    std::vector<GroundVector> displacement;
    for (int i = 0; i <= n; ++i) {
      time.push_back(1.0 * i / n);
      displacement.emplace_back(0.7 + 1.0 - std::cos(omega * time.back()), 0.0);
    }
    const GroundRecord record = GroundRecord::from_displacement(time, displacement);
    expect_consistent(record, 0.01, 0.99);
    for (double t = 0.0; t < 1.0; t += 0.0071) {
      error[static_cast<std::size_t>(pass)] =
          std::max(error[static_cast<std::size_t>(pass)],
                   std::abs(record.at(t).acceleration[0] - (t > 0.0 ? omega * omega * std::cos(omega * t) : 0.0)));
    }
    EXPECT_NEAR(record.at(0.5).displacement[0], 2.0, 1e-6);  // from the first point's 0.7
    EXPECT_EQ(record.drift_correction(), GroundVector::Zero());
  }
  EXPECT_NEAR(std::log2(error[0] / error[1]), 2.0, 0.3);
}

TEST_F(HistoryFile, GroundRecordsAreReadInTheirUnit) {
  const GroundRecord g = read_ground_record(file("t[s],y[g]\n0,0\n1,0.1\n2,0\n3,-0.1\n4,0\n"));
  EXPECT_EQ(g.at(1.5).acceleration[1], 0.0);
  EXPECT_GT(g.at(1.0).acceleration[0], 0.5);
  EXPECT_NEAR(read_ground_record(file("t[s],z[mm]\n0,0\n1,5\n2,5\n")).at(2.0).displacement[1], 5e-3, 1e-15);
  const auto read = [](const auto& f) { return read_ground_record(f); };
  EXPECT_EQ(message("t[s],y[m],z[g]\n0,0,0\n1,0,0\n", read),
            "h.csv:1: column z: found accelerations and displacements, expected either of them");
  EXPECT_EQ(message("t[s],x[m]\n0,0\n1,0\n", read),
            "h.csv:1: column x: found column 'x', expected y and z, each at most once");
}

GroundRecord pulse(double height) {
  return GroundRecord::from_displacement({0.0, 0.5, 1.0, 1.5}, {{0, 0}, {height, 0}, {height, 0.5 * height}, {0, 0}});
}

TEST(GroundMotion, DerivativesAlongTheTrackAreThoseOfTheWave) {
  const GroundMotion wave(pulse(0.1), -250.0, 30.0);
  constexpr double h = 1e-3;
  for (double x = -80.0; x < 60.0; x += 7.3) {
    const GroundPoint p = wave.at(x, 0.7), after = wave.at(x + h, 0.7), before = wave.at(x - h, 0.7);
    for (int k = 0; k < 2; ++k) {
      EXPECT_NEAR((after.displacement[k] - before.displacement[k]) / (2.0 * h), p.slope[k], 1e-8);
      EXPECT_NEAR((after.velocity[k] - before.velocity[k]) / (2.0 * h), p.slope_rate[k], 1e-5);
      EXPECT_NEAR((after.slope[k] - before.slope[k]) / (2.0 * h), p.curvature[k], 1e-7);
    }
  }
  EXPECT_EQ(wave.at(30.0, 0.4).displacement, pulse(0.1).at(0.4).displacement);
  EXPECT_LT((wave.at(-20.0, 0.4 + 0.2).displacement - wave.at(30.0, 0.4).displacement).norm(), 1e-12)
      << "50 m backward in 0.2 s";
  EXPECT_FALSE(wave.uniform());
}

TEST(GroundMotion, StationsAreJoinedByStraightLines) {
  const GroundMotion motion({{0.0, pulse(0.1)}, {32.0, pulse(0.2)}});
  EXPECT_EQ(motion.at(-5.0, 0.6).displacement, pulse(0.1).at(0.6).displacement);
  EXPECT_EQ(motion.at(99.0, 0.6).displacement, pulse(0.2).at(0.6).displacement);
  const GroundPoint p = motion.at(8.0, 0.6);
  EXPECT_NEAR(p.acceleration[0], 1.25 * pulse(0.1).at(0.6).acceleration[0], 1e-12);
  EXPECT_NEAR(p.slope[0], pulse(0.1).at(0.6).displacement[0] / 32.0, 1e-15);
  EXPECT_NEAR(p.slope_rate[0], pulse(0.1).at(0.6).velocity[0] / 32.0, 1e-14);
  EXPECT_THROW(GroundMotion({{3.0, pulse(0.1)}, {3.0, pulse(0.1)}}), InputError);
}

TEST(SpanDeviation, TransitionIsEquation22WithTheSignPutRight) {
  constexpr double Lt = 3.0, span = 40.0, delta = 8e-3;
  for (const auto direction : {SpanDeviationDirection::vertical, SpanDeviationDirection::lateral}) {
    const bool vertical = direction == SpanDeviationDirection::vertical;
    const double beta = vertical ? std::pow(9.42e7 / (4.0 * 210e9 * 3032e-8), 0.25)  // Eq. 23, Table 3
                                 : std::pow(47.1e7 / (4.0 * 210e9 * 509e-8), 0.25);
    EXPECT_NEAR(beta, vertical ? 1.387 : 3.239, 1e-3);
    const SpanDeviation rails({SpanDeviationShape::bending, direction, span, delta, 0.0, 0.0});
    const double theta = delta / span;
    for (double xt = 0.0; xt <= 2.0 * Lt; xt += 0.1) {
      const double s = xt - Lt, u = beta * s;
      const double r = s <= 0.0 ? theta / (4.0 * beta) * std::exp(u) * (std::cos(u) + std::sin(u))
                                : theta / (4.0 * beta) * std::exp(-u) * (std::cos(u) - std::sin(u)) + theta * s;
      const RailDeviation d = rails.at(s);
      EXPECT_NEAR(vertical ? d.z : d.y, r, 1e-15);
      EXPECT_EQ(vertical ? d.y : d.z, 0.0);
    }
  }
}

TEST(SpanDeviation, ShapesAreThoseOfSpansThatTurn) {
  const SpanDeviation bending({SpanDeviationShape::bending, SpanDeviationDirection::vertical, 20.0, 8e-3, 5.0, 0.0});
  const SpanDeviation shift(
      {SpanDeviationShape::parallel_shift, SpanDeviationDirection::lateral, 20.0, 8e-3, 5.0, 0.0});
  EXPECT_NEAR(bending.at(15.0).z, 4e-3, 1e-8);
  EXPECT_NEAR(bending.at(35.0).z, 4e-3, 1e-8);
  EXPECT_NEAR(bending.at(25.0).z, 8e-3 - 2.0 * 4e-4 / (4.0 * 1.387), 1e-6) << "rounded by the rail at the fold";
  EXPECT_NEAR(bending.at(60.0).z, 0.0, 1e-12);
  EXPECT_NEAR(shift.at(15.0).y, 4e-3, 1e-9);
  EXPECT_NEAR(shift.at(60.0).y, 8e-3, 1e-12);
  constexpr double h = 1e-5;
  for (const SpanDeviation* d : {&bending, &shift}) {
    for (double x = 0.0; x < 55.0; x += 0.2471) {
      const RailDeviation p = d->at(x), after = d->at(x + h), before = d->at(x - h);
      EXPECT_NEAR((after.z + after.y - before.z - before.y) / (2.0 * h), p.dz_dx + p.dy_dx, 1e-9);
      EXPECT_NEAR((after.dz_dx + after.dy_dx - before.dz_dx - before.dy_dx) / (2.0 * h), p.ddz_dx2 + p.ddy_dx2, 1e-8);
    }
    // twice continuously differentiable at a kink
    EXPECT_NEAR(d->at(25.0 + 1e-9).ddz_dx2 + d->at(25.0 + 1e-9).ddy_dx2,
                d->at(25.0 - 1e-9).ddz_dx2 + d->at(25.0 - 1e-9).ddy_dx2, 1e-11);
  }
  EXPECT_THROW(SpanDeviation({SpanDeviationShape::bending, SpanDeviationDirection::vertical, 0.0, 8e-3, 0.0, 0.0}),
               InputError);
}

}  // namespace
}  // namespace railtab
