#include "railtab/runtime/structure/modal_bridge.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "railtab/runtime/base/dense_solvers.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/motion_names.hpp"
#include "railtab/runtime/fe/mode_files.hpp"
#include "railtab/runtime/structure/bridge_damping.hpp"
#include "railtab/runtime/structure/deck_attachment.hpp"
#include "railtab/runtime/structure/deck_interpolation.hpp"
#include "railtab/runtime/structure/deck_nodes.hpp"

namespace railtab {

namespace {

/// One damping ratio for all modes, where their table has none.
std::optional<double> common_damping(const FeDamping& damping) {
  if (damping.ratio) return damping.ratio;
  if (damping.type.empty()) return std::nullopt;
  return damping_lower_bound("structure.damping_type", damping.type, damping.span);
}

Eigen::VectorXd damping_ratios(const std::vector<FeMode>& modes, const ImportParameters& parameters) {
  const std::optional<double> common = common_damping(parameters.damping);
  const bool in_table = modes.front().damping >= 0.0;
  if (in_table == common.has_value()) {
    throw input_error("structure", in_table ? "damping in the mode table and by another key" : "modes without damping",
                      fmt::format("a column damping in {}, or structure.damping_ratio, or structure.damping_type with "
                                  "structure.damping_span",
                                  parameters.files.modes.string()));
  }
  Eigen::VectorXd ratios(static_cast<Eigen::Index>(modes.size()));
  for (std::size_t m = 0; m < modes.size(); ++m) {
    ratios[static_cast<Eigen::Index>(m)] = common.value_or(modes[m].damping);
  }
  return ratios;
}

/// Rows in railtab's axes: with u = φ q in the model's length, q in it too, q in m leaves the φ of translations as they
/// are and divides those of rotations by the unit of length.
void add_shapes(const FeShapes& shapes, const FrameConversion& conversion, const std::string& file,
                ModalStructure& structure) {
  structure.shape.resize(static_cast<Eigen::Index>(shapes.rows.size()), structure.omega.size());
  for (std::size_t r = 0; r < shapes.rows.size(); ++r) {
    const FeRow& row = shapes.rows[r];
    const auto node = structure.at.nodes.find(row.node);
    if (node == structure.at.nodes.end()) {
      throw input_error(file, fmt::format("node {}", row.node), "a node of structure.nodes");
    }
    const FrameConversion::Row own = conversion.row(row.motion);
    const double translation = std::abs(conversion.row(0).to_model);
    structure.shape.row(static_cast<Eigen::Index>(r)) =
        translation / own.to_model * Eigen::RowVectorXd::Map(shapes.values[r].data(), structure.omega.size());
    node->second.rows[static_cast<std::size_t>(own.motion)].push_back(static_cast<int>(r));
    structure.at.motion.push_back(own.motion);
    structure.at.node_of_row.push_back(row.node);
  }
}

std::vector<int> deck_of(const ModalStructure& structure, const ImportParameters& parameters) {
  const std::vector<int> deck = selected_nodes(structure.at, parameters.deck, "structure.deck");
  bool moves = false;
  for (const int number : deck) {
    const std::vector<int>& rows = structure.at.nodes.at(number).rows[z_dof];
    if (rows.empty()) {
      throw input_error(fmt::format("structure.deck: node {}", number), "no vertical shape of the modes there",
                        fmt::format("a node of {} with its vertical motion", parameters.files.shapes.string()));
    }
    moves = moves || structure.shape.row(rows.front()).norm() > 0.0;
  }
  if (!moves) {
    throw input_error("structure.deck", "no mode that moves the deck vertically",
                      "modes with vertical motion: see structure.axes");
  }
  return deck;
}

StaticFlexibility flexibility_at(const ModalStructure& structure, int node) {
  const FeNode& place = structure.at.nodes.at(node);
  const Eigen::ArrayXd share =
      structure.shape.row(place.rows[z_dof].front()).transpose().array().square() / structure.omega.array().square();
  StaticFlexibility result{node, place.position[0], share.sum(), share[share.size() - 1], {}};
  const auto whole = structure.whole_flexibility.find(node);
  if (whole != structure.whole_flexibility.end()) result.whole = whole->second;
  return result;
}

/// Rows of a basis of the modal coordinates that are motions of nodes, one by one.
class MotionBasis {
 public:
  explicit MotionBasis(Eigen::Index modes) : rows_(modes, modes), spanned_(modes, modes) {}
  /// @param motion by the modal coordinates @return its number; held where the rows before span it
  int add(const Eigen::VectorXd& motion) {
    constexpr double distinct = 1e-3;  // of a motion that the rows before it do not span
    Eigen::VectorXd rest = motion;
    for (int twice = 0; twice < 2; ++twice) {
      rest -= spanned_.leftCols(count_) * (spanned_.leftCols(count_).transpose() * rest);
    }
    if (count_ == rows_.cols() || !(rest.norm() > distinct * motion.norm())) return held;
    rows_.row(count_) = motion;
    spanned_.col(count_) = rest.normalized();
    return static_cast<int>(count_++);
  }
  [[nodiscard]] Eigen::MatrixXd rows() const { return rows_.topRows(count_); }

 private:
  Eigen::MatrixXd rows_, spanned_;  // spanned: orthonormal columns
  Eigen::Index count_ = 0;
};

/// What supports have in programs' lists, zero or rounding.
bool at_rest(const ModalStructure& structure, const Eigen::VectorXd& motion) {
  constexpr double rounding = 1e-9;
  return motion.norm() <= rounding * structure.shape.rowwise().norm().maxCoeff();
}

/// Index of the first that is this node: two positions may have the same one.
std::size_t first_of(const std::vector<ReportedDeckNode>& reported, int node) {
  const auto same = std::find_if(reported.begin(), reported.end(),
                                 [node](const ReportedDeckNode& other) { return other.number == node; });
  return static_cast<std::size_t>(same - reported.begin());
}

/// Vertical motions of the reported nodes, which must be degrees of freedom.
void add_vertical_motions(const ModalStructure& structure, const std::vector<ReportedDeckNode>& reported,
                          MotionBasis& basis, std::vector<StructureNode>& nodes) {
  for (const ReportedDeckNode& node : reported) {
    const FeNode& place = structure.at.nodes.at(node.number);
    StructureNode own{
        node.name, place.position[0], {held, held, held, held, held, held}, place.position[1], place.position[2]};
    const std::size_t first = first_of(reported, node.number);
    const Eigen::VectorXd motion = structure.shape.row(place.rows[z_dof].front());
    const bool rests = at_rest(structure, motion);
    if (first < nodes.size()) {
      own.dof[z_dof] = nodes[first].dof[z_dof];
    } else if (!rests) {
      own.dof[z_dof] = basis.add(motion);
    }
    if (own.dof[z_dof] == held && !rests) {
      throw input_error("structure.report", fmt::format("{} positions with {} modes", reported.size(), motion.size()),
                        fmt::format("fewer positions: {} modes cannot tell the motion at x = {:.6g} m from that at the "
                                    "positions before it",
                                    motion.size(), place.position[0]));
    }
    nodes.push_back(std::move(own));
  }
}

/// The other motions of the reported nodes, as far as the modes tell them from those before.
void add_other_motions(const ModalStructure& structure, const std::vector<ReportedDeckNode>& reported,
                       MotionBasis& basis, Bridge& bridge) {
  for (std::size_t n = 0; n < bridge.nodes.size(); ++n) {
    const FeNode& place = structure.at.nodes.at(reported[n].number);
    const std::size_t first = first_of(reported, reported[n].number);
    if (first < n) {
      bridge.nodes[n].dof = bridge.nodes[first].dof;
      continue;
    }
    std::vector<std::string_view> lost;
    for (std::size_t k = 0; k < 6; ++k) {
      if (k == z_dof || place.rows[k].empty()) continue;
      const Eigen::VectorXd motion = structure.shape.row(place.rows[k].front());
      if (at_rest(structure, motion)) continue;
      bridge.nodes[n].dof[k] = basis.add(motion);
      if (bridge.nodes[n].dof[k] == held) lost.push_back(motion_names[k]);
    }
    if (lost.empty()) continue;
    bridge.left_out.push_back(
        fmt::format("{} of {} in the records, which have 0: the modes are too few to tell it from other motions",
                    fmt::join(lost, ", "), bridge.nodes[n].name));
  }
}

/// S of q = S p, whose first coordinates p are `motions`·q and whose others are orthogonal to them.
Eigen::MatrixXd change_of_basis(const Eigen::MatrixXd& motions) {
  const Eigen::Index modes = motions.cols(), count = motions.rows();
  if (count == 0) return Eigen::MatrixXd::Identity(modes, modes);
  Eigen::MatrixXd T(modes, modes);
  T << motions, orthogonal_complement(motions.transpose()).transpose();
  return dense_inverse(T);
}

void append(const Eigen::MatrixXd& matrix, std::vector<Eigen::Triplet<double>>& entries) {
  const Eigen::MatrixXd symmetric = 0.5 * (matrix + matrix.transpose());
  for (int j = 0; j < symmetric.cols(); ++j) {
    for (int i = 0; i < symmetric.rows(); ++i) entries.emplace_back(i, j, symmetric(i, j));
  }
}

/// The attachment by the degrees of freedom p, from that by rows of the shapes.
DeckAttachment by_modes(const DeckAttachment& by_rows, const Eigen::MatrixXd& shape_of_p) {
  DeckAttachment deck;
  deck.arm = by_rows.arm;
  deck.rows = Eigen::MatrixXd::Zero(6, shape_of_p.cols());
  for (std::size_t k = 0; k < by_rows.dof.size(); ++k) {
    deck.rows += by_rows.rows.col(static_cast<Eigen::Index>(k)) * shape_of_p.row(by_rows.dof[k]);
  }
  for (int m = 0; m < shape_of_p.cols(); ++m) deck.dof.push_back(m);
  return deck;
}

}  // namespace

ModalStructure read_modal_structure(const ImportParameters& parameters) {
  const FrameConversion conversion(parameters.frame, "structure");
  const FeFiles& files = parameters.files;
  const std::vector<FeMode> modes = read_mode_table(files.modes);
  ModalStructure structure;
  structure.at.mesh = read_fe_mesh(files.nodes);
  structure.at.source = files.modes.string();
  for (const auto& [number, position] : structure.at.mesh.nodes) {
    structure.at.nodes[number].position = conversion.position(position);
  }
  structure.omega.resize(static_cast<Eigen::Index>(modes.size()));
  for (std::size_t m = 0; m < modes.size(); ++m) {
    structure.omega[static_cast<Eigen::Index>(m)] = 2.0 * std::numbers::pi * modes[m].frequency;
  }
  structure.damping = damping_ratios(modes, parameters);
  add_shapes(read_mode_shapes(files.shapes, modes), conversion, files.shapes.string(), structure);
  const double to_stiffness = std::pow(conversion.row(0).to_model, 2);  // N/m per unit of the model
  for (std::size_t m = 0; m < modes.size(); ++m) {
    structure.shape.col(static_cast<Eigen::Index>(m)) /= std::sqrt(to_stiffness * modes[m].mass);
  }
  if (files.flexibility.empty()) return structure;
  for (const auto& [node, value] : read_flexibility(files.flexibility)) {
    const auto known = structure.at.nodes.find(node);
    if (known == structure.at.nodes.end() || known->second.rows[z_dof].empty()) {
      throw input_error(files.flexibility.string(), fmt::format("node {}", node),
                        "a node of structure.mode_shapes with its vertical motion");
    }
    structure.whole_flexibility[node] = value / to_stiffness;
  }
  return structure;
}

int softest_node(const ModalStructure& structure, const std::vector<int>& deck) {
  constexpr double near_centre = 0.5;  // [m] beyond the node next to it
  double least = INFINITY;
  for (const int node : deck) least = std::min(least, std::abs(structure.at.nodes.at(node).position[1]));
  int softest = no_node;
  double most = -1.0;
  for (const int node : deck) {
    if (std::abs(structure.at.nodes.at(node).position[1]) > least + near_centre) continue;
    const double flexibility = flexibility_at(structure, node).by_modes;
    if (flexibility > most) {
      most = flexibility;
      softest = node;
    }
  }
  return softest;
}

std::vector<StaticFlexibility> static_flexibility(const ModalStructure& structure, const ImportParameters& parameters) {
  std::vector<StaticFlexibility> result;
  for (const auto& [node, whole] : structure.whole_flexibility) result.push_back(flexibility_at(structure, node));
  if (result.empty()) {
    result.push_back(flexibility_at(structure, softest_node(structure, deck_of(structure, parameters))));
  }
  constexpr double rounding = 0.05;
  for (const StaticFlexibility& at : result) {
    if (at.lost() >= -rounding) continue;
    throw input_error(
        fmt::format("{}: node {}", parameters.files.flexibility.string(), at.node),
        fmt::format("{:.4g} m/N, and {:.4g} m/N by the modes alone", *at.whole, at.by_modes),
        "a structure that gives way at least as much as its modes: shapes, modal masses and structure.units do not "
        "belong together");
  }
  return result;
}

std::vector<std::string> lost_by_modes(const ModalStructure& structure, const ImportParameters& parameters) {
  std::vector<std::string> sentences;
  for (const StaticFlexibility& at : static_flexibility(structure, parameters)) {
    sentences.push_back(
        at.whole ? fmt::format("static flexibility beyond the modes: {:.2f} % at x = {:.6g} m, where the structure has "
                               "{:.4g} m/N along z and its {} modes {:.4g} m/N",
                               100.0 * at.lost(), at.x, *at.whole, structure.omega.size(), at.by_modes)
                 : fmt::format("static flexibility beyond the modes: how much is not known without "
                               "structure.static_flexibility; the {} modes have {:.4g} m/N along z at x = {:.6g} m, of "
                               "which the highest adds {:.2g} %",
                               structure.omega.size(), at.by_modes, at.x, 100.0 * at.by_last_mode / at.by_modes));
  }
  sentences.emplace_back("a check that the modes are orthogonal: without the mass matrix they are taken to be");
  return sentences;
}

/// Where modes leave so much of the static flexibility out that accelerations come out too small.
std::vector<std::string> missing_flexibility(const ModalStructure& structure, const ImportParameters& parameters) {
  constexpr double much = 0.05, nearly_all = 0.9;
  std::vector<std::string> sentences;
  for (const StaticFlexibility& at : static_flexibility(structure, parameters)) {
    if (!at.whole || at.lost() <= much) continue;
    sentences.push_back(fmt::format(
        "structure.mode_table: the {} modes, up to {:.4g} Hz, lack {:.1f} % of the static flexibility at x = {:.6g} m: "
        "{}",
        structure.omega.size(), structure.omega.maxCoeff() / (2.0 * std::numbers::pi), 100.0 * at.lost(), at.x,
        at.lost() > nearly_all ? "is structure.static_flexibility in the units of the modes?"
                               : "deflections, and accelerations above the highest mode, come out too small; export "
                                 "more modes"));
  }
  return sentences;
}

Bridge modal_bridge(const ImportParameters& parameters, DeckRecord record) {
  const ModalStructure structure = read_modal_structure(parameters);
  const std::vector<int> deck = deck_of(structure, parameters);
  Bridge bridge;
  DeckFunction at_rows = deck_function(structure.at, deck);
  const DeckExtent extent = plausible_deck_extent(structure.at, deck);
  bridge.end = extent.end;
  constexpr double rounding = 1e-6;  // [m]: the last nodes belong to the bridge
  bridge.spans.push_back({extent.begin - rounding, extent.end + rounding});
  bridge.left_out = lost_by_modes(structure, parameters);
  const std::vector<ReportedDeckNode> reported = reported_deck_nodes(structure.at, deck, parameters.report);
  MotionBasis basis(structure.omega.size());
  add_vertical_motions(structure, reported, basis, bridge.nodes);
  add_other_motions(structure, reported, basis, bridge);
  const Eigen::MatrixXd S = change_of_basis(basis.rows());
  const Eigen::ArrayXd omega = structure.omega;
  const Eigen::VectorXd c = 2.0 * structure.damping.array() * omega, k = omega.square();
  append(S.transpose() * S, bridge.matrices.mass);
  append(S.transpose() * c.asDiagonal() * S, bridge.matrices.damping);
  append(S.transpose() * k.asDiagonal() * S, bridge.matrices.stiffness);
  // every mode meets all sleepers on the bridge: last in the order of elimination, it fills the factor least
  bridge.dof_x.assign(static_cast<std::size_t>(structure.omega.size()), extent.end);
  if (record == DeckRecord::everywhere) {
    bridge.deck_ends = {{extent.begin, extent.end}};
    const auto by_shapes = [shape = Eigen::MatrixXd(structure.shape * S)](const DofSum& rows) {
      Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(shape.cols());
      for (const auto& [row, value] : rows) sum += value * shape.row(row);
      DofSum modes;
      for (int m = 0; m < sum.size(); ++m) modes.emplace_back(m, sum[m]);
      return modes;
    };
    if (is_surface(structure.at, deck)) {
      bridge.surface = [motion = surface_motion(structure.at, deck), by_shapes](double x, double y) {
        std::optional<DofSum> found = motion(x, y);
        if (found) found = by_shapes(*found);
        return found;
      };
    }
    for (const int number : deck) {
      const FeNode& node = structure.at.nodes.at(number);
      bridge.deck.push_back({{DeckQuantity::displacement, node.position[0], node.position[1]},
                             by_shapes({{node.rows[z_dof].front(), 1.0}})});
    }
  }
  bridge.attach = [at_rows = std::move(at_rows), shape = Eigen::MatrixXd(structure.shape * S)](
                      double x, double y, double z) -> std::optional<DeckAttachment> {
    const std::optional<DeckAttachment> found = at_rows(x, y, z);
    if (!found) return std::nullopt;
    return by_modes(*found, shape);
  };
  bridge.warnings = plausibility_warnings(0.0, omega[0] / (2.0 * std::numbers::pi));
  for (std::string& sentence : missing_flexibility(structure, parameters))
    bridge.warnings.push_back(std::move(sentence));
  for (std::string& sentence : deck_place_warnings(extent)) bridge.warnings.push_back(std::move(sentence));
  return bridge;
}

}  // namespace railtab
