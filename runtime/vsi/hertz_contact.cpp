// Hertz's contacts with creep forces as the contact law of a step (NormalContact::hertz).

#include <map>
#include <optional>

#include "railtab/runtime/base/index.hpp"
#include "railtab/runtime/vsi/contact_continuation.hpp"
#include "railtab/runtime/vsi/contact_evaluation.hpp"
#include "railtab/runtime/vsi/contact_law.hpp"
#include "railtab/runtime/vsi/contact_newton.hpp"
#include "railtab/runtime/vsi/external_load.hpp"

namespace railtab {

namespace {

// What the load weight is to the structure, to the rails' elements: a share of the force at the end of the step. Under
// ContactForceRule::energy that is the one whose mean with the force at the start is the step's mean.
double element_weight(const HhtScheme& hht) {
  const double of_force = hht.contact_force == ContactForceRule::energy ? 2.0 * hht.gamma() * hht.load_weight() : 1.0;
  return ElementStep(hht).share * of_force;
}

void couple_rails(const StepContext& step, std::vector<RailCoupling>& rail) {
  const std::vector<RailContact>& contacts = step.contacts;
  rail.clear();
  const int wheelsets = static_cast<int>(contacts.size()) / 2;
  const double of_elements = element_weight(step.hht);
  for (int j = 0; j < wheelsets; ++j) {
    const RailHeads at_j = rail_heads(contacts, j);
    // Wheelsets are ordered along the train, so those within reach are neighbours in the list; the compliance is
    // symmetric.
    for (int i = j; i < wheelsets; ++i) {
      const RailHeads at_i = rail_heads(contacts, i);
      RailHeadsCompliance c = step.hht.load_weight() * step.operators.structure->compliance(at_i, at_j);
      add_element_compliance(at_i, at_j, of_elements, c);
      if (c.isZero(0.0)) break;  // out of reach, or wheelset j beyond the modelled track
      rail.push_back({i, j, c});
      if (i != j) rail.push_back({j, i, c.transpose()});
    }
  }
}

class HertzContacts : public ContactLaw {
 public:
  explicit HertzContacts(const VsiModel& model) : of_model_(model.train_contact()), contact_(of_model_) {
    const std::size_t n = model.vehicle_x.size();
    prediction_.resize(n);
    problem_.wheelsets_per_vehicle = model.wheelsets_per_vehicle();
    problem_.wheelsets_per_group = 1;
    if (!model.vehicle.elements.empty()) elements_.emplace(model.vehicle, n);
    problem_.free = problem_.predicted = problem_.predicted_velocity = begin_velocity_ =
        Eigen::VectorXd::Zero(wheelset_unknowns * model.wheelsets());
    predicted_nodes_ = Eigen::VectorXd::Zero(6 * model.wheelsets());
  }

  void predict_vehicles(const StepContext& step, const VsiState& state, StepWorkspace& ws) override {
    const HhtScheme& hht = step.hht;
    for (int v = 0; v < static_cast<int>(state.vehicle.size()); ++v) {
      Prediction& p = prediction_[index(v)];
      const LinearMotion& motion = state.vehicle[index(v)];
      predict(hht, motion, p);
      vehicle_step_load(step.model, hht, v, step.begin, motion, ws.vehicle_load);
      step.operators.vehicle.find_free_increment(hht, ws.vehicle_load, motion, p);
      // predictor, its velocity, and the motion without contact forces
      free_ = p.displacement + p.increment;
      gather_wheelsets(step.model, v, p.displacement, problem_.predicted);
      gather_wheelsets(step.model, v, p.velocity, problem_.predicted_velocity);
      gather_wheelsets(step.model, v, motion.velocity, begin_velocity_);
      gather_wheelsets(step.model, v, free_, problem_.free);
      if (!elements_) continue;
      guess_ = p.displacement + motion.acceleration / hht.acceleration_rate();
      elements_->begin(v, element_step(hht), {motion, state.friction[index(v)], p, guess_}, free_);
    }
  }

  // With q the contact unknowns, 𝐂 = (1+α) Bᵀ K̄⁻¹ B and T = ∂f/∂q, Eq. 16 condensed to the contacts is
  //
  //     [ I  −𝐂 ] [ δq ]   [ q_free + 𝐂 f − q ]
  //     [ −T  I ] [ δf ] = [ 0                ]
  //
  // or (I − 𝐂 T) δq = q_free + 𝐂 f(q, v) − q.
  // 𝐂: vehicle_compliance and rail; q_free: free; f and T: evaluate() and differentiate().
  void present(const StepContext& step, const VsiState& state, StepWorkspace& ws) override {
    const bool search = step.limits.geometry == GeometrySource::search;
    for (std::size_t w = 0; w < contact_.model.size(); ++w) {
      const ContactGeometry* geometry = of_model_.model[w].geometry;
      contact_.model[w].geometry = search ? searched(geometry) : geometry;
    }
    contact_.set_speed(step.model.speed(step.end));
    if (step.model.structure) {
      gather_structure(step, state, ws);
      couple_rails(step, problem_.rail);
    }
    rail_deviation(step.model, step.contacts, step.end, ws.structure_predicted, problem_.deviation);
    if (step.model.structure) predict_elements(step, state);
    problem_.velocity_rate = Vector6::Constant(step.hht.velocity_rate());
    problem_.rail_velocity_rate = step.hht.velocity_rate();
    weigh_compliance(step);
    if (elements_) elements_->compliance = &step.operators.elements;
    problem_.elements = elements_ ? &*elements_ : nullptr;
    const bool energy = step.hht.contact_force == ContactForceRule::energy;
    problem_.start = energy ? &state.contact : nullptr;
    problem_.mean_weight = energy ? 1.0 / (step.hht.gamma() * step.hht.load_weight()) : 1.0;
    // Velocities that stay what they are leave creepages what they are. Forces that stay would be a worse start: at
    // walking pace they leave a motion in which a wheel slides.
    ws.solution.force = (energy ? 0.5 * problem_.mean_weight : 1.0) * state.contact.end_force;
    ws.solution.displacement =
        problem_.predicted + (begin_velocity_ - problem_.predicted_velocity) / step.hht.velocity_rate();
    newton_.estimate.add_to(contact_, problem_, state.contact, newton_, computes_side_by_side(contact_, problem_),
                            ws.solution);
  }

  ContactSolve solve(const StepContext& step, int pass, StepWorkspace& ws, StepReport& report) override {
    // the structure's response has moved nothing but q_free
    const InitialForces forces = pass > 0 ? InitialForces::known : InitialForces::estimated;
    NewtonReport newton;
    {
      const Stopwatch watch = report.times.measure(Phase::contact);
      newton = solve_contact_by_continuation(contact_, problem_, step.limits.newton, ws.solution, newton_, forces);
    }
    report.times.seconds(Phase::contact) -= newton.counts.seconds_lookup;
    report.times.seconds(Phase::lookup) += newton.counts.seconds_lookup;
    report.newton_iterations += newton.iterations;
    report.counts += newton.counts;
    if (!newton.converged) return ContactSolve::diverged;
    return pass > 0 && newton.iterations == 0 ? ContactSolve::unchanged : ContactSolve::changed;
  }

  double correct_far_field(const StepContext& step, StepWorkspace& ws) override {
    double largest = 0.0;
    load_elements(step, ws.solution);
    element_motion(step.contacts, element_force_, element_rate_, element_force_, 0.0, end_elements_);
    for (int wheel = 0; wheel < static_cast<int>(step.contacts.size()); ++wheel) {
      const int k = rail_unknown(wheel);
      // What the contact solution has the rail do under its forces: where Newton ended, and its residual.
      const Vector3 expected = ws.solution.displacement.segment<3>(k) + newton_.residual.segment<3>(k);
      const Vector3 missing = predicted_nodes_.segment<3>(3 * wheel) +
                              rail_head(step.contacts[index(wheel)], ws.structure_free) +
                              end_elements_[index(wheel)].displacement - expected;
      largest = std::max(largest, missing.cwiseAbs().maxCoeff());
      problem_.free.segment<3>(k) += missing;
      ws.far_field.segment<3>(3 * wheel) += missing;
    }
    return largest;
  }

  void close(const StepContext& step, VsiState& state, StepWorkspace& ws) override {
    const HhtScheme& hht = step.hht;
    for (int v = 0; v < static_cast<int>(state.vehicle.size()); ++v) {
      LinearMotion& motion = state.vehicle[index(v)];
      scatter_wheelset_forces(step.model, v, ws.solution.force, ws.vehicle_load);
      if (elements_) elements_->add_share(v, ws.vehicle_load);
      Prediction& p = prediction_[index(v)];
      step.operators.vehicle.add_displacement(hht.load_weight(), ws.vehicle_load, p.increment);
      close_load(hht, ws.vehicle_load, motion.contact_load, motion.step_load);
      scatter_wheelset_forces(step.model, v, ws.solution.end_force, motion.contact_load);
      if (elements_) {
        elements_->add_end_force(v, motion.contact_load);
        elements_->store_friction(v, state.friction[index(v)]);
      }
      update(hht, p, p.increment, motion);
    }
    if (step.model.structure) close_elements(step, ws.solution, state.deflection);
    newton_.estimate.learn(contact_, problem_, newton_, ws.solution);
    ws.solution.step_load = state.contact.step_load;
    close_load(hht, ws.solution.force, state.contact.end_force, ws.solution.step_load);
    std::swap(state.contact, ws.solution);
  }

  void reinitialise() override { newton_.forget_tangents(); }

 private:
  static ElementForces::Step element_step(const HhtScheme& hht) {
    const bool energy = hht.contact_force == ContactForceRule::energy;
    return {energy ? ElementRule::energy : ElementRule::endpoint, hht.time_step, hht.velocity_rate(),
            energy ? 1.0 / (hht.gamma() * hht.load_weight()) : 1.0};
  }

  // vehicle_compliance, where it is not zero.
  void weigh_compliance(const StepContext& step) {
    const VehicleResponse& vehicle = step.operators.vehicle;
    const Eigen::MatrixXd& compliance = vehicle.compliance();
    problem_.coupled = vehicle.coupled();
    if (problem_.vehicle_compliance.size() == 0) {
      problem_.vehicle_compliance.setZero(compliance.rows(), compliance.cols());
    }
    for (int w = 0; w < problem_.wheelsets_per_vehicle; ++w) {
      const auto [first, end] = problem_.coupled[index(w)];
      problem_.vehicle_compliance.block(6 * first, 6 * w, 6 * (end - first), 6) =
          step.hht.load_weight() * compliance.block(6 * first, 6 * w, 6 * (end - first), 6);
    }
  }

  void gather_structure(const StepContext& step, const VsiState& state, StepWorkspace& ws) {
    gather_rails(step.contacts, ws.structure_predicted, problem_.predicted);
    gather_rails(step.contacts, ws.structure_predicted_velocity, problem_.predicted_velocity);
    gather_rails(step.contacts, ws.structure_velocity, begin_velocity_);
    gather_rails(step.contacts, ws.structure_free, problem_.free);
    for (int wheel = 0; wheel < static_cast<int>(step.contacts.size()); ++wheel) {
      const int k = rail_unknown(wheel);
      predicted_nodes_.segment<3>(3 * wheel) = problem_.predicted.segment<3>(k);
      problem_.free.segment<3>(k) += problem_.predicted.segment<3>(k) + state.far_field.segment<3>(3 * wheel);
    }
  }

  void predict_elements(const StepContext& step, const VsiState& state) {
    const ElementStep of_step(step.hht);
    const ElementDeflection& begin = state.deflection;
    const double V = step.model.speed(step.end);
    element_rate_ = -of_step.back * begin.rate;
    element_motion(step.contacts, begin.force, element_rate_, begin.force, V, predicted_elements_);
    element_free_ = of_step.free(begin);
    element_motion(step.contacts, element_free_, begin.rate, begin.force, V, free_elements_);
    for (int wheel = 0; wheel < static_cast<int>(step.contacts.size()); ++wheel) {
      const int k = rail_unknown(wheel);
      const RailHeadMotion& predicted = predicted_elements_[index(wheel)];
      problem_.predicted.segment<3>(k) += predicted.displacement;
      problem_.predicted_velocity.segment<3>(k) += predicted.velocity;
      problem_.free.segment<3>(k) += free_elements_[index(wheel)].displacement;
      begin_velocity_.segment<3>(k) += free_elements_[index(wheel)].velocity;
      add_slopes(predicted, problem_.deviation[index(wheel / 2)][index(wheel % 2)]);
    }
  }

  // g at the end of the step, under the forces of the solution.
  void load_elements(const StepContext& step, const ContactSolution& solution) {
    element_force_ = element_free_;
    add_rail_part(element_weight(step.hht), solution.force, element_force_);
  }

  void close_elements(const StepContext& step, const ContactSolution& solution, ElementDeflection& deflection) {
    load_elements(step, solution);
    ElementStep(step.hht).close(element_force_, deflection);
  }

  // Made when first needed.
  const ContactGeometry* searched(const ContactGeometry* geometry) {
    auto known = search_.find(geometry);
    if (known == search_.end()) known = search_.emplace(geometry, geometry->without_table()).first;
    return &known->second;
  }

  TrainContact of_model_;
  TrainContact contact_;                                      // at the speed of the step's end
  std::map<const ContactGeometry*, ContactGeometry> search_;  // geometries of the model, and the same without tables
  ContactProblem problem_;
  std::optional<TrainElements> elements_;  // where vehicles have force elements
  std::vector<Prediction> prediction_;     // per vehicle
  Eigen::VectorXd free_, guess_;           // of one vehicle: ElementForces::begin()
  Eigen::VectorXd begin_velocity_;         // of wheelsets and rail heads, in the order of the unknowns
  Eigen::VectorXd predicted_nodes_;        // of rail heads, as their elements' nodes have them: 3 per wheel
  // Motion of rail heads between the nodes of their elements, per wheel: predicted, without the forces of this step,
  // and with them; and the forces that go with it, 3 per wheel.
  std::vector<RailHeadMotion> predicted_elements_, free_elements_, end_elements_;
  Eigen::VectorXd element_rate_, element_free_, element_force_;
  NewtonWorkspace newton_;  // tangents and loads are kept from step to step, until reinitialise()
};

}  // namespace

std::unique_ptr<ContactLaw> make_hertz_contact(const VsiModel& model) { return std::make_unique<HertzContacts>(model); }

}  // namespace railtab
