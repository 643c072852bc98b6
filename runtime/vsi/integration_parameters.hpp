#pragma once

#include <optional>

#include "railtab/runtime/vsi/hht.hpp"

namespace railtab {

struct IntegrationParameters {
  double time_step = 5e-4;      ///< [s]
  double duration = 0.0;        ///< [s]; 0: until the last wheelset has left the last span, and free_vibration
  double free_vibration = 0.0;  ///< [s]
  double alpha = -0.05;         ///< HHT alpha, -1/3..0
  /// None: automatic, `energy` in steps in which a wheel meets or leaves its rail and for some time after, else
  /// `endpoint`.
  std::optional<ContactForceRule> contact_force;
  /// Longest step in the millisecond after a wheel meets its rail or its force jumps, under the automatic rule [s],
  /// 1e-6..0.1; it is time_step by a power of two. In the rest of an impact, eight times as long.
  double impact_step = 3.125e-5;
  double tolerance = 1e-4;  ///< Newton: change of contact forces relative to the static wheel load
  int max_iterations = 20;
  int max_halvings = 6;  ///< of a step that does not converge
  /// Steps after which the iteration forgets tangents and forces of earlier steps. Checkpoints are taken there, so that
  /// a resumed run and an uninterrupted one are the same to the last bit; >= 1.
  long reinitialise_every = 2000;
};

}  // namespace railtab
