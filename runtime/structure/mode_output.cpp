#include "railtab/runtime/structure/mode_output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/motion_names.hpp"
#include "railtab/runtime/base/text_file.hpp"
#include "railtab/runtime/fe/mode_files.hpp"
#include "railtab/runtime/structure/deck_interpolation.hpp"
#include "railtab/runtime/structure/free_motion.hpp"
#include "railtab/runtime/structure/lowest_modes.hpp"
#include "railtab/runtime/structure/stiffness_factor.hpp"

namespace railtab {

namespace {

using Sparse = Eigen::SparseMatrix<double>;

void set_modes(const Sparse& stiffness, const Sparse& mass, const Sparse& damping, int modes, ModalStructure& result,
               ModalBasis& basis) {
  basis = lowest_modes(stiffness, mass, modes);
  result.omega = basis.omega2.cwiseSqrt();
  result.damping = (basis.shape.cwiseProduct(damping * basis.shape)).colwise().sum().transpose();
  result.damping.array() /= 2.0 * result.omega.array();
  Eigen::Index kept = 0;
  while (kept < result.damping.size() && result.damping[kept] <= most_damping_ratio) ++kept;
  if (kept == 0) {
    throw input_error("damping", fmt::format("a damping ratio of {:.3g} of the first mode", result.damping[0]),
                      fmt::format("at most {}, as files of modes hold", most_damping_ratio));
  }
  basis.shape.conservativeResize(Eigen::NoChange, kept);
  basis.omega2.conservativeResize(kept);
  result.omega.conservativeResize(kept);
  result.damping.conservativeResize(kept);
}

/// A motion of a node of the deck, as a sum of rows of the matrices.
struct DeckMotion {
  int node = 0;
  std::size_t motion = 0;
  Eigen::SparseVector<double> rows;
};

void set_shapes(const std::vector<DeckMotion>& motions, const ModalBasis& basis, ModalStructure& result) {
  result.shape.resize(static_cast<Eigen::Index>(motions.size()), basis.shape.cols());
  for (std::size_t r = 0; r < motions.size(); ++r) {
    result.shape.row(static_cast<Eigen::Index>(r)) = motions[r].rows.transpose() * basis.shape;
    result.at.nodes.at(motions[r].node).rows[motions[r].motion] = {static_cast<int>(r)};
  }
}

/// Of the structure itself, where it gives way most.
void set_flexibility(const std::vector<DeckMotion>& motions, const std::vector<int>& deck, const Sparse& stiffness,
                     ModalStructure& result) {
  const int softest = softest_node(result, deck);
  for (const DeckMotion& m : motions) {
    if (m.node != softest || m.motion != z_dof || m.rows.nonZeros() == 0) continue;
    const Eigen::VectorXd load = m.rows;
    result.whole_flexibility[softest] = m.rows.dot(stiffness_factor(stiffness).solve(load));
  }
}

std::string written_number(double value) { return fmt::format("{:.15g}", std::abs(value) < 1e-300 ? 0.0 : value); }

}  // namespace

ModalStructure modes_at_deck(const ImportParameters& parameters, int modes) {
  parameters.validate();
  if (!parameters.deck.given()) {
    throw input_error("structure.deck", "nothing", "the nodes of the deck at which shapes are written");
  }
  const FeStructure structure = read_on_supports(parameters);
  require_held(structure);
  const std::vector<int> deck = selected_nodes(structure, parameters.deck, "structure.deck");
  ModalStructure result;
  ModalBasis basis;
  set_modes(structure.stiffness, structure.mass, damping_matrix(structure, parameters.damping).of_unknowns, modes,
            result, basis);
  std::array<bool, 6> has{};
  for (const int node : deck) {
    for (std::size_t k = 0; k < 6; ++k) has[k] = has[k] || !structure.nodes.at(node).rows[k].empty();
  }
  std::vector<DeckMotion> motions;
  for (const int node : deck) {
    const FeNode& place = structure.nodes.at(node);
    result.at.nodes[node].position = place.position;
    for (std::size_t k = 0; k < 6; ++k) {
      if (!has[k]) continue;
      DeckMotion& motion = motions.emplace_back(DeckMotion{node, k, Eigen::SparseVector<double>(structure.dofs())});
      for (const auto& [row, share] : node_motion(place, k)) {
        if (row >= 0) motion.rows.coeffRef(row) += share;  // the others are those of supports, at rest
      }
    }
  }
  set_shapes(motions, basis, result);
  set_flexibility(motions, deck, structure.stiffness, result);
  return result;
}

ModalStructure modes_at_deck(const std::vector<BridgeParameters>& spans, int modes) {
  const Bridge bridge = beam_bridge(spans, MotionPlane::spatial);
  StructureModel model;
  model.supports.x = bridge.support_x;
  build_matrices(bridge.matrices, static_cast<int>(bridge.dof_x.size()), model);
  ModalStructure result;
  ModalBasis basis;
  set_modes(model.stiffness, model.mass, model.damping, modes, result, basis);
  constexpr double apart = 1e-3, inside = 1e-9;  // [m]: the end of a span no longer belongs to it
  std::vector<DeckMotion> motions;
  std::vector<int> deck;
  for (std::size_t s = 0; s < spans.size(); ++s) {
    for (int i = 0; i <= spans[s].elements; ++i) {
      const bool ends = i == spans[s].elements, last = s + 1 == spans.size();
      const double x = bridge.spans[s][0] + spans[s].length * i / spans[s].elements - (ends && !last ? apart : 0.0);
      const int node = static_cast<int>(deck.size()) + 1;
      deck.push_back(node);
      result.at.nodes[node].position = {x, -spans[s].track_offset, spans[s].axis_depth};
      const double before_end = std::min(x, bridge.spans[s][1] - inside);
      const DeckAttachment at = bridge.attach(before_end, 0.0, spans[s].axis_depth).value();
      for (std::size_t k = 0; k < 6; ++k) {
        DeckMotion& motion = motions.emplace_back(DeckMotion{node, k, Eigen::SparseVector<double>(model.dofs())});
        for (std::size_t j = 0; j < at.dof.size(); ++j) {
          const double value = at.rows(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(j));
          if (at.dof[j] >= 0 && value != 0.0) motion.rows.coeffRef(at.dof[j]) += value;
        }
      }
    }
  }
  set_shapes(motions, basis, result);
  set_flexibility(motions, deck, model.stiffness, result);
  return result;
}

std::string write_modes(const ModalStructure& structure, const std::filesystem::path& prefix) {
  const auto file = [&](const char* ending) { return fmt::format("{}{}", prefix.string(), ending); };
  const auto mark = [](const char* what) { return fmt::format("# {}, by vsi structure: m, N, kg\n", what); };
  std::string modes = mark("natural modes") + "mode,frequency,mass,damping\n";
  for (Eigen::Index m = 0; m < structure.omega.size(); ++m) {
    modes += fmt::format("{},{},1,{}\n", m + 1, written_number(structure.omega[m] / (2.0 * std::numbers::pi)),
                         written_number(structure.damping[m]));
  }
  const FeNode& first = structure.at.nodes.begin()->second;
  std::string shapes = mark("shapes of natural modes") + "mode,node", nodes = mark("nodes"),
              flexibility = mark("static flexibility") + "node,flexibility\n";
  for (std::size_t k = 0; k < 6; ++k) shapes += first.rows[k].empty() ? "" : fmt::format(",{}", shape_columns[k]);
  shapes += '\n';
  for (const auto& [node, place] : structure.at.nodes) {
    nodes += fmt::format("{} {} {} {}\n", node, written_number(place.position[0]), written_number(place.position[1]),
                         written_number(place.position[2]));
    for (Eigen::Index m = 0; m < structure.omega.size(); ++m) {
      shapes += fmt::format("{},{}", m + 1, node);
      for (const std::vector<int>& rows : place.rows) {
        if (!rows.empty()) shapes += fmt::format(",{}", written_number(structure.shape(rows.front(), m)));
      }
      shapes += '\n';
    }
  }
  for (const auto& [node, value] : structure.whole_flexibility) {
    flexibility += fmt::format("{},{}\n", node, written_number(value));
  }
  write_text_file(file(".modes.csv"), modes);
  write_text_file(file(".shapes.csv"), shapes);
  write_text_file(file(".nodes.csv"), nodes);
  write_text_file(file(".flexibility.csv"), flexibility);
  const std::string name = prefix.filename().string();
  const Eigen::AlignedBox3d box = box_around(structure.at);
  const Eigen::Array3d low = box.min().array() + 0.0, high = box.max().array() + 0.0;  // no "-0"
  return fmt::format(
      "[structure]\nformat = \"modes\"\nmode_table = \"{0}.modes.csv\"\nmode_shapes = \"{0}.shapes.csv\"\n"
      "nodes = \"{0}.nodes.csv\"\nstatic_flexibility = \"{0}.flexibility.csv\"\naxes = \"x y z\"\n"
      "deck.from = [{1}, {2}, {3}]\ndeck.to = [{4}, {5}, {6}]\n",
      name, low[0], low[1], low[2], high[0], high[1], high[2]);
}

}  // namespace railtab
