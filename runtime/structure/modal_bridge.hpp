#pragma once

#include <Eigen/Core>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "railtab/runtime/structure/bridge.hpp"
#include "railtab/runtime/structure/imported_bridge.hpp"

namespace railtab {

/// A structure that is known by natural modes, in SI units and railtab's axes: u = Φ q, q'' + 2ζω q' + ω² q = Φᵀ F.
struct ModalStructure {
  FeStructure at;                           ///< nodes, whose rows are rows of `shape`; no matrices
  Eigen::MatrixXd shape;                    ///< Φ, rows × modes, normalised to unit modal mass [1/√kg]
  Eigen::VectorXd omega;                    ///< [rad/s], rising
  Eigen::VectorXd damping;                  ///< ζ
  std::map<int, double> whole_flexibility;  ///< of the structure itself at nodes, by number [m/N]; may be empty
};
/// @throws InputError with file and line, or key
[[nodiscard]] ModalStructure read_modal_structure(const ImportParameters& parameters);

/// Static flexibility along z at a node: displacement under a unit force there [m/N].
struct StaticFlexibility {
  int node = 0;
  double x = 0.0;               ///< along the track [m]
  double by_modes = 0.0;        ///< Σ φ²/ω²
  double by_last_mode = 0.0;    ///< what the mode of the highest frequency adds
  std::optional<double> whole;  ///< of the structure itself, where it is known
  /// Share of `whole` that the modes leave out.
  [[nodiscard]] double lost() const noexcept { return 1.0 - by_modes / whole.value_or(by_modes); }
};
/// The node next to the track's centre line that gives way most along z by the modes: a midspan.
/// @param deck nodes with vertical shapes, at least one
[[nodiscard]] int softest_node(const ModalStructure& structure, const std::vector<int>& deck);
/// At every deck node whose whole flexibility is known, else at the softest one. Not empty.
/// @throws InputError where modes are more flexible than the structure by over 5 %: shapes, modal masses or units do
/// not belong together
[[nodiscard]] std::vector<StaticFlexibility> static_flexibility(const ModalStructure& structure,
                                                                const ImportParameters& parameters);
/// What the modes leave out, in sentences for the plan.
[[nodiscard]] std::vector<std::string> lost_by_modes(const ModalStructure& structure,
                                                     const ImportParameters& parameters);

/// The deck that the modes describe. Its degrees of freedom are a change of basis of the modal coordinates, such that
/// motions of the reported nodes are degrees of freedom themselves: M = SᵀS, C = Sᵀ 2ζω S, K = Sᵀ ω² S with q = S p.
/// @throws InputError with file and line, node, or key: also where more positions are reported than the modes can tell
/// apart
[[nodiscard]] Bridge modal_bridge(const ImportParameters& parameters, DeckRecord record = DeckRecord::named_nodes);

}  // namespace railtab
