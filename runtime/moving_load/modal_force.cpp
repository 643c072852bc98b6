#include "railtab/runtime/moving_load/modal_force.hpp"

#include <algorithm>

namespace railtab {
namespace {

/// Places of the first axle at which an axle passes a knot; those nearer to each other than rounding are one.
std::vector<double> events(const ModalDeck& deck, const AxleTrain& train) {
  std::vector<double> all;
  all.reserve(deck.knots.size() * train.behind.size());
  for (const double behind : train.behind) {
    for (const double knot : deck.knots) all.push_back(behind + knot);
  }
  std::sort(all.begin(), all.end());
  const double rounding = 1e-12 * (all.back() - all.front());
  const auto last = std::unique(all.begin(), all.end(), [rounding](double a, double b) { return b - a <= rounding; });
  all.erase(last, all.end());
  return all;
}

/// Adds P·φ_n(x + ξ) of the element that holds x + ξ for small ξ > 0, as cubics of ξ.
void add_axle(const ModalDeck& deck, std::size_t element, double x, double load, ModalForce::Cubic* sum, int modes) {
  const ModalDeck::Cubics& shape = deck.shape[element];
  const double u = x - deck.knots[element];
  for (int n = 0; n < modes; ++n) {
    const double c1 = shape(n, 1), c2 = shape(n, 2), c3 = shape(n, 3);
    sum[n][0] += load * (shape(n, 0) + u * (c1 + u * (c2 + u * c3)));
    sum[n][1] += load * (c1 + u * (2.0 * c2 + 3.0 * u * c3));
    sum[n][2] += load * (c2 + 3.0 * u * c3);
    sum[n][3] += load * c3;
  }
}

}  // namespace

ModalForce modal_force(const ModalDeck& deck, const AxleTrain& train) {
  ModalForce force;
  force.modes = deck.dynamic_modes;
  force.start = events(deck, train);
  force.cubic.resize(force.pieces() * static_cast<std::size_t>(force.modes), {0.0, 0.0, 0.0, 0.0});
  std::size_t first = 0, end = 0;  // axles that have not left and that have come on, at the middle of the piece
  for (std::size_t p = 0; p < force.pieces(); ++p) {
    const double start = force.start[p], middle = 0.5 * (start + force.start[p + 1]);
    while (first < train.behind.size() && middle - train.behind[first] > deck.length()) ++first;
    while (end < train.behind.size() && middle - train.behind[end] > 0.0) ++end;
    for (std::size_t k = first; k < end; ++k) {
      add_axle(deck, element_at(deck, middle - train.behind[k]), start - train.behind[k], train.load[k],
               &force.cubic[p * static_cast<std::size_t>(force.modes)], force.modes);
    }
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
