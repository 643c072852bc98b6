#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "assessment.hpp"

namespace railtab::assess {

/// A measure of moving forces and the peak of a passage that it is.
struct PassageMeasure {
  std::string_view measure;
  DeckPeak PassagePeaks::*peak;
};
inline constexpr std::array passage_measures{PassageMeasure{"deck_acceleration", &PassagePeaks::acceleration},
                                             PassageMeasure{"deck_displacement", &PassagePeaks::displacement},
                                             PassageMeasure{"deck_end_rotation", &PassagePeaks::end_rotation}};

/// A value [SI] at a deck, with the span that limits depend on; the caller adds where on it.
[[nodiscard]] MeasuredValue value_of_deck(const DeckAssessment& deck, std::string_view measure, AssessmentStage stage,
                                          double value);
/// The largest of all trains of a deck at computed speeds: of values that are not overestimated, and of those that are.
[[nodiscard]] std::vector<MeasuredValue> largest_of_passages(const DeckAssessment& deck, const PassageMeasure& measure);

/// Speeds [m/s] in which a limit is exceeded.
struct SpeedBand {
  double from = 0.0, to = 0.0;
  bool from_lowest = false, to_highest = false;  ///< it begins or ends where what was computed does: it may be wider
  MeasuredValue worst;                           ///< the value in it that is farthest beyond its limit
  std::vector<std::string> trains;               ///< that exceed the limit somewhere in it
};

/// A limit over the speeds for which it was computed.
struct OverSpeed {
  std::vector<SpeedBand> bands;              ///< by speed, apart from each other
  bool runs = false;                         ///< of runs: bands are single speeds
  std::vector<double> speeds;                ///< computed, of all trains, rising [m/s]
  double widest_step = 0.0;                  ///< largest distance between computed speeds of any train [m/s]
  std::optional<MeasuredValue> to_the_line;  ///< the value nearest to or farthest beyond its limit up to the line speed
};

/// What a verdict is over speed; none of verdicts of stage check, without values, of lower limits and of one speed.
///
/// Moving forces: a train on a deck exceeds the limit between computed speeds at which it does, and up to the place
/// where the line from there to the next computed speed meets the limit; bands of all trains and decks are merged.
/// Between runs, whose speeds are few, nothing is interpolated.
[[nodiscard]] std::optional<OverSpeed> over_speed(const Assessment& assessment, const Verdict& verdict);

/// The same in sentences: each band, from which computed speeds they are, the largest value up to the line's speed and
/// of all speeds. Empty where there is nothing to tell, also of runs none of which exceeds the limit.
[[nodiscard]] std::vector<std::string> over_speed_in_words(const Assessment& assessment, const Verdict& verdict);

}  // namespace railtab::assess
