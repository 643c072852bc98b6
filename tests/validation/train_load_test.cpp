// Loads on a coach and changes of its speed, against statics and equations of motion solved otherwise.

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "../folder_fixture.hpp"
#include "../imported_vehicle.hpp"
#include "../measured.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/scene/scene_model.hpp"
#include "railtab/runtime/scene/scene_parameters.hpp"
#include "railtab/runtime/start/static_equilibrium.hpp"
#include "railtab/runtime/structure/simple_beam.hpp"
#include "railtab/runtime/vehicle/static_wheel_load.hpp"
#include "railtab/runtime/vsi/simulation.hpp"

namespace railtab {
namespace {

using ImportedCoach = testing::ImportedVehicle;
using WindOnCoach = testing::InFolder;

constexpr double pi = std::numbers::pi;

SceneParameters coach_on_rigid_track() {
  SceneParameters scene;
  scene.contact.mode = ContactMode::online;
  scene.track_kind = TrackKind::rigid;
  scene.train.speed = 40.0;
  scene.train.force_elements = ForceElementChoice::linear;  // closed forms of a coach without stops
  return scene;
}

// Moment about the track's centre at the rail heads, positive to the right, of the wheel loads at their contact points.
double moment_at_rails(const VsiModel& model, const StepRecord& record) {
  double moment = 0.0;
  for (std::size_t wheel = 0; wheel < record.wheels.size(); ++wheel) {
    const double side = wheel % 2 == 0 ? -1.0 : 1.0;
    // Two patches share Q nearly as their normal forces.
    const WheelRecord& w = record.wheels[wheel];
    const double y_rail = (w.normal_force * w.y_rail + w.second_normal_force * w.second_y_rail) /
                          (w.normal_force + w.second_normal_force);
    moment += w.Q * (side * (model.geometry->pair().rail_offset() + y_rail));
  }
  return moment;
}

// Σ W Δy: what the weights of bodies add that have moved aside.
double moment_of_weights(const VsiModel& model, const StepRecord& record) {
  double moment = 0.0;
  for (std::size_t b = 0; b < record.bodies.size(); ++b) {
    const int heave = model.vehicle.dof[b][2];
    moment += model.vehicle.gravity * model.vehicle.mass(heave, heave) * record.bodies[b].displacement[1];
  }
  return moment;
}

constexpr double wind = 35e3;            // N on the car body, to the right
constexpr double car_body_height = 1.8;  // m: of its centre of gravity above the rails
constexpr double balance = 5e-3;         // of moments

LoadParameters wind_load() {
  LoadParameters load;
  load.load[1] = wind;
  return load;
}

StepRecord at_rest(const VsiModel& model) {
  VsiState state(model);
  EXPECT_TRUE(static_equilibrium(model, state).converged);
  StepRecord record;
  fill_record(model, state, record);
  return record;
}

double largest_unloading(const VsiModel& model, const StepRecord& record) {
  double unloading = 0.0;
  for (const WheelRecord& wheel : record.wheels) {
    unloading = std::max(unloading, 1.0 - wheel.Q / static_wheel_load(model.vehicle, 0));
  }
  return unloading;
}

TEST(Crosswind, ConstantWindAndTheWeightsMovedAsideUnloadTheWheels) {
  SceneParameters scene = coach_on_rigid_track();
  scene.loads.push_back(wind_load());
  const VsiModel model = build_model(scene);
  const StepRecord record = at_rest(model);
  double Y = 0.0;
  for (const WheelRecord& wheel : record.wheels) Y += wheel.Y;
  EXPECT_NEAR(Y, wind, 1e-4 * wind);
  const double expected = wind * car_body_height + moment_of_weights(model, record);
  const double unloading = largest_unloading(model, record);
  std::printf("wind of %.0f kN: car body moves by %.1f mm, moment %.2f kN m, F h + sum W dy %.2f, unloading %.3f\n",
              1e-3 * wind, 1e3 * record.bodies[0].displacement[1], 1e-3 * moment_at_rails(model, record),
              1e-3 * expected, unloading);
  testing::measured("wind.constant_percent", 100 * (moment_at_rails(model, record) / expected - 1));
  testing::measured("wind.constant_unloading", unloading);
  EXPECT_NEAR(moment_at_rails(model, record), expected, balance * expected);

  scene.train.geometric_stiffness = GeometricStiffness::omitted;
  const VsiModel upright = build_model(scene);
  const double without = largest_unloading(upright, at_rest(upright));
  testing::measured("wind.constant_unloading_upright", without);
  // 36 % more moment, that of the weight moved aside
  EXPECT_GT(unloading, 1.25 * without);
}

// Wind that the scene names by its speed is the load of its coefficients about the rail-head tops, on every coach.
TEST_F(WindOnCoach, OfCoefficientsIsTheirForceAndMoment) {
  const std::filesystem::path file = folder_ / "coefficients.csv";
  std::ofstream(file) << "yaw[deg],C_Fy[1],C_Fz[1],C_Mx[1]\n0,0,0,0\n90,2,-0.4,1.5\n";
  SceneParameters scene = coach_on_rigid_track();
  LoadParameters load;
  load.aerodynamics = file;
  load.wind_speed = 30.0;
  load.area = 12.0;
  load.length = 2.5;
  scene.loads.push_back(load);
  const VsiModel model = build_model(scene);
  const double yaw = std::asin(0.6) / (0.5 * pi), force = 0.5 * 1.225 * 50.0 * 50.0 * 12.0 * yaw;

  SceneParameters by_hand = coach_on_rigid_track();
  LoadParameters components;
  components.load[1] = 2.0 * force;
  components.load[2] = -0.4 * force;
  components.load[3] = 1.5 * 2.5 * force - car_body_height * 2.0 * force;
  by_hand.loads.push_back(components);
  const VsiModel same = build_model(by_hand);
  ASSERT_EQ(model.loads.size(), 1U);
  for (int k = 0; k < 6; ++k) {
    EXPECT_NEAR(model.loads[0].history.at(1.0)[k], same.loads[0].history.at(1.0)[k], 1e-9 * force) << k;
  }
  const StepRecord record = at_rest(model);
  const double aside = record.bodies[0].displacement[1];
  const double moment = 1.5 * 2.5 * force - 0.4 * force * aside + moment_of_weights(model, record);
  EXPECT_NEAR(moment_at_rails(model, record), moment, balance * moment);

  scene.loads[0].wind_speed = 80.0;
  scene.loads[0].wind_direction = 135.0;  // from behind, faster than the train: beyond the table
  EXPECT_THROW(static_cast<void>(build_model(scene)), InputError);
}

// A vehicle from matrices: the same moment, carried by the wheelsets alone.
TEST_F(ImportedCoach, LeansByTheSameMoment) {
  write(testing::free_coach());
  SceneParameters scene = this->scene(vehicle_section() + "[contact]\nmode = \"online\"\n[track]\nkind = \"rigid\"\n" +
                                      "[integration]\nduration = 0.1\n");
  scene.train.geometric_stiffness = GeometricStiffness::included;
  scene.loads.push_back(wind_load());
  const VsiModel model = build_model(scene);
  const StepRecord record = at_rest(model);
  const double expected = wind * car_body_height + moment_of_weights(model, record);
  EXPECT_NEAR(moment_at_rails(model, record), expected, balance * expected);

  SceneParameters built_in = coach_on_rigid_track();
  built_in.loads.push_back(wind_load());
  const VsiModel built = build_model(built_in);
  const double unloading = largest_unloading(built, at_rest(built));
  std::printf("imported coach: unloading %.4f, built-in coach %.4f\n", largest_unloading(model, record), unloading);
  EXPECT_NEAR(largest_unloading(model, record), unloading, 0.05 * unloading);
}

TEST(Cant, GeometricStiffnessInMatricesIsOfImportedVehicles) {
  SceneParameters scene = coach_on_rigid_track();
  scene.train.geometric_stiffness = GeometricStiffness::in_matrices;
  EXPECT_THROW(static_cast<void>(build_model(scene)), InputError);
}

TEST(Cant, AStandingVehicleLeansByItsWeight) {
  SceneParameters scene = coach_on_rigid_track();
  scene.train.speed = 1e-3;
  scene.train.cant = 0.15;
  const VsiModel model = build_model(scene);
  const StepRecord record = at_rest(model);
  const double sine = 0.1, cosine = std::sqrt(1.0 - sine * sine);
  double Q = 0.0, Y = 0.0, moment = moment_of_weights(model, record), weight = 0.0;
  for (const WheelRecord& wheel : record.wheels) {
    Q += wheel.Q;
    Y += wheel.Y;
  }
  for (std::size_t b = 0; b < model.vehicle.bodies.size(); ++b) {
    const int y = model.vehicle.dof[b][1];
    const double m = model.vehicle.mass(y, y);
    weight += m * 9.81;
    moment += m * 9.81 * sine * model.vehicle.bodies[b].position.z();  // z is down, the load to the left
  }
  EXPECT_NEAR(Q, weight * cosine, 1e-6 * weight);
  EXPECT_NEAR(Y, -weight * sine, 1e-4 * weight);
  testing::measured("cant.standing_percent", 100 * (moment_at_rails(model, record) / moment - 1));
  EXPECT_NEAR(moment_at_rails(model, record), moment, -balance * moment);
}

TEST(Cant, BalancesTheLateralAccelerationOfItsCurve) {
  SceneParameters scene = coach_on_rigid_track();
  scene.train.cant = 0.15;
  scene.train.lateral_acceleration = 9.81 * 0.1 / std::sqrt(0.99);
  const StepRecord record = at_rest(build_model(scene));
  for (const MotionRecord& body : record.bodies) EXPECT_NEAR(body.displacement[1], 0.0, 1e-9);
  EXPECT_NEAR(record.wheels[0].Q, record.wheels[1].Q, 1e-3);
}

TEST(Crosswind, SlowGustUnloadsWheelsByItsOverturningMoment) {
  constexpr double length = 20.0;  // s: the slowest motion of the coach, its lower sway, has a period of 1.7 s
  SceneParameters scene = coach_on_rigid_track();
  scene.loads.push_back(wind_load());
  scene.loads.back().start = 1.0;
  scene.loads.back().gust_duration = length;
  scene.integration.time_step = 4e-3;
  scene.integration.duration = 16.0;
  const VsiModel model = build_model(scene);
  VsiState state(model);
  ASSERT_TRUE(steady_start(model, state).converged);
  double worst = 0.0, worst_at_peak = 0.0, unloading = 0.0, expected_peak = 0.0;
  RunObserver observer;
  observer.record = [&](const StepRecord& r) {
    const double gust = r.time < 1.0 ? 0.0 : 0.5 * (1.0 - std::cos(2.0 * pi * (r.time - 1.0) / length));
    const double expected = gust * wind * car_body_height + moment_of_weights(model, r);
    const double difference = std::abs(moment_at_rails(model, r) - expected);
    worst = std::max(worst, difference);
    if (gust > 0.95) worst_at_peak = std::max(worst_at_peak, difference);
    expected_peak = std::max(expected_peak, expected);
    unloading = std::max(unloading, largest_unloading(model, r));
  };
  ASSERT_TRUE(simulate(model, scene.integration, scene.integration.duration, 5, state, observer).complete);
  // the textbook estimate: the moment over twice the half distance of the contacts, over four wheelsets
  const double textbook = expected_peak / (4.0 * 1.5) / 54.55e3;
  std::printf("slow gust: moment within %.2f %% (at its peak %.2f %%), unloading %.3f, M/(4·2b Q0) = %.3f\n",
              100.0 * worst / expected_peak, 100.0 * worst_at_peak / expected_peak, unloading, textbook);
  testing::measured("wind.gust_percent", 100 * worst / expected_peak);
  testing::measured("wind.gust_peak_percent", 100 * worst_at_peak / expected_peak);
  testing::measured("wind.gust_unloading", unloading);
  testing::measured("wind.gust_textbook", textbook);
  EXPECT_LT(worst, 0.02 * expected_peak);
  EXPECT_LT(worst_at_peak, balance * expected_peak);
  EXPECT_NEAR(unloading, textbook, 0.1 * textbook);
}

TEST(SpeedProfile, ConstantProfileIsConstantSpeed) {
  SceneParameters scene = coach_on_rigid_track();
  scene.train.initial_lateral_shift = 2e-3;
  scene.integration.duration = 0.1;
  const VsiModel constant = build_model(scene);
  VsiModel profile = constant;
  profile.speed_profile.emplace(std::vector<double>{0.0, 1.0}, std::vector<double>{40.0, 40.0});
  std::array<StepRecord, 2> last;
  for (const VsiModel* model : std::initializer_list<const VsiModel*>{&constant, &profile}) {
    VsiState state(*model);
    ASSERT_TRUE(steady_start(*model, state).converged);
    for (LinearMotion& motion : state.vehicle) motion.velocity[model->vehicle.dof[0][1]] = 0.05;
    RunObserver observer;
    observer.record = [&](const StepRecord& r) { last[model == &constant ? 0 : 1] = r; };
    ASSERT_TRUE(simulate(*model, scene.integration, 0.1, 100, state, observer).complete);
  }
  for (std::size_t wheel = 0; wheel < 8; ++wheel) {
    EXPECT_NEAR(last[0].wheels[wheel].Q, last[1].wheels[wheel].Q, 1e-3);
    EXPECT_NEAR(last[0].wheels[wheel].Y, last[1].wheels[wheel].Y, 1e-3);
  }
  EXPECT_NEAR(last[0].position, last[1].position, 1e-12);
}

TEST(SpeedProfile, RailsSlowTheWheelsRotation) {
  // J_y dΩ/dt = R·F_x with Ω = V/R: every wheelset pushes its rails back by J_y/R² times its deceleration, the train's
  // and that of its own surging on the longitudinal springs, which have no damping.
  constexpr double braking = 1.0;  // m/s²
  SceneParameters scene = coach_on_rigid_track();
  scene.integration.time_step = 1e-3;
  scene.integration.duration = 3.0;
  VsiModel model = build_model(scene);
  model.speed_profile.emplace(std::vector<double>{0.0, 1.0, 11.0},
                              std::vector<double>{40.0, 40.0, 40.0 - 10.0 * braking});
  VsiState state(model);
  ASSERT_TRUE(steady_start(model, state).converged);
  double X = 0.0, acceleration = 0.0, position = 0.0;
  int n = 0;
  RunObserver observer;
  observer.record = [&](const StepRecord& r) {
    position = r.position;
    if (r.time < 2.0) return;  // the shock of the braking's begin has to die out
    for (const WheelRecord& wheel : r.wheels) X += wheel.X;
    for (std::size_t b = 3; b < 7; ++b) acceleration += r.bodies[b].acceleration[0] - braking;
    ++n;
  };
  ASSERT_TRUE(simulate(model, scene.integration, scene.integration.duration, 1, state, observer).complete);
  const double expected = 112.0 / (0.46 * 0.46) * acceleration / n;
  EXPECT_NEAR(acceleration / n, -4.0 * braking, 0.4 * braking);
  std::printf("force on the rails by the wheels' rotation: %.1f N, expected %.1f N\n", X / n, expected);
  testing::measured("braking.force_percent", 100 * std::abs(X / n / expected - 1));
  EXPECT_NEAR(X / n, expected, 0.01 * std::abs(expected));
  EXPECT_NEAR(position, 40.0 * 3.0 - 0.5 * braking * 4.0, 1e-9);
}

// A mass that runs over a simple beam while it brakes: the beam's first modes with the mass on them,
//   (μL/2 δ_ij + m φ_i φ_j) q'' = m φ_i (g − 2V φ_j' q' − (V² φ_j'' + V' φ_j') q) − μL/2 ω_i² q_i,
// by Runge–Kutta steps.
class BrakingMass {
 public:
  static constexpr int modes = 12;
  static constexpr double L = 25.0, EI = 2.87e9 * 2.90, mu = 2303.0, m = 5750.0, V0 = 60.0, rate = -40.0;
  using Vector = Eigen::Matrix<double, modes, 1>;

  static double x(double t) { return V0 * t + 0.5 * rate * t * t; }

  [[nodiscard]] Vector acceleration(double t, const Vector& q, const Vector& v) const {
    const double V = V0 + rate * t, s = x(t);
    Vector shape, slope, bend, restoring;
    for (int i = 0; i < modes; ++i) {
      const double k = (i + 1) * pi / L;
      shape[i] = std::sin(k * s);
      slope[i] = k * std::cos(k * s);
      bend[i] = -k * k * std::sin(k * s);
      restoring[i] = 0.5 * L * EI * std::pow(k, 4) * q[i];
    }
    const Eigen::Matrix<double, modes, modes> mass =
        0.5 * mu * L * Eigen::Matrix<double, modes, modes>::Identity() + m * shape * shape.transpose();
    const double load = m * (9.81 - 2.0 * V * slope.dot(v) - V * V * bend.dot(q) - rate * slope.dot(q));
    return mass.partialPivLu().solve(Vector(load * shape - restoring));
  }

  // Midspan deflection at equal times.
  [[nodiscard]] std::vector<double> midspan(double end, int points) const {
    constexpr int between = 40;
    const double h = end / (points * between);
    Vector q = Vector::Zero(), v = Vector::Zero();
    std::vector<double> result{0.0};
    for (int step = 0; step < points * between; ++step) {
      const double t = step * h;
      const Vector a1 = acceleration(t, q, v);
      const Vector v2 = v + 0.5 * h * a1, a2 = acceleration(t + 0.5 * h, q + 0.5 * h * v, v2);
      const Vector v3 = v + 0.5 * h * a2, a3 = acceleration(t + 0.5 * h, q + 0.5 * h * v2, v3);
      const Vector v4 = v + h * a3, a4 = acceleration(t + h, q + h * v3, v4);
      q += h / 6.0 * (v + 2.0 * v2 + 2.0 * v3 + v4);
      v += h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
      if ((step + 1) % between != 0) continue;
      double u = 0.0;
      for (int i = 0; i < modes; ++i) u += q[i] * std::sin((i + 1) * pi / 2.0);
      result.push_back(u);
    }
    return result;
  }
};

TEST(SpeedProfile, BrakingMassOnABeamFollowsItsEquations) {
  const double end = 0.5;  // s: 25 m at 60 m/s and -40 m/s² take 0.5 s
  ASSERT_NEAR(BrakingMass::x(end), BrakingMass::L, 1e-12);
  constexpr int points = 50;
  const std::vector<double> expected = BrakingMass().midspan(end, points);
  VsiModel model;
  const DofIndices all_but_z{held, held, 0, held, held, held};
  model.vehicle = assemble_vehicle(
      {"mass", {{"wheelset", BrakingMass::m, {1, 1, 1}, {0, 0, -0.46}}}, {}, {0}, {all_but_z}, 0.46, 10.0});
  model.vehicle_x = {0.0};
  model.structure =
      build_simple_beam({.length = BrakingMass::L, .E = 2.87e9, .I = 2.90, .mass = 2303.0, .elements = 40});
  model.contact.speed = BrakingMass::V0;
  model.speed_profile.emplace(std::vector<double>{0.0, end},
                              std::vector<double>{BrakingMass::V0, BrakingMass::V0 + BrakingMass::rate * end});
  model.normal_contact = NormalContact::rigid;
  VsiState state(model);
  ASSERT_TRUE(static_equilibrium(model, state).converged);
  std::vector<double> u;
  RunObserver observer;
  observer.record = [&](const StepRecord& r) { u.push_back(r.nodes.at(0).displacement[2]); };
  IntegrationParameters integration;
  integration.time_step = end / 2000.0;
  integration.alpha = 0.0;
  ASSERT_TRUE(simulate(model, integration, end, 2000 / points, state, observer).complete);
  ASSERT_EQ(u.size(), expected.size());
  double size = 0.0, worst = 0.0;
  for (std::size_t i = 0; i < u.size(); ++i) {
    size = std::max(size, std::abs(expected[i]));
    worst = std::max(worst, std::abs(u[i] - expected[i]));
  }
  std::printf("braking mass on a beam: midspan within %.2e of %.3f mm\n", worst / size, 1e3 * size);
  testing::measured("braking.midspan", 1e4 * worst / size);
  EXPECT_LT(worst, 5e-3 * size);
}

}  // namespace
}  // namespace railtab
