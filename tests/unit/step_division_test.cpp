// How steps are divided at impacts and where they diverge.

#include "railtab/runtime/vsi/step_division.hpp"

#include <gtest/gtest.h>

namespace railtab {
namespace {

constexpr double wheel_load = 5e4;  // N
constexpr int impact_level = 2, landing_level = 5;

// 1 ms: 0.25 ms in an impact, 31.25 µs after a landing.
IntegrationParameters parameters() {
  IntegrationParameters p;
  p.time_step = 1e-3;
  p.impact_step = 3.125e-5;
  return p;
}

StepReport rejected(StepOutcome outcome, ContactChange change) {
  StepReport report;
  report.outcome = outcome;
  report.contact_change = change;
  return report;
}

TEST(StepDivision, AWheelThatMeetsItsRailTakesTheFinestSteps) {
  const StepDivision division(parameters(), true, wheel_load);
  VsiState state{VsiModel{}};
  EXPECT_EQ(division.coarsest_level(state), 0);
  const StepReport landing = rejected(StepOutcome::contact_state_changed, ContactChange::gained);
  EXPECT_EQ(division.begin_impact(landing, 1e-3, state), landing_level);
  EXPECT_EQ(division.coarsest_level(state), landing_level);
  state.time = 1e-3;
  EXPECT_EQ(division.coarsest_level(state), 0) << "the wheel may not have landed in the finer steps";
  division.after_step(ContactChange::gained, state);
  EXPECT_EQ(division.coarsest_level(state), landing_level);
  state.time = 2.5e-3;
  EXPECT_EQ(division.coarsest_level(state), impact_level);
  state.time = 12e-3;
  EXPECT_EQ(division.coarsest_level(state), 0);
}

TEST(StepDivision, AWheelThatLeavesItsRailTakesTheStepsOfAnImpact) {
  const StepDivision division(parameters(), true, wheel_load);
  VsiState state{VsiModel{}};
  const StepReport flight = rejected(StepOutcome::contact_state_changed, ContactChange::lost);
  EXPECT_EQ(division.begin_impact(flight, 1e-3, state), impact_level);
  EXPECT_EQ(division.coarsest_level(state), impact_level);
}

TEST(StepDivision, AForceJumpIsDividedForTheTimeOfAnImpact) {
  const StepDivision division(parameters(), true, wheel_load);
  EXPECT_EQ(division.force_jump(), 0.25 * wheel_load);
  VsiState state{VsiModel{}};
  const StepReport jump = rejected(StepOutcome::force_jumped, ContactChange::none);
  EXPECT_EQ(division.begin_impact(jump, 1e-3, state), landing_level);
  state.time = 1.5e-3;
  EXPECT_EQ(division.coarsest_level(state), landing_level);
  state.time = 10.5e-3;
  EXPECT_EQ(division.coarsest_level(state), impact_level);
}

TEST(StepDivision, WhatRejectsAStep) {
  const StepDivision division(parameters(), true, wheel_load);
  const auto endpoint = ContactForceRule::endpoint, energy = ContactForceRule::energy;
  EXPECT_EQ(division.rejected_events(0, endpoint), RejectedEvents::contact_change_and_force_jump);
  EXPECT_EQ(division.rejected_events(impact_level, energy), RejectedEvents::contact_change_and_force_jump);
  EXPECT_EQ(division.rejected_events(landing_level, endpoint), RejectedEvents::contact_change);
  EXPECT_EQ(division.rejected_events(landing_level, energy), RejectedEvents::none);
  const StepDivision fixed(parameters(), false, wheel_load);
  EXPECT_EQ(fixed.rejected_events(0, endpoint), RejectedEvents::none);
}

TEST(StepDivision, AStepThatDivergesIsHalvedSoManyTimes) {
  IntegrationParameters p = parameters();
  p.max_halvings = 3;
  const StepDivision division(p, true, wheel_load);
  EXPECT_TRUE(division.may_halve(2, 0));
  EXPECT_FALSE(division.may_halve(3, 0));
  EXPECT_TRUE(division.may_halve(landing_level + 2, landing_level));
}

}  // namespace
}  // namespace railtab
