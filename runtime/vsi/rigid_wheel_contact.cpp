// Wheels that follow the rails as the contact law of a step (NormalContact::rigid).

#include <algorithm>
#include <limits>
#include <optional>

#include "railtab/runtime/base/dense_solvers.hpp"
#include "railtab/runtime/base/index.hpp"
#include "railtab/runtime/vsi/contact_law.hpp"
#include "railtab/runtime/vsi/external_load.hpp"
#include "railtab/runtime/vsi/support_motion.hpp"

namespace railtab {

namespace {

using Eigen::Vector3d;

// Mean over the two rails under a wheelset of displacement, slope and curvature from structure dofs.
Vector3d mean_line(const RailContact* contact, const Eigen::VectorXd& dofs) {
  Vector3d line = Vector3d::Zero();
  for (int side = 0; side < 2; ++side) {
    if (!contact[side].on_rail) continue;
    const RailInterpolation& rows = contact[side].rows;
    for (std::size_t k = 0; k < 12; ++k) {
      if (rows.dof[k] != held) line += 0.5 * dofs[rows.dof[k]] * Vector3d(rows.z[k], -rows.pitch[k], rows.bend[k]);
    }
  }
  return line;
}

// How the wheels run at the end of a step.
struct Running {
  double V, rate;  // speed [m/s] and its rate [m/s²]
};

// Heave, its velocity and acceleration of a wheel on a line that has the values, slopes and curvatures `displacement`,
// and their material rates: d/dt = ∂/∂t + V ∂/∂x.
Vector3d followed(const Vector3d& displacement, const Vector3d& velocity, double acceleration, const Running& run) {
  return {displacement[0], velocity[0] + run.V * displacement[1],
          acceleration + 2.0 * run.V * velocity[1] + run.V * run.V * displacement[2] + run.rate * displacement[1]};
}

// Response of the mean lines to forces on the wheelsets: pairs within the reach of the tabulated compliance.
struct LineCoupling {
  int i, j;
  Vector3d line;  // displacement, slope, curvature under wheelset i per force on wheelset j, [1/N] times these units
};

std::vector<LineCoupling> line_couplings(const StepContext& step) {
  std::vector<LineCoupling> couplings;
  const std::vector<RailContact>& contacts = step.contacts;
  const int wheelsets = static_cast<int>(contacts.size()) / 2;
  const auto response = [&](int i, int j) {
    Vector3d line = Vector3d::Zero();
    for (int side = 0; side < 2; ++side) {
      for (int other = 0; other < 2; ++other) {
        line += 0.25 * step.hht.load_weight() *
                step.operators.structure->vertical_compliance(contacts[index(2 * i + side)],
                                                              contacts[index(2 * j + other)]);
      }
    }
    return line;
  };
  for (int j = 0; j < wheelsets; ++j) {
    for (int i = j; i < wheelsets; ++i) {
      const Vector3d line = response(i, j);
      if (i != j && line.isZero(0.0)) break;  // wheelsets are in the order of the train
      couplings.push_back({i, j, line});
      if (i != j) couplings.push_back({j, i, response(j, i)});
    }
  }
  return couplings;
}

// Lines are (displacement, slope, curvature) of the rails' mean under each wheelset, increments over the structure's
// predictor.
class RigidWheels : public ContactLaw {
 public:
  explicit RigidWheels(const VsiModel& model)
      : per_vehicle_(model.wheelsets_per_vehicle()),
        prediction_(model.vehicle_x.size()),
        remainder_(model.vehicle_x.size()),
        free_force_(model.wheelsets()) {
    if (!model.vehicle.elements.empty()) elements_.emplace(model.vehicle, model.vehicle_x.size());
  }

  void predict_vehicles(const StepContext& step, const VsiState& state, StepWorkspace& ws) override {
    for (int v = 0; v < static_cast<int>(state.vehicle.size()); ++v) {
      Eigen::VectorXd& R = remainder_[index(v)];
      const LinearMotion& motion = state.vehicle[index(v)];
      vehicle_step_load(step.model, step.hht, v, step.begin, motion, ws.vehicle_load);
      R = wheels(step).remainder(step.hht, ws.vehicle_load, motion, prediction_[index(v)]);
      free_force_.segment(per_vehicle_ * v, per_vehicle_) = wheels(step).free_force(R);
    }
    state_ = &state;
  }

  void present(const StepContext& step, const VsiState&, StepWorkspace& ws) override {
    const VsiModel& model = step.model;
    running_ = {model.speed(step.end), model.acceleration(step.end)};
    known_.clear();
    free_.assign(index(model.wheelsets()), Vector3d::Zero());
    increment_ = free_;
    couplings_.clear();
    for (int w = 0; w < model.wheelsets(); ++w) {
      const VerticalDeviation d = vertical_deviation(model, w, step.end);
      known_.emplace_back(d.z, d.rate, d.acceleration);
      if (model.structure && step.contacts[index(2 * w)].on_rail) continue;
      const VerticalDeviation ground = ground_under(model, w, step.end);
      known_.back() += Vector3d(ground.z, ground.rate, ground.acceleration);
    }
    if (!model.structure) return;
    couplings_ = line_couplings(step);
    for (int w = 0; w < model.wheelsets(); ++w) {
      const RailContact* contact = &step.contacts[index(2 * w)];
      known_[index(w)] += followed(mean_line(contact, ws.structure_predicted),
                                   mean_line(contact, ws.structure_predicted_velocity), 0.0, running_);
      free_[index(w)] = mean_line(contact, ws.structure_free);
    }
    add_carried(step);
  }

  ContactSolve solve(const StepContext& step, int, StepWorkspace& ws, StepReport& report) override {
    const Stopwatch watch = report.times.measure(Phase::contact);
    if (elements_) {
      elements_->compliance = &wheels(step).elements();
      element_load_.assign(remainder_.size(), Eigen::VectorXd::Zero(step.model.vehicle.dofs()));
      for (int v = 0; v < vehicles(); ++v) load_without_heave(step, v);
    }
    constexpr int most_passes = 50;
    double change = 0.0;
    for (int k = 0; k < most_passes; ++k) {
      follow(step, ws);
      ++report.newton_iterations;
      if (!force_.allFinite()) return ContactSolve::diverged;  // the system of the forces is singular
      change = respond_by_elements(step);
      if (!(change > 0.0)) break;
    }
    if (!(change <= 0.0)) return ContactSolve::diverged;
    set_vertical_forces(force_, ws.solution);
    return ContactSolve::changed;
  }

  double correct_far_field(const StepContext& step, StepWorkspace& ws) override {
    double largest = 0.0;
    for (std::size_t w = 0; w < increment_.size(); ++w) {
      const Vector3d missing = mean_line(&step.contacts[2 * w], ws.structure_free) - increment_[w];
      largest = std::max(largest, missing.cwiseAbs().maxCoeff());
      ws.far_field.segment<3>(3 * static_cast<Eigen::Index>(w)) += missing;
      increment_[w] += missing;
    }
    return largest;
  }

  void close(const StepContext& step, VsiState& state, StepWorkspace& ws) override {
    for (int v = 0; v < static_cast<int>(state.vehicle.size()); ++v) {
      const WheelsetHeave moved = heave_of(step, v);
      for (int i = 0; i < per_vehicle_; ++i) {
        ws.solution.displacement[wheelset_unknowns * (per_vehicle_ * v + i) + 2] = moved.z[i];
      }
      wheels(step).update(step.hht, prediction_[index(v)], loaded(v), moved,
                          force_.segment(per_vehicle_ * v, per_vehicle_), state.vehicle[index(v)]);
      if (!elements_) continue;
      elements_->add_end_force(v, state.vehicle[index(v)].contact_load);
      elements_->store_friction(v, state.friction[index(v)]);
    }
    std::swap(state.contact, ws.solution);
  }

  void reinitialise() override {}

 private:
  [[nodiscard]] static const RigidWheelResponse& wheels(const StepContext& step) {
    return *step.operators.rigid_wheels;
  }

  // R of a vehicle with the load of its force elements.
  [[nodiscard]] Eigen::VectorXd loaded(int v) const {
    if (!elements_) return remainder_[index(v)];
    return remainder_[index(v)] + element_load_[index(v)];
  }

  [[nodiscard]] int vehicles() const { return static_cast<int>(remainder_.size()); }

  void load_without_heave(const StepContext& step, int v) {
    free_force_.segment(per_vehicle_ * v, per_vehicle_) = wheels(step).free_force(loaded(v));
  }

  // Contact forces, and the lines under them, for what acts on the vehicles.
  void follow(const StepContext& step, const StepWorkspace& ws) {
    std::vector<Vector3d> free(free_.size());
    for (std::size_t w = 0; w < free_.size(); ++w) {
      increment_[w] = free_[w] + ws.far_field.segment<3>(3 * static_cast<Eigen::Index>(w));
      free[w] = heave(step.hht, w, increment_[w]);
    }
    solve_forces(step, free);
    for (const LineCoupling& c : couplings_) increment_[index(c.i)] -= c.line * force_[c.j];
  }

  // The force elements for the wheelsets' heave, which they change through the rails alone: little in a step. Returns
  // what their forces have changed by where that is more than rounding, or NaN.
  double respond_by_elements(const StepContext& step) {
    constexpr double rounding = 1e-11;
    double change = 0.0;
    for (int v = 0; elements_ && v < vehicles(); ++v) {
      const RigidWheelResponse& response = wheels(step);
      const LinearMotion& motion = state_->vehicle[index(v)];
      const WheelsetHeave heave = heave_of(step, v);
      const Eigen::VectorXd free = response.displacement(prediction_[index(v)], remainder_[index(v)], heave);
      elements_->begin(v, {ElementRule::endpoint, step.hht.time_step, step.hht.velocity_rate()},
                       {motion, state_->friction[index(v)], response.prescribed(prediction_[index(v)], heave), free},
                       free);
      if (!elements_->solve(v)) return std::numeric_limits<double>::quiet_NaN();
      const Eigen::VectorXd before = element_load_[index(v)];
      Eigen::VectorXd& load = element_load_[index(v)];
      load.setZero();
      elements_->add_share(v, load);
      load *= step.hht.load_weight();
      load_without_heave(step, v);
      const double difference = (load - before).cwiseAbs().maxCoeff();
      if (difference > rounding * (1.0 + before.cwiseAbs().maxCoeff())) change = std::max(change, difference);
    }
    return change;
  }

  [[nodiscard]] WheelsetHeave heave_of(const StepContext& step, int v) const {
    WheelsetHeave moved{Eigen::VectorXd(per_vehicle_), Eigen::VectorXd(per_vehicle_), Eigen::VectorXd(per_vehicle_)};
    for (int i = 0; i < per_vehicle_; ++i) {
      const int w = per_vehicle_ * v + i;
      const Vector3d h = heave(step.hht, index(w), increment_[index(w)]);
      moved.z[i] = h[0];
      moved.v[i] = h[1];
      moved.a[i] = h[2];
    }
    return moved;
  }

  // (z, v, a) of a wheelset for an increment of its line.
  [[nodiscard]] Vector3d heave(const HhtScheme& hht, std::size_t wheelset, const Vector3d& increment) const {
    return known_[wheelset] +
           followed(increment, hht.velocity_rate() * increment, hht.acceleration_rate() * increment[0], running_);
  }

  // The line that supports carry the rails along, as the wheels of every wheelset follow it.
  void add_carried(const StepContext& step) {
    const StructureSupports& supports = step.model.structure->supports;
    if (!step.model.ground_motion || supports.carried.size() == 0) return;
    const SupportMotion motion = support_motion(*step.model.ground_motion, supports.x, step.end);
    for (std::size_t w = 0; w < known_.size(); ++w) {
      const auto line = [&](const Eigen::VectorXd& translations) -> Vector3d {
        CarriedHead mean = CarriedHead::Zero();
        for (std::size_t side = 0; side < 2; ++side)
          mean += 0.5 * carried_head(step.contacts[2 * w + side], supports, translations);
        return {mean[1], -mean[4], mean[5]};
      };
      known_[w] += followed(line(motion.displacement), line(motion.velocity), line(motion.acceleration)[0], running_);
    }
  }

  // The constraint of Eq. 14 with its first two time derivatives, condensed to the vertical contact forces:
  //   [ I + (Z W A) T L ] F = F_0 + (Z W A) h_free
  // since F = F_0 + (Z W A) h and h = h_free − T L F; L are the couplings, T takes (z, v, a) of their lines.
  void solve_forces(const StepContext& step, const std::vector<Vector3d>& free) {
    const int wheelsets = static_cast<int>(free_force_.size());
    const RigidWheelResponse& response = wheels(step);
    const double rate = step.hht.velocity_rate();
    const auto impedance = [&](int i, int k) {
      const int a = i % per_vehicle_, b = k % per_vehicle_;
      return Vector3d(response.stiffness()(a, b), response.damping()(a, b), response.mass()(a, b));
    };
    // Wheelsets of the train that a vehicle's springs couple with one of them.
    const auto coupled = [&](int i) {
      const int first = i - i % per_vehicle_;
      const WheelsetRange of_vehicle = step.operators.vehicle.coupled()[index(i - first)];
      return WheelsetRange{first + of_vehicle.first, first + of_vehicle.end};
    };
    system_.setIdentity(wheelsets, wheelsets);
    right_ = free_force_;
    for (int i = 0; i < wheelsets; ++i) {
      const auto [first, end] = coupled(i);
      for (int k = first; k < end; ++k) right_[i] += impedance(i, k).dot(free[index(k)]);
    }
    for (const LineCoupling& c : couplings_) {
      const Vector3d motion = followed(c.line, rate * c.line, step.hht.acceleration_rate() * c.line[0], running_);
      const auto [first, end] = coupled(c.i);
      for (int i = first; i < end; ++i) system_(i, c.j) += impedance(i, c.i).dot(motion);
    }
    factor_.factor(system_);
    factor_.solve(right_, force_);
  }

  int per_vehicle_;
  std::vector<Prediction> prediction_;          // per vehicle
  std::vector<Eigen::VectorXd> remainder_;      // per vehicle: R
  const VsiState* state_ = nullptr;             // at the begin of the step
  std::optional<TrainElements> elements_;       // where vehicles have force elements
  std::vector<Eigen::VectorXd> element_load_;   // per vehicle: on its dofs, in R
  Eigen::VectorXd free_force_, right_, force_;  // per wheelset: without heave, right-hand side, and solved [N]
  Eigen::MatrixXd system_;
  LuFactor factor_;
  Running running_{};
  std::vector<LineCoupling> couplings_;
  std::vector<Vector3d> known_;      // (z, v, a) of irregularity and predictor
  std::vector<Vector3d> free_;       // increment of the lines without contact forces
  std::vector<Vector3d> increment_;  // with them
};

}  // namespace

std::unique_ptr<ContactLaw> make_rigid_wheels(const VsiModel& model) { return std::make_unique<RigidWheels>(model); }

}  // namespace railtab
