#pragma once

#include <memory>
#include <vector>

#include "railtab/runtime/vsi/structure_response.hpp"

namespace railtab {

/// Factors of a structure that outlive a run: runs of one process that follow each other on the same structure, with
/// steps of the same size, make them once. What they hold does not depend on the run, so that results are the same to
/// the last bit. Not for runs at the same time.
class StructureStore {
 public:
  /// StructureResponse(structure), of the last call where that was for the same matrices and rails.
  [[nodiscard]] std::shared_ptr<StructureResponse> at_rest(const SharedStructure& structure);
  /// Likewise StructureResponse(structure, scheme, active), for as many step sizes as a run has at once.
  [[nodiscard]] std::shared_ptr<StructureResponse> of_steps(const SharedStructure& structure, const HhtScheme& scheme,
                                                            const DofRange& active);

 private:
  /// Forgets everything where the structure is another.
  void take_up(const SharedStructure& structure);

  /// Those that responses refer to, and those of the last call, which are equal to them.
  SharedStructure structure_, last_;
  std::shared_ptr<const StepMatrices> matrices_;
  std::shared_ptr<StructureResponse> at_rest_;
  struct OfSteps {
    double alpha, time_step;
    std::shared_ptr<StructureResponse> response;
  };
  std::vector<OfSteps> of_steps_;  ///< last used last
};

}  // namespace railtab
