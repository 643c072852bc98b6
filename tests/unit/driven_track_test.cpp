// What an FMU has of a scene: stored to the last bit, damaged content rejected; and its steps.
#include "railtab/fmi/driven_track.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "railtab/fmi/track_simulation.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/structure/track_bridge.hpp"

namespace railtab::fmi {
namespace {

DrivenTrack short_bridge(double time_step = 1e-3, double alpha = -0.05) {
  TrackParameters track;
  track.length_before = track.length_after = 3.0;
  BridgeParameters span;
  span.length = 3.0;
  span.elements = 6;
  return {"short", {alpha, time_step}, {2.0, -0.5}, build_track_bridge(track, {span})};
}

TEST(DrivenTrack, IsStoredToTheLastBit) {
  const DrivenTrack track = short_bridge();
  const std::string bytes = track_bytes(track);
  const DrivenTrack read = track_of_bytes(bytes, "track");
  EXPECT_EQ(track_bytes(read), bytes);
  EXPECT_EQ(read.name, "short");
  EXPECT_EQ(read.wheelset_x, track.wheelset_x);
  EXPECT_EQ(read.scheme.alpha, -0.05);
  EXPECT_EQ((read.structure.stiffness - track.structure.stiffness).norm(), 0.0);
  EXPECT_EQ((read.structure.mass - track.structure.mass).norm(), 0.0);
  EXPECT_EQ(read.structure.rail[1].dof, track.structure.rail[1].dof);
  EXPECT_EQ(read.structure.rail[1].twist_rate, track.structure.rail[1].twist_rate);
  EXPECT_EQ(read.structure.rail[0].stiffness, track.structure.rail[0].stiffness);
  EXPECT_EQ(read.structure.dof_line, track.structure.dof_line);
  EXPECT_EQ(read.structure.dof_node, track.structure.dof_node);
  EXPECT_EQ(read.structure.nodes.size(), track.structure.nodes.size());
  EXPECT_EQ(track_guid(bytes).size(), 32u);
}

TEST(DrivenTrack, OtherContentIsRejectedAndHasAnotherGuid) {
  const std::string bytes = track_bytes(short_bridge());
  const auto expect_rejected = [](std::string_view content) {
    EXPECT_THROW(static_cast<void>(track_of_bytes(content, "track")), InputError) << content.size();
  };
  expect_rejected("");
  expect_rejected("railtab track of another version\n");
  for (const int node : {-1, short_bridge().structure.dofs()}) {
    DrivenTrack track = short_bridge();
    track.structure.dof_node.back() = node;
    expect_rejected(track_bytes(track));
  }
  DrivenTrack track = short_bridge();
  track.structure.dof_node.pop_back();
  expect_rejected(track_bytes(track));
  for (std::size_t length = 0; length < bytes.size(); length += 97) expect_rejected(bytes.substr(0, length));
  expect_rejected(bytes + "x");
  for (std::size_t place = 0; place < bytes.size(); place += 101) {
    std::string changed = bytes;
    changed[place] = static_cast<char>(changed[place] ^ 0x10);
    EXPECT_NE(track_guid(changed), track_guid(bytes)) << place;
  }
}

// Nodes of shells, of solids and of modes have no dofs of their own.
TEST(DrivenTrack, MovesNodesWhoseMotionsAreSums) {
  DrivenTrack track = short_bridge(), summed = track;
  constexpr std::size_t z = 2;
  StructureModel& structure = summed.structure;
  structure.summed_nodes.resize(static_cast<Eigen::Index>(6 * structure.nodes.size()), structure.dofs());
  for (std::size_t node = 0; node < structure.nodes.size(); ++node) {
    const int dof = std::exchange(structure.nodes[node].dof[z], held);
    ASSERT_NE(dof, held);
    structure.summed_nodes.insert(static_cast<Eigen::Index>(6 * node + z), dof) = 1.0;
  }
  TrackSimulation by_dofs(track), by_sums(track_of_bytes(track_bytes(summed), "track"));
  for (TrackSimulation* simulation : {&by_dofs, &by_sums}) {
    simulation->set(2, 6e4);
    simulation->step(simulation->time_step());
  }
  double largest = 0.0;
  for (std::size_t v = by_dofs.inputs(); v < by_dofs.variables().size(); ++v) {
    EXPECT_EQ(by_sums.value(v), by_dofs.value(v)) << by_dofs.variables()[v].name;
    if (by_dofs.variables()[v].name.starts_with("node[")) largest = std::max(largest, std::abs(by_dofs.value(v)));
  }
  EXPECT_GT(largest, 0.0);
  summed.structure.summed_nodes.conservativeResize(6, structure.dofs());
  EXPECT_THROW(static_cast<void>(track_of_bytes(track_bytes(summed), "track")), InputError);
}

// Displacement under the wheel of a load that grows as 1 - cos and moves, at the end of some time, by steps of a
// length.
double deflection(double time_step, double alpha) {
  constexpr double duration = 0.02, load = 6e4;
  TrackSimulation track(short_bridge(time_step, alpha));
  const auto steps = std::lround(duration / time_step);
  for (long k = 1; k <= steps; ++k) {
    const double t = static_cast<double>(k) * time_step;
    track.set(2, load * (1.0 - std::cos(300.0 * t)));
    track.step(time_step);
  }
  constexpr std::size_t rail_z = 1;
  return track.value(track.inputs() + rail_z);
}

TEST(DrivenTrack, StepsAreOfSecondOrder) {
  for (const double alpha : {0.0, -0.1}) {
    const double exact = deflection(2.5e-6, alpha);
    const double coarse = std::abs(deflection(1e-4, alpha) - exact), fine = std::abs(deflection(5e-5, alpha) - exact);
    const double order = std::log2(coarse / fine);
    EXPECT_GT(order, 1.8) << alpha;
    EXPECT_LT(order, 2.3) << alpha;
  }
}

}  // namespace
}  // namespace railtab::fmi
