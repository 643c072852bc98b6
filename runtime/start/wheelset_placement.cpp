#include "railtab/runtime/start/wheelset_placement.hpp"

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>

#include "railtab/runtime/base/index.hpp"
#include "railtab/runtime/start/static_equilibrium.hpp"
#include "railtab/runtime/vehicle/static_wheel_load.hpp"
#include "railtab/runtime/vsi/step.hpp"

namespace railtab {

namespace {

// Heights of wheels against their rails [m]: the tips of flanges lift them by 28 mm.
constexpr double highest = 0.04, deepest = 0.02;
constexpr double first_look = 2e-3;       // m: less deep, no contact goes unnoticed
constexpr double level_accuracy = 1e-12;  // m: a few newtons on contacts a thousand times as stiff as steel

// Vertical force of one rail on wheelset w, down [N].
double vertical_force(const TrainContact& train, const ContactProblem& problem, const Eigen::VectorXd& displacement,
                      int w, int side) {
  const WheelContactModel& contact = train[w];
  const WheelSide wheel_side = side == 0 ? WheelSide::left : WheelSide::right;
  const WheelsetMotion motion = wheelset_motion(problem, displacement, w);
  const RailHeadMotion rail = rail_motion(problem, displacement, w, side);
  const WheelContact found =
      wheel_contact(*contact.geometry, relative_pose(contact.geometry->pair(), wheel_side, motion, rail));
  return -wheel_force(contact, wheel_side, motion, rail, found).wheelset[2];
}

const DofIndices& wheelset_dof(const VsiModel& model, int w) {
  return model.vehicle.dof[index(model.vehicle.wheelsets[index(w % model.wheelsets_per_vehicle())])];
}

// A wheelset that stands on its rails with given loads on its two wheels [N].
class WheelsetPlacement {
 public:
  WheelsetPlacement(const TrainContact& contact, const ContactProblem& problem, int w,
                    const std::array<double, 2>& load, Eigen::VectorXd& displacement)
      : contact_(contact),
        problem_(problem),
        w_(w),
        load_(load),
        half_distance_(contact[w].geometry->pair().tape_circle_offset()),
        z_(displacement[wheelset_unknowns * w + 2]),
        roll_(displacement[wheelset_unknowns * w + 3]),
        displacement_(displacement) {}

  // Lowers the wheelset, as it is turned and rolled, until the wheel on `side` carries its load. From above: a wheel
  // deep in its rail has no contact that a search would find.
  double level(int side) {
    const double rail = rail_motion(problem_, displacement_, w_, side).displacement[1];
    const double on_rail = rail - (side == 0 ? -half_distance_ : half_distance_) * roll_;
    const auto carries = [&] {
      return vertical_force(contact_, problem_, displacement_, w_, side) > load_[index(side)];
    };
    double high = on_rail - highest, low = high;
    // Counted: where rails are displaced by 1e20 m, a look farther down is the same height again.
    constexpr int most_looks = static_cast<int>((highest + deepest) / first_look) + 2;
    bool found = false;
    for (int look = 0; look < most_looks && !found && !(low > on_rail + deepest); ++look) {
      high = low;
      z_ = low = high + first_look;
      found = carries();
    }
    if (!found) {
      near_rails_ = false;
      return z_;
    }
    constexpr int most_halvings = 64;
    for (int i = 0; i < most_halvings && low - high > level_accuracy; ++i) {
      z_ = 0.5 * (low + high);
      (carries() ? low : high) = z_;
    }
    near_rails_ = near_rails_ && low > on_rail - highest + first_look;
    return z_;
  }

  // To the height between those that the two wheels ask for. Returns the right one's less the left one's [m].
  double settle() {
    near_rails_ = true;
    const double left = level(0), right = level(1);
    z_ = 0.5 * (left + right);
    return right - left;
  }

  // Rolls the wheelset until both wheels ask for the same height; false where none near the rails does that.
  //
  // The heights' difference falls by the wheels' distance per roll where treads carry, hardly where a flange does: a
  // wheelset rolls about its centre, so that the flange leaves its rail by tan(contact angle) R0 as its wheel sinks by
  // half the distance. With the slope of treads a fixed-point iteration would creep there; the sign always shows the
  // way.
  bool roll_level() {
    constexpr double most_roll = 0.1;  // rad
    constexpr double enough = 1e-13;   // rad
    constexpr double jump = 1e-7;      // m: what forces that are continuous do not leave
    const double begin = roll_;
    const auto difference = [&](double roll) {
      roll_ = roll;
      return settle();
    };
    double from = begin, to = begin, at_from = difference(begin), at_to = at_from;
    for (double step = at_from / (2.0 * half_distance_); std::signbit(at_from) == std::signbit(at_to); step *= 2.0) {
      if (!(std::abs(to - begin) <= most_roll) || !std::isfinite(at_to)) return false;
      if (std::abs(at_to) <= level_accuracy) return near_rails();
      from = to;
      at_from = at_to;
      to += step;
      at_to = difference(to);
    }
    if (!std::isfinite(at_from) || !std::isfinite(at_to)) return false;
    if (from > to) {
      std::swap(from, to);
      std::swap(at_from, at_to);
    }
    boost::uintmax_t passes = 100;
    const auto close = [](double a, double b) { return std::abs(a - b) < enough; };
    const auto [left, right] = boost::math::tools::toms748_solve(difference, from, to, at_from, at_to, close, passes);
    return std::abs(difference(0.5 * (left + right))) < jump && near_rails();
  }

  [[nodiscard]] bool near_rails() const { return near_rails_; }

 private:
  const TrainContact& contact_;
  const ContactProblem& problem_;
  int w_;
  std::array<double, 2> load_;
  double half_distance_;
  bool near_rails_ = true;  // whether there were heights at which the wheels carry their loads
  double& z_;
  double& roll_;
  Eigen::VectorXd& displacement_;
};

// What static wheel loads displace the rails by.
void load_rails(const VsiModel& model, const ContactProblem& problem, Eigen::VectorXd& displacement) {
  for (int wheel = 0; wheel < 2 * model.wheelsets(); ++wheel)
    displacement.segment<3>(rail_unknown(wheel)) = problem.free.segment<3>(rail_unknown(wheel));
  for (const RailCoupling& c : problem.rail) {
    const double load = wheel_load_at_rest(model.vehicle, c.j % model.wheelsets_per_vehicle());
    displacement.segment<6>(rails_unknown(c.i)) += load * c.under_vertical_loads();
  }
}

}  // namespace

TrainContact contact_at_rest(const VsiModel& model) {
  TrainContact rest = model.train_contact();
  for (WheelContactModel& contact : rest.model) contact.damping = 0.0;
  return rest;
}

void set_down(const VsiModel& model, const TrainContact& contact, const ContactProblem& problem,
              Eigen::VectorXd& displacement) {
  load_rails(model, problem, displacement);
  for (int w = 0; w < model.wheelsets(); ++w) {
    const DofIndices& dof = wheelset_dof(model, w);
    if (dof[2] == held) continue;
    const double load = wheel_load_at_rest(model.vehicle, w % model.wheelsets_per_vehicle());
    WheelsetPlacement placement(contact, problem, w, {load, load}, displacement);
    const double difference = placement.settle();
    if (dof[3] == held) continue;
    displacement[wheelset_unknowns * w + 3] = difference / (2.0 * contact[w].geometry->pair().tape_circle_offset());
  }
}

bool displace_train(const VsiModel& model, double shift, double yaw, VsiState& state) {
  if (shift == 0.0 && yaw == 0.0) return true;
  const bool on_profiles = model.normal_contact == NormalContact::hertz;
  const TrainContact contact = contact_at_rest(model);
  std::vector<std::array<double, 2>> load(index(model.wheelsets()));
  if (on_profiles) {
    const ContactProblem before = present_contact(model, state);
    for (int w = 0; w < model.wheelsets(); ++w) {
      for (int side = 0; side < 2; ++side) {
        load[index(w)][index(side)] = vertical_force(contact, before, before.predicted, w, side);
      }
    }
  }
  for (LinearMotion& motion : state.vehicle) {
    motion.displacement += shift * model.vehicle.lateral_shift;
    for (int body : model.vehicle.wheelsets) {
      const int turned = model.vehicle.dof[index(body)][5];
      if (turned != held) motion.displacement[turned] += yaw;
    }
  }
  if (!on_profiles) return true;
  const ContactProblem displaced = present_contact(model, state);
  Eigen::VectorXd displacement = displaced.predicted;
  for (int w = 0; w < model.wheelsets(); ++w) {
    const DofIndices& dof = wheelset_dof(model, w);
    if (dof[2] == held) continue;
    WheelsetPlacement placement(contact, displaced, w, load[index(w)], displacement);
    if (dof[3] == held) {
      placement.settle();
      if (!placement.near_rails()) return false;
    } else if (!placement.roll_level()) {
      return false;
    }
    LinearMotion& motion = state.vehicle[index(w / model.wheelsets_per_vehicle())];
    motion.displacement[dof[2]] = displacement[wheelset_unknowns * w + 2];
    if (dof[3] != held) motion.displacement[dof[3]] = displacement[wheelset_unknowns * w + 3];
  }
  evaluate_contact_at(model, state);
  return true;
}

}  // namespace railtab
