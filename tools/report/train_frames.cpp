#include "train_frames.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <vector>

#include "headline.hpp"
#include "railtab/runtime/base/motion_names.hpp"
#include "railtab/runtime/drawing/body_names.hpp"
#include "railtab/runtime/report/history_store.hpp"
#include "railtab/runtime/report/html_page.hpp"
#include "railtab/runtime/report/html_text.hpp"

namespace railtab::report {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// The records that are drawn: all of them, or evenly spaced ones with the last, so that the page stays small.
std::vector<std::size_t> frames(const RunResults& results) {
  constexpr std::size_t most_numbers = 1'000'000, most_frames = 2000, fewest = 200;
  const std::size_t per_frame =
      10 * results.header.wheel_x.size() + 2 * results.header.body_names.size() + results.header.node_names.size() + 1;
  const std::size_t most = std::clamp(most_numbers / per_frame, fewest, most_frames), records = results.steps.size();
  const std::size_t every = std::max<std::size_t>(1, (records + most - 1) / most);
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < records; i += every) chosen.push_back(i);
  if (chosen.back() != records - 1) chosen.push_back(records - 1);
  return chosen;
}

class FrameWriter {
 public:
  explicit FrameWriter(const RunResults& results) : results_(results), frames_(frames(results)) {}

  [[nodiscard]] std::size_t count() const noexcept { return frames_.size(); }

  /// Values frame by frame, `members` of each.
  [[nodiscard]] std::string array(std::size_t members,
                                  const std::function<double(const StepRecord&, std::size_t)>& value) const {
    return quantised_json(values(members, value));
  }
  [[nodiscard]] std::string times(double StepRecord::*value) const {
    return fmt::format("\"{}\"",
                       float_base64(values(1, [&](const StepRecord& step, std::size_t) { return step.*value; })));
  }
  [[nodiscard]] std::string wheels(const std::function<double(const WheelRecord&)>& value) const {
    return array(results_.header.wheel_x.size(),
                 [&](const StepRecord& step, std::size_t i) { return value(step.wheels[i]); });
  }

 private:
  [[nodiscard]] std::vector<double> values(std::size_t members,
                                           const std::function<double(const StepRecord&, std::size_t)>& value) const {
    std::vector<double> all;
    all.reserve(members * frames_.size());
    for (const std::size_t frame : frames_) {
      for (std::size_t i = 0; i < members; ++i) all.push_back(value(results_.steps[frame], i));
    }
    return all;
  }

  const RunResults& results_;
  std::vector<std::size_t> frames_;
};

std::string numbers(const std::vector<double>& values) { return fmt::format("[{:.6g}]", fmt::join(values, ",")); }

std::string chosen_names(const std::vector<std::string>& names, const std::vector<std::size_t>& chosen) {
  std::vector<std::string> texts;
  for (const std::size_t i : chosen) texts.push_back(json_string(names[i]));
  return fmt::format("[{}]", fmt::join(texts, ","));
}

std::vector<double> at(const std::vector<double>& values, const std::vector<std::size_t>& chosen) {
  std::vector<double> result;
  for (const std::size_t i : chosen) result.push_back(values[i]);
  return result;
}

std::string wheel_arrays(const FrameWriter& writer) {
  const auto located = [](double WheelRecord::*value) {
    return [value](const WheelRecord& wheel) { return wheel.patches > 0 ? wheel.*value : none; };
  };
  const auto second = [](double WheelRecord::*value) {
    return [value](const WheelRecord& wheel) { return wheel.patches > 1 ? wheel.*value : none; };
  };
  return fmt::format(
      R"("Q":{},"Y":{},"patches":{},"from_table":{},"y_rail":{},"y_wheel":{},"angle":{},"force":{},)"
      R"("second_y_rail":{},"second_force":{})",
      writer.wheels([](const WheelRecord& wheel) { return wheel.Q; }),
      writer.wheels([](const WheelRecord& wheel) { return wheel.Y; }),
      writer.wheels([](const WheelRecord& wheel) { return static_cast<double>(wheel.patches); }),
      writer.wheels([](const WheelRecord& wheel) { return wheel.from_table < 0 ? none : wheel.from_table; }),
      writer.wheels(located(&WheelRecord::y_rail)), writer.wheels(located(&WheelRecord::y_wheel)),
      writer.wheels(located(&WheelRecord::angle)), writer.wheels(located(&WheelRecord::normal_force)),
      writer.wheels(second(&WheelRecord::second_y_rail)), writer.wheels(second(&WheelRecord::second_normal_force)));
}

std::string frame_data(const RunResults& results, const FrameWriter& writer) {
  const ResultHeader& header = results.header;
  std::vector<std::size_t> deck, bodies;
  for (std::size_t i = 0; i < header.node_names.size(); ++i) {
    if (is_deck(header.node_names[i])) deck.push_back(i);
  }
  for (std::size_t i = 0; i < header.body_names.size() && i < header.body_x.size(); ++i) {
    if (is_car_body(header.body_names[i])) bodies.push_back(i);
  }
  const auto motion = [](std::vector<MotionRecord> StepRecord::*of, const std::vector<std::size_t>& chosen, int k) {
    return [of, &chosen, k](const StepRecord& step, std::size_t i) { return (step.*of)[chosen[i]].displacement[k]; };
  };
  return fmt::format(
      R"({{"frames":{},"time":{},"position":{},"spans":[{},{}],"deck_names":{},"deck_x":{},"deck_z":{},)"
      R"("body_names":{},"body_x":{},"body_z":{},"body_pitch":{},"wheel_x":{},"load":{},{},)"
      R"("outline":{},"wheel":[{},{}],"rail":[{},{}]}})",
      writer.count(), writer.times(&StepRecord::time), writer.times(&StepRecord::position), numbers(header.span_from),
      numbers(header.span_to), chosen_names(header.node_names, deck), numbers(at(header.node_x, deck)),
      writer.array(deck.size(), motion(&StepRecord::nodes, deck, z_dof)), chosen_names(header.body_names, bodies),
      numbers(at(header.body_x, bodies)), writer.array(bodies.size(), motion(&StepRecord::bodies, bodies, z_dof)),
      writer.array(bodies.size(), motion(&StepRecord::bodies, bodies, pitch_dof)), numbers(header.wheel_x),
      numbers(header.static_wheel_load), wheel_arrays(writer), numbers(header.wheel_outline), numbers(header.wheel_y),
      numbers(header.wheel_z), numbers(header.rail_y), numbers(header.rail_z));
}

}  // namespace

std::string train_section(const RunResults& results) {
  if (results.steps.size() < 2 || results.header.wheel_x.empty()) return "";
  const FrameWriter writer(results);
  const double spacing =
      (results.steps.back().time - results.steps.front().time) / static_cast<double>(writer.count() - 1);
  return fmt::format(
      "<section class=\"theatre\" id=\"theatre\"><h2>Train and wheels over time</h2><p class=\"lead\">{} instants, "
      "some {:.2g} s apart. The deck passes through its recorded nodes and rests on its supports; displacements are "
      "enlarged, and the bars under the wheelsets are their vertical forces. Below, the chosen wheelset seen in the "
      "direction of travel; the mark on a patch is as wide as its share of the force.</p>"
      "<script type=\"application/json\" id=\"frames\">{}</script></section>\n",
      writer.count(), spacing, frame_data(results, writer));
}

}  // namespace railtab::report
