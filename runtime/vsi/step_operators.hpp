#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "railtab/runtime/vsi/element_forces.hpp"
#include "railtab/runtime/vsi/rigid_wheels.hpp"
#include "railtab/runtime/vsi/vsi_model.hpp"

namespace railtab {

/// What one time-step size needs: the factor of the structure's effective matrix and the inverse of a vehicle's, made
/// once, and the compliance of the rails where the train is.
class StepOperators {
 public:
  HhtScheme scheme;
  std::vector<SeparateSystem> systems;  ///< of the vehicle
  Eigen::MatrixXd vehicle_damping;
  VehicleResponse vehicle;
  std::vector<ElementCompliance> elements;       ///< per separate system; with force elements and NormalContact::hertz
  std::shared_ptr<StructureResponse> structure;  ///< null on rigid track
  std::optional<RigidWheelResponse> rigid_wheels;  ///< for NormalContact::rigid

  /// @param matrices of the model's structure; null on rigid track, and where the model has a store
  StepOperators(const VsiModel& model, const HhtScheme& hht, std::shared_ptr<const StepMatrices> matrices);

  /// For a step that ends at `time`: moves the table of the rails' compliance with the train, so that it covers the
  /// train up to there and some way ahead, takes the vehicle's gyroscopic terms at the speed there, and activates the
  /// degrees of freedom in `active`.
  void update_for_time(const VsiModel& model, double time, const DofRange& active);

  /// What the operators take now [bytes].
  [[nodiscard]] double bytes(const VsiModel& model) const;
  /// Memory that the operators keep for a vehicle [bytes].
  [[nodiscard]] static double vehicle_bytes(const VsiModel& model);
  /// The largest table of compliances of a run of `duration` [s] [bytes]. @param response of the model's structure
  [[nodiscard]] static double largest_table(const VsiModel& model, const StructureResponse& response, double duration,
                                            double time_step);

 private:
  void respond_to_elements(const VsiModel& model);

  double speed_;  ///< of the gyroscopic terms [m/s]
  double covered_from_ = 0.0,
         covered_to_ = -1.0;  ///< positions along the track [m]; none at first
};

}  // namespace railtab
