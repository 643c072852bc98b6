#include "railtab/runtime/scene/result_header.hpp"

#include <fmt/format.h>

#include "railtab/runtime/base/file_checksum.hpp"
#include "railtab/runtime/vehicle/static_wheel_load.hpp"

namespace railtab {

ResultHeader model_header(const VsiModel& model) {
  ResultHeader header;
  header.speed = model.speed(0.0);
  for (int w = 0; w < model.wheelsets(); ++w) {
    for (int side = 0; side < 2; ++side) {
      header.wheel_x.push_back(model.wheelset_x(w, 0.0) - model.wheelset_x(0, 0.0));
      header.static_wheel_load.push_back(static_wheel_load(model.vehicle, w % model.wheelsets_per_vehicle()));
    }
  }
  for (int v = 0; v < static_cast<int>(model.vehicle_x.size()); ++v) {
    for (const VehicleBody& body : model.vehicle.bodies) {
      header.body_names.push_back(fmt::format("coach-{}/{}", v * model.vehicle.coaches + body.coach + 1, body.name));
    }
  }
  if (model.structure) {
    for (const StructureNode& node : model.structure->nodes) {
      header.node_names.push_back(node.name);
      header.node_x.push_back(node.x);
    }
  }
  if (!model.geometry) return header;
  const WheelRailPair& pair = model.geometry->pair();
  header.wheel_profile = pair.wheel().knots().name;
  header.rail_profile = pair.rail().knots().name;
  header.wheel_y = pair.wheel().knots().y;
  header.wheel_z = pair.wheel().knots().z;
  header.rail_y = pair.rail().knots().y;
  header.rail_z = pair.rail().knots().z;
  return header;
}

ResultHeader result_header(const SceneParameters& scene, const VsiModel& model) {
  ResultHeader header = model_header(model);
  header.scene_name = scene.name;
  header.scene_text = scene.text;
  for (const std::filesystem::path& file : scene.files) {
    header.input_files.push_back(file.string());
    header.input_checksums.push_back(file_checksum(file));
  }
  header.program_version = RAILTAB_VERSION;
  header.contact_mode = contact_mode_name(scene.contact);
  return header;
}

}  // namespace railtab
