#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/motion_names.hpp"
#include "railtab/runtime/moving_load/deck_modes.hpp"
#include "railtab/runtime/structure/deck_attachment.hpp"
#include "railtab/runtime/structure/deck_interpolation.hpp"
#include "railtab/runtime/structure/deck_nodes.hpp"
#include "railtab/runtime/structure/free_motion.hpp"
#include "railtab/runtime/structure/lowest_modes.hpp"
#include "railtab/runtime/structure/modal_bridge.hpp"

namespace railtab {
namespace {

/// Vertical motion at x on the track's centre line, at the height of the deck's nodes; supports (-1) have no part.
DofSum on_centre_line(const DeckFunction& deck, double x) {
  const std::optional<DeckAttachment> found = deck(x, 0.0, 0.0);
  if (!found) {
    throw input_error("structure.deck", fmt::format("no deck at x = {:.6g} m on the track's centre line", x),
                      "nodes of the deck under the whole line");
  }
  const Eigen::RowVectorXd row =
      found->rows.row(2) + found->arm.y() * found->rows.row(3) - found->arm.x() * found->rows.row(4);
  DofSum motion;
  for (std::size_t k = 0; k < found->dof.size(); ++k) {
    motion.emplace_back(found->dof[k], row[static_cast<Eigen::Index>(k)]);
  }
  return motion;
}

/// A sum of rows in all modes, supports at rest.
Eigen::RowVectorXd of_modes(const DofSum& sum, const ModalBasis& basis) {
  Eigen::RowVectorXd motion = Eigen::RowVectorXd::Zero(basis.shape.cols());
  for (const auto& [row, share] : sum) {
    if (row >= 0) motion += share * basis.shape.row(row);
  }
  return motion;
}

/// The same of the vertical motion of the deck's nodes: nodes × modes.
Eigen::MatrixXd of_nodes(const FeStructure& structure, const std::vector<int>& deck, const ModalBasis& basis) {
  Eigen::MatrixXd motion(static_cast<Eigen::Index>(deck.size()), basis.shape.cols());
  for (std::size_t k = 0; k < deck.size(); ++k) {
    motion.row(static_cast<Eigen::Index>(k)) = of_modes(node_motion(structure.nodes.at(deck[k]), z_dof), basis);
  }
  return motion;
}

/// Vertical motion of the modes, mean over the width of the deck at places along it: places × modes. Twist about the
/// middle has none, wherever the track lies.
Eigen::MatrixXd mean_over_width(const FeStructure& structure, const std::vector<int>& deck, const ModalBasis& basis) {
  if (!is_surface(structure, deck)) return of_nodes(structure, deck, basis);
  constexpr int along = 49, across = 9;
  const DeckOutline outline = deck_outline(structure, deck);
  const auto [low, high] = outline.sides();
  const SurfaceMotion surface = surface_motion(structure, deck);
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(along, basis.shape.cols());
  for (int i = 0; i < along; ++i) {
    int found = 0;
    for (int j = 0; j < across; ++j) {
      const double y = low + (high - low) * (j + 0.5) / across;
      const DeckExtent extent = outline.at(y);
      const auto at = surface(extent.begin + (extent.end - extent.begin) * (i + 0.5) / along, y);
      if (!at) continue;
      result.row(i) += of_modes(*at, basis);
      ++found;
    }
    if (found > 0) result.row(i) /= found;
  }
  return result;
}

/// The largest mean_over_width() of each mode over its largest displacement anywhere, that of rotations at half the
/// width of the track.
Eigen::ArrayXd bending_share(const FeStructure& structure, const std::vector<int>& deck, const ModalBasis& basis) {
  const Eigen::ArrayXd largest = mean_over_width(structure, deck, basis).array().abs().colwise().maxCoeff().transpose();
  Eigen::ArrayXd anywhere = largest;
  for (Eigen::Index row = 0; row < basis.shape.rows(); ++row) {
    constexpr double half_track = 0.75;  // [m]: what a rotation counts as
    const double arm = structure.motion[static_cast<std::size_t>(row)] <= z_dof ? 1.0 : half_track;
    anywhere = anywhere.max(arm * basis.shape.row(row).array().abs().transpose());
  }
  return (anywhere > 0.0).select(largest / anywhere, 0.0);
}

struct DeckBasis {
  ModalBasis modes;
  bool complete = false;  ///< all that the structure has
};

/// Modes up to the cut-off, which needs the third bending mode, and some beyond it.
DeckBasis enough_modes(const FeStructure& structure, const std::vector<int>& deck, const DynamicModes& wanted) {
  constexpr int first_try = 20, most = 320;
  for (int count = std::max(first_try, 2 * wanted.count);; count *= 2) {
    const int asked = std::min(count, most);
    ModalBasis basis = lowest_modes(structure.stiffness, structure.mass, asked);
    const auto found = static_cast<int>(basis.omega2.size());
    const bool complete = found < asked || found == structure.dofs();
    if (complete || asked == most) return {std::move(basis), complete};
    const BendingModes bending = bending_modes(bending_share(structure, deck, basis));
    if (wanted.count == 0 && bending.found < 3) continue;
    const int dynamic = count_dynamic_modes(basis.omega2.array().sqrt(), bending, wanted);
    if (2 * dynamic <= found) return {std::move(basis), complete};
  }
}

/// Appends what the modes lack of the static deflection under the axles.
void append_residual_shapes(const FeStructure& structure, const DeckFunction& line, const DeckExtent& extent,
                            ModalBasis& basis) {
  constexpr int intervals = 48;
  constexpr double inside = 2e-6;  // [m]
  Eigen::MatrixXd forces = Eigen::MatrixXd::Zero(structure.dofs(), intervals + 1);
  for (int i = 0; i <= intervals; ++i) {
    const double x = extent.begin + (extent.end - extent.begin) * i / intervals;
    for (const auto& [row, share] : on_centre_line(line, std::clamp(x, extent.begin + inside, extent.end - inside))) {
      if (row >= 0) forces(row, i) += share;
    }
  }
  const Eigen::MatrixXd shapes = residual_shapes(structure.stiffness, basis, forces);
  const Eigen::Index modes = basis.omega2.size();
  basis.shape.conservativeResize(Eigen::NoChange, modes + shapes.cols());
  basis.shape.rightCols(shapes.cols()) = shapes;
  basis.omega2.conservativeResize(modes + shapes.cols());
  basis.omega2.tail(shapes.cols()).setConstant(basis.omega2[modes - 1]);
}

/// The cubic through the values at 0, h/3, 2h/3 and h.
ModalDeck::Cubics through(const std::array<Eigen::ArrayXd, 4>& f, double h) {
  ModalDeck::Cubics c(f[0].size(), 4);
  c << f[0], (-5.5 * f[0] + 9.0 * f[1] - 4.5 * f[2] + f[3]) / h,
      (9.0 * f[0] - 22.5 * f[1] + 18.0 * f[2] - 4.5 * f[3]) / (h * h),
      4.5 * (-f[0] + 3.0 * f[1] - 3.0 * f[2] + f[3]) / (h * h * h);
  return c;
}

void set_line(const DeckFunction& deck, const ModalBasis& basis, double length, ModalDeck& result) {
  constexpr double longest_element = 0.5, inside = 2e-6;  // [m]: the deck ends before its last node
  const int elements = std::clamp(static_cast<int>(std::ceil(length / longest_element)), 48, 400);
  const double h = length / elements;
  for (int e = 0; e < elements; ++e) {
    std::array<Eigen::ArrayXd, 4> values;
    for (int k = 0; k < 4; ++k) {
      const double u = std::clamp(h * k / 3.0, inside, h - inside);
      values[static_cast<std::size_t>(k)] = of_modes(on_centre_line(deck, result.start + h * e + u), basis).transpose();
    }
    result.knots.push_back(h * e);
    result.shape.push_back(through(values, h));
  }
  result.knots.push_back(length);
}

}  // namespace

ModalDeck imported_deck(const ImportParameters& parameters, const DynamicModes& modes) {
  parameters.validate();
  if (!parameters.deck.given()) {
    throw input_error("structure.deck", "nothing", "the nodes of the deck on which the train's forces act");
  }
  const bool by_modes = parameters.files.by_modes();
  ModalStructure modal = by_modes ? read_modal_structure(parameters) : ModalStructure{};
  const FeStructure structure = by_modes ? std::move(modal.at) : read_on_supports(parameters);
  if (!by_modes) require_held(structure);
  const std::vector<int> nodes = selected_nodes(structure, parameters.deck, "structure.deck");
  const auto [begin, end] = deck_extent(structure, nodes);
  if (!(end - begin > 0.5)) {
    throw input_error("structure.deck", fmt::format("a deck of {:.4g} m along the track", end - begin),
                      "a longer one: see structure.units and structure.axes");
  }
  const DeckFunction line = deck_function(structure, nodes);
  auto [basis, complete] = by_modes ? DeckBasis{{std::move(modal.shape), modal.omega.cwiseAbs2()}, false}
                                    : enough_modes(structure, nodes, modes);
  const BendingModes bending = bending_modes(bending_share(structure, nodes, basis));
  ModalDeck deck;
  deck.name = "structure";
  deck.start = begin;
  deck.first_bending = bending.first;
  deck.third_bending = bending.third;
  deck.third_bending_unknown = bending.found < 3 && !complete;
  deck.known_modes = static_cast<int>(basis.omega2.size());
  deck.dynamic_modes = count_dynamic_modes(basis.omega2.array().sqrt(), bending, modes);
  if (!by_modes) append_residual_shapes(structure, line, {begin, end}, basis);
  deck.omega = basis.omega2.array().sqrt();
  if (by_modes) {
    deck.damping = modal.damping;
  } else {
    const Eigen::SparseMatrix<double> damping = damping_matrix(structure, parameters.damping).of_unknowns;
    deck.damping =
        (basis.shape.cwiseProduct(damping * basis.shape)).colwise().sum().transpose().array() / (2.0 * deck.omega);
  }
  const double most_damped = deck.damping.head(deck.dynamic_modes).maxCoeff();
  if (most_damped >= 1.0) {
    throw input_error("structure", fmt::format("a mode with damping ratio {:.4g}", most_damped),
                      "damping below the critical one in all modes");
  }
  set_line(line, basis, end - begin, deck);
  std::vector<double> x;
  for (const int node : nodes) x.push_back(structure.nodes.at(node).position[0] - begin);
  set_points(static_cast<int>(deck.knots.size()) - 1, of_nodes(structure, nodes, basis), x, deck);
  return deck;
}

}  // namespace railtab
