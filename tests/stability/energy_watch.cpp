#include "energy_watch.hpp"

#include <algorithm>
#include <cmath>

namespace railtab::stability {
namespace {

constexpr double shortest_flight = 2e-3, longest_impact = 20e-3;  // s

/// Energy gained by the time integration of the contacts, without stiffness_work.
double contact_gain(const EnergyBalance& balance) { return balance.contact_gain - balance.stiffness_work; }

/// How much energy the motion has moved: the kinetic one, or the largest change of any other.
double exchanged(const EnergyBalance& first, const EnergyBalance& now) {
  return std::max({now.kinetic, std::abs(now.strain - first.strain), std::abs(now.gravity - first.gravity),
                   std::abs(now.contact - first.contact)});
}

}  // namespace

void EnergyWatch::take(const EnergyBalance& balance) {
  if (!kept_) first_ = balance;
  kept_ = true;
  now_ = balance;
}

void EnergyWatch::end(std::optional<Impact>& impact) {
  const double held = impact->spring_most - impact->spring_before;
  landings_.push_back({contact_gain(now_) - impact->gain_before, held});
  impact.reset();
}

void EnergyWatch::record(const StepRecord& record) {
  if (!kept_) return;
  flight_.resize(record.wheels.size(), 0.0);
  going_on_.resize(record.wheels.size());
  largest_step_ = std::max(largest_step_, std::abs(now_.gain() - last_.gain()));
  most_exchanged_ = std::max(most_exchanged_, exchanged(first_, now_));
  for (std::size_t w = 0; w < record.wheels.size(); ++w) {
    const bool in_contact = record.wheels[w].patches > 0;
    std::optional<Impact>& impact = going_on_[w];
    if (in_contact && flight_[w] >= shortest_flight) {
      impact = Impact{last_.time, contact_gain(last_), last_.contact, last_.contact};
    }
    if (impact) {
      impact->spring_most = std::max(impact->spring_most, now_.contact);
      if (!in_contact || now_.time - impact->begin > longest_impact) end(impact);
    }
    flight_[w] = in_contact ? 0.0 : flight_[w] + now_.time - last_.time;
  }
  last_ = now_;
}

EnergyResult EnergyWatch::result() const {
  constexpr double at_rest = 1e-9;  // J
  if (!kept_ || !(most_exchanged_ > at_rest)) return {};
  constexpr double hard = 0.01;  // of the hardest landing's energy: softer ones do not count
  double hardest = 0.0, impact = 0.0;
  for (const Landing& landing : landings_) hardest = std::max(hardest, landing.held);
  for (const Landing& landing : landings_) {
    if (landing.held > hard * hardest) impact = std::max(impact, std::abs(landing.gain) / landing.held);
  }
  return {true, largest_step_ / most_exchanged_, last_.gain() / most_exchanged_, static_cast<int>(landings_.size()),
          impact};
}

}  // namespace railtab::stability
