#pragma once

#include "railtab/runtime/structure/structure_model.hpp"

namespace railtab {

/// A simply supported, undamped beam in vertical bending from x = 0 to `length`.
struct SimpleBeamParameters {
  double length = 25.0;   ///< [m]
  double E = 2.87e9;      ///< [Pa]
  double I = 2.90;        ///< second moment of area of vertical bending [m⁴]
  double mass = 2303.0;   ///< per length [kg/m]
  int elements = 20;      ///< >= 2 and even, so that a node stands at midspan
  void validate() const;  ///< @throws InputError
};

/// The beam of the analytic moving-load solutions [YangYau1997] as a structure: only z and pitch are free, both rails
/// are the beam axis itself (rail-head height 0), and the node "deck-midspan-1" is named. The two rails share their
/// dofs, so each wheel of an axle adds its load to the same beam. @throws InputError
[[nodiscard]] StructureModel build_simple_beam(const SimpleBeamParameters& parameters);

}  // namespace railtab
