#include "railtab/runtime/scene/key_table.hpp"

namespace railtab::scene {
namespace {

VehicleImport& import_of(SceneDraft& draft) { return draft.parameters.vehicle; }

}  // namespace

const std::vector<KeyBinding>& vehicle_keys() {
  static const std::vector<KeyBinding> keys{
      {"vehicle.mass", "", "mass matrix, Matrix Market",
       FileKey{[](SceneDraft& d) -> std::filesystem::path& { return import_of(d).mass; }}},
      {"vehicle.damping", "", "damping matrix",
       FileKey{[](SceneDraft& d) -> std::filesystem::path& { return import_of(d).damping; }}},
      {"vehicle.stiffness", "", "stiffness matrix",
       FileKey{[](SceneDraft& d) -> std::filesystem::path& { return import_of(d).stiffness; }}},
      {"vehicle.dofs", "", "what the rows of the matrices are",
       FileKey{[](SceneDraft& d) -> std::filesystem::path& { return import_of(d).dofs; }}},
      {"vehicle.units", "", "of the model, with the second",
       TextKey{[](SceneDraft& d) -> std::string& { return import_of(d).frame.units; }, fe_unit_systems}},
      {"vehicle.axes", "", "the model's directions forward, right and down",
       TextKey{[](SceneDraft& d) -> std::string& { return import_of(d).frame.axes; }, nullptr}},
      {"vehicle.origin", "", "the model's point under the vehicle's centre, at the height of the rail-head tops",
       PointKey{[](SceneDraft& d) -> std::optional<Point>& { return import_of(d).frame.origin; }}},
      {"vehicle.wheelsets", "", "bodies that are wheelsets, in order from the front",
       TextListKey{[](SceneDraft& d) -> std::vector<std::string>& { return import_of(d).wheelsets; }}},
      {"vehicle.car_body", "", "body that is the car body",
       TextKey{[](SceneDraft& d) -> std::string& { return import_of(d).car_body; }, nullptr}},
      {"vehicle.length", "m", "over couplers, of a train of several",
       OptionalNumberKey{[](SceneDraft& d) -> std::optional<double>& { return import_of(d).length; },
                         {0.0, 100.0, true}}},
  };
  return keys;
}

}  // namespace railtab::scene
