#include "railtab/tablegen/rolling_contact_single.hpp"

#include <algorithm>
#include <mutex>

#include "railtab/tablegen/fftw_values.hpp"

namespace railtab {

namespace {

std::complex<float>* allocate_single(int count) {
  return reinterpret_cast<std::complex<float>*>(fftwf_alloc_complex(static_cast<std::size_t>(count)));
}

}  // namespace

RollingContactSingle::RollingContactSingle(const RollingContactProduct& product)
    : nx_(product.along()),
      ny_(product.across()),
      padded_x_(product.padded_along()),
      padded_y_(product.padded_across()),
      rows_(allocate_single(ny_ * padded_x_)),
      spectrum_(allocate_single(padded_x_ * padded_y_)),
      product_(allocate_single(padded_x_ * padded_y_)) {
  const std::lock_guard lock(fftw_planner());
  const unsigned flags = FFTW_ESTIMATE;  // a timed plan could sum in another order on the next run
  const int px = padded_x_, py = padded_y_, ny = ny_;
  // Transforms along x leave their results transposed, so that those across are on contiguous numbers.
  along_ =
      fftwf_plan_many_dft(1, &px, ny, raw(rows_), nullptr, 1, px, raw(spectrum_), nullptr, py, 1, FFTW_FORWARD, flags);
  across_ = fftwf_plan_many_dft(1, &py, px, raw(spectrum_), nullptr, 1, py, raw(spectrum_), nullptr, 1, py,
                                FFTW_FORWARD, flags);
  across_back_ = fftwf_plan_many_dft(1, &py, px, raw(product_), nullptr, 1, py, raw(product_), nullptr, 1, py,
                                     FFTW_BACKWARD, flags);
  along_back_ = fftwf_plan_many_dft(1, &px, ny, raw(product_), nullptr, py, 1, raw(spectrum_), nullptr, 1, px,
                                    FFTW_BACKWARD, flags);
  std::fill(rows_, rows_ + ny * px, Complex{});
  for (int kx = 0; kx < px; ++kx) {
    for (int ky = 0; ky < py; ++ky) {
      const RollingContactProduct::Spectrum b = product.spectrum(kx, ky);
      const std::complex<double> i(0.0, 1.0);
      alpha_.emplace_back(0.5 * (b.xx + b.yy));
      beta_.emplace_back(0.5 * (b.xx - b.yy) + i * b.xy);
    }
  }
}

RollingContactSingle::~RollingContactSingle() {
  const std::lock_guard lock(fftw_planner());
  for (fftwf_plan plan : {along_, across_, across_back_, along_back_}) fftwf_destroy_plan(plan);
  for (Complex* p : {rows_, spectrum_, product_}) fftwf_free(p);
}

/// product_ = α spectrum_ + β conj spectrum_(−k)
void RollingContactSingle::multiply() {
  // spelled out: the product of std::complex guards against infinities, at ten times the run time
  const auto line = [](const float* q, const float* mirrored, const float* a, const float* b, float* out, int count) {
    for (int k = 0; k < count; ++k) {
      const float qr = q[2 * k], qi = q[2 * k + 1], mr = mirrored[-2 * k], mi = mirrored[-2 * k + 1];
      const float ar = a[2 * k], ai = a[2 * k + 1], br = b[2 * k], bi = b[2 * k + 1];
      out[2 * k] = ar * qr - ai * qi + br * mr + bi * mi;
      out[2 * k + 1] = ar * qi + ai * qr + bi * mr - br * mi;
    }
  };
  const auto numbers = [](const Complex* p) { return reinterpret_cast<const float*>(p); };
  for (int kx = 0; kx < padded_x_; ++kx) {
    const int row = kx * padded_y_, mirrored = (padded_x_ - kx) % padded_x_ * padded_y_;
    const auto part = [&](int first, int from, int count) {
      line(numbers(spectrum_ + row + first), numbers(spectrum_ + mirrored + from), numbers(&alpha_[row + first]),
           numbers(&beta_[row + first]), reinterpret_cast<float*>(product_ + row + first), count);
    };
    part(0, 0, 1);
    part(1, padded_y_ - 1, padded_y_ - 1);
  }
}

void RollingContactSingle::apply(const ElementFieldSingle& traction, ElementFieldSingle& slip) {
  const int m = nx_ * ny_;
  for (int j = 0; j < ny_; ++j) {
    const float* x = traction.data() + j * nx_;
    Complex* row = rows_ + j * padded_x_;
    for (int i = 0; i < nx_; ++i) row[i] = {x[i], x[m + i]};
  }
  fftwf_execute(along_);
  for (int kx = 0; kx < padded_x_; ++kx) {
    std::fill(spectrum_ + kx * padded_y_ + ny_, spectrum_ + (kx + 1) * padded_y_, Complex{});
  }
  fftwf_execute(across_);
  multiply();
  fftwf_execute(across_back_);
  fftwf_execute(along_back_);
  for (int j = 0; j < ny_; ++j) {
    float* x = slip.data() + j * nx_;
    const Complex* row = spectrum_ + j * padded_x_;
    for (int i = 0; i < nx_; ++i) {
      x[i] = row[i].real();
      x[m + i] = row[i].imag();
    }
  }
}

}  // namespace railtab
