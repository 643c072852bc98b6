#pragma once

#include <span>
#include <vector>

#include "railtab/runtime/vsi/contact_state.hpp"
#include "railtab/runtime/vsi/energy_account.hpp"
#include "railtab/runtime/vsi/step_record.hpp"

namespace railtab {

/// Takes from the energy account of a run what its summary says of the contacts.
class ContactEnergyRecord {
 public:
  ContactEnergyRecord(const EnergyAccount& account, const VsiState& state);
  /// After every step.
  void step(const EnergyAccount& account, const VsiState& state);
  /// An impact that goes on does not count.
  [[nodiscard]] const ContactEnergy& summary() const noexcept { return summary_; }

 private:
  struct Impact {
    bool going_on = false;
    double begin = 0.0;   // [s]
    double gain = 0.0;    // [J] since then
    double before = 0.0;  // [J] in the contact springs of the wheelset before
    double stored = 0.0;  // [J] most in them since then, above that
  };
  void follow_impact(std::size_t wheelset, const EnergyAccount& account, double time, bool gained, bool lost);

  ContactEnergy summary_;
  double time_;
  std::vector<ContactState> contact_;  // per wheel, after the last step
  std::vector<double> energy_;         // [J] of the contact springs, per wheelset, after the last step
  std::vector<Impact> impacts_;        // per wheelset
};

}  // namespace railtab
