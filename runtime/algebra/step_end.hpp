#pragma once

#include <cstddef>

namespace railtab {

/// Newmark's update of a motion by the increment δ over its predictor, in place; the right-hand sides have the values
/// before the step:
///     u += u_v v + u_w w + δ,   v += v_w w + v_δ δ,   w = w_δ δ.
struct StepEnd {
  double *u, *v, *w;  ///< displacement, velocity, acceleration of all unknowns
  double u_v, u_w, v_w, v_delta, w_delta;

  template <class T>
  void move(T& u_now, T& v_now, T& w_now, const T& delta) const noexcept {
    u_now += u_v * v_now + u_w * w_now + delta;
    v_now += v_w * w_now + v_delta * delta;
    w_now = w_delta * delta;
  }
  void move(std::size_t i, double delta) const noexcept { move(u[i], v[i], w[i], delta); }
};

}  // namespace railtab
