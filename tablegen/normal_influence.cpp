#include "railtab/tablegen/normal_influence.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <numbers>

#include "railtab/tablegen/fftw_values.hpp"
#include "railtab/tablegen/rolling_contact_product.hpp"

namespace railtab {

namespace {

using Complex = std::complex<double>;

Complex* allocate(int count) { return reinterpret_cast<Complex*>(fftw_alloc_complex(static_cast<std::size_t>(count))); }

/// Antiderivative of 1/r at one corner of an element.
double corner(double x, double s) {
  return (x != 0.0 ? x * std::asinh(s / std::abs(x)) : 0.0) + (s != 0.0 ? s * std::asinh(x / std::abs(s)) : 0.0);
}

/// The least size from `low` on for which FFTW 3.3 finds fast plans without timing them. With its plans for other sizes
/// with the factors 2, 3 and 5 a transform takes up to three times as long as with these.
int padded_size(int low) {
  constexpr std::array sizes{16, 20, 32, 40, 64, 80, 96, 128, 160, 200, 256, 320, 400, 512, 640, 800, 1024};
  const auto* const found = std::lower_bound(sizes.begin(), sizes.end(), low);
  return found != sizes.end() ? *found : fast_transform_size(low);
}

}  // namespace

NormalInfluence::NormalInfluence(const Size& size, const std::vector<double>& angle, double contact_modulus)
    : size_(size), padded_x_(padded_size(2 * size.nx)), padded_s_(padded_size(2 * size.ns)), stride_(padded_x_ + 2) {
  for (int j = 0; j < size.ns; ++j) {
    direction_.push_back(angle.empty() ? Complex(1.0) : std::polar(1.0, angle[static_cast<std::size_t>(j)]));
  }
  rows_ = allocate(size.ns * padded_x_);
  spectrum_ = allocate(padded_s_ * stride_);
  displaced_ = allocate(padded_s_ * stride_);
  {
    const std::lock_guard lock(fftw_planner());
    const unsigned flags = FFTW_ESTIMATE;  // a timed plan could sum in another order on the next run
    const int px = padded_x_, ps = padded_s_, ns = size.ns;
    // Out of place, for which plans without timing are good. Rows beyond ns are zero, and what is displaced there is
    // not wanted.
    along_ = fftw_plan_many_dft(1, &px, ns, raw(rows_), nullptr, 1, px, raw(spectrum_), nullptr, 1, stride_,
                                FFTW_FORWARD, flags);
    across_ = fftw_plan_many_dft(1, &ps, px, raw(spectrum_), nullptr, stride_, 1, raw(displaced_), nullptr, stride_, 1,
                                 FFTW_FORWARD, flags);
    across_back_ = fftw_plan_many_dft(1, &ps, px, raw(displaced_), nullptr, stride_, 1, raw(spectrum_), nullptr,
                                      stride_, 1, FFTW_BACKWARD, flags);
    along_back_ = fftw_plan_many_dft(1, &px, ns, raw(spectrum_), nullptr, 1, stride_, raw(rows_), nullptr, 1, px,
                                     FFTW_BACKWARD, flags);
    tabulate(contact_modulus);
  }
}

NormalInfluence::~NormalInfluence() {
  const std::lock_guard lock(fftw_planner());
  for (fftw_plan plan : {along_, across_, across_back_, along_back_}) fftw_destroy_plan(plan);
  fftw_free(rows_);
  fftw_free(spectrum_);
  fftw_free(displaced_);
}

/// The kernel is even in x and s, its transform real.
void NormalInfluence::tabulate(double contact_modulus) {
  const int half_x = padded_x_ / 2 + 1, half_s = padded_s_ / 2 + 1;
  const double scale = 1.0 / (std::numbers::pi * contact_modulus * padded_x_ * padded_s_);
  // the antiderivative at all corners, then the cosine transform of one quarter
  std::vector<double> corners(static_cast<std::size_t>((half_x + 1) * (half_s + 1)));
  const auto at = [&](int i, int j) -> double& { return corners[static_cast<std::size_t>(i * (half_s + 1) + j)]; };
  for (int i = 0; i <= half_x; ++i) {
    for (int j = 0; j <= half_s; ++j) at(i, j) = corner((i - 0.5) * size_.dx, (j - 0.5) * size_.ds);
  }
  std::vector<double> quarter(static_cast<std::size_t>(half_x * half_s));
  for (int i = 0; i < half_x; ++i) {
    for (int j = 0; j < half_s; ++j) {
      quarter[static_cast<std::size_t>(i * half_s + j)] =
          scale * (at(i + 1, j + 1) - at(i, j + 1) - at(i + 1, j) + at(i, j));
    }
  }
  self_ = quarter[0] * padded_x_ * padded_s_;
  fftw_plan plan =
      fftw_plan_r2r_2d(half_x, half_s, quarter.data(), quarter.data(), FFTW_REDFT00, FFTW_REDFT00, FFTW_ESTIMATE);
  fftw_execute(plan);
  fftw_destroy_plan(plan);
  const double largest = *std::max_element(quarter.begin(), quarter.end());
  const double size = static_cast<double>(padded_x_) * padded_s_;
  for (int j = 0; j < padded_s_; ++j) {
    for (int i = 0; i < padded_x_; ++i) {
      const double k =
          quarter[static_cast<std::size_t>(std::min(i, padded_x_ - i) * half_s + std::min(j, padded_s_ - j))];
      kernel_.push_back(k);
      inverse_.push_back(1.0 / (std::max(k, 1e-4 * largest) * size * size));
    }
  }
}

void NormalInfluence::transform(const std::vector<double>& factor, const Eigen::VectorXd& from, Eigen::VectorXd& to) {
  const int nx = size_.nx, ns = size_.ns;
  for (int j = 0; j < ns; ++j) {
    const double c = direction_[static_cast<std::size_t>(j)].real(), s = direction_[static_cast<std::size_t>(j)].imag();
    const double* row = from.data() + j * nx;
    Complex* out = rows_ + j * padded_x_;
    for (int i = 0; i < nx; ++i) out[i] = {c * row[i], s * row[i]};
    std::fill(out + nx, out + padded_x_, Complex{});
  }
  fftw_execute(along_);
  std::fill(spectrum_ + ns * stride_, spectrum_ + padded_s_ * stride_, Complex{});
  fftw_execute(across_);
  for (int j = 0; j < padded_s_; ++j) {
    Complex* row = displaced_ + j * stride_;
    const double* by = factor.data() + j * padded_x_;
    for (int i = 0; i < padded_x_; ++i) row[i] *= by[i];
  }
  fftw_execute(across_back_);
  fftw_execute(along_back_);
  for (int j = 0; j < ns; ++j) {
    const double c = direction_[static_cast<std::size_t>(j)].real(), s = direction_[static_cast<std::size_t>(j)].imag();
    double* row = to.data() + j * nx;
    const Complex* in = rows_ + j * padded_x_;
    for (int i = 0; i < nx; ++i) row[i] = c * in[i].real() + s * in[i].imag();
  }
}

}  // namespace railtab
