#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "railtab/runtime/algebra/substitution_factor.hpp"

namespace railtab {

/// One back-substitution of a system whose load is known but for few unknowns: the wheels' forces, which the solution
/// under the wheels decides.
///
///     L z = known load            whole forward half, once
///     L w = load on few unknowns  on their path only, as often as it changes
///     Lᵀ x = D⁻¹ (z + w)          on the path as often, off it once
///
/// What lies on the path costs little, so that any number of responses to the changing load and the whole solution come
/// at the cost of little more than one back-substitution. Caller-owned buffers; nothing is allocated after the first
/// use.
class DividedSubstitution {
 public:
  /// Forward half of the known load. @param few  unknowns that later loads stand on; repeated ones are welcome
  void begin(const SubstitutionFactor& factor, const Eigen::VectorXd& known, std::span<const int> few);
  /// The same with the known load by add_known(ordered), which adds to zeros in the factor's order.
  template <class AddKnown>
  void begin_with(const SubstitutionFactor& factor, std::span<const int> few, AddKnown&& add_known) {
    begin(factor, few);
    known_.setZero();
    add_known(known_);
    factor.forward(known_);
  }
  /// The same without known load: for few entries of solutions under loads on few unknowns.
  void begin(const SubstitutionFactor& factor, std::span<const int> few);
  /// The solution at the few unknowns under the known load. Writes only their entries.
  void respond(const SubstitutionFactor& factor, Eigen::VectorXd& solution);
  /// Under known + weight·extra. Writes only their entries. @pre extra is zero at all others
  void respond(const SubstitutionFactor& factor, double weight, const Eigen::VectorXd& extra,
               Eigen::VectorXd& solution);
  /// The whole solution under the loads of the last respond(), which must have been called.
  void finish(const SubstitutionFactor& factor, Eigen::VectorXd& solution);

 private:
  std::vector<int> few_;
  SubstitutionFactor::Path path_;
  Eigen::VectorXd known_, work_, solved_;  // in the factor's order
};

}  // namespace railtab
