#include "railtab/fmi/track_simulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "railtab/runtime/base/input_error.hpp"

namespace railtab::fmi {
namespace {

// Steps of `time_step` in `length`; 0 where it is no multiple of it.
long steps_in(double length, double time_step) {
  constexpr double most = 1e9, relative = 1e-6, part_of_a_step = 1e-3;
  const double steps = length / time_step;
  const double rounding = std::min(relative * std::round(steps), part_of_a_step);
  if (!(steps > 0.5 && steps < most) || std::abs(steps - std::round(steps)) > rounding) return 0;
  return std::lround(steps);
}

double mean_x(const std::vector<double>& input) {
  double sum = 0.0;
  for (std::size_t i = 0; i < input.size(); i += inputs_per_wheelset) sum += input[i];
  return sum * inputs_per_wheelset / static_cast<double>(input.size());
}

Eigen::VectorXd forces(const std::vector<RailLoad>& loads) {
  Eigen::VectorXd forces(3 * static_cast<Eigen::Index>(loads.size()));
  for (std::size_t i = 0; i < loads.size(); ++i) forces.segment<3>(3 * static_cast<Eigen::Index>(i)) = loads[i].load;
  return forces;
}

}  // namespace

TrackSimulation::TrackSimulation(DrivenTrack track)
    : track_(std::move(track)), variables_(track_variables(track_)), response_(track_.structure, track_.scheme) {
  reset();
}

void TrackSimulation::reset() {
  state_ = TrackState();
  for (const TrackVariable& variable : variables_) {
    if (variable.causality == Causality::input) state_.input.push_back(variable.start);
  }
  state_.applied = state_.input;
  state_.motion = StructureMotion(track_.structure.dofs());
  response_.bring_in_order(state_.motion);
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(6 * static_cast<Eigen::Index>(track_.wheelset_x.size()));
  state_.deflection = {none, none, none};
  loads_ = loads(state_.applied);
  move_elements();
}

void TrackSimulation::set(std::size_t input, double value) {
  constexpr double largest_load = 1e8;  // [N], [N m]: no scene accepts more, wheels carry 1e5 N
  const TrackVariable& variable = variables_[input];
  if (!std::isfinite(value)) throw input_error(variable.name, fmt::format("{}", value), "a finite number");
  const bool is_load = input % inputs_per_wheelset != 0;
  if (is_load && std::abs(value) > largest_load) {
    throw input_error(variable.name, fmt::format("{:g} {}", value, variable.unit),
                      fmt::format("-{0:g} to {0:g} {1}", largest_load, variable.unit));
  }
  state_.input[input] = value;
}

std::vector<RailLoad> TrackSimulation::loads(const std::vector<double>& input) const {
  std::vector<RailLoad> loads;
  for (std::size_t w = 0; w < track_.wheelset_x.size(); ++w) {
    const double* const of = &input[inputs_per_wheelset * w];
    for (const RailSide side : {RailSide::left, RailSide::right}) {
      const double* const load = of + 1 + 3 * static_cast<int>(side);
      loads.push_back({rail_contact(track_.structure, side, of[0]), {load[0], load[1], load[2]}});
    }
  }
  return loads;
}

void TrackSimulation::rest() {
  state_.applied = state_.input;
  loads_ = loads(state_.applied);
  state_.motion = rest_under(track_.structure, loads_);
  response_.bring_in_order(state_.motion);
  state_.deflection.force = state_.deflection.slope_force = forces(loads_);
  state_.deflection.rate.setZero();
  state_.speed = 0.0;
  move_elements();
}

void TrackSimulation::move_elements() {
  std::vector<RailContact> contacts;
  for (const RailLoad& load : loads_) contacts.push_back(load.place);
  const ElementDeflection& d = state_.deflection;
  element_motion(contacts, d.force, d.rate, d.slope_force, state_.speed, elements_);
}

void TrackSimulation::step(double length) {
  const double time_step = track_.scheme.time_step;
  const long steps = steps_in(length, time_step);
  if (steps == 0) {
    throw input_error("communicationStepSize", fmt::format("{} s", length),
                      fmt::format("{} s, integration.time_step of the scene, or a multiple of it", time_step));
  }
  const std::vector<double> before = state_.applied;
  for (long k = 1; k <= steps; ++k) {
    const double share = static_cast<double>(k) / static_cast<double>(steps), from = mean_x(state_.applied);
    for (std::size_t i = 0; i < before.size(); ++i) {
      state_.applied[i] = k == steps ? state_.input[i] : before[i] + share * (state_.input[i] - before[i]);
    }
    loads_ = loads(state_.applied);
    state_.speed = (mean_x(state_.applied) - from) / time_step;
    advance_structure(response_, loads_, state_.motion, workspace_);
    const ElementStep of_step(track_.scheme);
    Eigen::VectorXd end = of_step.free(state_.deflection) + of_step.share * forces(loads_);
    of_step.close(end, state_.deflection);
    ++state_.steps;
  }
  move_elements();
}

double TrackSimulation::value(std::size_t variable) const {
  if (variable < inputs()) return state_.input[variable];
  const LinearMotion& motion = std::as_const(state_.motion).whole();
  const std::size_t output = variable - inputs(), wheel = output / outputs_per_wheel;
  if (wheel < loads_.size()) {
    const RailContact& place = loads_[wheel].place;
    const std::size_t k = output % outputs_per_wheel;
    const RailHeadMotion& element = elements_[wheel];
    if (k < 3) return (rail_head(place, motion.displacement) + element.displacement)[static_cast<Eigen::Index>(k)];
    if (k < 6) return (rail_head(place, motion.velocity) + element.velocity)[static_cast<Eigen::Index>(k - 3)];
    return rail_slopes(place, motion.displacement)[static_cast<Eigen::Index>(k - 6)] +
           (k == 6 ? element.yaw : -element.slope);
  }
  const std::size_t of_nodes = output - outputs_per_wheel * loads_.size(), k = of_nodes % outputs_per_node;
  constexpr std::size_t y = 1;
  return node_motion(track_.structure, of_nodes / outputs_per_node, y + k % 2,
                     k < 2 ? motion.displacement : motion.acceleration);
}

void TrackSimulation::set_state(const TrackState& state) {
  state_ = state;
  loads_ = loads(state_.applied);
  move_elements();
}

namespace {

// Every number of a state but the steps, in a fixed order.
template <class State, class Visitor>
void visit_numbers(State& state, Visitor&& visit) {
  visit(&state.begin, 1);
  visit(state.input.data(), state.input.size());
  visit(state.applied.data(), state.applied.size());
  visit(&state.speed, 1);
  const auto visit_vector = [&](auto& vector) { visit(vector.data(), static_cast<std::size_t>(vector.size())); };
  for (auto* vector : state.motion.numbers()) visit_vector(*vector);
  visit_vector(state.motion.loads().contact_load);
  auto& d = state.deflection;
  for (auto* vector : {&d.force, &d.rate, &d.slope_force}) visit_vector(*vector);
}

}  // namespace

std::vector<double> packed(const TrackState& state) {
  std::vector<double> numbers{static_cast<double>(state.steps)};
  visit_numbers(state, [&](const double* data, std::size_t n) { numbers.insert(numbers.end(), data, data + n); });
  return numbers;
}

TrackState unpacked(const std::vector<double>& numbers, const TrackState& like) {
  TrackState state = like;
  const std::size_t expected = packed(like).size();
  constexpr double most_steps = 1e15;
  if (numbers.size() != expected || !(numbers[0] >= 0.0 && numbers[0] < most_steps)) {
    throw input_error("serialized state", fmt::format("{} numbers", numbers.size()),
                      fmt::format("{}, a state of this FMU", expected));
  }
  std::size_t next = 0;
  state.steps = std::lround(numbers[next++]);
  visit_numbers(state, [&](double* data, std::size_t n) {
    std::copy_n(numbers.begin() + static_cast<std::ptrdiff_t>(next), n, data);
    next += n;
  });
  return state;
}

}  // namespace railtab::fmi
