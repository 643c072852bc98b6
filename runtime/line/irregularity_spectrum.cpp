#include "railtab/runtime/line/irregularity_spectrum.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/parameter_range.hpp"
#include "railtab/runtime/base/smooth_step.hpp"

namespace railtab {

namespace {

constexpr double band = 2.0 * std::numbers::pi / 2000.0;  // ΔΩ [rad/m]: the resolution of 2 km of track
constexpr double points_per_wave = 12.0;                  // of the shortest wave: a spline follows it to 1e-3

double square(double x) { return x * x; }

// [ERRI B 176]: Ωr, Ωc, Ωs [rad/m]; A_v, A_a, A_g [m² rad/m]
TrackSpectrum german(double omega, double half_base, double Av, double Aa, double Ag) {
  constexpr double Or = 0.0206, Oc = 0.8246, Os = 0.4380;
  const double O2 = omega * omega, shape = Oc * Oc / ((O2 + Or * Or) * (O2 + Oc * Oc));
  return {Av * shape, Aa * shape, Av / square(half_base) * shape * O2 / (O2 + Os * Os),
          Ag * shape * O2 / (O2 + Os * Os)};
}

struct FraClass {
  double Av, Aa, Os;  // [cm² rad/m], [cm² rad/m], [rad/m]
};

TrackSpectrum fra(double omega, double half_base, const FraClass& c) {
  constexpr double k = 0.25, Oc = 0.8245, cm2 = 1e-4;
  const double O2 = omega * omega, shape = cm2 * k * Oc * Oc / (O2 * (O2 + Oc * Oc));
  // Cross level and gauge share a density; as an angle, cross level is over the rails' distance.
  const double both = 4.0 * cm2 * k * c.Av * Oc * Oc / ((O2 + Oc * Oc) * (O2 + c.Os * c.Os));
  return {c.Av * shape, c.Aa * shape, both / square(2.0 * half_base), both};
}

/// Uniform in [0, 1): the same on every machine.
class Random {
 public:
  explicit Random(int seed) : generator_(static_cast<std::uint64_t>(seed)) {}
  double operator()() { return static_cast<double>(generator_() >> 11U) * 0x1p-53; }

 private:
  std::mt19937_64 generator_;
};

constexpr std::size_t together = 8;  // points that a wave is added to at once

// values += amplitude·cos(ω x + φ) at evenly spaced x, by turning on from some points to the next.
// @param values as many as x has, filled up to whole numbers of `together`
void add_wave(double amplitude, double omega, double phase, const std::vector<double>& x, std::vector<double>& values) {
  constexpr std::size_t stretch = 256;  // points, over which rounding stays below 1e-13
  static_assert(stretch % together == 0);
  using Points = Eigen::Array<double, together, 1>;
  const Points turn = Points::LinSpaced(0.0, together - 1.0) * (omega * (x[1] - x[0]));
  const Points cosines = turn.cos(), sines = turn.sin();
  const double next = static_cast<double>(together) * omega * (x[1] - x[0]);
  const double next_cos = std::cos(next), next_sin = std::sin(next);
  for (std::size_t begin = 0; begin < x.size(); begin += stretch) {
    const double at = omega * x[begin] + phase, first_cos = amplitude * std::cos(at),
                 first_sin = amplitude * std::sin(at);
    Points c = first_cos * cosines - first_sin * sines, s = first_sin * cosines + first_cos * sines;
    for (std::size_t i = begin; i < std::min(values.size(), begin + stretch); i += together) {
      Points::Map(&values[i]) += c;
      const Points turned = c * next_cos - s * next_sin;
      s = s * next_cos + c * next_sin;
      c = turned;
    }
  }
}

}  // namespace

std::vector<std::string> spectrum_names() { return {"german-low", "german-high", "fra-4", "fra-5", "fra-6"}; }

TrackSpectrum track_spectrum(const std::string& name, double omega, double half_base) noexcept {
  if (name == "german-high") return german(omega, half_base, 1.080e-6, 6.125e-7, 1.032e-7);
  if (name == "fra-4") return fra(omega, half_base, {0.5376, 0.3027, 1.1312});
  if (name == "fra-5") return fra(omega, half_base, {0.2095, 0.0762, 0.8209});
  if (name == "fra-6") return fra(omega, half_base, {0.0339, 0.0339, 0.4380});
  return german(omega, half_base, 4.032e-7, 2.119e-7, 5.32e-8);
}

void SpectrumParameters::validate() const {
  const std::vector<std::string> names = spectrum_names();
  if (std::find(names.begin(), names.end(), name) == names.end()) {
    throw input_error("irregularity.spectrum", name, fmt::format("one of {}", fmt::join(names, ", ")));
  }
  require_between("irregularity.seed", seed, 0, 1e9, "-");
  require_between("irregularity.shortest_wave", shortest, 0.1, 500.0, "m");
  require_between("irregularity.longest_wave", longest, 0.1, 500.0, "m");
  if (!(longest > shortest)) {
    throw input_error("irregularity.longest_wave",
                      fmt::format("{} m with irregularity.shortest_wave = {} m", longest, shortest),
                      "more than the shortest");
  }
  require_between("irregularity.fade_in", fade_length(), 0.0, 1e4, "m");
  require_positive("irregularity: half the distance of the rail heads", half_base, "m");
}

Irregularity random_irregularity(const SpectrumParameters& parameters, double from, double to,
                                 std::optional<double> fade_from) {
  parameters.validate();
  const double low = 2.0 * std::numbers::pi / parameters.longest, high = 2.0 * std::numbers::pi / parameters.shortest;
  const int bands = std::max(1, static_cast<int>(std::ceil((high - low) / band)));
  const double width = (high - low) / bands;
  const double spacing = parameters.shortest / points_per_wave;
  constexpr double most = 5e7;  // points: 13 GB while they are computed
  if (!(std::abs(to - from) / spacing <= most)) {
    throw input_error(
        "scene: irregularity.spectrum",
        fmt::format("{:.3g} m of track with waves from {} m", to - from, parameters.shortest),
        fmt::format("at most {:.3g} m of it (a shorter run, or a longer irregularity.shortest_wave)", most * spacing));
  }
  // Points at whole multiples of the spacing: what stands between them does not depend on the ends either.
  const auto first = static_cast<long>(std::floor(from / spacing)) - 2,
             last = static_cast<long>(std::ceil(to / spacing)) + 2;
  const auto points = static_cast<std::size_t>(last - first + 1);
  std::vector<double> x(points);
  for (std::size_t i = 0; i < points; ++i) x[i] = static_cast<double>(first + static_cast<long>(i)) * spacing;
  std::array<std::vector<double>, 4> sum;  // vertical, alignment, cross level, gauge
  for (std::vector<double>& values : sum) values.assign((points + together - 1) / together * together, 0.0);
  Random random(parameters.seed);
  for (int n = 0; n < bands; ++n) {
    const double omega = low + (n + random()) * width;
    const TrackSpectrum S = track_spectrum(parameters.name, omega, parameters.half_base);
    const std::array<double, 4> densities{S.vertical, S.alignment, S.cross_level, S.gauge};
    for (std::size_t c = 0; c < sum.size(); ++c) {
      const double amplitude = std::sqrt(2.0 * densities[c] * width), phase = 2.0 * std::numbers::pi * random();
      add_wave(amplitude, omega, phase, x, sum[c]);
    }
  }
  std::array<std::vector<double>, 4> rails;  // y_left, z_left, y_right, z_right
  for (std::vector<double>& values : rails) values.resize(points);
  for (std::size_t i = 0; i < points; ++i) {
    const double tilt = parameters.half_base * sum[2][i];
    rails[0][i] = sum[1][i] - 0.5 * sum[3][i];
    rails[1][i] = sum[0][i] - tilt;
    rails[2][i] = sum[1][i] + 0.5 * sum[3][i];
    rails[3][i] = sum[0][i] + tilt;
    if (!fade_from || !(parameters.fade_length() > 0.0)) continue;
    for (std::vector<double>& values : rails) values[i] *= smooth_step((x[i] - *fade_from) / parameters.fade_length());
  }
  return Irregularity(std::move(x), std::move(rails[0]), std::move(rails[1]), std::move(rails[2]), std::move(rails[3]));
}

}  // namespace railtab
