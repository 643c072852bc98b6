#include "railtab/fmi/track_variables.hpp"

#include <fmt/format.h>

#include <string_view>

namespace railtab::fmi {
namespace {

struct Quantity {
  std::string_view name, unit, description;
};

constexpr std::array<Quantity, 3> loads{{{"Y", "N", "lateral load on the rail, to the right"},
                                         {"Q", "N", "vertical load on the rail, down"},
                                         {"Mx", "N.m", "moment on the rail about x at the rail-head top"}}};
constexpr std::array<Quantity, outputs_per_wheel> motions{
    {{"rail_y", "m", "lateral displacement of the rail head, to the right"},
     {"rail_z", "m", "vertical displacement of the rail head, down"},
     {"rail_roll", "rad", "rotation of the rail head about x"},
     {"rail_y_rate", "m/s", "rate of rail_y at the place where the wheel stands"},
     {"rail_z_rate", "m/s", "rate of rail_z at the place where the wheel stands"},
     {"rail_roll_rate", "rad/s", "rate of rail_roll at the place where the wheel stands"},
     {"rail_yaw", "rad", "slope d rail_y/dx"},
     {"rail_pitch", "rad", "slope -d rail_z/dx"}}};
constexpr std::array<Quantity, outputs_per_node> node_motions{{{"y", "m", "lateral displacement, to the right"},
                                                               {"z", "m", "vertical displacement, down"},
                                                               {"y_acceleration", "m/s2", "lateral acceleration"},
                                                               {"z_acceleration", "m/s2", "vertical acceleration"}}};
constexpr std::array<std::string_view, 2> sides{"left", "right"};

TrackVariable variable(std::string_view of, const Quantity& quantity, std::string_view where, Causality causality) {
  return {fmt::format("{}.{}", of, quantity.name), std::string(quantity.unit),
          fmt::format("{}: {}", where, quantity.description), causality};
}

}  // namespace

std::vector<TrackVariable> track_variables(const DrivenTrack& track) {
  static_assert(inputs_per_wheelset == 1 + sides.size() * loads.size());
  std::vector<TrackVariable> variables, outputs;
  for (std::size_t w = 0; w < track.wheelset_x.size(); ++w) {
    const std::string wheelset = fmt::format("wheelset[{}]", w + 1);
    variables.push_back({wheelset + ".x", "m", fmt::format("wheelset {}: position along the track", w + 1),
                         Causality::input, track.wheelset_x[w]});
    for (const std::string_view side : sides) {
      const std::string wheel = fmt::format("{}.{}", wheelset, side);
      const std::string where = fmt::format("wheelset {}, {} wheel", w + 1, side);
      for (const Quantity& load : loads) variables.push_back(variable(wheel, load, where, Causality::input));
      for (const Quantity& motion : motions) outputs.push_back(variable(wheel, motion, where, Causality::output));
    }
  }
  for (std::size_t n = 0; n < track.structure.nodes.size(); ++n) {
    const StructureNode& node = track.structure.nodes[n];
    for (const Quantity& motion : node_motions) {
      outputs.push_back(variable(fmt::format("node[{}]", n + 1), motion, node.name, Causality::output));
    }
  }
  variables.insert(variables.end(), outputs.begin(), outputs.end());
  return variables;
}

}  // namespace railtab::fmi
