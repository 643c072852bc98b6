// What is followed all over a deck, for motions that are prescribed: every value follows by hand.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "railtab/runtime/structure/bridge.hpp"
#include "railtab/runtime/structure/carried_motion.hpp"
#include "railtab/runtime/structure/stiffness_factor.hpp"

namespace railtab {
namespace {

constexpr double length = 12.0, cubic = 1e-6, twisted = 2e-6, swayed = 3e-6, stretched = 4e-6;

/// A cubic that is zero at both ends, and its derivatives.
double z(double x) { return cubic * (x * x * x - 1.5 * length * x * x + 0.5 * length * length * x); }
double slope(double x) { return cubic * (3.0 * x * x - 3.0 * length * x + 0.5 * length * length); }
double curvature(double x) { return cubic * (6.0 * x - 3.0 * length); }
double roll(double x) { return twisted * x * (length - x); }

/// Sleepers stand on deck nodes.
BridgeParameters span() {
  BridgeParameters parameters;
  parameters.length = length;
  parameters.elements = 20;
  parameters.track_offset = 2.2;
  return parameters;
}

class PrescribedDeck {
 public:
  explicit PrescribedDeck(MotionPlane plane, const std::vector<BridgeParameters>& spans)
      : model(build_track_bridge({}, spans, plane, {}, DeckRecord::everywhere)) {
    motion = Eigen::VectorXd::Zero(model.dofs());
  }
  /// Sets one of the six motions of all deck nodes.
  void set(int k, const std::function<double(double)>& value) {
    for (int d = 0; d < model.dofs(); ++d) {
      const auto dof = static_cast<std::size_t>(d);
      if (model.dof_line[dof] == track_lines + k) motion[d] = value(model.dof_x[dof]);
    }
  }
  struct Found {
    double x, y, value;
  };
  [[nodiscard]] std::vector<Found> of(DeckQuantity quantity) const {
    const Eigen::VectorXd values = model.deck.rows * motion;
    std::vector<Found> found;
    for (std::size_t c = 0; c < model.deck.channel.size(); ++c) {
      const DeckChannel& channel = model.deck.channel[c];
      if (channel.quantity == quantity) found.push_back({channel.x, channel.y, values[static_cast<Eigen::Index>(c)]});
    }
    return found;
  }

  StructureModel model;
  Eigen::VectorXd motion;
};

PrescribedDeck bent_and_twisted() {
  PrescribedDeck deck(MotionPlane::spatial, {span()});
  deck.set(0, [](double x) { return stretched * x; });
  deck.set(2, z);
  deck.set(3, roll);
  deck.set(4, [](double x) { return -slope(x); });
  deck.set(1, [](double x) { return swayed * x * (x - length); });
  deck.set(5, [](double x) { return swayed * (2.0 * x - length); });
  return deck;
}

TEST(DeckChannels, DisplacementOfTheAxisAndUnderTheTrack) {
  const PrescribedDeck deck = bent_and_twisted();
  const auto found = deck.of(DeckQuantity::displacement);
  ASSERT_EQ(found.size(), 42U) << "two of each node, supports as well";
  for (const auto& at : found) {
    const double expected = z(at.x) + (at.y == 0.0 ? 2.2 * roll(at.x) : 0.0);
    EXPECT_NEAR(at.value, expected, 1e-15) << at.x << ", " << at.y;
    EXPECT_TRUE(at.y == 0.0 || at.y == -2.2);
  }
}

TEST(DeckChannels, RollAndTwistUnderTheSleepers) {
  const PrescribedDeck deck = bent_and_twisted();
  const auto rolls = deck.of(DeckQuantity::roll);
  ASSERT_EQ(rolls.size(), 20U) << "the sleeper at the end stands on the ground";
  for (const auto& at : rolls) EXPECT_NEAR(at.value, roll(at.x), 1e-15) << at.x;
  const auto on_deck = [](double x) { return x > -1e-9 && x < length - 1e-9 ? roll(x) : 0.0; };
  const auto twists = deck.of(DeckQuantity::twist);
  ASSERT_EQ(twists.size(), 25U) << "also those that begin up to 3 m before the deck";
  for (const auto& at : twists) {
    EXPECT_NEAR(at.value, 1.435 * (on_deck(at.x + 3.0) - on_deck(at.x)), 1e-15) << at.x;
  }
}

TEST(DeckChannels, TwistBetweenSleepersThatAreNotThreeMetresApart) {
  TrackParameters track;
  track.sleeper_spacing = 0.7;
  BridgeParameters parameters = span();
  parameters.length = 14.0;
  PrescribedDeck deck(MotionPlane::spatial, {span()});
  deck.model = build_track_bridge(track, {parameters}, MotionPlane::spatial, {}, DeckRecord::everywhere);
  deck.motion = Eigen::VectorXd::Zero(deck.model.dofs());
  deck.set(3, [](double x) { return 1e-3 * x; });  // free at the first end only for the test
  bool from = false, to = false;
  for (const auto& at : deck.of(DeckQuantity::twist)) {
    if (at.x < 1.5 || at.x > 9.0) continue;  // roll is linear between the supports, which hold it
    EXPECT_NEAR(at.value, 1.435 * 3e-3, 1e-14) << at.x;
    const auto at_sleeper = [](double x) { return std::abs(x / 0.7 - std::round(x / 0.7)) < 1e-9; };
    from = from || at_sleeper(at.x);
    to = to || at_sleeper(at.x + 3.0);
  }
  EXPECT_TRUE(from && to) << "a kink at either end";
}

TEST(DeckChannels, RotationsAndOffsetsOfTheEnds) {
  const PrescribedDeck deck = bent_and_twisted();
  constexpr double near_end = 1e-5;  // [m] before the end, where the channels stand
  const auto ends = deck.of(DeckQuantity::end_rotation);
  ASSERT_EQ(ends.size(), 2U);
  EXPECT_EQ(ends[1].x, length);
  EXPECT_NEAR(ends[0].value, -slope(0.0), 1e-15);
  EXPECT_NEAR(ends[1].value, -slope(length), near_end * std::abs(curvature(length)));
  const auto horizontal = deck.of(DeckQuantity::horizontal_rotation);
  ASSERT_EQ(horizontal.size(), 2U);
  EXPECT_NEAR(horizontal[0].value, -swayed * length, 1e-15);
  const auto gaps = deck.of(DeckQuantity::joint_gap);
  ASSERT_EQ(gaps.size(), 2U);
  const double lever = 0.172 + 0.2 - span().axis_depth;  // from the axis up to the underside of the sleepers
  EXPECT_NEAR(gaps[0].value, -slope(0.0) * lever + swayed * length * 2.2, 1e-15) << "x is held at the first end";
  const double moved = stretched * length - slope(length) * lever - swayed * length * 2.2;
  EXPECT_NEAR(gaps[1].value, -moved, 1e-9) << "opens where the end moves back";
  for (const auto& step : deck.of(DeckQuantity::joint_step))
    EXPECT_NEAR(step.value, 0.0, 1e-9) << "z and roll are held";
}

TEST(DeckChannels, SectionForcesOfBuiltInSpans) {
  const PrescribedDeck deck = bent_and_twisted();
  const double EI = span().E * span().Iy;
  const auto moments = deck.of(DeckQuantity::bending_moment);
  ASSERT_EQ(moments.size(), 21U);
  for (const auto& at : moments) EXPECT_NEAR(at.value, -EI * curvature(at.x), 1e-6 * EI * curvature(length)) << at.x;
  const auto shears = deck.of(DeckQuantity::shear_force);
  ASSERT_EQ(shears.size(), 20U);
  for (const auto& at : shears) EXPECT_NEAR(at.value, -EI * 6.0 * cubic, 1e-6 * EI * cubic) << at.x;
}

// A force at midspan of a span without track: PL/4, ±P/2, PL³/48EI.
TEST(DeckChannels, PointLoadOnASimpleSpan) {
  BridgeParameters parameters = span();
  parameters.track_offset = 0.0;
  const Bridge bridge = beam_bridge({parameters}, MotionPlane::vertical, {}, DeckRecord::everywhere);
  StructureModel model;
  model.supports.x = bridge.support_x;
  build_matrices(bridge.matrices, static_cast<int>(bridge.dof_x.size()), model);
  set_channels(bridge.deck, model);
  constexpr double P = 250e3;
  Eigen::VectorXd load = Eigen::VectorXd::Zero(model.dofs());
  load += P * Eigen::VectorXd(model.deck.rows.row(10).transpose());
  const Eigen::VectorXd u = stiffness_factor(model.stiffness).solve(load);
  const Eigen::VectorXd found = model.deck.rows * u;
  const double EI = parameters.E * parameters.Iy;
  EXPECT_NEAR(found[10], P * std::pow(length, 3) / (48.0 * EI), 1e-10 * found[10]);
  EXPECT_NEAR(found[21 + 10], P * length / 4.0, 1e-8 * P);
  EXPECT_NEAR(found[21 + 5], P * length / 8.0, 1e-8 * P);
  EXPECT_NEAR(found[42], 0.5 * P, 1e-8 * P);
  EXPECT_NEAR(found[42 + 19], -0.5 * P, 1e-8 * P);
}

TEST(DeckChannels, TwoSpansMeetAtAJoint) {
  PrescribedDeck deck(MotionPlane::vertical, {span(), span()});
  deck.set(0, [](double x) { return stretched * x; });
  const auto gaps = deck.of(DeckQuantity::joint_gap);
  ASSERT_EQ(gaps.size(), 3U) << "before the first, between, after the last";
  EXPECT_NEAR(gaps[1].x, length, 1e-12);
  EXPECT_NEAR(gaps[1].value, -stretched * length, 1e-9) << "the second span's first end is held";
  EXPECT_TRUE(deck.of(DeckQuantity::twist).empty()) << "the vertical plane has no roll";
  EXPECT_TRUE(deck.of(DeckQuantity::horizontal_rotation).empty());
}

// All supports and all dofs moved alike is a rigid motion: the deck goes along, and nothing else has a value.
TEST(DeckChannels, MoveWithTheirSupports) {
  const StructureModel model =
      build_track_bridge({}, {span(), span()}, MotionPlane::spatial, {}, DeckRecord::everywhere);
  const StructureModel relative = relative_to_supports(model);
  Eigen::VectorXd down = Eigen::VectorXd::Zero(model.supports.columns());
  for (Eigen::Index s = 1; s < down.size(); s += 2) down[s] = 1.0;
  const Eigen::VectorXd found = relative.supports.carried_deck * down;
  for (std::size_t c = 0; c < model.deck.channel.size(); ++c) {
    const bool displacement = model.deck.channel[c].quantity == DeckQuantity::displacement;
    const bool force = quantity_unit(model.deck.channel[c].quantity).starts_with('N');
    EXPECT_NEAR(found[static_cast<Eigen::Index>(c)], displacement ? 1.0 : 0.0, force ? 1e4 : 1e-6)
        << quantity_name(model.deck.channel[c].quantity) << " at " << model.deck.channel[c].x;
  }
  EXPECT_EQ(build_track_bridge({}, {span()}).deck.channel.size(), 0U) << "unless asked for";
}

}  // namespace
}  // namespace railtab
