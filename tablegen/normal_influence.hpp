#pragma once

#include <fftw3.h>

#include <Eigen/Core>
#include <complex>
#include <vector>

namespace railtab {

/// Normal displacement difference of two bodies by pressure on nx × ns rectangles of the developed rail surface:
///
///   u_k = Σ_l cos(δ_k − δ_l) A(k − l) p_l,   A = (1/πE*) ∫∫ dx' ds'/r over one rectangle (Boussinesq, Love),
///
/// δ the angle of the local normal. With w = e^{iδ} that is u = Re(conj(w) A (w p)): one complex convolution, by FFT on
/// a grid of twice the size. Symmetric and positive definite, since A is.
/// One object belongs to one thread at a time (it owns the work space).
class NormalInfluence {
 public:
  struct Size {
    int nx, ns;     ///< elements along x and across
    double dx, ds;  ///< of an element [m]
  };
  /// @param angle δ of each row of elements [rad]; empty for a plane @param contact_modulus E* [Pa]
  NormalInfluence(const Size& size, const std::vector<double>& angle, double contact_modulus);
  ~NormalInfluence();
  NormalInfluence(const NormalInfluence&) = delete;
  NormalInfluence& operator=(const NormalInfluence&) = delete;

  /// displacement = A pressure; ns rows of nx elements.
  void apply(const Eigen::VectorXd& pressure, Eigen::VectorXd& displacement) {
    transform(kernel_, pressure, displacement);
  }
  /// An approximate inverse, symmetric and positive definite: the kernel's inverse on the periodic grid.
  void apply_inverse(const Eigen::VectorXd& displacement, Eigen::VectorXd& pressure) {
    transform(inverse_, displacement, pressure);
  }
  /// Displacement of an element by its own unit pressure [m/Pa].
  [[nodiscard]] double self() const noexcept { return self_; }

 private:
  void tabulate(double contact_modulus);
  void transform(const std::vector<double>& factor, const Eigen::VectorXd& from, Eigen::VectorXd& to);

  Size size_;
  int padded_x_, padded_s_;
  int stride_;  ///< of rows of spectra, padded_x_ + 2: rows a power of two apart would share few lines of the cache
  std::vector<std::complex<double>> direction_;  ///< e^{iδ} of each row
  std::vector<double> kernel_, inverse_;         ///< rows of wave numbers along x, divided by the grid's size
  double self_ = 0.0;
  std::complex<double>*rows_, *spectrum_, *displaced_;  ///< rows along x: ns of the first, padded_s_ of the others
  fftw_plan along_, across_, across_back_, along_back_;
};

}  // namespace railtab
