#pragma once

#include <fftw3.h>

#include <Eigen/Core>
#include <complex>
#include <mutex>
#include <span>
#include <vector>

#include "railtab/tablegen/rolling_contact_grid.hpp"

namespace railtab {

/// FFTW's planner is the one part of it that threads may not enter together.
[[nodiscard]] std::mutex& fftw_planner();
/// Smallest even size from `low` with no prime factor above 5.
[[nodiscard]] int fast_transform_size(int low);

/// Slip per step of one element, by elastic deformation in steady rolling: B p = (A p)(x) − (A p)(x + dx), the
/// displacement difference now minus that one element further ahead, from which the particle came. A Toeplitz product,
/// done by FFT on a grid twice as large.
/// One object belongs to one thread at a time (it owns the work space).
class RollingContactProduct {
 public:
  /// @param nx, ny elements along and across; @param dx, dy their size; @param nu Poisson's ratio. G = 1.
  RollingContactProduct(int nx, int ny, double dx, double dy, double nu);
  ~RollingContactProduct();
  RollingContactProduct(const RollingContactProduct&) = delete;
  RollingContactProduct& operator=(const RollingContactProduct&) = delete;

  /// slip = B p, all nx×ny elements.
  void apply(const ElementField& traction, ElementField& slip);

  /// B between two elements of one row, `ahead` elements from the observed to the loaded one, in x (0) and y (1)
  /// direction. Across the directions there is no influence within a row.
  [[nodiscard]] double in_row(int component, int ahead) const { return row_[component][nx_ - 1 + ahead]; }

  [[nodiscard]] int along() const { return nx_; }
  [[nodiscard]] int across() const { return ny_; }
  [[nodiscard]] int padded_along() const { return padded_x_; }
  [[nodiscard]] int padded_across() const { return padded_y_; }
  struct Spectrum {
    std::complex<double> xx, xy, yy;
  };
  /// Transform of B at the wave numbers kx, ky below padded_along() and padded_across(), divided by their product.
  [[nodiscard]] Spectrum spectrum(int kx, int ky) const;

 private:
  void tabulate(double dx, double dy, double nu);

  int nx_, ny_, padded_x_, padded_y_, columns_;
  std::vector<double> row_[2];
  double* real_;
  std::complex<double>* spectrum_;
  std::vector<std::complex<double>> xx_, xy_, yy_;
  fftw_plan rows_forward_, columns_forward_, columns_backward_, rows_backward_;
};

}  // namespace railtab
