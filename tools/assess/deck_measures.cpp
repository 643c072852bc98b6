#include <fmt/format.h>

#include <array>

#include "railtab/runtime/measures/low_pass.hpp"
#include "run_judge.hpp"

namespace railtab::assess {
namespace {

/// Measures that the envelope of a deck has, by quantity; the first three also its recorded nodes.
struct EnvelopeMeasure {
  std::string_view quantity, name;
};
constexpr std::array envelope_measures{EnvelopeMeasure{"filtered_acceleration", "deck_acceleration"},
                                       EnvelopeMeasure{"acceleration", "deck_acceleration_unfiltered"},
                                       EnvelopeMeasure{"displacement", "deck_displacement"},
                                       EnvelopeMeasure{"twist", "deck_twist"},
                                       EnvelopeMeasure{"end_rotation", "deck_end_rotation"},
                                       EnvelopeMeasure{"horizontal_rotation", "horizontal_rotation"},
                                       EnvelopeMeasure{"joint_step", "deck_joint_step"},
                                       EnvelopeMeasure{"joint_gap", "deck_joint_gap"}};
const std::vector<std::string> of_envelope{"deck_twist",      "deck_end_rotation", "horizontal_rotation",
                                           "deck_joint_step", "deck_joint_gap",    "track_twist"};

/// All at the same distance from the track's centre.
bool one_line(const std::vector<double>& y) {
  return std::ranges::all_of(y, [&](double other) { return other == y.front(); });
}

class DeckJudge : public RunJudge {
 public:
  using RunJudge::RunJudge;

  void find() {
    if (header_.deck.empty()) {
      miss(of_envelope, "the run has no envelope of the deck (output.deck_envelope)");
    } else if (results_.summary.deck.empty()) {
      miss(of_envelope, "the run was ended before it wrote the envelope of the deck");
    } else {
      return whole_deck();
    }
    recorded_deck();
  }

 private:
  /// From the extremes of all its nodes.
  void whole_deck() {
    const bool fast = std::abs(header_.deck_cut_off - window_.deck_cut_off) <= 1e-6 * window_.deck_cut_off;
    for (std::size_t q = 0; q < header_.deck.size(); ++q) {
      const auto measure = std::ranges::find(envelope_measures, header_.deck[q].quantity, &EnvelopeMeasure::quantity);
      if (measure == envelope_measures.end()) continue;
      if (!fast && measure->name == "deck_acceleration") {
        const double asked = window_.deck_cut_off;
        const std::string steps =
            header_.deck_cut_off < asked
                ? fmt::format(", which takes integration.time_step of at most {:.3g} s", longest_low_pass_step(asked))
                : "";
        miss({"deck_acceleration"}, fmt::format("output.deck_cut_off is {:.4g} Hz, and the decks ask for {:.4g} Hz{}",
                                                header_.deck_cut_off, asked, steps));
        continue;
      }
      const DeckPlaces& places = header_.deck[q];
      const DeckExtremes& extremes = results_.summary.deck[q];
      const bool line = one_line(places.y);
      for (std::size_t i = 0; i < places.x.size(); ++i) {
        const std::optional<double> y = line ? std::nullopt : std::optional(places.y[i]);
        raise(std::string(measure->name), extremes.smallest[i], {"deck", extremes.smallest_time[i], places.x[i], y});
        raise(std::string(measure->name), extremes.largest[i], {"deck", extremes.largest_time[i], places.x[i], y});
      }
    }
    for (const EnvelopeMeasure& measure : envelope_measures) {
      if (std::ranges::count(header_.deck, measure.quantity, &DeckPlaces::quantity) > 0) continue;
      miss({std::string(measure.name)}, "the decks of this scene do not have it");
    }
    track_twist();
    keep();
  }

  /// A bound: deck and track have their largest twists at different places.
  void track_twist() {
    const auto twist = std::ranges::find(header_.deck, "twist", &DeckPlaces::quantity);
    if (twist == header_.deck.end() || twist->x.empty()) {
      return miss({"track_twist"}, "the decks of this scene do not have it");
    }
    if (!window_.track_twist) {
      return miss({"track_twist"}, "the scene's track is perfect: its twist without traffic is not known");
    }
    const DeckExtremes& extremes = results_.summary.deck[static_cast<std::size_t>(twist - header_.deck.begin())];
    const double deck = std::max(std::ranges::max(extremes.largest), -std::ranges::min(extremes.smallest));
    const auto [first, last] = std::ranges::minmax(twist->x);
    const double track = window_.track_twist(first, last);
    raise("track_twist", deck + track, {fmt::format("deck {:.2f} mm + track {:.2f} mm", 1e3 * deck, 1e3 * track)});
  }

  /// Of a recorded node; without y where all of the deck have one, or it is not known.
  [[nodiscard]] std::optional<double> y_of_node(std::size_t node) const {
    if (header_.node_y.empty()) return std::nullopt;
    std::vector<double> all;
    for (std::size_t i = 0; i < header_.node_names.size(); ++i) {
      if (is_deck(header_.node_names[i])) all.push_back(header_.node_y[i]);
    }
    return one_line(all) ? std::nullopt : std::optional(header_.node_y[node]);
  }

  void recorded_deck() {
    const std::vector<std::string> filtered{"deck_acceleration"},
        all{"deck_acceleration", "deck_acceleration_unfiltered", "deck_displacement"};
    if (std::none_of(header_.node_names.begin(), header_.node_names.end(), [](const auto& n) { return is_deck(n); })) {
      return miss(all, "no node named deck… is recorded");
    }
    const bool fast = samples_fast_enough(window_.deck_cut_off, step_);
    if (!fast)
      miss(filtered,
           fmt::format("records {:g} s apart are too far for a filter of {:.4g} Hz", step_, window_.deck_cut_off));
    for (std::size_t i = 0; i < header_.node_names.size(); ++i) {
      if (!is_deck(header_.node_names[i])) continue;
      const Series raw = of_records([&](const StepRecord& r) { return r.nodes[i].acceleration[vertical]; });
      const Series smooth = fast ? low_passed(raw, window_.deck_cut_off, step_) : Series{};
      const std::optional<double> y = y_of_node(i);
      for (std::size_t k = 0; k < records_; ++k) {
        const Spot spot{header_.node_names[i], at(k).time, header_.node_x[i], y};
        raise("deck_acceleration_unfiltered", raw[k], spot);
        if (fast) raise("deck_acceleration", smooth[k], spot);
        raise("deck_displacement", at(k).nodes[i].displacement[vertical], spot);
      }
    }
    keep();
  }
};

}  // namespace

void measure_decks(const RunResults& results, const RunWindow& window, RunMeasures& found) {
  DeckJudge(results, window, found).find();
}

}  // namespace railtab::assess
