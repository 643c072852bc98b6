#pragma once

#include <Eigen/Core>
#include <functional>
#include <unsupported/Eigen/MatrixFunctions>
#include <utility>
#include <vector>

namespace railtab::testing {

/// ẏ = A y + b
struct Regime {
  Eigen::MatrixXd A;
  Eigen::VectorXd b;
};

/// The exact motion of a system that is linear in each of several regimes, by matrix exponentials from one change of
/// regime to the next.
class PiecewiseLinearMotion {
 public:
  /// @param regime_of which of `regimes` holds at a state, continuous but at the changes
  PiecewiseLinearMotion(std::vector<Regime> regimes, std::function<int(const Eigen::VectorXd&)> regime_of,
                        Eigen::VectorXd start, double time_step)
      : regimes_(std::move(regimes)), regime_of_(std::move(regime_of)), y_(std::move(start)), time_step_(time_step) {
    for (const Regime& regime : regimes_) over_part_.push_back(over(regime, time_step_ / parts));
    regime_ = regime_of_(y_);
  }

  /// By the time step.
  void advance() {
    for (int i = 0; i < parts; ++i) advance_part();
  }
  [[nodiscard]] const Eigen::VectorXd& state() const { return y_; }

 private:
  static constexpr int parts = 4;  // of a time step; no regime is shorter

  static Eigen::MatrixXd over(const Regime& regime, double time) {
    const Eigen::Index n = regime.A.rows();
    Eigen::MatrixXd M = Eigen::MatrixXd::Zero(n + 1, n + 1);
    M.topLeftCorner(n, n) = time * regime.A;
    M.topRightCorner(n, 1) = time * regime.b;
    return M.exp();
  }
  [[nodiscard]] Eigen::VectorXd moved(const Eigen::MatrixXd& by) const {
    return by.topLeftCorner(y_.size(), y_.size()) * y_ + by.topRightCorner(y_.size(), 1);
  }

  void advance_part() {
    double left = time_step_ / parts;
    for (Eigen::VectorXd end = moved(over_part_[static_cast<std::size_t>(regime_)]);;) {
      const int next = regime_of_(end);
      if (next == regime_) {
        y_ = end;
        return;
      }
      const Regime& regime = regimes_[static_cast<std::size_t>(regime_)];
      double before = 0.0, after = left;
      while (after - before > 1e-14 * time_step_) {
        const double middle = 0.5 * (before + after);
        (regime_of_(moved(over(regime, middle))) == regime_ ? before : after) = middle;
      }
      y_ = moved(over(regime, after));
      left -= after;
      regime_ = regime_of_(y_);
      end = moved(over(regimes_[static_cast<std::size_t>(regime_)], left));
    }
  }

  std::vector<Regime> regimes_;
  std::function<int(const Eigen::VectorXd&)> regime_of_;
  std::vector<Eigen::MatrixXd> over_part_;
  Eigen::VectorXd y_;
  double time_step_;
  int regime_ = 0;
};

}  // namespace railtab::testing
