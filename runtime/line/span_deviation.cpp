#include "railtab/runtime/line/span_deviation.hpp"

#include <fmt/format.h>

#include <cmath>

#include "railtab/runtime/base/input_error.hpp"

namespace railtab {

double transition_stiffness(double pad_stiffness, double EI) noexcept {
  return std::pow(pad_stiffness / (4.0 * EI), 0.25);
}

double transition_stiffness(SpanDeviationDirection direction) noexcept {
  constexpr double E = 210e9;  // Pa
  return direction == SpanDeviationDirection::vertical ? transition_stiffness(9.42e7, E * 3032e-8)
                                                       : transition_stiffness(47.1e7, E * 509e-8);
}

void SpanDeviationParameters::validate() const {
  const auto require = [](bool ok, const char* key, double found, const char* expected) {
    if (!ok) throw input_error(key, fmt::format("{}", found), expected);
  };
  require(span > 0.0 && std::isfinite(span), "span_deviation.span", span, "> 0 m");
  require(std::abs(amplitude) <= 0.5, "span_deviation.amplitude", amplitude, "-0.5 to 0.5 m");
  require(std::isfinite(start), "span_deviation.start", start, "a finite position in m");
  require(beta >= 0.0 && std::isfinite(beta), "span_deviation.beta", beta, ">= 0 1/m");
}

SpanDeviation::SpanDeviation(const SpanDeviationParameters& p) : direction_(p.direction) {
  p.validate();
  beta_ = p.beta > 0.0 ? p.beta : transition_stiffness(p.direction);
  const double theta = p.amplitude / p.span;
  if (p.shape == SpanDeviationShape::bending) {
    kinks_ = {{p.start, theta}, {p.start + p.span, -2.0 * theta}, {p.start + 2.0 * p.span, theta}};
  } else {
    kinks_ = {{p.start, theta}, {p.start + p.span, -theta}};
  }
}

RailDeviation SpanDeviation::at(double x) const noexcept {
  double value = 0.0, slope = 0.0, curvature = 0.0;
  for (const Kink& kink : kinks_) {
    const double s = x - kink.x, u = beta_ * std::abs(s);
    const double decay = std::exp(-u), c = std::cos(u), n = std::sin(u);
    value += kink.angle * (std::max(s, 0.0) + decay * (c - n) / (4.0 * beta_));
    // d/ds of the decaying part is −(e^{−u} cos u)/2 · sign(s)
    slope += kink.angle * (s > 0.0 ? 1.0 - 0.5 * decay * c : 0.5 * decay * c);
    curvature += kink.angle * 0.5 * beta_ * decay * (c + n);
  }
  RailDeviation deviation;
  const bool vertical = direction_ == SpanDeviationDirection::vertical;
  (vertical ? deviation.z : deviation.y) = value;
  (vertical ? deviation.dz_dx : deviation.dy_dx) = slope;
  (vertical ? deviation.ddz_dx2 : deviation.ddy_dx2) = curvature;
  return deviation;
}

}  // namespace railtab
