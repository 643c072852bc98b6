#include "railtab/runtime/moving_load/train_passage.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "railtab/runtime/moving_load/modal_motion.hpp"

namespace railtab {
namespace {

using std::numbers::pi;
/// In the shortest period; on a deck with a free end, where accelerations jump, peaks are those of the samples.
constexpr double samples_per_period = 16.0, samples_with_jumps = 64.0;
/// A sample this near to the best peak may belong to a higher one: between samples a motion of the shortest period
/// rises by (π/16)²/2, 2 %.
constexpr double near_peak = 0.97;

/// Deck displacement (order 0) or acceleration (order 2): the largest amount so far and the motion at it.
struct Candidate {
  explicit Candidate(int derivative) : order(derivative) {}
  int order;
  double value = 0.0, start = 0.0, tau = 0.0;  // start [s] of the piece
  int point = 0;
  std::vector<ModalMotion> motion;
};

class Passage {
 public:
  Passage(const ModalDeck& deck, double speed) : deck_(deck), speed_(speed), modes_(deck.dynamic_modes) {
    for (int n = 0; n < modes_; ++n) motion_.emplace_back(deck.omega[n], deck.damping[n]);
    q_.setZero(modes_);
    dq_.setZero(modes_);
    a_.setZero(modes_);
    factor_.resize(static_cast<std::size_t>(modes_));
    jumps_ = has_free_end(deck);
    for (std::size_t e = 0; e < ends; ++e) {
      end_slope_[e] = deck.shape_at(e == 0 ? 0.0 : deck.length(), 1).head(modes_).matrix();
    }
    longest_step_ = 2.0 * pi / deck.omega[modes_ - 1] / (jumps_ ? samples_with_jumps : samples_per_period);
  }

  /// Through one piece, from `start` on and `duration` [s] long.
  void advance(const ModalForce::Cubic* force, double start, double duration) {
    const int steps = std::max(1, static_cast<int>(std::ceil(duration / longest_step_)));
    const double step = duration / steps;
    for (int n = 0; n < modes_; ++n) {
      motion_[index(n)].begin(q_[n], dq_[n], force[n], speed_);
      factor_[index(n)] = motion_[index(n)].factor(step);
      a_[n] = motion_[index(n)].acceleration();
    }
    if (jumps_) look(a_, start, 0.0, acceleration_);
    for (int i = 1; i <= steps; ++i) {
      const double tau = step * i;
      double bound_w = 0.0, bound_a = 0.0;
      for (int n = 0; n < modes_; ++n) {
        ModalMotion& mode = motion_[index(n)];
        mode.move(tau, factor_[index(n)]);
        q_[n] = mode.q();
        a_[n] = mode.acceleration();
        bound_w += std::abs(q_[n]) * deck_.largest_shape[n];
        bound_a += std::abs(a_[n]) * deck_.largest_shape[n];
      }
      look_at_ends(start + tau);
      if (bound_w > near_peak * displacement_.value) look(q_, start, tau, displacement_);
      if (bound_a > near_peak * acceleration_.value) look(a_, start, tau, acceleration_);
    }
    for (int n = 0; n < modes_; ++n) dq_[n] = motion_[index(n)].velocity();
  }

  /// Whether no later free vibration can exceed the peaks.
  [[nodiscard]] bool decided() const {
    double w = 0.0, a = 0.0, r = 0.0;
    for (int n = 0; n < modes_; ++n) {
      const double free = std::abs(motion_[index(n)].free_part()), amplitude = free * deck_.largest_shape[n];
      w += amplitude;
      a += amplitude * deck_.omega[n] * deck_.omega[n];
      r += free * std::max(std::abs(end_slope_[0][n]), std::abs(end_slope_[1][n]));
    }
    return w <= displacement_.value && a <= acceleration_.value && r <= end_rotation_.value;
  }

  [[nodiscard]] DeckPeak acceleration() const { return top(acceleration_, nullptr); }
  [[nodiscard]] DeckPeak displacement(const AxleTrain& train) const { return top(displacement_, &train); }
  /// With what the modes beyond the dynamic ones add at that time.
  [[nodiscard]] DeckPeak end_rotation(const AxleTrain& train) const {
    const int others = deck_.modes() - modes_;
    if (others == 0 || end_rotation_.value == 0.0) return end_rotation_;
    const Eigen::ArrayXd q = modal_force_at(deck_, train, speed_ * end_rotation_.time) / deck_.omega.square();
    const double added = (q * deck_.shape_at(end_rotation_.x, 1)).tail(others).sum();
    return {std::abs(std::copysign(end_rotation_.value, end_sign_) + added), end_rotation_.x, end_rotation_.time};
  }

 private:
  static std::size_t index(int n) { return static_cast<std::size_t>(n); }

  void look_at_ends(double time) {
    for (std::size_t e = 0; e < ends; ++e) {
      const double rotation = end_slope_[e].dot(q_);
      if (!(std::abs(rotation) > end_rotation_.value)) continue;
      end_rotation_ = {std::abs(rotation), e == 0 ? 0.0 : deck_.length(), time};
      end_sign_ = rotation;
    }
  }

  /// Looks at all points for a motion higher than the candidate, by a step of Newton's to the top beside the sample.
  void look(const Eigen::VectorXd& mode_values, double start, double tau, Candidate& best) {
    at_points_.noalias() = deck_.point_shape.leftCols(modes_) * mode_values;
    Eigen::Index point = 0;
    const double sample = at_points_.cwiseAbs().maxCoeff(&point);
    if (!(sample > near_peak * best.value)) return;
    double u[3] = {0.0, 0.0, 0.0};
    for (int n = 0; n < modes_; ++n) {
      const std::array<double, 5> q = motion_[index(n)].derivatives(0.0);
      for (int k = 0; k < 3; ++k) u[k] += deck_.point_shape(point, n) * q[index(best.order + k)];
    }
    const bool beside_top = !jumps_ && u[0] * u[2] < 0.0 && std::abs(u[1]) <= longest_step_ * std::abs(u[2]);
    const double value = beside_top ? std::abs(u[0] - 0.5 * u[1] * u[1] / u[2]) : sample;
    if (!(value > best.value)) return;
    best.value = value;
    best.start = start;
    best.tau = tau;
    best.point = static_cast<int>(point);
    best.motion = motion_;
  }

  /// The candidate's motion u and its derivatives: ∂u/∂t, ∂²u/∂t², ∂u/∂x, ∂²u/∂x².
  struct Local {
    double u = 0.0, t = 0.0, tt = 0.0, x = 0.0, xx = 0.0;
  };
  [[nodiscard]] Local local(const Candidate& best, double ahead, double x) const {
    const bool on_line = best.point < deck_.points_on_line;
    const Eigen::ArrayXd phi = line_or_point(best, x);
    const Eigen::ArrayXd slope = deck_.shape_at(x, 1), bend = deck_.shape_at(x, 2);
    Local sum;
    for (int n = 0; n < modes_; ++n) {
      const std::array<double, 5> q = best.motion[index(n)].derivatives(ahead);
      sum.u += phi[n] * q[index(best.order)];
      sum.t += phi[n] * q[index(best.order + 1)];
      sum.tt += phi[n] * q[index(best.order + 2)];
      sum.x += on_line ? slope[n] * q[index(best.order)] : 0.0;
      sum.xx += bend[n] * q[index(best.order)];
    }
    return sum;
  }

  [[nodiscard]] Eigen::ArrayXd line_or_point(const Candidate& best, double x) const {
    if (best.point < deck_.points_on_line) return deck_.shape_at(x);
    return deck_.point_shape.row(best.point).transpose().array();
  }

  /// Newton iteration in time and place in turn, within a step and an interval about the sample.
  [[nodiscard]] DeckPeak top(const Candidate& best, const AxleTrain* train) const {
    if (best.motion.empty()) return {};
    constexpr int rounds = 6;
    const double x0 = deck_.point_x[index(best.point)], interval = deck_.length() / (deck_.points_on_line - 1);
    double ahead = 0.0, x = x0;
    Local at = local(best, ahead, x);
    for (int i = 0; i < rounds; ++i) {
      if (!jumps_ && at.u * at.tt < 0.0) ahead = std::clamp(ahead - at.t / at.tt, -longest_step_, longest_step_);
      at = local(best, ahead, x);
      if (at.u * at.xx < 0.0) {
        x = std::clamp(x - at.x / at.xx, std::max(0.0, x0 - interval), std::min(deck_.length(), x0 + interval));
      }
      at = local(best, ahead, x);
    }
    const double time = best.start + best.tau + ahead;
    return {std::abs(at.u + (train ? without_inertia(*train, speed_ * time, best, x) : 0.0)), x, time};
  }

  /// What the modes beyond the dynamic ones add to the displacement.
  [[nodiscard]] double without_inertia(const AxleTrain& train, double s, const Candidate& best, double x) const {
    const int others = deck_.modes() - modes_;
    if (others == 0) return 0.0;
    const Eigen::ArrayXd q = modal_force_at(deck_, train, s) / deck_.omega.square();
    return (q * line_or_point(best, x)).tail(others).sum();
  }

  const ModalDeck& deck_;
  double speed_, longest_step_ = 0.0;
  bool jumps_ = false;
  int modes_;
  std::vector<ModalMotion> motion_;
  std::vector<std::complex<double>> factor_;
  Eigen::VectorXd q_, dq_, a_, at_points_;
  Candidate displacement_{0}, acceleration_{2};
  static constexpr std::size_t ends = 2;
  std::array<Eigen::VectorXd, ends> end_slope_;  // of the modes that vibrate, at x = 0 and at the deck's length
  DeckPeak end_rotation_;
  double end_sign_ = 1.0;
};

}  // namespace

PassagePeaks train_passage(const ModalDeck& deck, const AxleTrain& train, const ModalForce& force, double speed) {
  Passage passage(deck, speed);
  const auto modes = static_cast<std::size_t>(force.modes);
  for (std::size_t p = 0; p < force.pieces(); ++p) {
    passage.advance(&force.cubic[p * modes], force.start[p] / speed, (force.start[p + 1] - force.start[p]) / speed);
  }
  constexpr int most_periods = 50;  // of the first mode: without damping the envelope may never fall
  const std::vector<ModalForce::Cubic> none(modes, {0.0, 0.0, 0.0, 0.0});
  const double period = 2.0 * pi / deck.omega[0];
  for (int i = 0; i < most_periods && !passage.decided(); ++i) {
    passage.advance(none.data(), force.start.back() / speed + i * period, period);
  }
  return {speed, passage.acceleration(), passage.displacement(train), passage.end_rotation(train)};
}

}  // namespace railtab
