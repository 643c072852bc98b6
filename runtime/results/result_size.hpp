#pragma once

#include "railtab/runtime/vsi/step_record.hpp"

namespace railtab {

/// Sizes of a results file and of what writing it takes [bytes].
struct ResultSize {
  double file = 0.0;    ///< complete, with its checkpoints
  double grid = 0.0;    ///< of it, the group for ParaView
  double memory = 0.0;  ///< records between flushes, and HDF5's caches
};

/// @param header   as it is written, cut to what is recorded
/// @param records  number of them
/// @param state    numbers of a checkpoint; 0 where the run is too short for one
/// @param instants OutputParameters::paraview_instants
[[nodiscard]] ResultSize result_size(const ResultHeader& header, double records, double state, int instants);

}  // namespace railtab
