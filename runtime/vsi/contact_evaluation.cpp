#include "railtab/runtime/vsi/contact_evaluation.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

#include "railtab/runtime/base/index.hpp"
#include "railtab/runtime/base/stopwatch.hpp"
#include "railtab/runtime/contact/contact_response.hpp"

namespace railtab {

namespace {

using Matrix12 = NewtonWorkspace::Matrix12;

WheelContact contact_of_wheel(const WheelContactModel& model, std::size_t wheel, const WheelsetPose& pose, Pairs pairs,
                              NewtonWorkspace& ws) {
  if (ws.found.empty()) return wheel_contact(*model.geometry, pose);
  if (pairs == Pairs::searched) {
    ws.found[wheel] = model.geometry->patches(pose);
    ws.found_at[wheel] = pose;
  }
  WheelContact contact;
  contact.pose = pose;
  contact.patches = pairs == Pairs::searched
                        ? ws.found[wheel]
                        : moved_patches(*model.geometry, ws.found[wheel], ws.found_at[wheel], pose);
  return contact;
}

// What a wheel's force consists of.
void keep_numbers(const WheelForce& force, std::size_t wheel, ContactSolution& s, ContactCounts& counts) {
  s.rail_x[wheel] = force.rail_x;
  s.normal[wheel] = force.normal;
  s.creep_power[wheel] = force.creep_power;
  s.pressure[wheel] = force.pressure;
  counts.outside_creep_table += force.outside_creep_table;
}

// A wheel's part of the tangent of its wheelset.
void add_tangent(const Matrix9& of_wheel, int side, Matrix12& tangent) {
  const int r = 6 + 3 * side;
  tangent.topLeftCorner<6, 6>() += of_wheel.topLeftCorner<6, 6>();
  tangent.block<6, 3>(0, r) += of_wheel.topRightCorner<6, 3>();
  tangent.block<3, 6>(r, 0) += of_wheel.bottomLeftCorner<3, 6>();
  tangent.block<3, 3>(r, r) += of_wheel.bottomRightCorner<3, 3>();
}

}  // namespace

ContactCounts evaluate(const TrainContact& train, const ContactProblem& problem, Pairs pairs, Wheelsets wheelsets,
                       ContactSolution& s, NewtonWorkspace& ws) {
  ContactCounts counts;
  for (int w = wheelsets.first; w < wheelsets.end; ++w) {
    const WheelContactModel& model = train[w];
    const WheelsetMotion motion = wheelset_motion(problem, s.displacement, w);
    auto force = s.force.segment<wheelset_unknowns>(wheelset_unknowns * w);
    auto end_force = s.end_force.segment<wheelset_unknowns>(wheelset_unknowns * w);
    force.setZero();
    end_force.setZero();
    for (int side = 0; side < 2; ++side) {
      const RailHeadMotion rail = rail_motion(problem, s.displacement, w, side);
      const WheelSide wheel_side = wheel_sides[index(side)];
      const std::size_t number = index(2 * w + side);
      const WheelsetPose pose = relative_pose(model.geometry->pair(), wheel_side, motion, rail);
      WheelContact& contact = s.contact[number];
      {
        const Stopwatch watch(counts.seconds_lookup);
        contact = contact_of_wheel(model, number, pose, pairs, ws);
      }
      if (pairs == Pairs::searched) {
        ++counts.queries;
        if (answered_by_table(*model.geometry, contact)) ++counts.table_queries;
      }
      const LoadedWheelForce wheel = wheel_force(model, wheel_side, motion, rail, contact);
      const int r = 6 + 3 * side;
      end_force.head<6>() += wheel.wheelset;
      end_force.segment<3>(r) = wheel.rail;
      keep_numbers(wheel, number, s, counts);
      s.memory[number] = contact_memory(model.geometry->pair(), contact, wheel);
      if (problem.start) {
        const ContactMemory& start = problem.start->memory[number];
        const Vector9 share =
            problem.mean_weight *
            (mean_force(model, wheel_side, motion, rail, start, contact, wheel) - 0.5 * start.force());
        force.head<6>() += share.head<6>();
        force.segment<3>(r) = share.tail<3>();
      } else {
        force.head<6>() += wheel.wheelset;
        force.segment<3>(r) = wheel.rail;
      }
    }
  }
  return counts;
}

bool computes_side_by_side(const TrainContact& train, const ContactProblem& problem) noexcept {
  return !problem.start && std::all_of(train.model.begin(), train.model.end(),
                                       [](const WheelContactModel& model) { return computes_side_by_side(model); });
}

ContactCounts evaluate_side_by_side(const TrainContact& train, const ContactProblem& problem,
                                    std::span<const int> wheelsets, ContactSolution& s, NewtonWorkspace& ws) {
  using Computed = NewtonWorkspace::Computed;
  constexpr std::size_t most = WheelLanes::count / 2;  // wheelsets
  // With 10 and 20 % runs took the same time, with 40 % longer.
  constexpr double most_tangent_error = 0.15;
  ContactCounts counts;
  std::array<WheelState, 2 * most> wheel;
  std::array<LoadedAnswer, 2 * most> answer;
  std::array<LoadedWheelForce, 2 * most> of_wheel;
  std::array<Matrix9, 2 * most> tangent;
  for (std::size_t first = 0, count = 0; first < wheelsets.size(); first += count) {
    // neighbours on the same profiles
    const WheelContactModel& model = train[wheelsets[first]];
    bool differentiates = false;
    for (count = 0; count < most && first + count < wheelsets.size(); ++count) {
      const int w = wheelsets[first + count];
      if (train[w].geometry != model.geometry) break;
      const WheelsetMotion motion = wheelset_motion(problem, s.displacement, w);
      for (int side = 0; side < 2; ++side) {
        const std::size_t i = 2 * count + index(side);
        WheelContact& contact = s.contact[index(2 * w + side)];
        wheel[i] = {wheel_sides[index(side)], motion, rail_motion(problem, s.displacement, w, side)};
        answer[i] = {&contact.pose, &contact.loaded, &of_wheel[i], &tangent[i]};
      }
      // Not for the sake of a wheelset that will probably not be answered again.
      differentiates |= problem.wheelsets_per_group == 1 && ws.computed[index(w)] != Computed::nothing &&
                        ws.tangent_error[index(w)] > most_tangent_error;
    }
    const std::span<const WheelState> wheels(wheel.data(), 2 * count);
    const std::uint32_t answered =
        differentiates
            ? loaded_wheel_responses(model, wheels, {problem.velocity_rate, problem.rail_velocity_rate}, answer)
            : loaded_wheel_forces(model, wheels, answer);
    for (std::size_t i = 0; i < count; ++i) {
      const int w = wheelsets[first + i];
      const bool both = (answered >> (2 * i) & 3U) == 3U;
      ws.computed[index(w)] = !both            ? Computed::nothing
                              : differentiates ? Computed::forces_and_tangent
                                               : Computed::forces;
      if (!both) continue;
      auto force = s.force.segment<wheelset_unknowns>(wheelset_unknowns * w);
      force.setZero();
      for (int side = 0; side < 2; ++side) {
        const std::size_t number = index(2 * w + side);
        const LoadedWheelForce& of = of_wheel[2 * i + index(side)];
        force.head<6>() += of.wheelset;
        force.segment<3>(6 + 3 * side) = of.rail;
        keep_numbers(of, number, s, counts);
        s.contact[number].patches.clear();
        ContactMemory& memory = s.memory[number];
        memory.pose = s.contact[number].pose;
        memory.count = 0;
        memory.loaded = of.memory;
      }
      s.end_force.segment<wheelset_unknowns>(wheelset_unknowns * w) = force;
      if (differentiates) {
        ws.tangent[index(w)].setZero();
        for (int side = 0; side < 2; ++side) add_tangent(tangent[2 * i + index(side)], side, ws.tangent[index(w)]);
      }
      counts.queries += 2;
      counts.table_queries += 2;
    }
  }
  return counts;
}

void differentiate(const TrainContact& train, const ContactProblem& problem, Wheelsets wheelsets,
                   const ContactSolution& s, NewtonWorkspace& ws) {
  for (int w = wheelsets.first; w < wheelsets.end; ++w) {
    const WheelContactModel& model = train[w];
    Matrix12& tangent = ws.tangent[index(w)];
    tangent.setZero();
    const WheelsetMotion motion = wheelset_motion(problem, s.displacement, w);
    for (int side = 0; side < 2; ++side) {
      const RailHeadMotion rail = rail_motion(problem, s.displacement, w, side);
      const std::size_t number = index(2 * w + side);
      const ContactMemory* start = problem.start ? &problem.start->memory[number] : nullptr;
      const Matrix9 t = (start ? problem.mean_weight : 1.0) *
                        wheel_force_tangent(model, wheel_sides[index(side)], motion, rail, s.contact[number],
                                            {problem.velocity_rate, problem.rail_velocity_rate, start});
      add_tangent(t, side, tangent);
    }
  }
}

ContactCounts& ContactCounts::operator+=(const ContactCounts& more) noexcept {
  queries += more.queries;
  table_queries += more.table_queries;
  outside_creep_table += more.outside_creep_table;
  seconds_lookup += more.seconds_lookup;
  return *this;
}

WheelsetMotion wheelset_motion(const ContactProblem& problem, const Eigen::VectorXd& q, int wheelset) noexcept {
  const int k = wheelset_unknowns * wheelset;
  const Vector6 displacement = q.segment<6>(k);
  return {displacement, problem.predicted_velocity.segment<6>(k) +
                            problem.velocity_rate.cwiseProduct(displacement - problem.predicted.segment<6>(k))};
}

RailHeadMotion rail_motion(const ContactProblem& problem, const Eigen::VectorXd& q, int wheelset, int side) noexcept {
  const int k = wheelset_unknowns * wheelset + 6 + 3 * side;
  RailHeadMotion motion = problem.deviation[index(wheelset)][index(side)];
  const Vector3 displacement = q.segment<3>(k);
  motion.displacement += displacement;
  motion.velocity += problem.predicted_velocity.segment<3>(k) +
                     problem.rail_velocity_rate * (displacement - problem.predicted.segment<3>(k));
  return motion;
}

void evaluate_contact(const TrainContact& train, const ContactProblem& problem, ContactSolution& solution) {
  NewtonWorkspace workspace;
  const int wheelsets = static_cast<int>(solution.displacement.size()) / wheelset_unknowns;
  evaluate(train, problem, Pairs::searched, {0, wheelsets}, solution, workspace);
}

}  // namespace railtab
