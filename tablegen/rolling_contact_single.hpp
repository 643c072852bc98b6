#pragma once

#include <fftw3.h>

#include <Eigen/Core>
#include <complex>
#include <vector>

#include "railtab/tablegen/rolling_contact_product.hpp"

namespace railtab {

/// Tractions or slips as ElementField, in single precision.
using ElementFieldSingle = Eigen::VectorXf;

/// B p in single precision, for the linear systems of Newton's method, which are solved to 1 % at best: less than half
/// the time of RollingContactProduct. Both components are transformed at once, as q = p_x + i p_y: with
/// Q(k) = FFT(q), the transform of s_x + i s_y is α(k) Q(k) + β(k) conj Q(−k), α = (B_xx + B_yy)/2 and
/// β = (B_xx − B_yy)/2 + i B_xy.
/// One object belongs to one thread at a time (it owns the work space).
class RollingContactSingle {
 public:
  explicit RollingContactSingle(const RollingContactProduct& product);
  ~RollingContactSingle();
  RollingContactSingle(const RollingContactSingle&) = delete;
  RollingContactSingle& operator=(const RollingContactSingle&) = delete;

  /// slip = B p, all nx×ny elements.
  void apply(const ElementFieldSingle& traction, ElementFieldSingle& slip);

 private:
  using Complex = std::complex<float>;
  void multiply();

  int nx_, ny_, padded_x_, padded_y_;
  std::vector<Complex> alpha_, beta_;     ///< with the wave number along x first
  Complex *rows_, *spectrum_, *product_;  ///< rows_: ny×padded along x; the others along y, transposed
  fftwf_plan along_, across_, across_back_, along_back_;
};

}  // namespace railtab
