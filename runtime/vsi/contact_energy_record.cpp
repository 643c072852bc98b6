#include "railtab/runtime/vsi/contact_energy_record.hpp"

#include <algorithm>
#include <cmath>

namespace railtab {

ContactEnergyRecord::ContactEnergyRecord(const EnergyAccount& account, const VsiState& state)
    : time_(state.time),
      contact_(contact_states(state.contact)),
      energy_(account.wheelset_energy().begin(), account.wheelset_energy().end()),
      impacts_(energy_.size()) {}

void ContactEnergyRecord::step(const EnergyAccount& account, const VsiState& state) {
  summary_.gain = account.balance().contact_gain;
  summary_.stiffness_work = account.balance().stiffness_work;
  double all = 0.0;
  for (const double gain : account.wheelset_gain()) all += gain;
  if (std::abs(all) > std::abs(summary_.largest_step)) {
    summary_.largest_step = all;
    summary_.largest_step_time = state.time;
  }
  const std::vector<ContactState> contact = contact_states(state.contact);
  for (std::size_t w = 0; w < impacts_.size(); ++w) {
    bool gained = false, lost = false;
    for (const std::size_t wheel : {2 * w, 2 * w + 1}) {
      gained = gained || contact[wheel] > contact_[wheel];
      lost = lost || contact[wheel] < contact_[wheel];
    }
    follow_impact(w, account, state.time, gained, lost);
    energy_[w] = account.wheelset_energy()[w];
  }
  contact_ = contact;
  time_ = state.time;
}

void ContactEnergyRecord::follow_impact(std::size_t wheelset, const EnergyAccount& account, double time, bool gained,
                                        bool lost) {
  Impact& impact = impacts_[wheelset];
  if (!impact.going_on) {
    if (!gained) return;
    impact = {true, time_, 0.0, energy_[wheelset], 0.0};
  }
  impact.gain += account.wheelset_gain()[wheelset];
  impact.stored = std::max(impact.stored, account.wheelset_energy()[wheelset] - impact.before);
  if (!lost && time - impact.begin < longest_impact) return;
  impact.going_on = false;
  ++summary_.impacts;
  if (std::abs(impact.gain) <= std::abs(summary_.largest_impact)) return;
  summary_.largest_impact = impact.gain;
  summary_.largest_impact_time = impact.begin;
  summary_.largest_impact_stored = impact.stored;
}

}  // namespace railtab
