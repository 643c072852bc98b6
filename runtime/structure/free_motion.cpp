#include "railtab/runtime/structure/free_motion.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <map>
#include <random>
#include <set>

#include "railtab/runtime/base/dense_solvers.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/joined_groups.hpp"
#include "railtab/runtime/base/motion_names.hpp"

namespace railtab {

namespace {

using Sparse = Eigen::SparseMatrix<double>;
using Matrix = Eigen::MatrixXd;

/// Rows that stiffness or a common node joins, numbered from 0.
std::vector<int> parts_of(const FeStructure& structure) {
  JoinedGroups groups(static_cast<std::size_t>(structure.dofs()));
  for (int j = 0; j < structure.stiffness.outerSize(); ++j) {
    for (Sparse::InnerIterator entry(structure.stiffness, j); entry; ++entry) {
      if (entry.value() != 0.0) groups.join(static_cast<int>(entry.row()), j);
    }
  }
  std::map<int, int> first_row;
  for (int r = 0; r < structure.dofs(); ++r) {
    const int node = structure.node_of_row[static_cast<std::size_t>(r)];
    if (node != no_node) groups.join(r, first_row.emplace(node, r).first->second);
  }
  std::map<int, int> number;
  std::vector<int> parts;
  for (int r = 0; r < structure.dofs(); ++r) {
    parts.push_back(number.emplace(groups.first(r), static_cast<int>(number.size())).first->second);
  }
  return parts;
}

/// The rigid motions of one part: columns x, y, z and, in units of 1/length, roll, pitch, yaw about its centre.
struct RigidPart {
  Matrix motions;
  Eigen::Vector3d centre;
  double length;
  std::set<int> nodes;
};

RigidPart rigid_part(const FeStructure& structure, const std::vector<int>& parts, int part, bool rotations) {
  RigidPart rigid{Matrix::Zero(structure.dofs(), rotations ? 6 : 3), Eigen::Vector3d::Zero(), 0.0, {}};
  Eigen::Vector3d low = Eigen::Vector3d::Constant(INFINITY), high = -low;
  const auto of_part = [&](Eigen::Index r) {
    const auto row = static_cast<std::size_t>(r);
    return parts[row] == part && structure.node_of_row[row] != no_node;
  };
  for (Eigen::Index r = 0; r < rigid.motions.rows(); ++r) {
    if (!of_part(r)) continue;
    const int node = structure.node_of_row[static_cast<std::size_t>(r)];
    if (!rigid.nodes.insert(node).second) continue;
    low = low.cwiseMin(structure.nodes.at(node).position);
    high = high.cwiseMax(structure.nodes.at(node).position);
  }
  if (rigid.nodes.empty()) return rigid;
  rigid.centre = 0.5 * (low + high);
  rigid.length = std::max(1.0, 0.5 * (high - low).norm());
  for (Eigen::Index r = 0; r < rigid.motions.rows(); ++r) {
    if (!of_part(r)) continue;
    const int motion = structure.motion[static_cast<std::size_t>(r)];
    if (motion < 3) rigid.motions(r, motion) = 1.0;
    if (!rotations) continue;
    if (motion >= 3) rigid.motions(r, motion) = 1.0 / rigid.length;
    if (motion >= 3) continue;
    const Eigen::Vector3d& position = structure.nodes.at(structure.node_of_row[static_cast<std::size_t>(r)]).position;
    for (Eigen::Index k = 0; k < 3; ++k) {
      rigid.motions(r, 3 + k) = Eigen::Vector3d::Unit(k).cross(position - rigid.centre)[motion] / rigid.length;
    }
  }
  return rigid;
}

/// Nothing resists a motion whose energy is rounding of what its parts have: vᵀKv against |v|ᵀ|K||v|. One held motion
/// of one node in a mesh of a million leaves more than that.
bool is_free(const Sparse& stiffness, const Eigen::VectorXd& v) {
  constexpr double rounding = 1e-12;
  const double energy = v.dot(stiffness * v);
  const double parts = v.cwiseAbs().dot(stiffness.cwiseAbs() * v.cwiseAbs());
  return energy < rounding * parts;
}

/// Combinations of the rigid motions, as columns, that strain nothing.
Matrix free_combinations(const Sparse& stiffness, const Matrix& motions) {
  // motions that the part does not have, or not apart from each other, are no motions: those with length only
  const SymmetricSpectrum gram = symmetric_spectrum(motions.transpose() * motions);
  constexpr double least = 1e-10;
  Matrix basis(motions.cols(), 0);
  for (Eigen::Index k = 0; k < motions.cols(); ++k) {
    if (gram.values[k] <= least * gram.values.tail(1)[0]) continue;
    basis.conservativeResize(Eigen::NoChange, basis.cols() + 1);
    basis.rightCols(1) = gram.vectors.col(k) / std::sqrt(gram.values[k]);
  }
  const Matrix shapes = motions * basis;
  const SymmetricSpectrum energy = symmetric_spectrum(shapes.transpose() * (stiffness * shapes));
  Matrix found(motions.cols(), 0);
  for (Eigen::Index k = 0; k < basis.cols(); ++k) {
    const Eigen::VectorXd combination = basis * energy.vectors.col(k);
    if (!is_free(stiffness, motions * combination)) break;  // the others strain more
    found.conservativeResize(Eigen::NoChange, found.cols() + 1);
    found.rightCols(1) = combination;
  }
  return found;
}

/// "through y = 0 m, z = 1.9 m" of an axis along axis `k`.
std::string axis_text(Eigen::Index k, const Eigen::Vector3d& point) {
  std::string text;
  for (Eigen::Index i = 0; i < 3; ++i) {
    if (i == k) continue;
    const double place = std::abs(point[i]) < 5e-4 ? 0.0 : point[i];  // [m]
    text += fmt::format("{} {} = {:.4g} m", text.empty() ? " through" : ",", motion_names[static_cast<std::size_t>(i)],
                        place);
  }
  return text;
}

/// What the free combinations are in terms of railtab's axes.
std::vector<FreeMotion> in_words(const Matrix& free, const RigidPart& rigid, const std::string& of_part) {
  constexpr double tolerance = 1e-6;
  std::vector<FreeMotion> result;
  if (free.cols() == 0) return result;
  for (Eigen::Index k = 0; k < 3; ++k) {
    const Eigen::VectorXd unit = Eigen::VectorXd::Unit(free.rows(), k);
    if ((free * least_squares_solution(free, unit) - unit).norm() > tolerance) continue;
    const std::string name(motion_names[static_cast<std::size_t>(k)]);
    result.push_back({fmt::format("moves along {}{}", name, of_part), name + " of a support"});
  }
  constexpr std::array<const char*, 3> held_by{"roll of a support, or its z at nodes beside each other",
                                               "z of a support at another x", "y of a support at another x"};
  for (Eigen::Index k = 0; free.rows() == 6 && k < 3; ++k) {
    const Matrix turning = free.bottomRows(3);
    const Eigen::Vector3d axis = Eigen::Vector3d::Unit(k);
    const Eigen::VectorXd wanted = axis;
    const Eigen::VectorXd share = least_squares_solution(turning, wanted);
    if ((turning * share - wanted).norm() > tolerance) continue;
    const Eigen::Vector3d shift = rigid.length * (free.topRows(3) * share);
    const auto i = static_cast<std::size_t>(k);
    result.push_back({fmt::format("turns about {} ({}){}{}", motion_names[i], motion_names[i + 3],
                                  axis_text(k, rigid.centre + axis.cross(shift)), of_part),
                      held_by[i]});
  }
  if (static_cast<Eigen::Index>(result.size()) < free.cols()) {
    result.push_back({"turns about an axis askew" + of_part, "x, y or z of a support away from that axis"});
  }
  return result;
}

}  // namespace

std::vector<FreeMotion> free_motions(const FeStructure& structure) {
  const bool expanded = std::any_of(structure.nodes.begin(), structure.nodes.end(),
                                    [](const auto& node) { return node.second.expanded(); });
  const std::vector<int> parts = parts_of(structure);
  const int count = parts.empty() ? 0 : *std::max_element(parts.begin(), parts.end()) + 1;
  constexpr int most = 20;  // parts to speak of: a mesh whose nodes are not joined at all has thousands
  std::vector<FreeMotion> found;
  for (int part = 0; part < std::min(count, most); ++part) {
    const RigidPart rigid = rigid_part(structure, parts, part, !expanded);
    if (rigid.nodes.empty()) continue;
    const std::string of_part =
        count == 1 ? "" : fmt::format(" (the part with node {}, {} nodes)", *rigid.nodes.begin(), rigid.nodes.size());
    const Matrix free = free_combinations(structure.stiffness, rigid.motions);
    for (FreeMotion& motion : in_words(free, rigid, of_part)) found.push_back(std::move(motion));
  }
  if (!found.empty() || !expanded) return found;
  if (const auto v = motion_without_stiffness(structure.stiffness)) {
    Eigen::Index row = 0;
    v->cwiseAbs().maxCoeff(&row);
    const auto r = static_cast<std::size_t>(row);
    const std::string_view name = motion_names[static_cast<std::size_t>(structure.motion[r])];
    found.push_back({fmt::format("moves or turns (most at node {} along {})", structure.node_of_row[r], name),
                     fmt::format("a constraint of {} there, or of a rotation", name)});
  }
  return found;
}

std::optional<Eigen::VectorXd> motion_without_stiffness(const Sparse& stiffness) {
  constexpr double shift = 1e-13;  // beside rounding, and far below the softest deformation
  const Eigen::VectorXd diagonal = stiffness.diagonal().cwiseAbs();
  const Eigen::VectorXd weight = (diagonal.array() > 0.0).select(diagonal, std::max(1.0, diagonal.maxCoeff()));
  Sparse shifted(stiffness.rows(), stiffness.cols());
  shifted.setIdentity();
  shifted = stiffness + Sparse(shift * weight.asDiagonal() * shifted);
  const Eigen::SimplicialLDLT<Sparse> factor(shifted);  // by rounding, pivots may be negative
  std::mt19937_64 generator(1);
  Eigen::VectorXd v(diagonal.size());
  for (double& value : v) value = std::uniform_real_distribution<double>(-1.0, 1.0)(generator);
  constexpr int iterations = 4;
  for (int i = 0; i < iterations; ++i) {
    const Eigen::VectorXd load = weight.cwiseProduct(v);
    v = factor.solve(load);
    v /= v.cwiseAbs().maxCoeff();
  }
  constexpr double rounding = 1e-12;
  if (v.dot(stiffness * v) > rounding * v.dot(weight.cwiseProduct(v))) return std::nullopt;
  return v;
}

void require_held(const FeStructure& structure) {
  std::vector<std::string> motions;
  std::set<std::string> holds;
  for (const FreeMotion& motion : free_motions(structure)) {
    motions.push_back(motion.text);
    holds.insert(motion.held_by);
  }
  if (motions.empty()) return;
  throw input_error(structure.source, fmt::format("a structure that {} without resistance", fmt::join(motions, "; ")),
                    fmt::format("supports against that ({}): constraints in the model, or [[support]] with such holds",
                                fmt::join(holds, "; ")));
}

}  // namespace railtab
