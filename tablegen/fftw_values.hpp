#pragma once

#include <fftw3.h>

#include <complex>

namespace railtab {

/// Complex values as FFTW names them: the layouts are the same.
inline fftw_complex* raw(std::complex<double>* values) { return reinterpret_cast<fftw_complex*>(values); }
inline fftwf_complex* raw(std::complex<float>* values) { return reinterpret_cast<fftwf_complex*>(values); }

}  // namespace railtab
