#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "railtab/runtime/structure/longitudinal_motion.hpp"
#include "railtab/runtime/structure/matrix_assembly.hpp"

namespace railtab {

/// Where a spring of the ballast ends on a bridge: the motions x, y, z, roll, pitch, yaw of a point of the bridge are
/// rows·a[dof] (held dofs count as zero), and a rigid arm leads from that point to the end of the spring.
struct DeckAttachment {
  std::vector<int> dof;
  Eigen::Matrix<double, 6, Eigen::Dynamic> rows;
  Eigen::Vector3d arm;  // [m]
  /// Motion 0 to 5 for x, y, z, roll, pitch, yaw of the end of the arm.
  [[nodiscard]] DofSum motion(Eigen::Index k) const;
};

/// A bridge without its track, in railtab's axes and SI units; x = 0 and the track's centre are those of the track.
struct Bridge {
  MatrixAssembly matrices;
  std::vector<double> dof_x;    // position along the track of each dof [m]
  std::vector<int> dof_line{};  // StructureModel::dof_line, from track_lines on; empty: all -1
  std::vector<int> dof_node{};  // StructureModel::dof_node; empty: each is a node
  int node_count = 0;           // that dof_node has
  /// The dofs that were added last are all of their node; a node without any is not counted.
  void end_node() {
    if (!dof_node.empty() && dof_node.back() == node_count) ++node_count;
  }
  std::vector<std::array<double, 2>> spans;  // from and to [m]
  std::vector<double> support_x;             // of each support, whose y and z are two columns of it [m]
  std::string beyond_supports;               // StructureSupports::beyond
  std::vector<std::string> warnings;         // on what was imported
  std::vector<std::string> left_out{};       // StructureModel::left_out
  double end = 0.0;                          // [m]: the track goes on beyond for its own length_after
  std::vector<StructureNode> nodes;  // of interest; a name that begins with "deck-" gives the rails above a name too
  // Motions of theirs that are sums of dofs: node, 0 to 5 for x to yaw.
  struct SummedMotion {
    std::size_t node, motion;
    DofSum sum;
  };
  std::vector<SummedMotion> summed{};
  std::vector<DeckRow> deck{};                     // vertical motions of the decks' nodes, forces in their sections
  std::vector<std::array<double, 2>> deck_ends{};  // from and to [m]
  /// The attachment of a ballast spring at (x, y, z) [m], y right of the track's centre and z below the rail-head top;
  /// empty where the bridge does not carry the track.
  std::function<std::optional<DeckAttachment>(double x, double y, double z)> attach;
  // Vertical displacement of a surface at (x, y) by the nodes around it, which spreads nothing as a spring's attachment
  // does; not set: that of the attachment.
  std::function<std::optional<DofSum>(double x, double y)> surface{};
};

/// Lines of dofs (StructureModel::dof_line) that a track has: of the sleepers, of the left and of the right rail.
inline constexpr int track_lines = 3 * lines_per_node;

/// Simply supported beam spans from x = 0.
/// @param report positions along the track whose nearest beam node between supports is reported; empty: midspans [m]
/// @throws InputError naming the key
[[nodiscard]] Bridge beam_bridge(const std::vector<BridgeParameters>& spans, MotionPlane plane,
                                 const std::vector<double>& report = {}, DeckRecord record = DeckRecord::named_nodes);

/// In which motions a track is built.
struct TrackMotion {
  MotionPlane plane = MotionPlane::spatial;
  LongitudinalChoice longitudinal;
};

/// Rails on pads, sleepers and ballast, laid over a bridge and on to the ground before and after it. The one place
/// where track and bridge are put together. @throws InputError naming the key
[[nodiscard]] StructureModel lay_track(const TrackParameters& track, Bridge bridge, const TrackMotion& motion,
                                       DeckRecord record = DeckRecord::named_nodes);

/// Dofs of the ground under every sleeper; none where it stands on a bridge.
using SleeperGround = std::vector<std::optional<DofIndices>>;
/// Adds to the bridge's channels what its decks do under the track and at their ends.
void add_track_channels(const TrackParameters& track, const std::vector<double>& sleeper_x, const SleeperGround& ground,
                        MotionPlane plane, Bridge& bridge);

/// Dofs of a node that a support moves along y and z and holds otherwise; the support is added at x.
[[nodiscard]] DofIndices supported_node(double x, std::vector<double>& support_x);

/// Whether a plane has a dof: 0 to 5 for x, y, z, roll, pitch, yaw.
[[nodiscard]] constexpr bool has_dof(MotionPlane plane, std::size_t dof) noexcept {
  return plane == MotionPlane::spatial || dof % 2 == 0;
}

}  // namespace railtab
