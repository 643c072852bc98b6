#pragma once

#include <optional>
#include <string>
#include <vector>

#include "railtab/runtime/structure/fe_structure.hpp"
#include "railtab/runtime/structure/track_bridge.hpp"

namespace railtab {

/// Damping of an imported structure, in one of four ways: its own matrix (FeFiles::damping), Rayleigh's coefficients, a
/// ratio, or the bridge standard's lower bound for a type and span. The last two give C = aM + bK with the ratio at two
/// frequencies, between which it is lower and beyond which it is higher.
struct FeDamping {
  std::optional<double> mass_factor;       ///< a [1/s], >= 0
  std::optional<double> stiffness_factor;  ///< b [s], >= 0
  std::optional<double> ratio;             ///< of critical, 0..0.5
  std::string type;                        ///< one of bridge_damping_types()
  double span = 0.0;                       ///< [m], with `type`
  /// At which the ratio holds [Hz]; 0: the first and the third natural frequency of the structure.
  std::array<double, 2> frequencies{0.0, 0.0};
  bool operator==(const FeDamping&) const = default;
};

/// A structure from a finite-element program and how track and train meet it.
struct ImportParameters {
  FeFiles files;
  FeFrame frame;
  FeDamping damping;
  NodeSelection deck;                   ///< nodes that carry railtab's own track
  NodeSelection rail_left, rail_right;  ///< or nodes of beams that are rails in the model, with z and pitch
  std::vector<FeSupport> supports;      ///< none: the model is constrained, and its supports have no rows
  std::vector<double> report;      ///< positions along the track at which the deck is reported [m]; empty: its middle
  std::vector<double> sections{};  ///< positions along the track of sections whose forces are followed [m]
  std::optional<double> axis_depth{};  ///< of the axis of their moments below the rail-head tops [m]

  /// @throws InputError naming the keys: damping in no or more than one way, a file missing
  void validate() const;
  bool operator==(const ImportParameters&) const = default;
};

/// Railtab's track laid over the deck of an imported bridge, between whose first and last deck nodes the sleepers rest
/// on it. Named nodes: "deck-<x>" (the deck node nearest to the track's centre at x), or "deck-midspan-1" where no
/// position is asked for, and the rails above them. Of an expanded node the motion of its first row is reported; a node
/// of a surface without rotations of its own has roll and pitch of the deck around it (surface_slopes()).
/// @throws InputError naming file, node or key
[[nodiscard]] StructureModel build_track_on_import(const TrackParameters& track, const ImportParameters& parameters,
                                                   DeckRecord record = DeckRecord::named_nodes);

/// An imported structure whose own beams are the rails, at the rail-head tops. @throws InputError naming file, node or
/// key
[[nodiscard]] StructureModel import_with_rails(const ImportParameters& parameters,
                                               DeckRecord record = DeckRecord::named_nodes);

/// The model on its supports. @throws InputError with file and line, row, or key
[[nodiscard]] FeStructure read_on_supports(const ImportParameters& parameters);

/// Damping of an imported structure, of its degrees of freedom and from the rows that are supports'.
struct FeDampingMatrix {
  Eigen::SparseMatrix<double> of_unknowns;
  StructureSupports::Columns of_supports;
  double first_frequency = 0.0;  ///< of the structure [Hz], where the damping needed it, else 0
};
/// @throws InputError, ComputationError
[[nodiscard]] FeDampingMatrix damping_matrix(const FeStructure& structure, const FeDamping& damping);

/// Mass that moves along z over the length of the mesh [kg/m].
[[nodiscard]] double mass_per_length(const FeStructure& structure);

/// Sentences on a mass per length [kg/m] and a first frequency [Hz] (0: not known) that no railway bridge has: units,
/// densities or supports may be wrong.
[[nodiscard]] std::vector<std::string> plausibility_warnings(double mass_per_length, double first_frequency);

}  // namespace railtab
