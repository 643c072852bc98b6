#pragma once

#include <fftw3.h>

#include <Eigen/Core>
#include <complex>
#include <mutex>
#include <span>
#include <vector>

namespace railtab {

/// Tractions or slips on a square of elements: x components, then y components; each n rows across (y, rightward) of n
/// elements along the rolling direction (x, forward).
using ElementField = Eigen::VectorXd;

/// FFTW's planner is the one part of it that threads may not enter together.
[[nodiscard]] std::mutex& fftw_planner();

/// Slip per step of one element, by elastic deformation in steady rolling: B p = (A p)(x) − (A p)(x + dx), the
/// displacement difference now minus that one element further ahead, from which the particle came. A Toeplitz product,
/// done by FFT on a grid twice as large.
/// One object belongs to one thread at a time (it owns the work space).
class RollingContactProduct {
 public:
  /// @param n elements along each side; @param dx, dy their size; @param nu Poisson's ratio. G = 1.
  RollingContactProduct(int n, double dx, double dy, double nu);
  ~RollingContactProduct();
  RollingContactProduct(const RollingContactProduct&) = delete;
  RollingContactProduct& operator=(const RollingContactProduct&) = delete;

  /// slip = B p, all n×n elements.
  void apply(const ElementField& traction, ElementField& slip);

  /// B between two elements of one row, `ahead` elements from the observed to the loaded one, in x (0) and y (1)
  /// direction. Across the directions there is no influence within a row.
  [[nodiscard]] double in_row(int component, int ahead) const { return row_[component][n_ - 1 + ahead]; }

  [[nodiscard]] int elements() const { return n_; }
  [[nodiscard]] int padded() const { return padded_; }
  struct Spectrum {
    std::complex<double> xx, xy, yy;
  };
  /// Transform of B at the wave numbers kx, ky in 0..padded()−1, divided by padded()².
  [[nodiscard]] Spectrum spectrum(int kx, int ky) const;

 private:
  void tabulate(double dx, double dy, double nu);

  int n_, padded_, columns_;
  std::vector<double> row_[2];
  double* real_;
  std::complex<double>* spectrum_;
  std::vector<std::complex<double>> xx_, xy_, yy_;
  fftw_plan rows_forward_, columns_forward_, columns_backward_, rows_backward_;
};

}  // namespace railtab
