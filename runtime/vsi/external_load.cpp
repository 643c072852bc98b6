#include "railtab/runtime/vsi/external_load.hpp"

#include "railtab/runtime/base/index.hpp"
#include "railtab/runtime/vsi/support_motion.hpp"

namespace railtab {

namespace {

void add_body_load(const VsiModel& model, const BodyLoad& acting, int vehicle, int body, double time,
                   Eigen::VectorXd& load) {
  const double x = model.vehicle_x[index(vehicle)] + model.vehicle.bodies[index(body)].position[0];
  const bool over_time = acting.history.argument() == LoadArgument::time;
  const ForceAndMoment value = acting.history.at(over_time ? time : x + model.distance(time));
  const DofIndices& dof = model.vehicle.dof[index(body)];
  for (int k = 0; k < 6; ++k) {
    if (dof[index(k)] != held) load[dof[index(k)]] += value[k];
  }
}

}  // namespace

void vehicle_load(const VsiModel& model, int vehicle, double time, Eigen::VectorXd& load) {
  load.setZero(model.vehicle.dofs());
  for (const BodyLoad& acting : model.loads) {
    if (acting.vehicle == vehicle || acting.vehicle == BodyLoad::every_vehicle) {
      for (const int body : acting.bodies) add_body_load(model, acting, vehicle, body, time, load);
    }
  }
  if (model.lateral_acceleration != 0.0) load += model.lateral_acceleration * model.vehicle.lateral_load;
  // the car bodies whose x is held are what pulls the rest
  if (model.speed_profile) load += model.acceleration(time) * model.vehicle.acceleration_load;
}

void vehicle_step_load(const VsiModel& model, const HhtScheme& scheme, int vehicle, double time,
                       const LinearMotion& motion, Eigen::VectorXd& load) {
  load = model.vehicle.static_load;
  if (model.loads.empty() && !model.speed_profile && model.lateral_acceleration == 0.0) return;
  Eigen::VectorXd acting;
  const double end = time + scheme.time_step;
  vehicle_load(model, vehicle, end, acting);
  load += scheme.load_weight() * acting;
  if (scheme.alpha == 0.0) return;
  vehicle_load(model, vehicle, time, acting);
  load -= scheme.alpha * acting;
  if (model.speed_profile && model.gyroscopic_moments == GyroscopicMoments::included) {
    const double faster = model.speed(end) - model.speed(time);
    load -= scheme.alpha * faster * (model.vehicle.gyroscopic * motion.velocity);
  }
}

void add_ground_load(const VsiModel& model, const HhtScheme& scheme, double time, const DofRange& range,
                     Eigen::VectorXd& load) {
  if (!model.ground_motion) return;
  const StructureSupports& supports = model.structure->supports;
  const auto add_force = [&](const SupportMotion& s, double weight) {
    const auto add = [&](const StructureSupports::Columns& matrix, const Eigen::VectorXd& motion) {
      range.of(load) -= matrix.middleRows(range.begin, range.count) * (weight * motion);
    };
    add(supports.stiffness, s.displacement);
    add(supports.damping, s.velocity);
    add(supports.mass, s.acceleration);
  };
  add_force(support_motion(*model.ground_motion, supports.x, time + scheme.time_step), scheme.load_weight());
  if (scheme.alpha != 0.0) add_force(support_motion(*model.ground_motion, supports.x, time), -scheme.alpha);
}

}  // namespace railtab
