// Vehicles that lean under wind, on cant and under lateral acceleration: equilibrium of moments at the rails and of
// every body, built in and imported.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "../imported_vehicle.hpp"
#include "../measured.hpp"
#include "../moments_at_rails.hpp"
#include "body_balance.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/scene/result_header.hpp"
#include "railtab/runtime/scene/scene_model.hpp"
#include "railtab/runtime/scene/scene_parameters.hpp"
#include "railtab/runtime/start/static_equilibrium.hpp"
#include "railtab/runtime/vehicle/static_wheel_load.hpp"
#include "railtab/runtime/vsi/simulation.hpp"

namespace railtab {
namespace {

using testing::mass_times_height;
using testing::moment_at_rails;
using testing::moment_of_inertia_forces;
using testing::moment_of_weights;
using WindOnCoach = testing::InFolder;

constexpr double pi = std::numbers::pi;
constexpr double wind = 35e3, storm = 60e3;  // N on the car body, to the right
constexpr double car_body_height = 1.8;      // m: of its centre of gravity above the rails
constexpr double balance = 5e-3;             // of moments

SceneParameters coach_on_rigid_track() {
  SceneParameters scene;
  scene.contact.mode = ContactMode::online;
  scene.track_kind = TrackKind::rigid;
  scene.train.speed = 40.0;
  scene.train.force_elements = ForceElementChoice::linear;  // closed forms of a coach without stops
  return scene;
}

LoadParameters wind_load(double force) {
  LoadParameters load;
  load.load[1] = force;
  return load;
}

VsiState at_rest(const VsiModel& model) {
  VsiState state(model);
  EXPECT_TRUE(static_equilibrium(model, state).converged);
  return state;
}

double wheel_load(const VsiState& state, int wheel) { return state.contact.end_force[rail_unknown(wheel) + 1]; }
double lateral_force(const VsiState& state, int wheel) { return state.contact.end_force[rail_unknown(wheel)]; }

double largest_unloading(const VsiModel& model, const VsiState& state) {
  double unloading = 0.0;
  for (int wheel = 0; wheel < 2 * model.wheelsets(); ++wheel) {
    unloading = std::max(unloading, 1.0 - wheel_load(state, wheel) / static_wheel_load(model.vehicle, wheel / 2));
  }
  return unloading;
}

// Of the Manchester coach under a force [N] on its car body: by its parameters and motion alone.
BodyBalance balance_of_bodies(const VsiModel& model, const VsiState& state, double force) {
  const CoachParameters p = coach_parameters("manchester-coach");
  BodyBalance of(model.vehicle, state.vehicle[0]);
  const Eigen::Vector3d gravity{0.0, model.lateral_acceleration, model.vehicle.gravity};
  const double weight_car = gravity.z() * p.car_body.mass, weight_bogie = gravity.z() * p.bogie.mass;
  const Eigen::Vector3d car_rest{0.0, 0.0, -p.car_body_height};
  const Eigen::Vector3d primary{p.primary.kx, p.primary.ky, p.primary.kz};
  const Eigen::Vector3d primary_damping{p.primary.cx, p.primary.cy, p.primary.cz};
  const Eigen::Vector3d secondary{p.secondary.kx, p.secondary.ky, p.secondary.kz};
  const Eigen::Vector3d secondary_damping{p.secondary.cx, p.secondary.cy, p.secondary.cz};
  of.force[0] += p.car_body.mass * gravity;
  of.force[0].y() += force;
  for (const std::size_t bogie : {1U, 2U}) {
    const double x = (bogie == 1 ? 1.0 : -1.0) * p.half_bogie_distance;
    const Eigen::Vector3d bogie_rest{x, 0.0, -p.bogie_height};
    of.force[bogie] += p.bogie.mass * gravity;
    for (const double side : {-1.0, 1.0}) {
      of.add_spring(bogie, 0, bogie_rest, car_rest, {x, side * p.secondary_half_distance, -p.secondary_height},
                    secondary, secondary_damping, weight_car / 4);
      of.add_rotational(bogie, 0, {p.secondary_bending + p.roll_bar / 2, p.secondary_bending, 0.0});
    }
    for (const std::size_t axle : {0U, 1U}) {
      const std::size_t wheelset = 3 + 2 * (bogie - 1) + axle;
      const Eigen::Vector3d rest{x + (axle == 0 ? 1.0 : -1.0) * p.half_wheelbase, 0.0, -p.nominal_radius};
      of.rotation[wheelset].y() = of.rate[wheelset].y() = 0.0;  // its boxes do not turn with it
      for (const double side : {-1.0, 1.0}) {
        of.add_spring(wheelset, bogie, rest, bogie_rest, rest + Eigen::Vector3d(0.0, side * p.primary_half_distance, 0),
                      primary, primary_damping, (weight_car / 2 + weight_bogie) / 4);
      }
      of.force[wheelset] += p.wheelset.mass * gravity;
      const Eigen::Matrix<double, 6, 1> rails =
          state.contact.end_force.segment<6>(wheelset_unknowns * static_cast<int>(wheelset - 3));
      of.force[wheelset] += rails.head<3>();
      of.moment[wheelset] += rails.tail<3>();
    }
  }
  return of;
}

// What is left on the bodies, at most [N], about x [N m].
struct Rest {
  double lateral = 0.0, vertical = 0.0, moment = 0.0;

  void add(const BodyBalance& of) {
    for (std::size_t b = 0; b < of.force.size(); ++b) {
      lateral = std::max(lateral, std::abs(of.force[b].y()));
      vertical = std::max(vertical, std::abs(of.force[b].z()));
      moment = std::max(moment, std::abs(of.moment[b].x()));
    }
  }
  void expect_below(const std::string& name, double force, double overturning) const {
    const double weight = standard_gravity * coach_parameters("manchester-coach").car_body.mass;
    std::printf("%s: left on a body %.2f N lateral, %.2f N vertical, %.3f N m about x\n", name.c_str(), lateral,
                vertical, moment);
    testing::measured(name + ".body_lateral_percent", 100 * lateral / force);
    testing::measured(name + ".body_vertical_percent", 100 * vertical / weight);
    testing::measured(name + ".body_moment_percent", 100 * moment / overturning);
    EXPECT_LT(lateral, balance * force);
    EXPECT_LT(vertical, balance * weight);
    EXPECT_LT(moment, balance * overturning);
  }
};

TEST(Crosswind, ConstantWindAndTheWeightsMovedAsideUnloadTheWheels) {
  struct Case {
    const char* name;
    double force;
  };
  for (const auto& [name, force] : {Case{"constant", wind}, Case{"storm", storm}}) {
    SceneParameters scene = coach_on_rigid_track();
    scene.loads.push_back(wind_load(force));
    const VsiModel model = build_model(scene);
    const VsiState state = at_rest(model);
    double Y = 0.0;
    for (int wheel = 0; wheel < 8; ++wheel) Y += lateral_force(state, wheel);
    EXPECT_NEAR(Y, force, 1e-4 * force);
    const double overturning = force * car_body_height, leaning = moment_of_weights(model, state);
    const double found = moment_at_rails(model, state), expected = overturning + leaning;
    const double unloading = largest_unloading(model, state);

    scene.train.geometric_stiffness = GeometricStiffness::omitted;
    const VsiModel upright = build_model(scene);
    const VsiState stands = at_rest(upright);
    const double without = largest_unloading(upright, stands);
    std::printf("wind of %.0f kN: moment %.2f kN m, F h %.2f + sum W dy %.2f; unloading %.3f, upright %.3f\n",
                1e-3 * force, 1e-3 * found, 1e-3 * overturning, 1e-3 * leaning, unloading, without);
    testing::measured(std::string("wind.") + name + "_percent", 100 * (found / expected - 1));
    testing::measured(std::string("wind.") + name + "_unloading", unloading);
    testing::measured(std::string("wind.") + name + "_unloading_upright", without);
    testing::measured(std::string("wind.") + name + "_leaning_share", 100 * leaning / overturning);
    EXPECT_NEAR(found, expected, balance * expected);
    EXPECT_NEAR(moment_at_rails(upright, stands), overturning, balance * overturning);
    // 36 % more moment, that of the weight moved aside
    EXPECT_GT(unloading, 1.25 * without);
  }
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
  const VsiState state = at_rest(model);
  const double aside = state.vehicle[0].displacement[model.vehicle.dof[0][1]];
  const double moment = 1.5 * 2.5 * force - 0.4 * force * aside + moment_of_weights(model, state);
  EXPECT_NEAR(moment_at_rails(model, state), moment, balance * moment);

  scene.loads[0].wind_speed = 80.0;
  scene.loads[0].wind_direction = 135.0;  // from behind, faster than the train: beyond the table
  EXPECT_THROW(static_cast<void>(build_model(scene)), InputError);
}

TEST(Crosswind, SlowGustUnloadsWheelsByItsOverturningMoment) {
  constexpr double length = 30.0;  // s: the slowest motion of the coach, its lower sway, has a period of 1.7 s
  SceneParameters scene = coach_on_rigid_track();
  scene.loads.push_back(wind_load(wind));
  scene.loads.back().start = 1.0;
  scene.loads.back().gust_duration = length;
  scene.integration.time_step = 4e-3;
  scene.integration.duration = 33.0;
  const VsiModel model = build_model(scene);
  VsiState state(model);
  ASSERT_TRUE(steady_start(model, state).converged);
  double worst = 0.0, worst_with_inertia = 0.0, unloading = 0.0, expected_peak = 0.0;
  Rest rest;
  RunObserver observer;
  observer.state = [&](const VsiState& now) {
    const bool blows = now.time > 1.0 && now.time < 1.0 + length;
    const double gust = blows ? 0.5 * (1.0 - std::cos(2.0 * pi * (now.time - 1.0) / length)) : 0.0;
    const double expected = gust * wind * car_body_height + moment_of_weights(model, now);
    const double off = moment_at_rails(model, now) - expected;
    worst = std::max(worst, std::abs(off));
    worst_with_inertia = std::max(worst_with_inertia, std::abs(off - moment_of_inertia_forces(model, now)));
    expected_peak = std::max(expected_peak, expected);
    unloading = std::max(unloading, largest_unloading(model, now));
    rest.add(balance_of_bodies(model, now, gust * wind));
  };
  ASSERT_TRUE(simulate(model, scene.integration, scene.integration.duration, 1000, state, observer).complete);
  rest.expect_below("wind.gust", wind, wind * car_body_height);
  // the textbook estimate: the moment over twice the half distance of the contacts, over four wheelsets
  const double textbook = expected_peak / (4.0 * 1.5) / 54.55e3;
  std::printf("slow gust: moment within %.3f %% of its peak, %.3f %% with inertia; unloading %.3f, textbook %.3f\n",
              100.0 * worst / expected_peak, 100.0 * worst_with_inertia / expected_peak, unloading, textbook);
  testing::measured("wind.gust_percent", 100 * worst / expected_peak);
  testing::measured("wind.gust_with_inertia_percent", 100 * worst_with_inertia / expected_peak);
  testing::measured("wind.gust_unloading", unloading);
  testing::measured("wind.gust_textbook", textbook);
  EXPECT_LT(worst, balance * expected_peak);
  EXPECT_LT(worst_with_inertia, 0.2 * balance * expected_peak);
  EXPECT_NEAR(unloading, textbook, 0.1 * textbook);
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
  const VsiState state = at_rest(model);
  const double sine = 0.1, cosine = std::sqrt(1.0 - sine * sine);
  double Q = 0.0, Y = 0.0, weight = 0.0;
  for (int wheel = 0; wheel < 8; ++wheel) {
    Q += wheel_load(state, wheel);
    Y += lateral_force(state, wheel);
  }
  for (const DofIndices& dof : model.vehicle.dof) weight += standard_gravity * model.vehicle.mass(dof[1], dof[1]);
  EXPECT_NEAR(Q, weight * cosine, 1e-6 * weight);
  EXPECT_NEAR(Y, -weight * sine, 1e-4 * weight);
  const double moment =
      moment_of_weights(model, state) - standard_gravity * sine * mass_times_height(model.vehicle);  // to the left
  const double percent = 100 * (moment_at_rails(model, state) / moment - 1);
  std::printf("canted standstill: moment %.2f kN m, %.3f %% off\n", 1e-3 * moment, percent);
  testing::measured("cant.standing_percent", percent);
  EXPECT_LT(moment, -50e3);
  EXPECT_NEAR(moment_at_rails(model, state), moment, -balance * moment);
  Rest rest;
  rest.add(balance_of_bodies(model, state, 0.0));
  rest.expect_below("cant", weight * sine, -moment);
}

TEST(Cant, BalancesTheLateralAccelerationOfItsCurve) {
  SceneParameters scene = coach_on_rigid_track();
  scene.train.cant = 0.15;
  scene.train.lateral_acceleration = 9.81 * 0.1 / std::sqrt(0.99);
  const VsiModel model = build_model(scene);
  const VsiState state = at_rest(model);
  for (const DofIndices& dof : model.vehicle.dof) EXPECT_NEAR(state.vehicle[0].displacement[dof[1]], 0.0, 1e-9);
  EXPECT_NEAR(wheel_load(state, 0), wheel_load(state, 1), 1e-3);
}

TEST(Cant, LateralAccelerationThatItDoesNotBalanceOverturns) {
  constexpr double acceleration = 1.0, cant = 0.06, sine = cant / 1.5;  // m/s²: V²/R, m
  SceneParameters scene = coach_on_rigid_track();
  scene.train.lateral_acceleration = acceleration;
  scene.train.cant = cant;
  const VsiModel model = build_model(scene);
  const VsiState state = at_rest(model);
  const double cosine = std::sqrt(1.0 - sine * sine), uncompensated = acceleration * cosine - standard_gravity * sine;
  EXPECT_NEAR(model.vehicle.gravity, standard_gravity * cosine + acceleration * sine, 1e-12);
  const double Q0 = static_wheel_load(build_model(coach_on_rigid_track()).vehicle, 0);  // of level track in any curve
  for (const double load : model_header(model).static_wheel_load) EXPECT_NEAR(load, Q0, 1e-9 * Q0);
  const double centrifugal = uncompensated * mass_times_height(model.vehicle);
  const double moment = centrifugal + moment_of_weights(model, state);
  const double percent = 100 * (moment_at_rails(model, state) / moment - 1);
  std::printf("uncompensated %.2f m/s²: moment %.2f kN m, of it leaning %.2f, %.3f %% off\n", uncompensated,
              1e-3 * moment, 1e-3 * moment_of_weights(model, state), percent);
  testing::measured("cant.uncompensated_percent", percent);
  EXPECT_GT(moment, 1.2 * centrifugal);
  EXPECT_NEAR(moment_at_rails(model, state), moment, balance * moment);
}

// Car body, bogie frames and wheelsets of the leaning coach, each under the forces of its springs, its weight, the wind
// and the rails. What linear equations of motion leave out is of second order: a tenth of the wind, a hundredth of it.
TEST(Crosswind, EveryBodyOfALeaningCoachIsInEquilibrium) {
  const auto rest_in = [](double force) {
    SceneParameters scene = coach_on_rigid_track();
    scene.loads.push_back(wind_load(force));
    const VsiModel model = build_model(scene);
    Rest rest;
    rest.add(balance_of_bodies(model, at_rest(model), force));
    return rest;
  };
  const Rest rest = rest_in(wind);
  rest.expect_below("wind", wind, wind * car_body_height);
  EXPECT_LT(rest_in(0.1 * wind).moment, 0.01 * rest.moment);
}

// What acts on a vehicle that leans.
struct LeaningCase {
  const char* name;
  double force = 0.0, gust = 0.0;  // N at the car body; duration in s, 0: constant
  double cant = 0.0;               // m, at a standstill
};
constexpr LeaningCase leaning_cases[] = {
    {.name = "wind", .force = wind}, {.name = "gust", .force = wind, .gust = 3.0}, {.name = "cant", .cant = 0.15}};

// The same coach from matrices, without its geometric stiffness and with it.
class LeaningImports : public testing::ImportedVehicle {
 protected:
  struct Outcome {
    double unloading = 0.0, off = 0.0, largest_moment = 0.0;  // off the moments' balance [N m]
  };

  static void apply(const LeaningCase& of, SceneParameters& scene) {
    scene.train.cant = of.cant;
    scene.train.speed = of.cant > 0.0 ? 1e-3 : 40.0;
    if (of.force == 0.0) return;
    scene.loads.push_back(wind_load(of.force));
    scene.loads.back().gust_duration = of.gust;
  }

  [[nodiscard]] SceneParameters imported(GeometricStiffness geometric, double gravity) const {
    const VehicleWeight weight{gravity, geometric == GeometricStiffness::in_matrices ? GeometricStiffness::included
                                                                                     : GeometricStiffness::omitted};
    write(testing::free_coach(coach_parameters("manchester-coach"), weight));
    SceneParameters scene =
        this->scene(vehicle_section() + "[contact]\nmode = \"online\"\n[track]\nkind = \"rigid\"\n" +
                    "[integration]\nduration = 0.1\n");
    scene.train.geometric_stiffness = geometric;
    return scene;
  }

  static Outcome outcome(const LeaningCase& of, const SceneParameters& scene) {
    const VsiModel model = build_model(scene);
    VsiState state(model);
    EXPECT_TRUE(steady_start(model, state).converged);
    Outcome result;
    const auto add = [&](const VsiState& now) {
      const double gust = of.gust > 0.0 ? 0.5 * (1.0 - std::cos(2.0 * pi * now.time / of.gust)) : 1.0;
      const double expected = gust * of.force * car_body_height + moment_of_weights(model, now) +
                              model.lateral_acceleration * mass_times_height(model.vehicle) +
                              moment_of_inertia_forces(model, now);
      const double found = moment_at_rails(model, now);
      result.off = std::max(result.off, std::abs(found - expected));
      result.largest_moment = std::max(result.largest_moment, std::abs(found));
      result.unloading = std::max(result.unloading, largest_unloading(model, now));
    };
    if (of.gust == 0.0) {
      add(state);
      return result;
    }
    RunObserver observer;
    observer.state = add;
    IntegrationParameters integration;
    integration.time_step = 2e-3;
    integration.tolerance = 1e-7;  // the default lets two programs of one motion differ by 1e-5
    EXPECT_TRUE(simulate(model, integration, of.gust, 10000, state, observer).complete);
    return result;
  }
};

TEST_F(LeaningImports, UnloadTheirWheelsAsTheBuiltCoach) {
  for (const LeaningCase& of : leaning_cases) {
    SceneParameters scene = coach_on_rigid_track();
    apply(of, scene);
    const Outcome built = outcome(of, scene);
    // matrices written with the weight normal to the canted track
    const double gravity = build_model(scene).vehicle.gravity;
    for (const GeometricStiffness geometric : {GeometricStiffness::in_matrices, GeometricStiffness::included}) {
      SceneParameters of_matrices = imported(geometric, gravity);
      apply(of, of_matrices);
      const Outcome found = outcome(of, of_matrices);
      const bool same = geometric == GeometricStiffness::in_matrices;
      const std::string name = std::string("leaning_import.") + of.name + (same ? "_in_matrices" : "_included");
      std::printf("%s: unloading %.6f, built coach %.6f; moments %.3f %% off, built coach %.3f %%\n", name.c_str(),
                  found.unloading, built.unloading, 100 * found.off / found.largest_moment,
                  100 * built.off / built.largest_moment);
      testing::measured(name + "_percent", 100 * found.off / found.largest_moment);
      testing::measured(name + "_unloading_percent", 100 * (found.unloading / built.unloading - 1));
      EXPECT_LT(found.off, balance * found.largest_moment) << name;
      EXPECT_NEAR(found.unloading, built.unloading, (same ? 1e-5 : 0.05) * built.unloading) << name;
    }
  }
}

}  // namespace
}  // namespace railtab
