#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "railtab/runtime/report/chart.hpp"
#include "railtab/runtime/results/result_file.hpp"

namespace railtab::report {

/// Extremes of a quantity over a run along the deck: at each x the smallest and largest of all y. [SI]
struct DeckEnvelope {
  std::vector<double> x, smallest, largest;
};
/// @param quantity of DeckPlaces @return empty where the run does not have it
[[nodiscard]] DeckEnvelope deck_envelope(const RunResults& run, std::string_view quantity);

/// Charts over x of the extremes that runs have of their whole decks (ResultHeader::deck), as HTML: displacement,
/// acceleration with and without filter, twist, bending moment. At one x the extremes of all y. Empty where no run has
/// the quantity.
/// @param names of the runs, put before the names of lines where there are several
[[nodiscard]] std::string deck_charts(std::span<const RunResults> runs, const std::vector<std::string>& names,
                                      const std::vector<Mark>& bridge);

/// Whether a run's file has them.
[[nodiscard]] bool has_deck_extremes(const RunResults& run) noexcept;

}  // namespace railtab::report
