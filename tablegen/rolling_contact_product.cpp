#include "railtab/tablegen/rolling_contact_product.hpp"

#include <algorithm>

#include "railtab/tablegen/fftw_values.hpp"
#include "railtab/tablegen/influence_numbers.hpp"

namespace railtab {

std::mutex& fftw_planner() {
  static std::mutex mutex;
  return mutex;
}

int fast_transform_size(int low) {
  for (int size = low + low % 2;; size += 2) {
    int rest = size;
    for (const int factor : {2, 3, 5}) {
      while (rest % factor == 0) rest /= factor;
    }
    if (rest == 1) return size;
  }
}

RollingContactProduct::RollingContactProduct(int nx, int ny, double dx, double dy, double nu)
    : nx_(nx),
      ny_(ny),
      padded_x_(fast_transform_size(2 * nx)),
      padded_y_(fast_transform_size(2 * ny)),
      columns_(padded_x_ / 2 + 1) {
  const std::lock_guard lock(fftw_planner());
  const int plane = padded_y_ * columns_;
  real_ = fftw_alloc_real(static_cast<std::size_t>(padded_y_) * padded_x_);
  spectrum_ = reinterpret_cast<std::complex<double>*>(fftw_alloc_complex(static_cast<std::size_t>(2) * plane));
  // One component: the ny rows that carry traction, then all columns of the half spectrum. Rows beyond ny are zero, and
  // their slip is not wanted: they are transformed across only.
  const unsigned flags = FFTW_ESTIMATE;  // a timed plan could sum in another order on the next run
  rows_forward_ = fftw_plan_many_dft_r2c(1, &padded_x_, ny_, real_, nullptr, 1, padded_x_, raw(spectrum_), nullptr, 1,
                                         columns_, flags);
  columns_forward_ = fftw_plan_many_dft(1, &padded_y_, columns_, raw(spectrum_), nullptr, columns_, 1, raw(spectrum_),
                                        nullptr, columns_, 1, FFTW_FORWARD, flags);
  columns_backward_ = fftw_plan_many_dft(1, &padded_y_, columns_, raw(spectrum_), nullptr, columns_, 1, raw(spectrum_),
                                         nullptr, columns_, 1, FFTW_BACKWARD, flags);
  rows_backward_ = fftw_plan_many_dft_c2r(1, &padded_x_, ny_, raw(spectrum_), nullptr, 1, columns_, real_, nullptr, 1,
                                          padded_x_, flags);
  tabulate(dx, dy, nu);
}

RollingContactProduct::~RollingContactProduct() {
  const std::lock_guard lock(fftw_planner());
  for (fftw_plan plan : {rows_forward_, columns_forward_, columns_backward_, rows_backward_}) fftw_destroy_plan(plan);
  fftw_free(real_);
  fftw_free(spectrum_);
}

RollingContactProduct::Spectrum RollingContactProduct::spectrum(int kx, int ky) const {
  // B is real: the half of the spectrum that is not stored is the conjugate of the other
  const bool stored = kx < columns_;
  const int row = stored ? ky : (padded_y_ - ky) % padded_y_;
  const std::size_t k = static_cast<std::size_t>(row * columns_ + (stored ? kx : padded_x_ - kx));
  if (stored) return {xx_[k], xy_[k], yy_[k]};
  return {std::conj(xx_[k]), std::conj(xy_[k]), std::conj(yy_[k])};
}

void RollingContactProduct::tabulate(double dx, double dy, double nu) {
  const int plane = padded_y_ * columns_;
  const double scale = 1.0 / (static_cast<double>(padded_x_) * padded_y_);
  std::vector<double> kernel(static_cast<std::size_t>(padded_x_) * padded_y_);
  std::vector<std::complex<double>> half(static_cast<std::size_t>(plane));
  fftw_plan plan = fftw_plan_dft_r2c_2d(padded_y_, padded_x_, kernel.data(), raw(half.data()), FFTW_ESTIMATE);
  row_[0].resize(static_cast<std::size_t>(2 * nx_ - 1));
  row_[1].resize(static_cast<std::size_t>(2 * nx_ - 1));

  // A on the offsets −(nx−1)..nx along and −(ny−1)..ny−1 across, observed minus loaded element
  const int wide = 2 * nx_;
  std::vector<InfluenceNumber> a;
  for (int j = 1 - ny_; j < ny_; ++j) {
    for (int i = 1 - nx_; i <= nx_; ++i) a.push_back(influence_number(i * dx, j * dy, dx, dy, nu));
  }
  const auto fill = [&](double InfluenceNumber::*part, std::vector<std::complex<double>>& out) {
    std::fill(kernel.begin(), kernel.end(), 0.0);
    for (int j = 1 - ny_; j < ny_; ++j) {
      for (int i = 1 - nx_; i < nx_; ++i) {
        const std::size_t k = static_cast<std::size_t>((j + ny_ - 1) * wide + i + nx_ - 1);
        kernel[static_cast<std::size_t>(((j + padded_y_) % padded_y_) * padded_x_ + (i + padded_x_) % padded_x_)] =
            scale * (a[k].*part - a[k + 1].*part);
      }
    }
    fftw_execute(plan);
    out = half;
  };
  fill(&InfluenceNumber::xx, xx_);
  fill(&InfluenceNumber::xy, xy_);
  fill(&InfluenceNumber::yy, yy_);
  fftw_destroy_plan(plan);
  for (int ahead = 1 - nx_; ahead < nx_; ++ahead) {
    const std::size_t k = static_cast<std::size_t>((ny_ - 1) * wide - ahead + nx_ - 1);
    row_[0][static_cast<std::size_t>(nx_ - 1 + ahead)] = a[k].xx - a[k + 1].xx;
    row_[1][static_cast<std::size_t>(nx_ - 1 + ahead)] = a[k].yy - a[k + 1].yy;
  }
}

void RollingContactProduct::apply(const ElementField& traction, ElementField& slip) {
  const int plane = padded_y_ * columns_;
  for (int c = 0; c < 2; ++c) {
    std::complex<double>* spectrum = spectrum_ + c * plane;
    for (int j = 0; j < ny_; ++j) {
      const double* from = traction.data() + (c * ny_ + j) * nx_;
      std::copy(from, from + nx_, real_ + j * padded_x_);
      std::fill(real_ + j * padded_x_ + nx_, real_ + (j + 1) * padded_x_, 0.0);
    }
    fftw_execute_dft_r2c(rows_forward_, real_, raw(spectrum));
    std::fill(spectrum + ny_ * columns_, spectrum + plane, 0.0);
    fftw_execute_dft(columns_forward_, raw(spectrum), raw(spectrum));
  }
  // spelled out: the product of std::complex guards against infinities, at ten times the run time
  double* x = reinterpret_cast<double*>(spectrum_);
  double* y = reinterpret_cast<double*>(spectrum_ + plane);
  const double* kxx = reinterpret_cast<const double*>(xx_.data());
  const double* kxy = reinterpret_cast<const double*>(xy_.data());
  const double* kyy = reinterpret_cast<const double*>(yy_.data());
  for (int k = 0; k < 2 * plane; k += 2) {
    const double xr = x[k], xi = x[k + 1], yr = y[k], yi = y[k + 1];
    x[k] = kxx[k] * xr - kxx[k + 1] * xi + kxy[k] * yr - kxy[k + 1] * yi;
    x[k + 1] = kxx[k] * xi + kxx[k + 1] * xr + kxy[k] * yi + kxy[k + 1] * yr;
    y[k] = kxy[k] * xr - kxy[k + 1] * xi + kyy[k] * yr - kyy[k + 1] * yi;
    y[k + 1] = kxy[k] * xi + kxy[k + 1] * xr + kyy[k] * yi + kyy[k + 1] * yr;
  }
  for (int c = 0; c < 2; ++c) {
    std::complex<double>* spectrum = spectrum_ + c * plane;
    fftw_execute_dft(columns_backward_, raw(spectrum), raw(spectrum));
    fftw_execute_dft_c2r(rows_backward_, raw(spectrum), real_);
    for (int j = 0; j < ny_; ++j) {
      std::copy(real_ + j * padded_x_, real_ + j * padded_x_ + nx_, slip.data() + (c * ny_ + j) * nx_);
    }
  }
}

}  // namespace railtab
