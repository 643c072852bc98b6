#pragma once

#include <memory>
#include <vector>

#include "railtab/fmi/driven_track.hpp"
#include "railtab/fmi/track_variables.hpp"
#include "railtab/runtime/vsi/element_deflection.hpp"
#include "railtab/runtime/vsi/structure_step.hpp"

namespace railtab::fmi {

/// All that changes from step to step, to be kept and set again.
struct TrackState {
  double begin = 0.0;           ///< time of the start [s]
  long steps = 0;               ///< of the scheme since then
  std::vector<double> input;    ///< as set, for the end of the next step
  std::vector<double> applied;  ///< at the present time
  StructureMotion motion{};
  ElementDeflection deflection{};  ///< of rails under the wheels
  double speed = 0.0;              ///< of the wheelsets over the last step, their mean [m/s]
};

/// A track in motion under inputs, the variables of track_variables().
class TrackSimulation {
 public:
  /// At time 0, unloaded. @throws InputError, ComputationError as StructureResponse
  explicit TrackSimulation(DrivenTrack track);

  [[nodiscard]] const std::vector<TrackVariable>& variables() const noexcept { return variables_; }
  [[nodiscard]] std::size_t inputs() const noexcept { return state_.input.size(); }
  [[nodiscard]] double time_step() const noexcept { return track_.scheme.time_step; }  ///< [s]
  [[nodiscard]] double time() const noexcept {
    return state_.begin + static_cast<double>(state_.steps) * track_.scheme.time_step;
  }

  /// As the constructor left it.
  void reset();
  void begin_at(double time) noexcept { state_.begin = time; }
  /// @param input its value reference, below inputs() @throws InputError where the value is not finite
  void set(std::size_t input, double value);
  /// Static equilibrium under the inputs.
  void rest();
  /// HHT steps to time() + `length` with the inputs at their end; between them, where there are several, inputs change
  /// linearly from those applied before.
  /// @throws InputError where `length` [s] is no multiple of the scheme's step
  void step(double length);
  /// A variable by its value reference: an input as set, an output at the present time.
  [[nodiscard]] double value(std::size_t variable) const;

  [[nodiscard]] const TrackState& state() const noexcept { return state_; }
  /// @pre of a simulation of the same track
  void set_state(const TrackState& state);

 private:
  [[nodiscard]] std::vector<RailLoad> loads(const std::vector<double>& input) const;
  /// elements_ under loads_, as the state has them.
  void move_elements();

  DrivenTrack track_;
  std::vector<TrackVariable> variables_;
  StructureResponse response_;
  StructureStepWorkspace workspace_;
  TrackState state_;
  std::vector<RailLoad> loads_;           ///< of state_.applied
  std::vector<RailHeadMotion> elements_;  ///< per wheel, of rails between the nodes of their elements
};

/// A state as numbers.
[[nodiscard]] std::vector<double> packed(const TrackState& state);
/// The inverse. @param like a state of the same track
/// @throws InputError where the count is not that of `like`, or the first number none of steps
[[nodiscard]] TrackState unpacked(const std::vector<double>& numbers, const TrackState& like);

}  // namespace railtab::fmi
