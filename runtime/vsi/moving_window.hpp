#pragma once

#include <Eigen/Core>
#include <vector>

#include "railtab/runtime/structure/reduction.hpp"
#include "railtab/runtime/structure/structure_model.hpp"
#include "railtab/runtime/vsi/linear_motion.hpp"

namespace railtab {

struct VsiModel;
struct VsiState;

/// A span with the track on it, rails cut at its ends, in its lowest modes: what it does once the train has left it,
/// and on ground that moves before the train has come.
struct SpanModes {
  double from = 0.0, to = 0.0;      ///< [m]
  DofRange dofs;                    ///< of the structure
  Eigen::MatrixXd shape;            ///< Φ, those dofs × modes, ΦᵀMΦ = I
  Eigen::VectorXd omega2, damping;  ///< diagonals of ΦᵀKΦ and ΦᵀCΦ
  /// Φᵀ M_s and Φᵀ C_s of supports that displacements are relative to, modes × 2 per support.
  Eigen::MatrixXd support_mass, support_damping;
};

/// A structure that is active only where the train is.
struct WindowModel {
  double ahead = 20.0, behind = 20.0;  ///< of the first and last wheelset [m]
  std::vector<SpanModes> spans;
  [[nodiscard]] Eigen::Index numbers() const noexcept;  ///< of VsiState::left_behind
};

/// @pre the structure says where its unknowns are (dof_x). @throws ComputationError where a span is not held
[[nodiscard]] WindowModel make_window(const StructureModel& structure, const ReductionParameters& parameters);

/// Moves the active window of degrees of freedom with the train, in strides, whole spans at a time. Its position
/// depends on the time alone, so that a resumed run finds it again.
class MovingWindow {
 public:
  MovingWindow(const VsiModel& model, double time_step);

  /// The degrees of freedom that are active in the step from state.time. Those outside are put to rest; spans that fall
  /// behind continue to vibrate in their own modes, and those that enter bring the vibration that the ground has given
  /// them.
  DofRange move(VsiState& state);
  /// The most degrees of freedom that are active at once in a run of `duration` [s].
  [[nodiscard]] DofRange largest(double duration) const;
  /// One time step of the spans behind, and where the ground moves of those ahead; their nodes of interest are written
  /// into the state.
  void step_inactive_spans(VsiState& state) const;
  /// RunSummary::window_error, so far.
  [[nodiscard]] double error() const noexcept { return error_; }

 private:
  struct Ends {
    double from, to;
    bool operator==(const Ends&) const = default;
  };
  [[nodiscard]] Ends ends(long step) const;
  /// @param lost what no mode keeps of the motion. @param behind that falls behind. @param front end of the window [m]
  void note_error(const Eigen::VectorXd& motion, const Eigen::VectorXd& lost, const DofRange& behind, double front);
  void join(const DofRange& stayed, double was_to, const LinearMotion& left, const DofRange& range,
            VsiState& state) const;
  /// @param first its place in VsiState::left_behind
  void step_span(std::size_t index, Eigen::Index first, const Eigen::VectorXd* load, VsiState& state) const;

  /// Dofs of a span's nodes of interest, and the rows of Φ that belong to them, filled up with zeros.
  struct Followed {
    std::vector<int> dofs;
    Eigen::MatrixXd shape;
  };

  const VsiModel& model_;
  HhtScheme scheme_;
  std::vector<Followed> followed_;           // of every span
  std::vector<Eigen::VectorXd> compliance_;  // of every span's modes in a step
  bool placed_ = false;
  long moved_at_ = 0;  // step of the last move, which a run prepares for and then makes
  double from_ = 0.0, to_ = 0.0, error_ = 0.0;
};

}  // namespace railtab
