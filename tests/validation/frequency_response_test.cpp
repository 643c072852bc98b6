// A metro car on a rough track: the run's spectra against the linear frequency response of the same model.

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <complex>
#include <cstdio>
#include <numbers>
#include <random>

#include "../measured.hpp"
#include "railtab/runtime/line/irregularity_spectrum.hpp"
#include "railtab/runtime/scene/scene_model.hpp"
#include "railtab/runtime/scene/scene_parameters.hpp"
#include "railtab/runtime/stability/linear_stability.hpp"
#include "railtab/runtime/start/static_equilibrium.hpp"
#include "railtab/runtime/vsi/simulation.hpp"
#include "railtab/runtime/vsi/step_record.hpp"

namespace railtab {
namespace {

using Complex = std::complex<double>;

constexpr double pi = std::numbers::pi;
constexpr double speed = 60.0 / 3.6;            // m/s
constexpr double period = 20.0, before = 20.0;  // s: of the deviations, and of what is left to decay
constexpr double lowest = 0.5, highest = 20.0;  // Hz
constexpr int columns = 4;                      // y and z of the left rail, of the right one

/// A track of waves that repeat themselves after `period`, with random phases.
struct Waves {
  std::vector<double> frequency;                        // at that speed [Hz]
  std::vector<std::array<Complex, columns>> deviation;  // d(x) = Re Σ D e^{iωx/V}

  [[nodiscard]] Irregularity track(double length) const {
    constexpr double spacing = 0.04;  // m
    std::vector<double> x;
    std::array<std::vector<double>, columns> d;
    for (double at = -length; at <= length; at += spacing) {
      x.push_back(at);
      std::array<double, columns> sum{};
      for (std::size_t n = 0; n < frequency.size(); ++n) {
        const Complex wave = std::polar(1.0, 2.0 * pi * frequency[n] * at / speed);
        for (std::size_t c = 0; c < columns; ++c) sum[c] += (deviation[n][c] * wave).real();
      }
      for (std::size_t c = 0; c < columns; ++c) d[c].push_back(sum[c]);
    }
    return {x, d[0], d[1], d[2], d[3]};
  }
};

/// FRA class 6 by lines, the larger the farther they are apart. @param share of its amplitudes
Waves class_6(double share) {
  Waves waves;
  std::mt19937 random(20261124);
  std::uniform_real_distribution<double> angle(0.0, 2.0 * pi);
  constexpr double half_base = 0.75;
  for (int line = static_cast<int>(lowest * period); line <= highest * period; line += std::max(1, line / 12)) {
    const double frequency = line / period, omega = 2.0 * pi * frequency / speed;
    const double width = 2.0 * pi * std::max(1, line / 12) / period / speed;
    const TrackSpectrum density = track_spectrum("fra-6", omega, half_base);
    const auto wave = [&](double of) { return std::polar(share * std::sqrt(2.0 * of * width), angle(random)); };
    const Complex vertical = wave(density.vertical), lateral = wave(density.alignment),
                  cross = half_base * wave(density.cross_level);
    waves.frequency.push_back(frequency);
    waves.deviation.push_back({lateral, vertical - cross, lateral, vertical + cross});
  }
  return waves;
}

/// Derivatives of the force of one wheel by the motion of its rail head.
struct RailSlopes {
  Eigen::Matrix<double, 6, 2> on_wheelset[2];  // by (y, z), by their slopes (yaw, slope)
  Eigen::Matrix<double, 1, 2> Q[2];
  Eigen::Matrix<double, 1, 6> Q_by_displacement, Q_by_velocity;
};

RailSlopes rail_slopes(const WheelContactModel& model, WheelSide side, const WheelsetMotion& at) {
  const auto force = [&](const WheelsetMotion& motion, const RailHeadMotion& rail) {
    const WheelsetPose pose = relative_pose(model.geometry->pair(), side, motion, rail);
    return wheel_force(model, side, motion, rail, wheel_contact(*model.geometry, pose));
  };
  constexpr double step = 1e-6;
  RailSlopes slopes;
  const auto by_rail = [&](int kind, int column, const auto& move) {
    RailHeadMotion ahead, behind;
    move(ahead, step);
    move(behind, -step);
    const WheelForce a = force(at, ahead), b = force(at, behind);
    slopes.on_wheelset[kind].col(column) = (a.wheelset - b.wheelset) / (2.0 * step);
    slopes.Q[kind](column) = (a.rail[1] - b.rail[1]) / (2.0 * step);
  };
  by_rail(0, 0, [](RailHeadMotion& rail, double by) { rail.displacement[0] = by; });
  by_rail(0, 1, [](RailHeadMotion& rail, double by) { rail.displacement[1] = by; });
  by_rail(1, 0, [](RailHeadMotion& rail, double by) { rail.yaw = by; });
  by_rail(1, 1, [](RailHeadMotion& rail, double by) { rail.slope = by; });
  for (Eigen::Index k = 0; k < 6; ++k) {
    const auto by_wheelset = [&](Vector6 WheelsetMotion::*member, double by) {
      WheelsetMotion ahead = at, behind = at;
      (ahead.*member)[k] += by;
      (behind.*member)[k] -= by;
      return (force(ahead, {}).rail[1] - force(behind, {}).rail[1]) / (2.0 * by);
    };
    slopes.Q_by_displacement(k) = by_wheelset(&WheelsetMotion::displacement, step);
    slopes.Q_by_velocity(k) = by_wheelset(&WheelsetMotion::velocity, step * speed);
  }
  return slopes;
}

/// Quantities that are compared, each with its amplitude by line; of a run also over the period that is evaluated.
struct Spectra {
  std::vector<std::vector<Complex>> of;      // by quantity, then by line
  std::vector<std::vector<double>> history;  // by quantity, then by record
  std::vector<double> time;                  // [s]
};
constexpr std::array<const char*, 7> names{"car body y", "car body z",   "car body roll", "bogie y",
                                           "bogie z",    "wheelset 1 y", "wheel force"};

std::vector<Complex> quantities(const VsiModel& model, const Eigen::VectorXcd& u, Complex wheel_force) {
  const auto dof = [&](int body, std::size_t motion) {
    return u[model.vehicle.dof[static_cast<std::size_t>(body)][motion]];
  };
  int bogie = 0;
  while (model.vehicle.bodies[static_cast<std::size_t>(bogie)].name != "bogie-1") ++bogie;
  return {dof(0, 1),  dof(0, 2), dof(0, 3), dof(bogie, 1), dof(bogie, 2), dof(model.vehicle.wheelsets[0], 1),
          wheel_force};
}

Spectra linear_spectra(const VsiModel& model, const Waves& waves) {
  VsiState rest(model);
  EXPECT_TRUE(static_equilibrium(model, rest).converged);
  const VehicleModel running = running_vehicle(model, speed);
  Eigen::VectorXd displacement = Eigen::VectorXd::Zero(wheelset_unknowns * model.wheelsets()), velocity = displacement;
  gather_wheelsets(model, 0, rest.vehicle[0].displacement, displacement);
  gather_wheelsets(model, 0, rest.vehicle[0].velocity, velocity);
  Spectra spectra;
  spectra.of.resize(names.size());
  for (std::size_t n = 0; n < waves.frequency.size(); ++n) {
    const double omega = 2.0 * pi * waves.frequency[n];
    const Complex i_omega(0.0, omega);
    Eigen::VectorXcd load = Eigen::VectorXcd::Zero(running.dofs());
    Complex Q = 0.0;
    Eigen::Matrix<Complex, 1, 6> Q_by_motion;
    for (int w = 0; w < model.wheelsets(); ++w) {
      const WheelsetMotion at{displacement.segment<6>(wheelset_unknowns * w),
                              velocity.segment<6>(wheelset_unknowns * w)};
      const Complex there = std::polar(1.0, omega * model.wheelset_x(w, 0.0) / speed);
      Eigen::Matrix<Complex, 6, 1> force = Eigen::Matrix<Complex, 6, 1>::Zero();
      for (const WheelSide side : wheel_sides) {
        const std::size_t first = side == WheelSide::left ? 0 : 2;
        const Eigen::Vector2cd rail(there * waves.deviation[n][first], there * waves.deviation[n][first + 1]);
        const RailSlopes slopes = rail_slopes(model.contact, side, at);
        const auto by_rail = [&](const auto& of) { return (of[0] * rail + of[1] * (i_omega / speed * rail)).eval(); };
        force += by_rail(slopes.on_wheelset);
        if (w > 0 || side == WheelSide::right) continue;
        Q = by_rail(slopes.Q)(0);
        Q_by_motion = slopes.Q_by_displacement + i_omega * slopes.Q_by_velocity;
      }
      const DofIndices& dof = running.dof[static_cast<std::size_t>(running.wheelsets[static_cast<std::size_t>(w)])];
      for (std::size_t k = 0; k < 6; ++k) {
        if (dof[k] != held) load[dof[k]] += force[static_cast<Eigen::Index>(k)];
      }
    }
    const Eigen::MatrixXcd dynamic = running.stiffness.cast<Complex>() + i_omega * running.damping.cast<Complex>() -
                                     omega * omega * running.mass.cast<Complex>();
    const Eigen::VectorXcd u = dynamic.partialPivLu().solve(load);
    const DofIndices& dof = running.dof[static_cast<std::size_t>(running.wheelsets[0])];
    for (std::size_t k = 0; k < 6; ++k) {
      if (dof[k] != held) Q += Q_by_motion(static_cast<Eigen::Index>(k)) * u[dof[k]];
    }
    const std::vector<Complex> found = quantities(model, u, Q);
    for (std::size_t q = 0; q < names.size(); ++q) spectra.of[q].push_back(found[q]);
  }
  return spectra;
}

Spectra simulated_spectra(VsiModel model, const Waves& waves, double time_step, double tolerance) {
  model.irregularity = waves.track(speed * (before + period) + 60.0);
  VsiState state(model);
  EXPECT_TRUE(static_equilibrium(model, state).converged);
  IntegrationParameters integration;
  integration.time_step = time_step;
  integration.tolerance = tolerance;
  Spectra spectra;
  spectra.of.assign(names.size(), std::vector<Complex>(waves.frequency.size()));
  spectra.history.resize(names.size());
  long samples = 0;
  RunObserver observer;
  observer.record = [&](const StepRecord& record) {
    if (record.time <= before + 0.5 * time_step) return;
    ++samples;
    spectra.time.push_back(record.time);
    Eigen::VectorXcd u = Eigen::VectorXcd::Zero(model.vehicle.dofs());
    for (std::size_t b = 0; b < record.bodies.size(); ++b) {
      for (std::size_t k = 0; k < 6; ++k) {
        if (model.vehicle.dof[b][k] != held)
          u[model.vehicle.dof[b][k]] = record.bodies[b].displacement[static_cast<Eigen::Index>(k)];
      }
    }
    const std::vector<Complex> now = quantities(model, u, record.wheels[0].Q);
    for (std::size_t q = 0; q < names.size(); ++q) spectra.history[q].push_back(now[q].real());
    for (std::size_t n = 0; n < waves.frequency.size(); ++n) {
      const Complex wave = std::polar(1.0, -2.0 * pi * waves.frequency[n] * record.time);
      for (std::size_t q = 0; q < names.size(); ++q) spectra.of[q][n] += now[q] * wave;
    }
  };
  const RunSummary summary = simulate(model, integration, before + period, 1, state, observer);
  EXPECT_TRUE(summary.complete) << summary.message;
  for (std::vector<Complex>& of : spectra.of) {
    for (Complex& amplitude : of) amplitude *= 2.0 / static_cast<double>(samples);
  }
  return spectra;
}

// Standard deviation of the difference between a run and the linear motion over the same time.
double rms_of_difference(const Spectra& run, const Spectra& linear, const Waves& waves, std::size_t q) {
  Eigen::ArrayXd difference = Eigen::ArrayXd::Map(run.history[q].data(), static_cast<Eigen::Index>(run.time.size()));
  for (std::size_t i = 0; i < run.time.size(); ++i) {
    for (std::size_t n = 0; n < waves.frequency.size(); ++n) {
      difference[static_cast<Eigen::Index>(i)] -=
          (linear.of[q][n] * std::polar(1.0, 2.0 * pi * waves.frequency[n] * run.time[i])).real();
    }
  }
  return std::sqrt((difference - difference.mean()).square().mean());
}

VsiModel metro(const std::string& wheel = "S1002", const std::string& creep_law = "polach") {
  SceneParameters scene;
  scene.train.vehicle = "metro-gz18";
  scene.train.speed = speed;
  scene.train.force_elements = ForceElementChoice::linear;
  scene.contact.mode = ContactMode::online;
  scene.contact.dimensions.nominal_radius = 0.42;
  scene.contact.wheel = wheel;
  scene.contact.creep_law = creep_law;
  scene.track_kind = TrackKind::rigid;
  return build_model(scene);
}

constexpr std::size_t car_body_y = 0, wheelset_y = 5, wheel_load = 6;

/// rms of what two other programs differ by on this car, on AAR class 6: ORVD and SIMPACK [m], [N].
constexpr double programs_wheelset_y = 15e-6, programs_wheel_force = 0.65e3;

// Largest difference of an amplitude from its linear one, of lines above a share of the largest one.
double worst_line(const Spectra& run, const Spectra& linear, const Waves& waves, double share) {
  double worst_of_all = 0.0;
  for (std::size_t q = 0; q < names.size(); ++q) {
    double worst = 0.0, at = 0.0, largest = 0.0;
    for (const Complex& amplitude : linear.of[q]) largest = std::max(largest, std::abs(amplitude));
    int lines = 0;
    for (std::size_t n = 0; n < waves.frequency.size(); ++n) {
      if (std::abs(linear.of[q][n]) < share * largest) continue;
      ++lines;
      const double difference = std::abs(run.of[q][n]) / std::abs(linear.of[q][n]) - 1.0;
      if (std::abs(difference) <= std::abs(worst)) continue;
      worst = difference;
      at = waves.frequency[n];
    }
    std::printf("%-14s %d lines, largest %.3e, worst %+.2f %% at %.2f Hz\n", names[q], lines, largest, 100.0 * worst,
                at);
    EXPECT_GT(lines, 20) << names[q];
    worst_of_all = std::max(worst_of_all, std::abs(worst));
  }
  return worst_of_all;
}

// Deviations of micrometres, within which the contact geometry is linear; below 20 Hz.
TEST(FrequencyResponse, OfAMetroCarIsThatOfItsLinearModel) {
  const VsiModel model = metro();
  constexpr double share = 0.002;
  const Waves waves = class_6(share);
  const Spectra linear = linear_spectra(model, waves), run = simulated_spectra(model, waves, 1e-3, 1e-10);
  const double worst = worst_line(run, linear, waves, 1e-3);
  EXPECT_LT(worst, 0.01);
  testing::measured("metro.response_percent", 100.0 * worst);
  // the difference in time, for the whole amplitudes of the class
  const double y = rms_of_difference(run, linear, waves, wheelset_y) / share;
  const double Q = rms_of_difference(run, linear, waves, wheel_load) / share;
  std::printf("difference in time, to the scale of the class: wheelset y %.2f um, wheel force %.4f kN\n", 1e6 * y,
              1e-3 * Q);
  testing::measured("metro.small.wheelset_y_difference_um", 1e6 * y);
  testing::measured("metro.small.Q_difference_kN", 1e-3 * Q);
  EXPECT_LT(y, 0.2 * programs_wheelset_y);
  EXPECT_LT(Q, 0.1 * programs_wheel_force);
}

// At the full amplitudes of the class, where geometry and creep forces are linear: cones roll on the crowns of the
// rails, and the creep law does not saturate.
TEST(FrequencyResponse, OfAMetroCarOnConesAtFullAmplitudesIsThatOfItsLinearModel) {
  const VsiModel model = metro("cone-1:40", "linear");
  const Waves waves = class_6(1.0);
  const Spectra linear = linear_spectra(model, waves), run = simulated_spectra(model, waves, 1e-3, 1e-7);
  const double worst = worst_line(run, linear, waves, 1e-2);
  const double y = rms_of_difference(run, linear, waves, wheelset_y);
  const double Q = rms_of_difference(run, linear, waves, wheel_load);
  std::printf("cones: worst %.2f %%; difference in time: wheelset y %.2f um, wheel force %.4f kN\n", 100.0 * worst,
              1e6 * y, 1e-3 * Q);
  testing::measured("metro.cones.response_percent", 100.0 * worst);
  testing::measured("metro.cones.wheelset_y_difference_um", 1e6 * y);
  testing::measured("metro.cones.Q_difference_kN", 1e-3 * Q);
  EXPECT_LT(worst, 0.02);
  EXPECT_LT(y, programs_wheelset_y);
  EXPECT_LT(Q, 0.1 * programs_wheel_force);
}

// At its full amplitudes the profiles' changing slopes count: differences from the linear motion grow by more than the
// amplitude. The run's own error is the difference between two steps, of wheel forces below 20 Hz: above it they
// vibrate, where the linear motion has nothing, in phases that no two steps share.
TEST(FrequencyResponse, OfAMetroCarOnARoughTrackIsNearThatOfItsLinearModel) {
  const VsiModel model = metro();
  const Waves waves = class_6(1.0);
  const Spectra linear = linear_spectra(model, waves), run = simulated_spectra(model, waves, 1e-3, 1e-7);
  const Spectra double_step = simulated_spectra(model, waves, 2e-3, 1e-7);
  const auto rms = [](const std::vector<Complex>& of) {
    double sum = 0.0;
    for (const Complex& amplitude : of) sum += 0.5 * std::norm(amplitude);
    return std::sqrt(sum);
  };
  const auto of_run = [&](std::size_t q) { return rms(run.of[q]); };
  const auto of_linear = [&](std::size_t q) { return rms(linear.of[q]); };
  const auto between_steps = [&](std::size_t q) {
    std::vector<Complex> difference = run.of[q];
    for (std::size_t n = 0; n < difference.size(); ++n) difference[n] -= double_step.of[q][n];
    return rms(difference);
  };
  for (const std::size_t q : {car_body_y, wheelset_y, wheel_load}) {
    const double difference = rms_of_difference(run, linear, waves, q);
    std::printf("%-14s rms %.4g, linear %.4g; difference in time %.3g; between steps %.3g\n", names[q], of_run(q),
                of_linear(q), difference, between_steps(q));
    EXPECT_NEAR(of_run(q) / of_linear(q), 1.0, 0.1) << names[q];
    EXPECT_GT(std::abs(of_run(q) / of_linear(q) - 1.0), 0.01) << names[q];
  }
  testing::measured("metro.rough.wheelset_y_mm", 1e3 * of_run(wheelset_y));
  testing::measured("metro.linear.wheelset_y_mm", 1e3 * of_linear(wheelset_y));
  testing::measured("metro.rough.Q_kN", 1e-3 * of_run(wheel_load));
  testing::measured("metro.linear.Q_kN", 1e-3 * of_linear(wheel_load));
  testing::measured("metro.rough.wheelset_y_difference_um", 1e6 * rms_of_difference(run, linear, waves, wheelset_y));
  testing::measured("metro.rough.Q_difference_kN", 1e-3 * rms_of_difference(run, linear, waves, wheel_load));
  testing::measured("metro.steps.wheelset_y_um", 1e6 * between_steps(wheelset_y));
  testing::measured("metro.steps.Q_kN", 1e-3 * between_steps(wheel_load));
  EXPECT_LT(between_steps(wheelset_y), programs_wheelset_y);
  EXPECT_LT(between_steps(wheel_load), programs_wheel_force);
}

}  // namespace
}  // namespace railtab
