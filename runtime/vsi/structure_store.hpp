#pragma once

#include <array>
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

  SharedStructure structure_;
  std::weak_ptr<const StructureModel> last_;                     ///< of the last call, equal to it
  std::array<std::shared_ptr<const StepMatrices>, 2> matrices_;  ///< of windows; of steps with all unknowns
  std::shared_ptr<StructureResponse> at_rest_;
  struct OfSteps {
    double alpha, time_step;
    bool all_active;
    std::shared_ptr<StructureResponse> response;
  };
  std::vector<OfSteps> of_steps_;  ///< last used last
};

}  // namespace railtab
