#pragma once

#include <array>
#include <complex>
#include <optional>
#include <vector>

namespace railtab {

/// Root mean squares of a weighted acceleration over one window after the other [EN12299: 5 s].
class WindowedRms {
 public:
  /// @param window [s] @param step between samples [s], shorter
  WindowedRms(double window, double step);
  void add(double weighted);
  /// Of the windows that are full [m/s²].
  [[nodiscard]] const std::vector<double>& values() const noexcept { return values_; }

 private:
  long samples_, count_ = 0;
  double sum_ = 0.0;
  std::vector<double> values_;
};

/// Mean comfort N_MV = 6 √(a_x² + a_y² + a_z²), a the 95th percentiles of the rms of 5 s windows: W_d for x and y, W_b
/// for z [EN12299]. The standard takes 60 windows, 5 minutes on the floor. @pre each has a value
[[nodiscard]] double mean_comfort(const std::vector<double>& x, const std::vector<double>& y,
                                  const std::vector<double>& z);

/// Mean comfort of standing passengers, N_VD = 3 √(16 a_x50² + 4 a_y50² + a_z50²) + 5 a_y95, of the percentiles of the
/// same windows on the floor [EN12299]. @pre each has a value
[[nodiscard]] double mean_comfort_standing(const std::vector<double>& x, const std::vector<double>& y,
                                           const std::vector<double>& z);

/// Mean comfort of seated passengers, N_VA = 4 a_zP + 2 √(a_yA² + a_zA²) + 4 a_xD, a the 95th percentiles of such
/// windows on the floor P, the seat pan A and the seat back D: W_c for x, W_d for y, W_b for z [EN12299]. @pre each has
/// a value
[[nodiscard]] double mean_comfort_seated(const std::vector<double>& z_floor, const std::vector<double>& y_pan,
                                         const std::vector<double>& z_pan, const std::vector<double>& x_back);

/// Running root mean square over the last second and vibration dose of a weighted acceleration [ISO2631-1, 6.3].
class VibrationDose {
 public:
  /// @param window of the running rms [s] @param step between samples [s], shorter
  explicit VibrationDose(double step, double window = 1.0);
  void add(double weighted);
  [[nodiscard]] double largest_running_rms() const noexcept { return largest_; }  ///< MTVV [m/s²]; 0 before a second
  [[nodiscard]] double dose() const noexcept;                                     ///< VDV = (∫ a⁴ dt)^¼ [m/s^1.75]

 private:
  double step_, sum_ = 0.0, fourth_ = 0.0, largest_ = 0.0;
  std::vector<double> squares_;  // of the window, in a ring
  std::size_t at_ = 0, filled_ = 0;
};

/// Which of Sperling's weightings.
enum class SperlingDirection { vertical, lateral };
/// Sperling's weighting of an acceleration; f [Hz].
///   B = 0.588 √((1.911 f² + (0.25 f²)²)/((1 − 0.277 f²)² + (1.563 f − 0.0368 f³)²)), lateral 1.25 B        (FM3)
[[nodiscard]] double sperling_weighting(SperlingDirection direction, double frequency) noexcept;

/// Sperling's ride index W_z = (Σ_i (a_i B_i)³)^(1/10) of the amplitudes a_i [cm/s²] of the harmonics of one window
/// after the other, 0.4 to 30 Hz. The sum of cubes depends on the window: 5 s unless said otherwise.
class SperlingIndex {
 public:
  SperlingIndex(SperlingDirection direction, double step, double window = 5.0);
  void add(double acceleration);
  /// Of the windows that are full.
  [[nodiscard]] const std::vector<double>& values() const noexcept { return values_; }

 private:
  struct Line {
    double weight;                       ///< B
    std::complex<double> turn, at, sum;  ///< e^{−iωΔt}, e^{−iωt}, Σ a e^{−iωt}
  };
  void restart();
  std::vector<Line> lines_;
  long samples_, count_ = 0;
  std::vector<double> values_;
};

}  // namespace railtab
