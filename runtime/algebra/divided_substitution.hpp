#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "railtab/runtime/algebra/substitution_factor.hpp"

namespace railtab {

/// Unknowns that loads stand on now, repeated ones are welcome, and others that they may soon stand on: a path of both
/// serves until the loads leave it.
struct LoadedUnknowns {
  std::span<const int> now, soon;
};

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
  /// Forward half of the known load. @param few  unknowns that later loads stand on @pre all are unknowns of the factor
  void begin(const SubstitutionFactor& factor, const Eigen::VectorXd& known, const LoadedUnknowns& few);
  /// The same with the known load that set_known(ordered) sets in the factor's order.
  template <class SetKnown>
  void begin_with(const SubstitutionFactor& factor, const LoadedUnknowns& few, SetKnown&& set_known) {
    begin(factor, few);
    set_known(known_);
    factor.forward(known_);
  }
  /// The same without known load: for few entries of solutions under loads on few unknowns.
  void begin(const SubstitutionFactor& factor, const LoadedUnknowns& few);
  /// The solution at the few unknowns under the known load. Writes only their entries.
  void respond(const SubstitutionFactor& factor, Eigen::VectorXd& solution);
  /// Under known + weight·extra. Writes only their entries. @pre extra is zero at all others
  void respond(const SubstitutionFactor& factor, double weight, const Eigen::VectorXd& extra,
               Eigen::VectorXd& solution);
  /// The whole solution under the loads of the last respond(), which must have been called.
  void finish(const SubstitutionFactor& factor, Eigen::VectorXd& solution);
  /// The same in the factor's order; refers to what the next use replaces.
  [[nodiscard]] const Eigen::VectorXd& finish(const SubstitutionFactor& factor);

 private:
  std::vector<int> few_, on_path_;
  SubstitutionFactor::Path path_;
  long path_of_ = 0;                       // id() of the factor that found the path
  Eigen::VectorXd known_, work_, solved_;  // in the factor's order
};

}  // namespace railtab
