#include "railtab/runtime/moving_load/modal_force.hpp"

#include <algorithm>
#include <cmath>

namespace railtab {
namespace {

/// Both ends of the deck and the knots at which a dynamic mode's value or slope jumps, as at joints between spans.
std::vector<double> kinks(const ModalDeck& deck) {
  constexpr double smooth = 1e-3;  // of the largest slope, times the element's length for values
  const auto modes = static_cast<Eigen::Index>(deck.dynamic_modes);
  double steepest = 0.0;
  for (const ModalDeck::Cubics& c : deck.shape) steepest = std::max(steepest, c.col(1).head(modes).abs().maxCoeff());
  std::vector<double> found{0.0};
  for (std::size_t e = 1; e < deck.shape.size(); ++e) {
    const ModalDeck::Cubics &before = deck.shape[e - 1], &after = deck.shape[e];
    const double h = deck.knots[e] - deck.knots[e - 1];
    const Eigen::ArrayXd value = before.col(0) + h * (before.col(1) + h * (before.col(2) + h * before.col(3)));
    const Eigen::ArrayXd slope = before.col(1) + h * (2.0 * before.col(2) + 3.0 * h * before.col(3));
    const double jump = (value - after.col(0)).head(modes).abs().maxCoeff() / h;
    const double turn = (slope - after.col(1)).head(modes).abs().maxCoeff();
    if (std::max(jump, turn) > smooth * steepest) found.push_back(deck.knots[e]);
  }
  found.push_back(deck.length());
  return found;
}

/// Where pieces begin: at axles on kinks, those that lengths in files leave side by side being one, and evenly between
/// them. The cubic of a piece of length h has the rounding of its values over h³.
std::vector<double> piece_starts(const ModalDeck& deck, const AxleTrain& train) {
  std::vector<double> events;
  for (const double kink : kinks(deck)) {
    for (const double behind : train.behind) events.push_back(behind + kink);
  }
  std::sort(events.begin(), events.end());
  const double longest = deck.length() / static_cast<double>(deck.shape.size());
  const double rounding = std::max(1e-6 * longest, 1e-12 * (events.back() - events.front()));
  std::vector<double> starts{events.front()};
  for (const double event : events) {
    const double from = starts.back(), gap = event - from;
    if (gap <= rounding) continue;
    const int parts = std::max(1, static_cast<int>(std::ceil(gap / longest)));
    for (int i = 1; i < parts; ++i) starts.push_back(from + gap * i / parts);
    starts.push_back(event);
  }
  return starts;
}

/// The cubic over a length h with values and slopes at both ends.
ModalForce::Cubic hermite(double f0, double d0, double f1, double d1, double h) {
  const double rise = (f1 - f0) / h;
  return {f0, d0, (3.0 * rise - 2.0 * d0 - d1) / h, (d0 + d1 - 2.0 * rise) / (h * h)};
}

/// Adds P·φ_n and P·dφ_n/dx at x, by the element that holds `inside`, which is x but for rounding.
void add_axle(const ModalDeck& deck, double x, double inside, double load, std::vector<double>& value,
              std::vector<double>& slope) {
  const std::size_t element = element_at(deck, inside);
  const ModalDeck::Cubics& shape = deck.shape[element];
  const double u = x - deck.knots[element];
  for (std::size_t n = 0; n < value.size(); ++n) {
    const auto row = static_cast<Eigen::Index>(n);
    const double c1 = shape(row, 1), c2 = shape(row, 2), c3 = shape(row, 3);
    value[n] += load * (shape(row, 0) + u * (c1 + u * (c2 + u * c3)));
    slope[n] += load * (c1 + u * (2.0 * c2 + 3.0 * u * c3));
  }
}

}  // namespace

ModalForce modal_force(const ModalDeck& deck, const AxleTrain& train) {
  ModalForce force;
  force.modes = deck.dynamic_modes;
  force.start = piece_starts(deck, train);
  force.others = deck.modes() - deck.dynamic_modes;
  const auto modes = static_cast<std::size_t>(force.modes), all = static_cast<std::size_t>(deck.modes());
  force.cubic.reserve(force.pieces() * modes);
  force.other.reserve(force.pieces() * (all - modes));
  force.other_bound.assign(force.pieces(), 0.0);
  force.other_turn.assign(force.pieces(), {});
  const std::array<Eigen::ArrayXd, 2> end_slope{deck.shape_at(0.0, 1), deck.shape_at(deck.length(), 1)};
  std::vector<double> f0, d0, f1, d1;  // values and slopes at both ends of a piece
  std::size_t first = 0, end = 0;      // axles that have not left and that have come on, in the middle of the piece
  for (std::size_t p = 0; p < force.pieces(); ++p) {
    const double a = force.start[p], b = force.start[p + 1], h = b - a, middle = 0.5 * (a + b);
    while (first < train.behind.size() && middle - train.behind[first] > deck.length()) ++first;
    while (end < train.behind.size() && middle - train.behind[end] > 0.0) ++end;
    for (std::vector<double>* sum : {&f0, &d0, &f1, &d1}) sum->assign(all, 0.0);
    constexpr double inside = 1e-6;
    for (std::size_t k = first; k < end; ++k) {
      const double behind = train.behind[k];
      add_axle(deck, a - behind, a - behind + inside * h, train.load[k], f0, d0);
      add_axle(deck, b - behind, b - behind - inside * h, train.load[k], f1, d1);
    }
    for (std::size_t n = 0; n < modes; ++n) force.cubic.push_back(hermite(f0[n], d0[n], f1[n], d1[n], h));
    double bound = 0.0;
    for (std::size_t n = modes; n < all; ++n) {
      const auto row = static_cast<Eigen::Index>(n);
      const double flexibility = 1.0 / (deck.omega[row] * deck.omega[row]);
      ModalForce::Cubic q = hermite(f0[n], d0[n], f1[n], d1[n], h);
      for (std::size_t j = 0; j < q.size(); ++j) {
        q[j] *= flexibility;
        for (std::size_t e = 0; e < 2; ++e) force.other_turn[p][e][j] += end_slope[e][row] * q[j];
      }
      force.other.push_back(q);
      // a cubic is nowhere larger than its control values
      const double largest = std::max(
          {std::abs(f0[n]), std::abs(f0[n] + h * d0[n] / 3.0), std::abs(f1[n] - h * d1[n] / 3.0), std::abs(f1[n])});
      bound += largest * flexibility * deck.largest_shape[row];
    }
    force.other_bound[p] = bound;
  }
  return force;
}

Eigen::ArrayXd modal_force_at(const ModalDeck& deck, const AxleTrain& train, double s) {
  Eigen::ArrayXd force = Eigen::ArrayXd::Zero(deck.modes());
  for (std::size_t k = 0; k < train.behind.size(); ++k) {
    const double x = s - train.behind[k];
    if (x >= 0.0 && x <= deck.length()) force += train.load[k] * deck.shape_at(x);
  }
  return force;
}

}  // namespace railtab
