#pragma once

#include <span>

#include "railtab/runtime/algebra/structure_factor.hpp"

namespace railtab {

/// One back-substitution of a system whose load is known but for few unknowns: the wheels' forces, which the solution
/// under the wheels decides.
///
///     L z = known load            whole forward half, once
///     L w = load on few unknowns  on their path only, as often as it changes
///     Lᵀ x = D⁻¹ (z + w)          on the path as often, off it once
///
/// What lies on the path costs little, so that any number of answers to the changing load and the whole solution come
/// at the price of little more than one back-substitution. Caller-owned buffers; nothing is allocated after the first
/// use.
class DividedSubstitution {
 public:
  /// Forward half of the known load. @param few  unknowns that later loads stand on; repeated ones are welcome
  void begin(const StructureFactor& factor, const Eigen::VectorXd& known, std::span<const int> few);
  /// The solution at the few unknowns under the known load. Writes only their entries.
  void respond(const StructureFactor& factor, Eigen::VectorXd& solution);
  /// Under known + weight·extra. Reads and writes only their entries.
  void respond(const StructureFactor& factor, double weight, const Eigen::VectorXd& extra, Eigen::VectorXd& solution);
  /// The whole solution under the loads of the last respond(), which must have been called.
  void finish(const StructureFactor& factor, Eigen::VectorXd& solution);

 private:
  std::vector<int> few_;
  StructureFactor::Path path_;
  Eigen::VectorXd known_, work_, solved_;  // in the factor's order
};

}  // namespace railtab
