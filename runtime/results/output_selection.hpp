#pragma once

#include <string>
#include <vector>

#include "railtab/runtime/vsi/step_record.hpp"

namespace railtab {

/// What a run records, and how often.
struct OutputParameters {
  int every = 1;                ///< steps between records, >= 1
  bool wheels = true;           ///< contact forces and positions
  bool energy = false;          ///< RunSummary::contact_energy: some time for every step
  bool deck_envelope = false;   ///< RunSummary::deck: likewise
  double deck_cut_off = 30.0;   ///< of its filtered acceleration [Hz]
  int paraview_instants = 100;  ///< most instants that results show in ParaView, beside the last; 0: none
  /// Patterns of names with * and ?; nothing is recorded of what none of them fits.
  std::vector<std::string> bodies{"*"}, nodes{"*"};
};

/// The chosen part of header and records. What is not chosen is not there, as if the run did not have it.
class OutputSelection {
 public:
  /// @throws InputError where a pattern fits nothing that the run has
  OutputSelection(const OutputParameters& output, const ResultHeader& header);
  [[nodiscard]] ResultHeader of(ResultHeader header) const;
  /// Cuts `record` down to what is chosen.
  void cut(StepRecord& record) const;

 private:
  bool wheels_;
  std::vector<std::size_t> bodies_, nodes_;  // chosen, ascending
};

}  // namespace railtab
