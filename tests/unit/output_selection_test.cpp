#include "railtab/runtime/results/output_selection.hpp"

#include <gtest/gtest.h>

#include "railtab/runtime/base/input_error.hpp"

namespace railtab {
namespace {

ResultHeader header() {
  ResultHeader h;
  h.wheel_x = {0.0, 0.0};
  h.static_wheel_load = {5e4, 5e4};
  h.body_names = {"coach-1/car-body", "coach-1/bogie-1", "coach-2/car-body"};
  h.node_names = {"deck-midspan-1", "rail-left-midspan-1", "deck-midspan-2"};
  h.node_x = {16.0, 15.9, 48.0};
  return h;
}

StepRecord record() {
  StepRecord r;
  r.wheels.resize(2);
  for (double value : {1.0, 2.0, 3.0}) {
    MotionRecord m;
    m.displacement[2] = value;
    r.bodies.push_back(m);
    r.nodes.push_back(m);
  }
  return r;
}

TEST(OutputSelection, KeepsEverythingAtFirst) {
  const OutputSelection selection({}, header());
  StepRecord r = record();
  selection.cut(r);
  EXPECT_EQ(selection.of(header()).node_names, header().node_names);
  EXPECT_EQ(r.wheels.size(), 2U);
  EXPECT_EQ(r.bodies.size(), 3U);
}

TEST(OutputSelection, CutsHeaderAndRecordAlike) {
  OutputParameters output;
  output.wheels = false;
  output.bodies = {"*/car-body"};
  output.nodes = {"deck-*"};
  const OutputSelection selection(output, header());
  const ResultHeader h = selection.of(header());
  EXPECT_TRUE(h.wheel_x.empty());
  EXPECT_TRUE(h.static_wheel_load.empty());
  EXPECT_EQ(h.body_names, (std::vector<std::string>{"coach-1/car-body", "coach-2/car-body"}));
  EXPECT_EQ(h.node_names, (std::vector<std::string>{"deck-midspan-1", "deck-midspan-2"}));
  EXPECT_EQ(h.node_x, (std::vector<double>{16.0, 48.0}));
  StepRecord r = record();
  selection.cut(r);
  ASSERT_EQ(r.bodies.size(), 2U);
  ASSERT_EQ(r.nodes.size(), 2U);
  EXPECT_TRUE(r.wheels.empty());
  EXPECT_EQ(r.bodies[1].displacement[2], 3.0);
  EXPECT_EQ(r.nodes[1].displacement[2], 3.0);
}

TEST(OutputSelection, NothingChosenIsNothingRecorded) {
  OutputParameters output;
  output.bodies.clear();
  const OutputSelection selection(output, header());
  StepRecord r = record();
  selection.cut(r);
  EXPECT_TRUE(r.bodies.empty());
}

TEST(OutputSelection, RejectsAPatternThatFitsNothing) {
  OutputParameters output;
  output.nodes = {"deck-*", "pier-*"};
  EXPECT_THROW(OutputSelection(output, header()), InputError);
}

}  // namespace
}  // namespace railtab
