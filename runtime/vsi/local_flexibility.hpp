#pragma once

#include "railtab/runtime/vsi/structure_response.hpp"

namespace railtab {

/// Static correction of a structure in modal coordinates: the modes left out answer to the wheels at once, without
/// inertia. Their flexibility is that of the whole structure at rest less that of the modes kept,
///
///     R = K⁻¹ − Φ Λ⁻¹ Φᵀ,
///
/// restricted to the rail heads under the wheels; between wheels farther apart than a window it is left out.
class LocalFlexibility {
 public:
  /// @param unreduced, reduced must live as long as this; `reduced` is in modal coordinates of `unreduced`
  LocalFlexibility(const StructureModel& unreduced, const StructureModel& reduced);

  /// Cover loads between positions `from` and `to` [m].
  void follow(double from, double to);
  /// Displacement of rail head `i` from unit loads on rail head `j` (3×3). @pre the table covers both
  [[nodiscard]] Eigen::Matrix3d operator()(const RailContact& i, const RailContact& j) const noexcept;

 private:
  const StructureModel& unreduced_;
  StructureResponse rest_;
  Eigen::VectorXd modal_flexibility_;  // diagonal of Λ⁻¹
};

}  // namespace railtab
