#include "railtab/runtime/vsi/structure_response.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <limits>
#include <tuple>
#include <utility>
#include <vector>

#include "railtab/runtime/algebra/elimination_order.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/structure/track_bridge.hpp"
#include "railtab/runtime/vsi/operator_room.hpp"

namespace railtab {
namespace {

// @param offset of the track's centre from the deck's [m]
StructureModel short_bridge(double offset = 0.0) {
  TrackParameters track;
  track.length_before = track.length_after = 6.0;
  BridgeParameters span;
  span.length = 6.0;
  span.elements = 10;
  span.track_offset = offset;
  return build_track_bridge(track, {span});
}

LinearMotion random_motion(Eigen::Index dofs) {
  LinearMotion motion(dofs);
  motion.displacement = 1e-3 * Eigen::VectorXd::Random(dofs);
  motion.velocity = 0.1 * Eigen::VectorXd::Random(dofs);
  motion.acceleration = 10.0 * Eigen::VectorXd::Random(dofs);
  return motion;
}

// A step that rails loaded before bend on, by a workspace: its end under further loads there.
Eigen::VectorXd increment(const StructureResponse& response, const LinearMotion& motion, const KnownLoad& load,
                          const std::vector<int>& few, StructureSolution& solution) {
  Eigen::VectorXd extra = Eigen::VectorXd::Zero(motion.displacement.size()), result = extra;
  for (int dof : few) extra[dof] = 1e4 + dof;
  response.begin_step(StructureMotion(motion), load, {few, {}}, solution);
  solution.substitution.respond(response.factor(), 0.9, extra, result);
  solution.substitution.finish(response.factor(), result);
  return result;
}

// In sections and as a whole, all unknowns active or those of a window.
TEST(StructureResponse, LoadsOnFewUnknownsAreAsOnAll) {
  TrackParameters track;
  track.length_before = track.length_after = 60.0;
  for (const bool long_one : {true, false}) {
    const StructureModel structure = long_one ? build_track_bridge(track, {BridgeParameters{}}) : short_bridge();
    const Eigen::Index n = structure.dofs();
    const HhtScheme scheme{.alpha = -0.1, .time_step = 1e-3};
    StructureResponse response(structure, scheme);
    EXPECT_EQ(response.in_sections(), long_one);
    StructureSolution kept;
    for (const DofRange& active : {DofRange{0, n}, DofRange{n / 8, n - n / 4}, DofRange{0, n}}) {
      response.activate(active);
      LinearMotion motion = random_motion(n);
      for (const Eigen::Index dof : {active.begin, n / 2, n / 2 + 1, active.end() - 1}) {
        motion.contact_load[dof] = 5e4 + static_cast<double>(dof);
      }
      std::vector<int> loaded;
      find_loaded(motion, active, loaded);
      EXPECT_EQ(loaded.size(), 4U);
      const std::vector<int> few{loaded[1], loaded[2]};
      loaded = {loaded[3], loaded[1], loaded[0], loaded[2], loaded[1], loaded[3]};  // repeated ones are welcome
      StructureSolution fresh;
      const Eigen::VectorXd of_all = increment(response, motion, {0.1 * motion.contact_load}, few, fresh);
      const Eigen::VectorXd of_few = increment(response, motion, {motion.contact_load, loaded, 0.1}, few, kept);
      EXPECT_LT((of_few - of_all).cwiseAbs().maxCoeff(), 1e-12 * of_all.cwiseAbs().maxCoeff());
      EXPECT_GT(of_all.cwiseAbs().maxCoeff(), 0.0);
    }
  }
}

// Both rails of one mesh, one whose nodes stand elsewhere in two elements, and one that ends earlier.
TEST(RailHeads, AreTheContactsOfBothRails) {
  StructureModel structure = short_bridge();
  RailLine& right = structure.rail[1];
  right.x[20] += 0.01;
  right.x.resize(right.x.size() - 2);
  right.dof.resize(right.x.size());
  right.twist_rate.resize(right.x.size());
  const std::vector<double>& x = structure.rail[0].x;
  for (const double at : {x[3], 0.4 * x[7] + 0.6 * x[8], x[20] + 0.005, x[20] - 0.1, x.back() - 0.1, x.back() + 1.0}) {
    std::vector<RailContact> both;
    append_rail_heads(structure, at, both);
    ASSERT_EQ(both.size(), 2U);
    for (const RailSide side : {RailSide::left, RailSide::right}) {
      const RailContact& found = both[static_cast<std::size_t>(side)];
      const RailContact expected = rail_contact(structure, side, at);
      EXPECT_EQ(found.side, side);
      EXPECT_EQ(found.on_rail, expected.on_rail) << at;
      if (!expected.on_rail) continue;
      EXPECT_EQ(found.x, at);
      EXPECT_EQ(found.element, expected.element);
      EXPECT_EQ(found.rail, expected.rail);
      EXPECT_EQ(found.rows.dof, expected.rows.dof);
      for (const auto row : {&RailInterpolation::y, &RailInterpolation::z, &RailInterpolation::roll,
                             &RailInterpolation::yaw, &RailInterpolation::pitch, &RailInterpolation::bend}) {
        EXPECT_EQ(found.rows.*row, expected.rows.*row) << at;
      }
      EXPECT_EQ(found.own.compliance, expected.own.compliance);
      EXPECT_EQ(found.own.slope, expected.own.slope);
    }
  }
}

TEST(LinearMotion, FindsItsLoads) {
  LinearMotion motion(100);
  for (const int dof : {3, 17, 32, 78}) motion.contact_load[dof] = -1.0;
  motion.step_load[55] = 1.0;  // in a block without contact loads
  motion.contact_load[40] = std::numeric_limits<double>::quiet_NaN();
  std::vector<int> loaded{1, 2};
  find_loaded(motion, {5, 73}, loaded);
  EXPECT_EQ(loaded, (std::vector<int>{17, 32, 40, 55}));
  find_loaded(motion, {0, 100}, loaded);
  EXPECT_EQ(loaded, (std::vector<int>{3, 17, 32, 40, 55, 78}));
  motion.loaded = {78, 3, 17, 99};  // where that is known
  find_loaded(motion, {5, 94}, loaded);
  EXPECT_EQ(loaded, (std::vector<int>{78, 17}));
}

// Of few unknowns as of all of them.
TEST(LinearMotion, ClosesFewLoadsAsAll) {
  const HhtScheme scheme{.alpha = -0.1, .time_step = 1e-3, .contact_force = ContactForceRule::endpoint};
  Eigen::VectorXd load = Eigen::VectorXd::Zero(9), before = load, of_all = Eigen::VectorXd::Ones(9), of_few = load;
  load[2] = 3.0;
  load[4] = 5.0;
  before[4] = 7.0;
  before[8] = 11.0;
  close_load(scheme, load, before, of_all);
  close_load(scheme, {4, 8}, load, before, of_few);
  close_load(scheme, {2, 4}, load, before, of_few);
  EXPECT_EQ(of_few, of_all);
}

// Three routes: the table of node compliances with shape functions, single entries of the inverse for the very
// positions, and whole solutions with the factor of the time steps. On a symmetric bridge, beside the middle of one,
// and with one rail that is stiffer than the other.
class RailCompliances : public ::testing::TestWithParam<int> {
 protected:
  static StructureModel structure() {
    StructureModel s = short_bridge(GetParam() == 1 ? 1.5 : 0.0);
    if (GetParam() == 2) s.stiffness.coeffRef(s.rail[1].dof[9][2], s.rail[1].dof[9][2]) *= 1.2;
    return s;
  }
};
INSTANTIATE_TEST_SUITE_P(Bridges, RailCompliances, ::testing::Values(0, 1, 2));

TEST_P(RailCompliances, AreThoseOfASolveAtThePositions) {
  const StructureModel structure = RailCompliances::structure();
  StructureResponse response(structure, HhtScheme{.alpha = -0.1, .time_step = 1e-3});
  response.tabulate_compliance(100.0, -100.0, 100.0);  // all of it: nothing is left to the far field
  EXPECT_EQ(response.rails_mirror(), GetParam() == 0);
  std::vector<RailContact> contacts;
  for (const double x : {-3.21, 0.1, 2.345, 5.99}) append_rail_heads(structure, x, contacts);
  const Eigen::MatrixXd solved = response.compliance_at(contacts);
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    for (std::size_t j = 0; j < contacts.size(); ++j) {
      const Eigen::Matrix3d tabulated = response.compliance(contacts[i], contacts[j]);
      const Eigen::Matrix3d exact =
          solved.block<3, 3>(static_cast<Eigen::Index>(3 * i), static_cast<Eigen::Index>(3 * j));
      EXPECT_LT((tabulated - exact).cwiseAbs().maxCoeff(), 1e-10 * solved.cwiseAbs().maxCoeff()) << i << " " << j;
    }
  }
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      const RailHeadsCompliance of_wheelsets = response.compliance(rail_heads(contacts, i), rail_heads(contacts, j));
      const RailHeadsCompliance exact = solved.block<6, 6>(6 * i, 6 * j);
      EXPECT_LT((of_wheelsets - exact).cwiseAbs().maxCoeff(), 1e-10 * solved.cwiseAbs().maxCoeff()) << i << " " << j;
    }
  }
  for (std::size_t j = 0; j < contacts.size(); ++j) {
    for (int k = 0; k < 3; ++k) {
      Eigen::VectorXd load = Eigen::VectorXd::Zero(structure.dofs());
      add_rail_load(contacts[j], Eigen::Vector3d::Unit(k), load);
      const Eigen::VectorXd whole = response.solve(load);
      for (std::size_t i = 0; i < contacts.size(); ++i) {
        const Eigen::Vector3d miss =
            rail_head(contacts[i], whole) -
            solved.block<3, 1>(static_cast<Eigen::Index>(3 * i), static_cast<Eigen::Index>(3 * j) + k);
        EXPECT_LT(miss.cwiseAbs().maxCoeff(), 1e-10 * solved.cwiseAbs().maxCoeff()) << i << " " << j << " " << k;
      }
    }
  }
}

// Positions that come near a node, as positions of a moving train do: within rounding of it, on either side.
TEST(StructureResponse, TabulatedComplianceHoldsAtNodes) {
  TrackParameters track;
  track.length_before = track.length_after = 60.0;
  const StructureModel structure = build_track_bridge(track, {});
  StructureResponse response(structure, HhtScheme{.alpha = -0.05, .time_step = 5e-4});
  response.tabulate_compliance(5.0, -60.0, 60.0);
  const RailLine& rail = structure.rail[0];
  for (std::size_t node = 1; node + 1 < rail.x.size(); ++node) {
    const auto at = [&](double x) {
      const RailContact contact = rail_contact(structure, RailSide::left, x);
      return response.compliance(contact, contact)(1, 1);
    };
    const double x = rail.x[node];
    const double own = at(x + 1e-6);
    for (const double near :
         {std::nextafter(x, -INFINITY), x, std::nextafter(x, INFINITY), 0.1 * std::round(10.0 * x)}) {
      EXPECT_NEAR(at(near), own, 1e-4 * own) << node;
    }
  }
}

// Displacement, slope and curvature of the rail's line under a load on the other rail: slope and curvature by
// differences.
TEST(StructureResponse, VerticalComplianceHasTheLinesSlopeAndCurvature) {
  const StructureModel structure = short_bridge();
  StructureResponse response(structure, HhtScheme{.alpha = -0.1, .time_step = 1e-3});
  response.tabulate_compliance(100.0, -100.0, 100.0);
  const RailContact load = rail_contact(structure, RailSide::left, 2.345);
  for (const RailSide side : {RailSide::left, RailSide::right}) {
    const auto at = [&](double x) { return response.vertical_compliance(rail_contact(structure, side, x), load); };
    constexpr double x = 2.05, h = 1e-3;
    const Eigen::Vector3d line = at(x);
    const double scale = std::abs(at(2.345)[0]) / 0.3;  // per length of an element
    EXPECT_NEAR(line[0], response.compliance(rail_contact(structure, side, x), load)(1, 1), 1e-12 * scale);
    EXPECT_NEAR(line[1], (at(x + h)[0] - at(x - h)[0]) / (2 * h), 1e-4 * scale);
    EXPECT_NEAR(line[2], (at(x + h)[1] - at(x - h)[1]) / (2 * h), 1e-4 * scale / 0.3);
  }
}

TEST(EliminationOrder, EliminatesEveryUnknownOfTheRangeOnce) {
  const StructureModel structure = short_bridge();
  for (const DofRange& range : {DofRange{0, structure.dofs()}, DofRange{100, 250}}) {
    for (const EliminationOrder order : {EliminationOrder::minimum_degree, EliminationOrder::nested_dissection}) {
      std::vector<int> seen = elimination_order(structure.stiffness, range, order);
      std::sort(seen.begin(), seen.end());
      ASSERT_EQ(static_cast<Eigen::Index>(seen.size()), range.count);
      for (std::size_t i = 0; i < seen.size(); ++i) EXPECT_EQ(seen[i], static_cast<int>(i));
    }
  }
}

// METIS catches SIGTERM while it works.
TEST(EliminationOrder, ATerminatedProcessEnds) {
  const StructureModel structure = short_bridge();
  const pid_t child = fork();
  if (child == 0) {
    for (;;) {
      static_cast<void>(
          elimination_order(structure.stiffness, {0, structure.dofs()}, EliminationOrder::nested_dissection));
    }
  }
  usleep(200'000);
  ASSERT_EQ(kill(child, SIGTERM), 0);
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(WTERMSIG(status), SIGTERM);
}

// Nodes of beam elements 250 m long, on which hundreds of sleepers hang, leave the track's order alone.
TEST(EliminationOrder, HubsDoNotFillTheFactor) {
  const auto entries_per_unknown = [](int elements) {
    TrackParameters track;
    track.length_before = track.length_after = 12.0;
    BridgeParameters span;
    span.length = 400.0;
    span.elements = elements;
    const StructureModel s = build_track_bridge(track, {span});
    const StructureResponse::Memory memory = StructureResponse(s, HhtScheme{.time_step = 1e-3}).memory();
    return memory.low_entries / static_cast<double>(s.dofs());
  };
  const double fine = entries_per_unknown(100);
  EXPECT_LT(fine, 300.0);
  EXPECT_LT(entries_per_unknown(2), 1.5 * fine);
}

// On a line of three kilometres compliances come from factors of stretches, on a shorter one from that of all unknowns:
// the same about a place where two stretches meet, which the train may come to from either side, on a deck too.
TEST(StructureResponse, CompliancesOfStretchesAreThoseOfTheWholeLine) {
  TrackParameters track;
  track.elements_per_bay = 1;
  track.length_before = 990.0;  // the second stretch begins on the deck
  track.length_after = 1990.0;
  BridgeParameters span;
  span.length = 20.4;
  const StructureModel line = build_track_bridge(track, {span}, MotionPlane::vertical);
  StructureModel unplaced = line;  // no stretches
  unplaced.dof_x.clear();
  unplaced.dof_line.clear();
  const HhtScheme scheme{.alpha = -0.05, .time_step = 1e-3};
  StructureResponse by_stretches(line, scheme), whole(unplaced, scheme), from_behind(line, scheme);
  const double vectors = 6.0 * sizeof(double) * line.dofs();  // of few entries of a solution
  EXPECT_LT(by_stretches.memory().low - vectors, 0.5 * whole.memory().kept);
  by_stretches.tabulate_compliance(5.0, -30.0, 40.0);
  whole.tabulate_compliance(5.0, -30.0, 40.0);
  from_behind.tabulate_compliance(5.0, 20.0, 40.0);
  from_behind.tabulate_compliance(5.0, -30.0, 40.0);
  double largest = 0.0, difference = 0.0;
  for (double x = -25.0; x < 35.0; x += 0.7) {
    const RailContact i = rail_contact(line, RailSide::left, x), j = rail_contact(line, RailSide::right, x + 2.5);
    for (const auto& [a, b] : {std::pair(i, i), std::pair(i, j), std::pair(j, i)}) {
      const Eigen::Matrix3d expected = whole.compliance(a, b), found = by_stretches.compliance(a, b);
      largest = std::max(largest, expected.cwiseAbs().maxCoeff());
      difference = std::max(difference, (found - expected).cwiseAbs().maxCoeff());
      EXPECT_EQ(found, from_behind.compliance(a, b)) << x;
    }
  }
  std::printf("compliances of stretches: off by %.1g of the largest\n", difference / largest);
  EXPECT_GT(largest, 0.0);
  EXPECT_LT(difference, 1e-12 * largest);
}

// Operators of many sizes are kept where they are small, of three where they are large.
TEST(OperatorRoom, IsBoundedByCountAndBytes) {
  const auto fit = [](double bytes) {
    OperatorRoom room;
    while (room.for_another()) room.add(bytes);
    return room.count;
  };
  EXPECT_EQ(fit(1e6), OperatorRoom::most);
  EXPECT_EQ(fit(1e9), OperatorRoom::least);
  EXPECT_EQ(fit(OperatorRoom::kept_bytes / 5.0), 5);
  for (const double one : {1e6, OperatorRoom::kept_bytes / 5.0, 1e9}) {
    EXPECT_GE(OperatorRoom::of_others(one), (fit(one) - 1) * one);
  }
}

// In sections where the active unknowns are many, as a whole where they are few: the same increment.
TEST(StructureResponse, AStepInSectionsIsThatOfTheWhole) {
  TrackParameters track;
  track.length_before = track.length_after = 15.0;
  const StructureModel structure = build_track_bridge(track, {BridgeParameters{}});
  StructureModel unlike = structure;
  unlike.dof_line.clear();
  const HhtScheme scheme{.alpha = -0.1, .time_step = 1e-3};
  StructureResponse in_sections(structure, scheme), whole(unlike, scheme);
  const int n = structure.dofs();
  const LinearMotion motion = random_motion(n);
  const Eigen::VectorXd load = 1e5 * Eigen::VectorXd::Random(n);
  for (const DofRange& range : {DofRange{0, n}, DofRange{300, 400}, DofRange{0, n}}) {
    in_sections.activate(range);
    whole.activate(range);
    EXPECT_EQ(in_sections.in_sections(), range.count == n);
    EXPECT_FALSE(whole.in_sections());
    const Eigen::VectorXd expected = whole.increment(motion, load);
    EXPECT_LT((in_sections.increment(motion, load) - expected).cwiseAbs().maxCoeff(),
              1e-7 * expected.cwiseAbs().maxCoeff())
        << "more than rounding L's entries to floats changes";
  }
}

TEST(StructureResponse, KeepsFactorsForLaterRunsWhereAsked) {
  TrackParameters track;
  track.length_before = track.length_after = 60.0;
  const StructureModel structure = build_track_bridge(track, {BridgeParameters{}});
  const int n = structure.dofs();
  const DofRange all{0, n}, window{n / 8, n - n / 4};
  const LinearMotion motion = random_motion(n);
  const Eigen::VectorXd load = 1e5 * Eigen::VectorXd::Random(n);
  for (const bool keeps : {false, true}) {
    StructureResponse response(structure, HhtScheme{.alpha = -0.1, .time_step = 1e-3});
    if (keeps) response.keep_for_later_runs();
    const auto of_all = response.factor().id();
    const Eigen::VectorXd by_all = response.increment(motion, load);
    response.activate(window);
    const auto of_window = response.factor().id();
    const Eigen::VectorXd by_window = response.increment(motion, load);
    response.activate(all);
    EXPECT_EQ(response.factor().id() == of_all, keeps);
    EXPECT_EQ(response.increment(motion, load), by_all);
    response.activate(window);
    EXPECT_EQ(response.factor().id() == of_window, keeps);
    EXPECT_EQ(response.increment(motion, load), by_window);
    EXPECT_NE(by_window, by_all);
  }
}

// A step leaves what the next one begins with; whatever changes the motion in between counts.
TEST(StructureResponse, AStepBeginsFromTheMotionAsItIs) {
  TrackParameters track;
  track.length_before = track.length_after = 60.0;
  const StructureModel structure = build_track_bridge(track, {BridgeParameters{}});
  const int n = structure.dofs();
  const StructureResponse response(structure, HhtScheme{.alpha = -0.1, .time_step = 1e-3}),
      shorter(structure, HhtScheme{.alpha = -0.1, .time_step = 5e-4});
  ASSERT_TRUE(response.in_sections());
  const Eigen::VectorXd load = 1e5 * Eigen::VectorXd::Random(n);
  StructureMotion motion(random_motion(n));
  StructureSolution solution;
  const auto step = [&](const StructureResponse& by, StructureMotion& of) {
    response.bring_in_order(of);
    Eigen::VectorXd none = Eigen::VectorXd::Zero(n);
    by.begin_step(of, {load}, {}, solution);
    solution.substitution.respond(by.factor(), none);
    by.finish_step(solution, of);
  };
  const auto goes_on_as_anew = [&](const StructureResponse& by) {
    StructureMotion on = motion, anew(std::as_const(motion).whole());
    step(by, on);
    step(by, anew);
    const Eigen::VectorXd expected = anew.whole().displacement;
    return (on.whole().displacement - expected).cwiseAbs().maxCoeff() < 1e-12 * expected.cwiseAbs().maxCoeff();
  };
  step(response, motion);
  EXPECT_TRUE(goes_on_as_anew(response));
  EXPECT_TRUE(goes_on_as_anew(shorter));
  motion.set(n / 2, {1.0, 20.0, 3e3});
  EXPECT_TRUE(goes_on_as_anew(response));
  step(response, motion);
  motion.whole().velocity[n / 3] += 10.0;
  EXPECT_TRUE(goes_on_as_anew(response));
  step(response, motion);
  for (Eigen::VectorXd* numbers : motion.numbers()) *numbers *= 2.0;
  EXPECT_TRUE(goes_on_as_anew(response));
}

// Single precision suffices for elements of 1 m and 0.32 m in steps of 0.5 ms; shorter ones, or steps of 5 ms, take a
// double-precision factor.
TEST(StructureResponse, ShortElementsInLongStepsAreNotRoundedToFloats) {
  TrackParameters track;
  track.length_before = track.length_after = 40.0;
  BridgeParameters span;
  for (const auto& [elements, time_step, divides] :
       {std::tuple{32, 5e-4, true}, {100, 5e-4, true}, {400, 5e-4, false}, {100, 5e-3, false}, {1000, 5e-3, false}}) {
    span.elements = elements;
    const StructureModel structure = build_track_bridge(track, {span, span});
    const HhtScheme scheme{.alpha = -0.05, .time_step = time_step};
    const StructureResponse response(structure, scheme);
    EXPECT_EQ(response.in_sections(), divides) << elements << " elements, " << time_step << " s";
    if (!divides) continue;
    StructureModel unlike = structure;
    unlike.dof_line.clear();
    const StructureResponse whole(unlike, scheme);
    Eigen::VectorXd load = Eigen::VectorXd::Zero(structure.dofs());
    load[structure.rail[0].dof[structure.rail[0].dof.size() / 2][2]] = 1e5;
    const Eigen::VectorXd expected = whole.solve(load);
    EXPECT_LT((response.solve(load) - expected).cwiseAbs().maxCoeff(), 1e-4 * expected.cwiseAbs().maxCoeff());
  }
}

// In sections the state is updated from the solution in their order, in a window at its place.
TEST(StructureResponse, EndsAStepInSectionsAsTheIncrementDoes) {
  TrackParameters track;
  track.length_before = track.length_after = 40.0;
  const StructureModel structure = build_track_bridge(track, {BridgeParameters{}});
  const auto begin_of = [&](double x) {
    return std::lower_bound(structure.dof_x.begin(), structure.dof_x.end(), x) - structure.dof_x.begin();
  };
  const DofRange whole{0, structure.dofs()}, window{begin_of(-20.0), begin_of(50.0) - begin_of(-20.0)};
  const LinearMotion begin = random_motion(structure.dofs());
  const Eigen::VectorXd load = 1e5 * Eigen::VectorXd::Random(structure.dofs());
  for (const DofRange& range : {whole, window}) {
    const StructureResponse response(structure, {.alpha = -0.1, .time_step = 1e-3}, range);
    ASSERT_TRUE(response.in_sections());
    LinearMotion expected = begin;
    update(response.scheme(), response.increment(begin, load), range, expected);
    StructureSolution solution;
    StructureMotion motion(begin);
    const auto step = [&] {
      Eigen::VectorXd nowhere;
      response.begin_step(motion, {load}, {}, solution);
      solution.substitution.respond(response.factor(), nowhere);
      response.finish_step(solution, motion);
    };
    step();
    const LinearMotion end = std::as_const(motion).whole();
    for (const auto member : {&LinearMotion::displacement, &LinearMotion::velocity, &LinearMotion::acceleration}) {
      const Eigen::VectorXd &ended = end.*member, &wanted = expected.*member, &began = begin.*member;
      EXPECT_LT((ended - wanted).cwiseAbs().maxCoeff(), 1e-14 * wanted.cwiseAbs().maxCoeff());
      EXPECT_GT(range.of(ended - began).cwiseAbs().minCoeff(), 0.0);
      EXPECT_EQ(ended.head(range.begin), began.head(range.begin));
      EXPECT_EQ(ended.tail(whole.count - range.end()), began.tail(whole.count - range.end()));
    }
    // The next step goes on in the sections' order, and from what is set in it.
    const int changed = static_cast<int>(range.begin + range.count / 2);
    expected.displacement[changed] = 1e-3;
    expected.velocity[changed] = -0.2;
    expected.acceleration[changed] = 5.0;
    motion.set(changed, {1e-3, -0.2, 5.0});
    update(response.scheme(), response.increment(expected, load), range, expected);
    step();
    const std::vector<int> few{changed, held, static_cast<int>(range.begin), changed};
    StructureMotion read = motion;
    for (const int dof : few) {
      if (dof == held) continue;
      EXPECT_NEAR(read.at(few).displacement[dof], expected.displacement[dof], 1e-15);
      EXPECT_NEAR(read.at(few).acceleration[dof], expected.acceleration[dof],
                  1e-13 * expected.acceleration.cwiseAbs().maxCoeff());
    }
    EXPECT_LT((motion.whole().velocity - expected.velocity).cwiseAbs().maxCoeff(),
              1e-13 * expected.velocity.cwiseAbs().maxCoeff());
  }
}

TEST(StructureResponse, RejectsANumberThatIsNotFinite) {
  StructureModel structure = short_bridge();
  structure.stiffness.coeffRef(7, 7) = std::numeric_limits<double>::quiet_NaN();
  try {
    const StructureResponse response(structure);
    FAIL() << "not rejected";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "stiffness matrix of the structure, row 8, column 8: found nan, expected a finite number");
  }
}

TEST(StructureResponse, RejectsAMechanism) {
  StructureModel structure = short_bridge();
  structure.stiffness *= -1.0;
  EXPECT_THROW(StructureResponse{structure}, ComputationError);
}

}  // namespace
}  // namespace railtab
