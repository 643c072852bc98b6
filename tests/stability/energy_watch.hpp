#pragma once

#include <optional>
#include <vector>

#include "railtab/runtime/vsi/energy_account.hpp"
#include "railtab/runtime/vsi/step_record.hpp"
#include "stability_case.hpp"

namespace railtab::stability {

/// The energy account of a run, step by step and impact by impact. ContactEnergyRecord counts impacts by wheelset and
/// with stiffness_work; here stiffness_work is left out, so that the gain is that of the time integration alone.
class EnergyWatch {
 public:
  /// The account after a step or after one of its halves.
  void take(const EnergyBalance& balance);
  /// The record at the end of a step.
  void record(const StepRecord& record);
  [[nodiscard]] EnergyResult result() const;

 private:
  /// From the last instant before a wheel lands until it is in the air again, or for 20 ms.
  struct Impact {
    double begin = 0.0;                             ///< [s]
    double gain_before = 0.0;                       ///< of the contacts [J]
    double spring_before = 0.0, spring_most = 0.0;  ///< energy of the contacts' springs [J]
  };
  void end(std::optional<Impact>& impact);

  EnergyBalance first_, now_, last_;  ///< after the first step, and at the ends of this one and the one before
  bool kept_ = false;
  double largest_step_ = 0.0, most_exchanged_ = 0.0;
  struct Landing {
    double gain, held;  ///< of the contacts, and the most that their springs took up [J]
  };
  std::vector<Landing> landings_;
  std::vector<double> flight_;                   ///< of each wheel [s]
  std::vector<std::optional<Impact>> going_on_;  ///< of each wheel
};

}  // namespace railtab::stability
