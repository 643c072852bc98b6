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
  const DeckEnvelope envelope = deck_envelope(run, quantity.name);
  if (envelope.x.empty()) return;
  for (const auto& [name, values] :
       {std::pair("largest", &envelope.largest), std::pair("smallest", &envelope.smallest)}) {
    Series series{label + quantity.label + name, envelope.x, *values};
    for (double& y : series.y) y *= factor;
    chart.series.push_back(std::move(series));
  }
}

}  // namespace

DeckEnvelope deck_envelope(const RunResults& run, std::string_view quantity) {
  const auto places = std::ranges::find(run.header.deck, quantity, &DeckPlaces::quantity);
  if (places == run.header.deck.end() || run.summary.deck.empty()) return {};
  const DeckExtremes& extremes = run.summary.deck[static_cast<std::size_t>(places - run.header.deck.begin())];
  std::map<double, std::pair<double, double>> at;
  for (std::size_t i = 0; i < places->x.size(); ++i) {
    const double low = extremes.smallest[i], high = extremes.largest[i];
    const auto [entry, first] = at.try_emplace(places->x[i], low, high);
    if (first) continue;
    entry->second = {std::min(entry->second.first, low), std::max(entry->second.second, high)};
  }
  DeckEnvelope envelope;
  for (const auto& [x, extreme] : at) {
    envelope.x.push_back(x);
    envelope.smallest.push_back(extreme.first);
    envelope.largest.push_back(extreme.second);
  }
  return envelope;
}

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
