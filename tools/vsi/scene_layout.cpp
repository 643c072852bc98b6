#include "scene_layout.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "railtab/runtime/report/axis_ticks.hpp"
#include "railtab/runtime/report/html_text.hpp"
#include "railtab/runtime/scene/scene_model.hpp"

namespace railtab::vsi {
namespace {

constexpr std::size_t columns = 68;

/// Ends of what is drawn [m].
std::array<double, 2> extent(const SceneLayout& layout) {
  double from = layout.track_from, to = layout.track_to;
  for (const auto& span : layout.spans) {
    from = std::min(from, span[0]);
    to = std::max(to, span[1]);
  }
  from = std::min(from, layout.wheelsets.back());
  to = std::max(to, layout.wheelsets.front() + layout.travel);
  return {from, std::max(to, from + 1.0)};
}

/// Characters at positions along the track.
class Line {
 public:
  explicit Line(const std::array<double, 2>& ends) : ends_(ends) {}
  void fill(double from, double to, char with) {
    for (std::size_t k = column(from); k <= column(to); ++k) text_[k] = with;
  }
  void put(double at, char what) { text_[column(at)] = what; }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  [[nodiscard]] std::size_t column(double x) const {
    const double share = std::clamp((x - ends_[0]) / (ends_[1] - ends_[0]), 0.0, 1.0);
    return static_cast<std::size_t>(std::lround(share * static_cast<double>(columns - 1)));
  }
  std::array<double, 2> ends_;
  std::string text_ = std::string(columns, ' ');
};

}  // namespace

SceneLayout scene_layout(const SceneParameters& scene, const VsiModel& model) {
  SceneLayout layout;
  for (int w = 0; w < model.wheelsets(); ++w) layout.wheelsets.push_back(model.wheelset_x(w, 0.0));
  layout.duration = run_duration(scene, model);
  layout.travel = model.distance(layout.duration);
  layout.rigid = !model.structure;
  if (model.structure) {
    layout.track_from = model.structure->rail[0].x.front();
    layout.track_to = model.structure->rail[0].x.back();
    layout.spans = model.structure->spans;
    for (const StructureNode& node : model.structure->nodes) {
      layout.nodes.push_back(fmt::format("{} at x = {:.6g} m", node.name, node.x));
    }
  } else {
    layout.track_from = layout.wheelsets.back();
    layout.track_to = layout.wheelsets.front() + layout.travel;
  }
  if (scene.irregularity) layout.uneven.push_back({model.irregularity.begin(), model.irregularity.end()});
  if (scene.spectrum) layout.uneven.push_back({layout.track_from, layout.track_to});
  return layout;
}

std::string layout_text(const SceneLayout& layout) {
  const std::array<double, 2> ends = extent(layout);
  Line track(ends), spans(ends), train(ends), end(ends), uneven(ends);
  track.fill(layout.track_from, layout.track_to, '=');
  for (const auto& span : layout.spans) {
    spans.fill(span[0], span[1], '-');
    spans.put(span[0], '^');
    spans.put(span[1], '^');
  }
  for (const double x : layout.wheelsets) {
    train.put(x, 'o');
    end.put(x + layout.travel, 'o');
  }
  for (const auto& range : layout.uneven) uneven.fill(range[0], range[1], '~');
  std::string text = fmt::format("  x [m]      {:<34.6g}{:>34.6g}\n", ends[0], ends[1]);
  text += fmt::format("  t = 0      {}\n", train.text());
  text += fmt::format("  {:<11}{}\n", layout.rigid ? "rigid rail" : "track", track.text());
  if (!layout.spans.empty()) text += fmt::format("  bridge     {}\n", spans.text());
  if (!layout.uneven.empty()) text += fmt::format("  uneven     {}\n", uneven.text());
  return text + fmt::format("  {:<11}{}\n", fmt::format("t = {:.3g} s", layout.duration), end.text());
}

std::string layout_svg(const SceneLayout& layout, const std::string& title) {
  constexpr double width = 1000.0, margin = 40.0, level = 90.0;
  const std::array<double, 2> ends = extent(layout);
  const report::Axis axis = report::tight_axis(ends[0], ends[1], 10);
  const auto X = [&](double x) { return margin + (width - 2.0 * margin) * axis.fraction(x); };
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 1000 190\" font-family=\"sans-serif\" font-size=\"13\" "
      "role=\"img\"><title>{0}</title><rect width=\"1000\" height=\"190\" fill=\"#fff\"/><text x=\"{1}\" "
      "y=\"22\">{0}</text>\n",
      report::escaped(title), margin);
  svg += fmt::format("<path d=\"M{:.1f} {}H{:.1f}\" stroke=\"#1d2430\" stroke-width=\"2\"{}/>\n", X(layout.track_from),
                     level, X(layout.track_to), layout.rigid ? " stroke-dasharray=\"6 4\"" : "");
  for (const auto& span : layout.spans) {
    svg += fmt::format(
        "<rect x=\"{0:.1f}\" y=\"93\" width=\"{1:.1f}\" height=\"9\" fill=\"#8795a6\" stroke=\"#1d2430\"/><path "
        "d=\"M{0:.1f} 102l-5 10h10zM{2:.1f} 102l-5 10h10z\" fill=\"#c7cfd9\" stroke=\"#1d2430\"/>\n",
        X(span[0]), X(span[1]) - X(span[0]), X(span[1]));
  }
  for (const auto& range : layout.uneven) {
    svg +=
        fmt::format("<path d=\"M{:.1f} 120H{:.1f}\" stroke=\"#d55e00\" stroke-width=\"3\" stroke-dasharray=\"2 3\"/>\n",
                    X(std::max(range[0], ends[0])), X(std::min(range[1], ends[1])));
  }
  for (const double x : layout.wheelsets) {
    svg += fmt::format(
        "<circle cx=\"{:.1f}\" cy=\"85\" r=\"4\" fill=\"#0072b2\"/><circle cx=\"{:.1f}\" cy=\"85\" r=\"3.5\" "
        "fill=\"none\" stroke=\"#0072b2\"/>\n",
        X(x), X(x + layout.travel));
  }
  svg += fmt::format(
      "<text x=\"{:.1f}\" y=\"66\" fill=\"#0072b2\" text-anchor=\"middle\">t = 0</text><text x=\"{:.1f}\" y=\"66\" "
      "fill=\"#0072b2\" text-anchor=\"middle\">t = {:.4g} s</text>\n",
      X(layout.wheelsets.front()), X(layout.wheelsets.front() + layout.travel), layout.duration);
  if (!layout.uneven.empty())
    svg += "<text x=\"960\" y=\"138\" fill=\"#d55e00\" text-anchor=\"end\">uneven track</text>\n";
  for (const report::Tick& tick : axis.ticks) {
    svg += fmt::format(
        "<path d=\"M{0:.1f} 146v5\" stroke=\"#566171\"/><text x=\"{0:.1f}\" y=\"166\" fill=\"#566171\" "
        "text-anchor=\"middle\">{1} m</text>\n",
        X(tick.value), tick.label);
  }
  return svg + "</svg>\n";
}

}  // namespace railtab::vsi
