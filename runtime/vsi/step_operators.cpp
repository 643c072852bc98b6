#include "railtab/runtime/vsi/step_operators.hpp"

#include <algorithm>
#include <utility>

namespace railtab {

namespace {

// Rail coupling beyond this distance is left to the far-field correction: rail bending waves within one step have died
// out.
constexpr double compliance_window = 5.0;  // m
constexpr double compliance_ahead = 10.0;  // m: covered before the train

}  // namespace

StepOperators::StepOperators(const VsiModel& model, const HhtScheme& hht, std::shared_ptr<const StepMatrices> matrices)
    : scheme(hht),
      systems(separate_systems(model.vehicle)),
      vehicle_damping(model.vehicle_damping(model.contact.speed)),
      vehicle(model.vehicle, systems, vehicle_damping, hht),
      speed_(model.contact.speed) {
  if (model.normal_contact == NormalContact::rigid) {
    rigid_wheels.emplace(model.vehicle, vehicle_damping, hht);
  }
  respond_to_elements(model);
  if (!model.structure) return;
  const DofRange active{0, model.window ? 0 : model.structure->dofs()};  // a window is placed by update_for_time()
  structure = model.store ? model.store->of_steps(model.structure, hht, active)
                          : std::make_shared<StructureResponse>(std::move(matrices), hht, active);
}

void StepOperators::respond_to_elements(const VsiModel& model) {
  if (model.vehicle.elements.empty() || rigid_wheels) return;
  elements.clear();
  for (const SeparateSystem& system : systems) {
    elements.emplace_back(model.vehicle, system, vehicle.inverse(), scheme.load_weight());
  }
}

double StepOperators::bytes(const VsiModel& model) const {
  return vehicle_bytes(model) + (structure ? static_cast<double>(structure->bytes()) : 0.0);
}

double StepOperators::vehicle_bytes(const VsiModel& model) {
  constexpr double matrices = 6.0;  // damping and inverse, both and the stiffness by systems, one to make the inverse
  return matrices * sizeof(double) * model.vehicle.dofs() * model.vehicle.dofs();
}

double StepOperators::largest_table(const VsiModel& model, const StructureResponse& response, double duration,
                                    double time_step) {
  constexpr int looks = 200;
  double largest = 0.0;
  for (int i = 0; i <= looks; ++i) {
    const double time = duration * i / looks;
    const double rear = model.wheelset_x(model.wheelsets() - 1, time - time_step);
    largest =
        std::max(largest, response.table_bytes(compliance_window, rear, model.wheelset_x(0, time) + compliance_ahead));
  }
  return largest;
}

void StepOperators::update_for_time(const VsiModel& model, double time, const DofRange& active) {
  if (model.speed(time) != speed_) {
    speed_ = model.speed(time);
    vehicle_damping = model.vehicle_damping(speed_);
    vehicle = VehicleResponse(model.vehicle, systems, vehicle_damping, scheme);
    if (rigid_wheels) rigid_wheels.emplace(model.vehicle, vehicle_damping, scheme);
    respond_to_elements(model);
  }
  const double front = model.wheelset_x(0, time);
  const double rear = model.wheelset_x(model.wheelsets() - 1, time);
  if (structure) structure->activate(active);
  if (!structure || (rear >= covered_from_ && front <= covered_to_)) return;
  // A step that is repeated as halves looks back by at most one step.
  covered_from_ = model.wheelset_x(model.wheelsets() - 1, time - scheme.time_step);
  covered_to_ = front + compliance_ahead;
  structure->tabulate_compliance(compliance_window, covered_from_, covered_to_);
}

}  // namespace railtab
