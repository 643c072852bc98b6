#include "railtab/runtime/moving_load/modal_deck.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/interval_search.hpp"
#include "railtab/runtime/moving_load/deck_modes.hpp"
#include "railtab/runtime/structure/beam_element.hpp"

namespace railtab {
namespace {

using std::numbers::pi;

/// All [Hz].
double cut_off_frequency(double first, double third) noexcept {
  constexpr double least = 30.0;
  return std::max({least, 1.5 * first, third});
}

}  // namespace

bool has_free_end(const ModalDeck& deck) {
  constexpr double rounding = 1e-6;
  for (const double x : {0.0, deck.length()}) {
    if ((deck.shape_at(x).abs() > rounding * deck.largest_shape).head(deck.dynamic_modes).any()) return true;
  }
  return false;
}

double sudden_acceleration(const ModalDeck& deck, double x) {
  const Eigen::ArrayXd here = deck.shape_at(x);
  double largest = 0.0;
  for (const double end : {0.0, deck.length()}) {
    largest = std::max(largest, std::abs((here * deck.shape_at(end)).head(deck.dynamic_modes).sum()));
  }
  return largest;
}

std::size_t element_at(const ModalDeck& deck, double x) noexcept {
  return interval_at(deck.knots, std::clamp(x, 0.0, deck.length()));
}

Eigen::ArrayXd ModalDeck::shape_at(double x, int derivative) const {
  const std::size_t e = element_at(*this, x);
  const Cubics& c = shape[e];
  const double u = x - knots[e];
  if (derivative == 0) return c.col(0) + u * (c.col(1) + u * (c.col(2) + u * c.col(3)));
  if (derivative == 1) return c.col(1) + u * (2.0 * c.col(2) + 3.0 * u * c.col(3));
  return 2.0 * c.col(2) + 6.0 * u * c.col(3);
}

double ModalDeck::cut_off() const noexcept {
  return cut_off_frequency(frequency(first_bending), frequency(third_bending));
}

std::string doubtful_cut_off(const ModalDeck& deck) {
  if (!deck.third_bending_unknown) return {};
  return fmt::format(
      "f3, the third bending mode of deck {}, is not among its {} modes up to {:.4g} Hz: accelerations are those of "
      "modes up to {:.4g} Hz, while all up to the greatest of 30 Hz, 1.5 f1 and f3 are expected",
      deck.name, deck.known_modes, deck.frequency(deck.known_modes - 1), deck.cut_off());
}

BendingModes bending_modes(const Eigen::ArrayXd& share) {
  constexpr double least = 1.0 / 3.0;
  BendingModes result;
  for (int mode = 0; mode < share.size() && result.found < 3; ++mode) {
    if (!(share[mode] >= least)) continue;
    if (++result.found == 1) result.first = mode;
    result.third = mode;
  }
  return result;
}

int count_dynamic_modes(const Eigen::ArrayXd& omega, const BendingModes& bending, const DynamicModes& modes) {
  if (modes.count > 0) return std::min(modes.count, static_cast<int>(omega.size()));
  const double limit =
      2.0 * pi * (1.0 + 1e-9) * cut_off_frequency(omega[bending.first] / (2.0 * pi), omega[bending.third] / (2.0 * pi));
  return static_cast<int>((omega <= limit).count());
}

void set_points(int intervals, const Eigen::MatrixXd& other_shapes, const std::vector<double>& other_x,
                ModalDeck& deck) {
  deck.points_on_line = intervals + 1;
  deck.point_shape.resize(intervals + 1 + other_shapes.rows(), deck.modes());
  for (int i = 0; i <= intervals; ++i) {
    deck.point_x.push_back(deck.length() * i / intervals);
    deck.point_shape.row(i) = deck.shape_at(deck.point_x.back()).matrix().transpose();
  }
  deck.point_shape.bottomRows(other_shapes.rows()) = other_shapes;
  deck.point_x.insert(deck.point_x.end(), other_x.begin(), other_x.end());
  deck.largest_shape = deck.point_shape.cwiseAbs().colwise().maxCoeff().transpose();
}

namespace {

struct SineMode {
  double omega;      ///< [rad/s]
  int half_waves;    ///< n of sin(nπx/L)
  double amplitude;  ///< under the track [kg^-1/2]
  bool bends;
};

/// Twist of the span between supports that hold it, under a track beside its axis: at rest a load P deflects the track
/// by P e² x(L − x)/(GJ L), of which the modes that are left out have less than 1 %.
void add_torsion(const BridgeParameters& span, std::vector<SineMode>& sines) {
  constexpr int count = 64;
  if (span.track_offset == 0.0) return;
  const double first = pi / span.length * std::sqrt(span.G * span.J / span.rotary_inertia);
  const double amplitude = std::abs(span.track_offset) * std::sqrt(2.0 / (span.rotary_inertia * span.length));
  for (int n = 1; n <= count; ++n) sines.push_back({first * n, n, amplitude, false});
}

}  // namespace

ModalDeck simply_supported_deck(const BridgeParameters& span, const DynamicModes& modes) {
  span.validate();
  BeamSection section;
  section.E = span.E;
  section.Iy = span.Iy;
  section.mass = span.mass;
  const double first = simply_supported_frequency(section, span.length, 1);  // the n-th is n² times it
  constexpr int least = 25, most = 100;
  ModalDeck deck;
  const auto by_cut_off = static_cast<int>(
      std::sqrt(cut_off_frequency(first / (2.0 * pi), 9.0 * first / (2.0 * pi)) * 2.0 * pi / first) + 1.0);
  if (by_cut_off > most) {
    throw input_error("bridge", fmt::format("a first natural frequency of {:.4g} Hz", first / (2.0 * pi)),
                      fmt::format("at most {} modes below 30 Hz: see length, mass and bending stiffness", most));
  }
  std::vector<SineMode> sines;
  for (int n = 1; n <= std::max({least, modes.count, by_cut_off}); ++n) {
    sines.push_back({first * n * n, n, std::sqrt(2.0 / (span.mass * span.length)), true});
  }
  add_torsion(span, sines);
  std::stable_sort(sines.begin(), sines.end(), [](const SineMode& a, const SineMode& b) { return a.omega < b.omega; });
  const auto count = static_cast<Eigen::Index>(sines.size());
  deck.known_modes = static_cast<int>(count);
  Eigen::ArrayXd n(count), amplitude(count);
  deck.omega.resize(count);
  for (Eigen::Index mode = 0; mode < count; ++mode) {
    const SineMode& sine = sines[static_cast<std::size_t>(mode)];
    deck.omega[mode] = sine.omega;
    n[mode] = sine.half_waves;
    amplitude[mode] = sine.amplitude;
    if (sine.bends && sine.half_waves == 1) deck.first_bending = static_cast<int>(mode);
    if (sine.bends && sine.half_waves == 3) deck.third_bending = static_cast<int>(mode);
  }
  deck.damping = Eigen::ArrayXd::Constant(count, span.damping_ratio);
  deck.dynamic_modes = count_dynamic_modes(deck.omega, {deck.first_bending, deck.third_bending, 3}, modes);
  const int of_shortest = 2 * static_cast<int>(n.maxCoeff());
  const int of_dynamic = static_cast<int>(n.head(deck.dynamic_modes).maxCoeff());
  const int elements = std::max(of_shortest, 16 * std::max(3, of_dynamic));
  const double h = span.length / elements;
  for (int e = 0; e < elements; ++e) {
    const double x = h * e;
    deck.knots.push_back(x);
    const Eigen::ArrayXd k = n * (pi / span.length);
    const Eigen::ArrayXd a = amplitude * (k * x).sin(), b = amplitude * (k * (x + h)).sin();
    const Eigen::ArrayXd slope_a = amplitude * k * (k * x).cos(), slope_b = amplitude * k * (k * (x + h)).cos();
    ModalDeck::Cubics c(count, 4);
    c << a, slope_a, (3.0 * (b - a) / h - 2.0 * slope_a - slope_b) / h,
        (2.0 * (a - b) / h + slope_a + slope_b) / (h * h);
    deck.shape.push_back(std::move(c));
  }
  deck.knots.push_back(span.length);
  set_points(std::max(20, 8 * of_dynamic), Eigen::MatrixXd(0, count), {}, deck);
  return deck;
}

}  // namespace railtab
