#include "railtab/runtime/moving_load/static_deflection.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "railtab/runtime/moving_load/modal_force.hpp"

namespace railtab {
namespace {

/// Top of |f| near x by parabolas through three points, ever nearer to each other; within [low, high].
double top_near(const std::function<double(double)>& f, double x, double step, double low, double high) {
  constexpr int rounds = 3;
  for (int i = 0; i < rounds; ++i, step *= 0.25) {
    const double left = f(std::max(low, x - step)), middle = f(x), right = f(std::min(high, x + step));
    const double bend = left - 2.0 * middle + right;
    if (bend * middle < 0.0) x = std::clamp(x + std::clamp(0.5 * (left - right) / bend, -1.0, 1.0) * step, low, high);
  }
  return x;
}

}  // namespace

StaticDeflection largest_static_deflection(const ModalDeck& deck, const AxleTrain& train) {
  constexpr int steps_on_deck = 100;
  const double low = train.behind.front(), high = train.behind.back() + deck.length();
  const auto steps = static_cast<long>(std::ceil((high - low) / deck.length() * steps_on_deck));
  const double step = (high - low) / static_cast<double>(steps);
  const auto q = [&](double s) -> Eigen::ArrayXd { return modal_force_at(deck, train, s) / deck.omega.square(); };
  StaticDeflection best;
  Eigen::Index best_point = 0;
  for (long i = 0; i <= steps; ++i) {
    const double s = low + step * static_cast<double>(i);
    Eigen::Index point = 0;
    const double value = (deck.point_shape * q(s).matrix()).cwiseAbs().maxCoeff(&point);
    if (!(value > best.value)) continue;
    best = {value, 0.0, s};
    best_point = point;
  }
  best.x = deck.point_x[static_cast<std::size_t>(best_point)];
  const bool on_line = best_point < deck.points_on_line;
  const auto shape = [&](double x) -> Eigen::ArrayXd {
    return on_line ? deck.shape_at(x) : Eigen::ArrayXd(deck.point_shape.row(best_point).transpose().array());
  };
  constexpr int rounds = 3;
  for (int i = 0; i < rounds; ++i) {
    const Eigen::ArrayXd phi = shape(best.x);
    best.front = top_near([&](double s) { return (q(s) * phi).sum(); }, best.front, step, low, high);
    if (!on_line) break;
    const Eigen::ArrayXd at = q(best.front);
    best.x = top_near([&](double x) { return (at * deck.shape_at(x)).sum(); }, best.x,
                      deck.length() / (deck.points_on_line - 1), 0.0, deck.length());
  }
  best.value = std::max(best.value, std::abs((q(best.front) * shape(best.x)).sum()));
  return best;
}

}  // namespace railtab
