#include "railtab/runtime/scene/key_table.hpp"

namespace railtab::scene {
namespace {

template <auto member>
auto& of_train(SceneDraft& draft) {
  return draft.parameters.train.*member;
}
template <auto member>
auto& of_vehicle(SceneDraft& draft) {
  return draft.parameters.vehicle.*member;
}

}  // namespace

std::vector<KeyRow> train_keys() {
  return {
      {"name", "", "name of the scene; absent: the name of the file",
       TextKey{[](SceneDraft& d) -> std::string& { return d.parameters.name; }, nullptr}},
      {"train.vehicle",
       "",
       "imported: the vehicle of [vehicle], the default if that section has keys",
       VehicleKey{of_train<&TrainParameters::vehicle>},
       {&without_consist},
       {&vehicle_implausible, &vehicle_above_top_speed, &vehicle_above_critical_speed, &vehicle_linearised}},
      {"train.count",
       "1",
       "number of coaches",
       IntegerKey{of_train<&TrainParameters::count>, 1, 100},
       {&without_consist}},
      {"train.consist",
       "",
       "vehicles from front to rear; `-` turns one around, `*` repeats it",
       ConsistKey{of_train<&TrainParameters::consist>},
       {&without_imported_vehicle}},
      {"train.joint",
       "",
       "joint between neighbouring vehicles whose files name none",
       FileKey{of_train<&TrainParameters::joint>},
       {&without_imported_vehicle}},
      {"train.speed",
       "m/s",
       "constant running speed",
       NumberKey{of_train<&TrainParameters::speed>, {1e-3, 200.0}},
       {&without_speed_kmh, &without_speed_file}},
      {"train.speed_kmh",
       "km/h",
       "constant running speed",
       OptionalNumberKey{[](SceneDraft& d) -> std::optional<double>& { return d.speed_kmh; }, {3.6e-3, 720.0}},
       {&without_speed_file}},
      {"train.speed_file",
       "",
       "running speed over time, by forces on the car bodies (brakes: loads)",
       FileKey{of_train<&TrainParameters::speed_file>},
       {},
       {&speed_outside_run, &speed_without_brakes}},
      {"train.start",
       "m",
       "position of the first wheelset at t = 0",
       NumberKey{of_train<&TrainParameters::start>, {-1e6, 1e6}},
       {},
       {&start_on_span}},
      {"train.initial_lateral_shift",
       "m",
       "lateral shift of all wheelsets at t = 0, to the right",
       NumberKey{of_train<&TrainParameters::initial_lateral_shift>, {-0.02, 0.02}},
       {&with_hertz_contact},
       {&start_on_flanges}},
      {"train.initial_yaw",
       "rad",
       "yaw of all wheelsets at t = 0",
       NumberKey{of_train<&TrainParameters::initial_yaw>, {-0.1, 0.1}},
       {&with_hertz_contact}},
      {"train.lateral_acceleration",
       "m/s²",
       "horizontal acceleration that pushes to the right, V²/R of a curve to the left",
       NumberKey{of_train<&TrainParameters::lateral_acceleration>, {-5.0, 5.0}},
       {&with_hertz_contact}},
      {"train.cant",
       "m",
       "height of the right rail above the left one, over 1.5 m",
       NumberKey{of_train<&TrainParameters::cant>, {-0.5, 0.5}},
       {&with_hertz_contact}},
      {"train.geometric_stiffness", "",
       "stiffness by the weight of a leaning vehicle; in-matrices: the imported stiffness has it",
       choice<GeometricStiffness>(of_train<&TrainParameters::geometric_stiffness>,
                                  {{"included", GeometricStiffness::included},
                                   {"omitted", GeometricStiffness::omitted},
                                   {"in-matrices", GeometricStiffness::in_matrices}})},
      {"train.force_elements", "", "bump stops, blow-off, dry friction; linear: stand-ins, without stops",
       choice<ForceElementChoice>(
           of_train<&TrainParameters::force_elements>,
           {{"nonlinear", ForceElementChoice::nonlinear}, {"linear", ForceElementChoice::linear}})},
  };
}

std::vector<KeyRow> vehicle_keys() {
  return applying(
      with_imported_vehicle,
      {
          {"vehicle.mass", "", "Matrix Market", FileKey{of_vehicle<&VehicleImport::mass>}},
          {"vehicle.damping", "", "Matrix Market", FileKey{of_vehicle<&VehicleImport::damping>}},
          {"vehicle.stiffness", "", "Matrix Market", FileKey{of_vehicle<&VehicleImport::stiffness>}},
          {"vehicle.dofs", "", "body and direction of each row", FileKey{of_vehicle<&VehicleImport::dofs>}},
          {"vehicle.units", "", "units of length, force, mass",
           TextKey{[](SceneDraft& d) -> std::string& { return d.parameters.vehicle.frame.units; }, fe_unit_systems}},
          {"vehicle.axes", "", "model's directions forward, right and down",
           TextKey{[](SceneDraft& d) -> std::string& { return d.parameters.vehicle.frame.axes; }, nullptr}},
          {"vehicle.origin", "",
           "point of the model under the vehicle's centre, at the rail-head tops, in its axes and unit",
           PointKey{[](SceneDraft& d) -> std::optional<Point>& { return d.parameters.vehicle.frame.origin; },
                    {-1e9, 1e9}}},
          {"vehicle.wheelsets", "", "wheelsets, from front to rear",
           TextListKey{of_vehicle<&VehicleImport::wheelsets>}},
          {"vehicle.car_body", "", "car body", TextKey{of_vehicle<&VehicleImport::car_body>, nullptr}},
          {"vehicle.car_bodies", "", "car bodies of a train, from front to rear, in place of vehicle.car_body",
           TextListKey{of_vehicle<&VehicleImport::car_bodies>}},
          {"vehicle.length", "m", "length over couplers, for several vehicles",
           OptionalNumberKey{of_vehicle<&VehicleImport::length>, {0.5, 100.0}}},
      });
}

}  // namespace railtab::scene
