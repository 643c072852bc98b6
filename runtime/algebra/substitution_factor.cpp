#include "railtab/runtime/algebra/substitution_factor.hpp"

#include <atomic>

namespace railtab {

SubstitutionFactor::SubstitutionFactor() {
  static std::atomic<long> made = 0;
  id_ = ++made;
}

SubstitutionFactor::Vector SubstitutionFactor::solve(const Vector& load) const {
  Path nothing;
  find_path({}, nothing);
  Vector y, x = Vector::Zero(room()), natural = Vector::Zero(load.size());
  into(load, y);
  forward(y);
  backward(y, x, nothing);
  backward_off(nothing, y, x);
  out_of(x, natural);
  return natural;
}

}  // namespace railtab
