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

/// A piece of ModalForce: forces on the modes that vibrate, and what the others do without inertia.
struct Piece {
  const ModalForce::Cubic* force;
  const ModalForce::Cubic* other = nullptr;  // none after the last axle
  double other_bound = 0.0;
  std::array<ModalForce::Cubic, 2> other_turn{};
};

double value_at(const ModalForce::Cubic& c, double s) noexcept { return c[0] + s * (c[1] + s * (c[2] + s * c[3])); }

/// Deck displacement (order 0) or acceleration (order 2): the largest amount so far and the motion at it.
struct Candidate {
  explicit Candidate(int derivative) : order(derivative) {}
  int order;
  double value = 0.0, start = 0.0, tau = 0.0;  // start [s] of the piece
  int point = 0;
  std::vector<ModalMotion> motion;
  const ModalForce::Cubic* other = nullptr;  // of the other modes, with a displacement
  double duration = 0.0;                     // of the piece [s], beyond which `other` does not hold
};

class Passage {
 public:
  Passage(const ModalDeck& deck, double speed) : deck_(deck), speed_(speed), modes_(deck.dynamic_modes) {
    for (int n = 0; n < modes_; ++n) motion_.emplace_back(deck.omega[n], deck.damping[n]);
    q_.setZero(modes_);
    dq_.setZero(modes_);
    a_.setZero(modes_);
    other_q_.setZero(deck.modes() - modes_);
    factor_.resize(static_cast<std::size_t>(modes_));
    jumps_ = has_free_end(deck);
    for (std::size_t e = 0; e < ends; ++e) {
      end_slope_[e] = deck.shape_at(e == 0 ? 0.0 : deck.length(), 1).head(modes_).matrix();
    }
    longest_step_ = 2.0 * pi / deck.omega[modes_ - 1] / (jumps_ ? samples_with_jumps : samples_per_period);
  }

  /// Through one piece, from `start` on and `duration` [s] long.
  void advance(const Piece& piece, double start, double duration) {
    duration_ = duration;
    const int steps = std::max(1, static_cast<int>(std::ceil(duration / longest_step_)));
    const double step = duration / steps;
    for (int n = 0; n < modes_; ++n) {
      motion_[index(n)].begin(q_[n], dq_[n], piece.force[n], speed_);
      factor_[index(n)] = motion_[index(n)].factor(step);
      a_[n] = motion_[index(n)].acceleration();
    }
    if (jumps_) look(a_, nullptr, 0.0, start, 0.0, acceleration_);
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
      look_at_ends(piece, start, tau);
      if (bound_w + piece.other_bound > near_peak * displacement_.value) {
        look(q_, piece.other, piece.other_bound, start, tau, displacement_);
      }
      if (bound_a > near_peak * acceleration_.value) look(a_, nullptr, 0.0, start, tau, acceleration_);
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

  [[nodiscard]] DeckPeak acceleration() const { return top(acceleration_); }
  [[nodiscard]] DeckPeak displacement() const { return top(displacement_); }
  [[nodiscard]] const DeckPeak& end_rotation() const { return end_rotation_; }

 private:
  static std::size_t index(int n) { return static_cast<std::size_t>(n); }

  void look_at_ends(const Piece& piece, double start, double tau) {
    for (std::size_t e = 0; e < ends; ++e) {
      const double rotation = std::abs(end_slope_[e].dot(q_) + value_at(piece.other_turn[e], speed_ * tau));
      if (rotation > end_rotation_.value) end_rotation_ = {rotation, e == 0 ? 0.0 : deck_.length(), start + tau};
    }
  }

  /// Adds what the other modes do at points where the sum may come near to the candidate.
  void add_others(const ModalForce::Cubic* other, double bound, double tau, const Candidate& best) {
    const double least = near_peak * best.value - bound;
    if (!(at_points_.cwiseAbs().maxCoeff() > least)) return;
    for (Eigen::Index k = 0; k < other_q_.size(); ++k) other_q_[k] = value_at(other[k], speed_ * tau);
    for (Eigen::Index i = 0; i < at_points_.size(); ++i) {
      if (!(std::abs(at_points_[i]) > least)) continue;
      at_points_[i] += deck_.point_shape.row(i).tail(other_q_.size()).dot(other_q_);
    }
  }

  /// q and its first two derivatives by time of a mode without inertia.
  [[nodiscard]] std::array<double, 3> other_motion(const ModalForce::Cubic& c, double tau) const noexcept {
    const double s = speed_ * tau;
    return {value_at(c, s), speed_ * (c[1] + s * (2.0 * c[2] + 3.0 * s * c[3])),
            speed_ * speed_ * (2.0 * c[2] + 6.0 * s * c[3])};
  }

  /// Looks at all points for a motion higher than the candidate, by a step of Newton's to the top beside the sample.
  /// @param other of the other modes, their sum nowhere above `bound`; nullptr: none
  void look(const Eigen::VectorXd& mode_values, const ModalForce::Cubic* other, double bound, double start, double tau,
            Candidate& best) {
    at_points_.noalias() = deck_.point_shape.leftCols(modes_) * mode_values;
    if (other) add_others(other, bound, tau, best);
    Eigen::Index point = 0;
    const double sample = at_points_.cwiseAbs().maxCoeff(&point);
    if (!(sample > near_peak * best.value)) return;
    double u[3] = {0.0, 0.0, 0.0};
    for (Eigen::Index k = 0; other && k < other_q_.size(); ++k) {
      const std::array<double, 3> q = other_motion(other[k], tau);
      for (std::size_t j = 0; j < 3; ++j) u[j] += deck_.point_shape(point, modes_ + k) * q[j];
    }
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
    best.other = other;
    best.duration = duration_;
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
    for (Eigen::Index k = 0; best.other && k < other_q_.size(); ++k) {
      const Eigen::Index n = modes_ + k;
      const std::array<double, 3> q = other_motion(best.other[k], best.tau + ahead);
      sum.u += phi[n] * q[0];
      sum.t += phi[n] * q[1];
      sum.tt += phi[n] * q[2];
      sum.x += on_line ? slope[n] * q[0] : 0.0;
      sum.xx += bend[n] * q[0];
    }
    return sum;
  }

  [[nodiscard]] Eigen::ArrayXd line_or_point(const Candidate& best, double x) const {
    if (best.point < deck_.points_on_line) return deck_.shape_at(x);
    return deck_.point_shape.row(best.point).transpose().array();
  }

  /// Newton iteration in time and place in turn, within a step and an interval about the sample.
  [[nodiscard]] DeckPeak top(const Candidate& best) const {
    if (best.motion.empty()) return {};
    constexpr int rounds = 6;
    const double x0 = deck_.point_x[index(best.point)], interval = deck_.length() / (deck_.points_on_line - 1);
    double ahead = 0.0, x = x0;
    const double earliest = best.other ? std::max(-longest_step_, -best.tau) : -longest_step_;
    const double latest = best.other ? std::min(longest_step_, best.duration - best.tau) : longest_step_;
    const Local sample = local(best, ahead, x);
    Local at = sample;
    for (int i = 0; i < rounds; ++i) {
      if (!jumps_ && at.u * at.tt < 0.0) ahead = std::clamp(ahead - at.t / at.tt, earliest, latest);
      at = local(best, ahead, x);
      if (at.u * at.xx < 0.0) {
        x = std::clamp(x - at.x / at.xx, std::max(0.0, x0 - interval), std::min(deck_.length(), x0 + interval));
      }
      at = local(best, ahead, x);
    }
    if (std::abs(sample.u) > std::abs(at.u)) return {std::abs(sample.u), x0, best.start + best.tau};
    return {std::abs(at.u), x, best.start + best.tau + ahead};
  }

  const ModalDeck& deck_;
  double speed_, longest_step_ = 0.0, duration_ = 0.0;  // duration_: of the present piece [s]
  bool jumps_ = false;
  int modes_;
  std::vector<ModalMotion> motion_;
  std::vector<std::complex<double>> factor_;
  Eigen::VectorXd q_, dq_, a_, other_q_, at_points_;
  Candidate displacement_{0}, acceleration_{2};
  static constexpr std::size_t ends = 2;
  std::array<Eigen::VectorXd, ends> end_slope_;  // of the modes that vibrate, at x = 0 and at the deck's length
  DeckPeak end_rotation_;
};

}  // namespace

PassagePeaks train_passage(const ModalDeck& deck, const ModalForce& force, double speed) {
  Passage passage(deck, speed);
  const auto modes = static_cast<std::size_t>(force.modes), others = static_cast<std::size_t>(force.others);
  for (std::size_t p = 0; p < force.pieces(); ++p) {
    passage.advance(
        {&force.cubic[p * modes], force.other.data() + p * others, force.other_bound[p], force.other_turn[p]},
        force.start[p] / speed, (force.start[p + 1] - force.start[p]) / speed);
  }
  constexpr int most_periods = 50;  // of the first mode: without damping the envelope may never fall
  const std::vector<ModalForce::Cubic> none(modes, {0.0, 0.0, 0.0, 0.0});
  const double period = 2.0 * pi / deck.omega[0];
  for (int i = 0; i < most_periods && !passage.decided(); ++i) {
    passage.advance({none.data()}, force.start.back() / speed + i * period, period);
  }
  return {speed, passage.acceleration(), passage.displacement(), passage.end_rotation()};
}

}  // namespace railtab
