#include "deck_charts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

namespace railtab::report {
namespace {

struct DeckLine {
  const char* name;   // of DeckPlaces
  const char* label;  // before "largest", "smallest"
};
struct DeckChart {
  const char* title;
  const char* note;
  const char* y_label;
  double factor;
  std::vector<DeckLine> quantities;
};

std::vector<DeckChart> all_charts() {
  return {{"Deck displacement, whole deck",
           "Largest and smallest of all nodes and steps; positive down.",
           "z [mm]",
           1e3,
           {{"displacement", ""}}},
          {"Deck acceleration, whole deck",
           "Largest and smallest of all nodes and steps; positive down.",
           "a_z [m/s²]",
           1.0,
           {{"filtered_acceleration", "low-passed, "}, {"acceleration", "unfiltered, "}}},
          {"Deck twist, whole deck",
           "Change of the cross level over 3 m from x on; right side down is positive.",
           "t [mm/3 m]",
           1e3,
           {{"twist", ""}}},
          {"Bending moment",
           "Largest and smallest of all steps; sagging is positive.",
           "M [MN m]",
           1e-6,
           {{"bending_moment", ""}}}};
}

/// Largest and smallest over x.
void add_lines(const RunResults& run, const DeckLine& quantity, double factor, const std::string& label, Chart& chart) {
  const auto places = std::ranges::find(run.header.deck, quantity.name, &DeckPlaces::quantity);
  if (places == run.header.deck.end()) return;
  const DeckExtremes& extremes = run.summary.deck[static_cast<std::size_t>(places - run.header.deck.begin())];
  std::map<double, std::pair<double, double>> at;
  for (std::size_t i = 0; i < places->x.size(); ++i) {
    const double low = factor * extremes.smallest[i], high = factor * extremes.largest[i];
    const auto [entry, first] = at.try_emplace(places->x[i], low, high);
    if (first) continue;
    entry->second = {std::min(entry->second.first, low), std::max(entry->second.second, high)};
  }
  Series largest{label + quantity.label + "largest", {}, {}}, smallest{label + quantity.label + "smallest", {}, {}};
  for (const auto& [x, extreme] : at) {
    smallest.x.push_back(x);
    smallest.y.push_back(extreme.first);
    largest.x.push_back(x);
    largest.y.push_back(extreme.second);
  }
  chart.series.push_back(std::move(largest));
  chart.series.push_back(std::move(smallest));
}

}  // namespace

bool has_deck_extremes(const RunResults& run) noexcept { return !run.summary.deck.empty(); }

std::string deck_charts(std::span<const RunResults> runs, const std::vector<std::string>& names,
                        const std::vector<Mark>& bridge) {
  std::string html;
  for (const DeckChart& own : all_charts()) {
    Chart chart;
    chart.title = own.title;
    chart.note = own.note;
    chart.x_label = "position along the track [m]";
    chart.y_label = own.y_label;
    for (std::size_t r = 0; r < runs.size(); ++r) {
      if (!has_deck_extremes(runs[r])) continue;
      const std::string label = runs.size() > 1 ? names[r] + ", " : "";
      for (const DeckLine& quantity : own.quantities) add_lines(runs[r], quantity, own.factor, label, chart);
    }
    chart.marks = bridge;
    html += chart_html(chart);
  }
  return html;
}

}  // namespace railtab::report
