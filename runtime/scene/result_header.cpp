#include "railtab/runtime/scene/result_header.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "railtab/runtime/base/file_checksum.hpp"
#include "railtab/runtime/base/version.hpp"
#include "railtab/runtime/scene/run_plan.hpp"
#include "railtab/runtime/vehicle/static_wheel_load.hpp"

namespace railtab {

ResultHeader model_header(const VsiModel& model) {
  ResultHeader header;
  header.speed = model.speed(0.0);
  header.judged = model.judged;
  for (int w = 0; w < model.wheelsets(); ++w) {
    for (int side = 0; side < 2; ++side) {
      header.wheel_x.push_back(model.wheelset_x(w, 0.0) - model.wheelset_x(0, 0.0));
      header.static_wheel_load.push_back(static_wheel_load(model.vehicle, w % model.wheelsets_per_vehicle()));
    }
  }
  for (std::size_t v = 0; v < model.vehicle_x.size(); ++v) {
    const int first_coach = static_cast<int>(v) * model.vehicle.coaches + 1;
    for (const VehicleBody& body : model.vehicle.bodies) {
      header.body_names.push_back(fmt::format("coach-{}/{}", first_coach + body.coach, body.name));
      header.body_x.push_back(model.vehicle_x[v] + body.position.x() - model.wheelset_x(0, 0.0));
      header.body_y.push_back(body.position.y());
      header.body_z.push_back(body.position.z());
    }
  }
  if (model.structure) {
    for (const StructureNode& node : model.structure->nodes) {
      header.node_names.push_back(node.name);
      header.node_x.push_back(node.x);
      header.node_y.push_back(node.y);
      header.node_z.push_back(node.z);
    }
    const auto known = [](const std::vector<double>& values) {
      return std::none_of(values.begin(), values.end(), [](double value) { return std::isnan(value); });
    };
    if (!known(header.node_y) || !known(header.node_z)) {
      header.node_y.clear();
      header.node_z.clear();
    }
    for (const std::array<double, 2>& span : model.structure->spans) {
      header.span_from.push_back(span[0]);
      header.span_to.push_back(span[1]);
    }
  }
  if (!model.geometry) return header;
  const WheelRailPair& pair = model.geometry->pair();
  if (!model.wheelset_geometry.empty()) {
    for (int wheel = 0; wheel < 2 * model.wheelsets(); ++wheel) {
      header.wheel_outline.push_back(&model.geometry_of(wheel / 2) == model.geometry.get() ? 1.0 : 0.0);
    }
  }
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
  header.program_version = version();
  header.contact_mode = contact_mode_name(scene.contact);
  ModelParts parts = model_parts(scene, model);
  header.built = std::move(parts.built);
  header.left_out = std::move(parts.left_out);
  return header;
}

}  // namespace railtab
