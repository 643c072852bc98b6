#include "railtab/runtime/structure/structure_summary.hpp"

#include <Eigen/Geometry>
#include <array>
#include <cassert>
#include <cmath>
#include <numbers>

#include "bridge.hpp"
#include "railtab/runtime/structure/reduction.hpp"

namespace railtab {

namespace {

/// Rigid motion `k` (x, y, z, roll, pitch, yaw about `centre`) of every row. @pre no expanded node where k >= 3
Eigen::VectorXd rigid_motion(const FeStructure& structure, std::size_t k, const Eigen::Vector3d& centre) {
  Eigen::VectorXd motion = Eigen::VectorXd::Zero(structure.dofs());
  for (Eigen::Index r = 0; r < motion.size(); ++r) {
    if (structure.node_of_row[static_cast<std::size_t>(r)] == no_node) continue;
    const auto of_row = static_cast<std::size_t>(structure.motion[static_cast<std::size_t>(r)]);
    if (of_row == k) motion[r] = 1.0;
    if (k < 3 || of_row >= 3) continue;
    const FeNode& node = structure.nodes.at(structure.node_of_row[static_cast<std::size_t>(r)]);
    const Eigen::Vector3d axis = Eigen::Vector3d::Unit(static_cast<Eigen::Index>(k) - 3);
    motion[r] = axis.cross(node.position - centre)[static_cast<Eigen::Index>(of_row)];
  }
  return motion;
}

/// Nothing resists a motion whose energy is rounding of what its parts have: vᵀKv against |v|ᵀ|K||v|. One held motion
/// of one node in a mesh of a million leaves more than that.
bool is_free(const Eigen::SparseMatrix<double>& stiffness, const Eigen::VectorXd& v) {
  constexpr double rounding = 1e-11;
  const double energy = v.dot(stiffness * v);
  const double parts = v.cwiseAbs().dot(stiffness.cwiseAbs() * v.cwiseAbs());
  return energy < rounding * parts;
}

void add_modes(const Eigen::SparseMatrix<double>& mass, const Eigen::SparseMatrix<double>& damping,
               const Eigen::SparseMatrix<double>& stiffness, int count, StructureSummary& summary) {
  if (count == 0) return;
  const ModalBasis found = lowest_modes(stiffness, mass, count);
  for (Eigen::Index k = 0; k < found.omega2.size(); ++k) {
    const Eigen::VectorXd shape = found.shape.col(k);
    const double omega = std::sqrt(found.omega2[k]);
    summary.frequencies.push_back(omega / (2.0 * std::numbers::pi));
    summary.damping_ratios.push_back(shape.dot(damping * shape) / (2.0 * omega));
  }
}

}  // namespace

StructureSummary summarise(const FeStructure& structure, const FeDamping& damping, int modes) {
  assert(modes >= 0);
  constexpr std::array<const char*, 6> names{"x", "y", "z", "roll", "pitch", "yaw"};
  StructureSummary summary;
  summary.dofs = structure.dofs();
  summary.nodes = static_cast<long>(structure.nodes.size());
  summary.low.setConstant(INFINITY);
  summary.high.setConstant(-INFINITY);
  bool expanded = false;
  for (const auto& [number, node] : structure.nodes) {
    expanded = expanded || node.expanded();
    summary.low = summary.low.cwiseMin(node.position);
    summary.high = summary.high.cwiseMax(node.position);
  }
  const Eigen::Vector3d centre = 0.5 * (summary.low + summary.high);
  for (std::size_t k = 0; k < (expanded ? 3U : 6U); ++k) {
    const Eigen::VectorXd v = rigid_motion(structure, k, centre);
    if (k < 3) summary.mass[static_cast<Eigen::Index>(k)] = v.dot(structure.mass * v);
    if (!v.isZero() && is_free(structure.stiffness, v)) summary.free.emplace_back(names[k]);
  }
  if (!summary.free.empty() || modes == 0) return summary;
  add_modes(structure.mass, damping_matrix(structure, damping).of_unknowns, structure.stiffness, modes, summary);
  return summary;
}

StructureSummary summarise(const std::vector<BridgeParameters>& spans, int modes) {
  assert(modes >= 0);
  const Bridge bridge = beam_bridge(spans, MotionPlane::spatial);
  StructureModel model;
  model.supports.x = bridge.support_x;
  build_matrices(bridge.matrices, static_cast<int>(bridge.dof_x.size()), model);
  StructureSummary summary;
  summary.dofs = model.dofs();
  summary.low.setZero();
  summary.high << bridge.end, 0.0, 0.0;
  summary.mass.setZero();
  for (const BridgeParameters& span : spans) {
    summary.nodes += span.elements + 1;
    summary.mass.array() += span.mass * span.length;
    summary.low = summary.low.cwiseMin(Eigen::Vector3d(0.0, -span.track_offset, span.axis_depth));
    summary.high = summary.high.cwiseMax(Eigen::Vector3d(0.0, -span.track_offset, span.axis_depth));
  }
  add_modes(model.mass, model.damping, model.stiffness, modes, summary);
  return summary;
}

}  // namespace railtab
