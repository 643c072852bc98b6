#include "railtab/runtime/structure/structure_summary.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "railtab/runtime/base/dense_solvers.hpp"
#include "railtab/runtime/structure/bridge.hpp"
#include "railtab/runtime/structure/free_motion.hpp"
#include "railtab/runtime/structure/lowest_modes.hpp"

namespace railtab {

namespace {

/// Translation `k` (x, y, z) of every row.
Eigen::VectorXd translation(const FeStructure& structure, int k) {
  Eigen::VectorXd motion = Eigen::VectorXd::Zero(structure.dofs());
  for (Eigen::Index r = 0; r < motion.size(); ++r) {
    const auto row = static_cast<std::size_t>(r);
    if (structure.node_of_row[row] != no_node && structure.motion[row] == k) motion[r] = 1.0;
  }
  return motion;
}

/// Turns modes of equal frequencies, whose directions are arbitrary, to those in which damping does not couple them.
void turn_equal_modes(const Eigen::SparseMatrix<double>& damping, ModalBasis& basis) {
  constexpr double alike = 2e-6;  // of ω²: 1e-6 of the frequency
  const Eigen::Index modes = basis.omega2.size();
  for (Eigen::Index begin = 0, end = 0; begin < modes; begin = end) {
    for (end = begin + 1; end < modes && basis.omega2[end] <= (1.0 + alike) * basis.omega2[end - 1];) ++end;
    if (end - begin == 1) continue;
    const Eigen::MatrixXd shapes = basis.shape.middleCols(begin, end - begin);
    basis.shape.middleCols(begin, end - begin) =
        shapes * symmetric_spectrum(shapes.transpose() * (damping * shapes)).vectors;
  }
}

void add_modes(const Eigen::SparseMatrix<double>& mass, const Eigen::SparseMatrix<double>& damping,
               const Eigen::SparseMatrix<double>& stiffness, int count, StructureSummary& summary) {
  if (count == 0) return;
  ModalBasis found = lowest_modes(stiffness, mass, count);
  turn_equal_modes(damping, found);
  for (Eigen::Index k = 0; k < found.omega2.size(); ++k) {
    const Eigen::VectorXd shape = found.shape.col(k);
    const double omega = std::sqrt(found.omega2[k]);
    summary.frequencies.push_back(omega / (2.0 * std::numbers::pi));
    summary.damping_ratios.push_back(shape.dot(damping * shape) / (2.0 * omega));
  }
}

void set_corners(const FeStructure& structure, StructureSummary& summary) {
  const Eigen::AlignedBox3d box = box_around(structure);
  summary.low = box.min();
  summary.high = box.max();
}

}  // namespace

StructureSummary summarise(const FeStructure& structure, const FeDamping& damping, int modes) {
  assert(modes >= 0);
  StructureSummary summary;
  summary.dofs = structure.dofs();
  summary.nodes = static_cast<long>(structure.nodes.size());
  set_corners(structure, summary);
  for (int k = 0; k < 3; ++k) {
    const Eigen::VectorXd v = translation(structure, k);
    summary.mass[k] = v.dot(structure.mass * v);
  }
  for (const FreeMotion& motion : free_motions(structure)) summary.free.push_back(motion.text);
  if (!summary.free.empty() || modes == 0) return summary;
  add_modes(structure.mass, damping_matrix(structure, damping).of_unknowns, structure.stiffness, modes, summary);
  return summary;
}

StructureSummary summarise(const ModalStructure& structure, int modes) {
  assert(modes >= 0);
  StructureSummary summary;
  summary.dofs = structure.omega.size();
  summary.nodes = static_cast<long>(structure.at.nodes.size());
  set_corners(structure.at, summary);
  summary.mass.setConstant(NAN);
  for (Eigen::Index m = 0; m < std::min<Eigen::Index>(modes, structure.omega.size()); ++m) {
    summary.frequencies.push_back(structure.omega[m] / (2.0 * std::numbers::pi));
    summary.damping_ratios.push_back(structure.damping[m]);
  }
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
