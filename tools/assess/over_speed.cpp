#include "over_speed.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace railtab::assess {
namespace {

constexpr double kmh = 3.6;

/// A train on a deck, or in runs: values by speed, all against one limit.
struct Curve {
  std::vector<MeasuredValue> values;
  double limit = 0.0;
};

double beyond(const Curve& curve, std::size_t i) { return curve.values[i].value - curve.limit; }

/// Where the line between two neighbouring values meets the limit [m/s].
double crossing(const Curve& curve, std::size_t i) {
  const double below = beyond(curve, i), above = beyond(curve, i + 1);
  const double first = *curve.values[i].speed, second = *curve.values[i + 1].speed;
  return first + (second - first) * below / (below - above);
}

/// @pre speeds of the curve rise
std::vector<SpeedBand> bands_of(const Curve& curve) {
  std::vector<SpeedBand> bands;
  const std::size_t count = curve.values.size();
  for (std::size_t i = 0; i < count; ++i) {
    if (!(beyond(curve, i) > 0.0)) continue;
    const MeasuredValue& value = curve.values[i];
    const bool begins = i == 0 || !(beyond(curve, i - 1) > 0.0), last = i + 1 == count;
    if (begins) {
      bands.push_back({i == 0 ? *value.speed : crossing(curve, i - 1), 0.0, i == 0, false, value, {value.train}});
    }
    SpeedBand& band = bands.back();
    if (value.value > band.worst.value) band.worst = value;
    band.to_highest = last;
    band.to = last || beyond(curve, i + 1) > 0.0 ? *value.speed : crossing(curve, i);
  }
  return bands;
}

/// Bands that touch or overlap become one. @param clause gives the limits by which the worst value is found
std::vector<SpeedBand> merged(std::vector<SpeedBand> bands, const Clause& clause) {
  const auto share = [&](const MeasuredValue& value) { return value.value / *limit_for(clause, value); };
  std::ranges::sort(bands, {}, &SpeedBand::from);
  std::vector<SpeedBand> apart;
  for (SpeedBand& band : bands) {
    if (apart.empty() || band.from > apart.back().to) {
      apart.push_back(std::move(band));
      continue;
    }
    SpeedBand& before = apart.back();
    before.from_lowest = before.from_lowest || (band.from_lowest && band.from == before.from);
    if (band.to >= before.to) before.to_highest = band.to_highest || (before.to_highest && band.to == before.to);
    before.to = std::max(before.to, band.to);
    for (std::string& train : band.trains) {
      if (std::ranges::count(before.trains, train) == 0) before.trains.push_back(std::move(train));
    }
    if (share(band.worst) > share(before.worst)) before.worst = std::move(band.worst);
  }
  return apart;
}

/// Why the acceleration is smaller on a track; empty where a single axle load that comes on to a free end has little
/// part in it. What many such loads excite by resonance is not told apart.
std::string overestimated(const ModalDeck& deck, const AxleTrain& train, const DeckPeak& peak) {
  constexpr double part = 0.1;  // of the value: a smaller one decides nothing
  if (train.load.empty()) return {};
  const double sudden = sudden_acceleration(deck, peak.x) * std::ranges::max(train.load);
  if (sudden <= part * peak.value) return {};
  return fmt::format(
      "overestimated: an axle load that comes on to the free end of the deck accelerates this place at once, by up to "
      "{:.3g} m/s²; rails, sleepers and ballast spread it, so runs with contact decide",
      sudden);
}

MeasuredValue value_of_passage(const DeckAssessment& deck, const TrainResponse& response, const PassagePeaks& passage,
                               const PassageMeasure& measure) {
  const DeckPeak& peak = passage.*measure.peak;
  MeasuredValue value = value_of_deck(deck, measure.measure, AssessmentStage::moving_load, peak.value);
  value.x = deck.deck.start + peak.x;
  value.train = deck.trains[response.train].name;
  value.speed = passage.speed;
  value.time = peak.time;
  if (measure.peak == &PassagePeaks::acceleration)
    value.overestimated = overestimated(deck.deck, deck.trains[response.train], peak);
  return value;
}

/// Of every train on every deck that the clause is about.
std::vector<Curve> curves_of_moving_forces(const Assessment& assessment, const Clause& clause) {
  std::vector<Curve> curves;
  const auto measure = std::ranges::find(passage_measures, clause.measure, &PassageMeasure::measure);
  if (measure == passage_measures.end()) return curves;
  for (const DeckAssessment& deck : assessment.decks) {
    const std::optional<double> limit =
        limit_for(clause, value_of_deck(deck, clause.measure, AssessmentStage::moving_load, 0.0));
    if (!limit) continue;
    for (const TrainResponse& response : deck.responses) {
      Curve curve{{}, *limit};
      for (const PassagePeaks& passage : response.passages) {
        curve.values.push_back(value_of_passage(deck, response, passage, *measure));
      }
      if (!curve.values.empty()) curves.push_back(std::move(curve));
    }
  }
  return curves;
}

/// Values of runs, each a curve of its own: nothing is known between their speeds.
std::vector<Curve> curves_of_runs(const Assessment& assessment, const Clause& clause) {
  std::vector<Curve> curves;
  for (const MeasuredValue& value : assessment.values) {
    if (value.stage != AssessmentStage::contact || !value.speed) continue;
    if (const std::optional<double> limit = limit_for(clause, value)) curves.push_back({{value}, *limit});
  }
  return curves;
}

/// The value up to the line speed that is nearest to or farthest beyond its limit.
std::optional<MeasuredValue> worst_to_the_line(const std::vector<Curve>& curves, double line_speed) {
  constexpr double rounding = 1e-9;
  std::optional<MeasuredValue> worst;
  double largest = -1.0;
  for (const Curve& curve : curves) {
    for (const MeasuredValue& value : curve.values) {
      const double share = value.value / curve.limit;
      if (*value.speed > line_speed * (1.0 + rounding) || !(share > largest)) continue;
      largest = share;
      worst = value;
    }
  }
  return worst;
}

std::string band_in_words(const SpeedBand& band, bool run, std::string_view unit) {
  const std::string worst = amount_in_words(band.worst.value, unit);
  if (run)
    return fmt::format("exceeded in runs at {:.1f} km/h: largest {} with {}", kmh * band.from, worst, band.worst.train);
  const std::string others = band.trains.size() > 1 ? fmt::format("; {} trains exceed it", band.trains.size()) : "";
  return fmt::format("exceeded from {:.1f} km/h{} to {:.1f} km/h{}: largest {} at {:.1f} km/h with {}{}",
                     kmh * band.from, band.from_lowest ? ", the lowest speed computed," : "", kmh * band.to,
                     band.to_highest ? ", the highest speed computed" : "", worst, kmh * *band.worst.speed,
                     band.worst.train, others);
}

std::string computed_in_words(const OverSpeed& over) {
  if (over.runs) {
    std::vector<std::string> speeds;
    for (const double speed : over.speeds) speeds.push_back(fmt::format("{:.1f}", kmh * speed));
    return fmt::format("runs at {} km/h; between them nothing is known", fmt::join(speeds, ", "));
  }
  const std::string speeds = fmt::format("speeds computed from {:.1f} to {:.1f} km/h, at most {:.1f} km/h apart",
                                         kmh * over.speeds.front(), kmh * over.speeds.back(), kmh * over.widest_step);
  return over.bands.empty() ? "exceeded at none of the " + speeds : speeds + "; ends of bands interpolated";
}

}  // namespace

MeasuredValue value_of_deck(const DeckAssessment& deck, std::string_view measure, AssessmentStage stage, double value) {
  MeasuredValue result;
  result.measure = measure;
  result.stage = stage;
  result.value = value;
  result.where = deck.deck.name;
  if (deck.span > 0.0) result.quantities["span"] = deck.span;
  return result;
}

std::vector<MeasuredValue> largest_of_passages(const DeckAssessment& deck, const PassageMeasure& measure) {
  std::optional<MeasuredValue> largest, overestimated;
  for (const TrainResponse& response : deck.responses) {
    for (const PassagePeaks& passage : response.passages) {
      MeasuredValue value = value_of_passage(deck, response, passage, measure);
      std::optional<MeasuredValue>& worst = value.overestimated.empty() ? largest : overestimated;
      if (!worst || value.value > worst->value) worst = std::move(value);
    }
  }
  std::vector<MeasuredValue> found;
  for (std::optional<MeasuredValue>* value : {&largest, &overestimated}) {
    if (*value) found.push_back(*std::move(*value));
  }
  return found;
}

std::optional<OverSpeed> over_speed(const Assessment& assessment, const Verdict& verdict) {
  const Clause& clause = *verdict.clause;
  if (!verdict.at || clause.limit.lower || verdict.stage == AssessmentStage::check) return std::nullopt;
  OverSpeed over;
  over.runs = verdict.stage == AssessmentStage::contact;
  const std::vector<Curve> curves =
      over.runs ? curves_of_runs(assessment, clause) : curves_of_moving_forces(assessment, clause);
  std::vector<SpeedBand> bands;
  for (const Curve& curve : curves) {
    for (std::size_t i = 0; i < curve.values.size(); ++i) {
      over.speeds.push_back(*curve.values[i].speed);
      if (i > 0) over.widest_step = std::max(over.widest_step, *curve.values[i].speed - *curve.values[i - 1].speed);
    }
    for (SpeedBand& band : bands_of(curve)) {
      if (over.runs) band.from_lowest = band.to_highest = false;
      bands.push_back(std::move(band));
    }
  }
  std::ranges::sort(over.speeds);
  over.speeds.erase(std::unique(over.speeds.begin(), over.speeds.end()), over.speeds.end());
  if (over.speeds.size() < 2) return std::nullopt;
  over.bands = merged(std::move(bands), clause);
  over.to_the_line = worst_to_the_line(curves, assessment.facts.line_speed);
  return over;
}

std::vector<std::string> over_speed_in_words(const Assessment& assessment, const Verdict& verdict) {
  const std::optional<OverSpeed> over = over_speed(assessment, verdict);
  if (!over) return {};
  if (over->runs && over->bands.empty()) return {};
  const std::string& unit = verdict.clause->unit;
  std::vector<std::string> words;
  for (const SpeedBand& band : over->bands) words.push_back(band_in_words(band, over->runs, unit));
  words.push_back(computed_in_words(*over));
  const std::string all = fmt::format("{} over all speeds computed, up to {:.1f} km/h",
                                      amount_in_words(verdict.at->value, unit), kmh * over->speeds.back());
  const double line = kmh * assessment.facts.line_speed;
  if (over->to_the_line) {
    const MeasuredValue& value = *over->to_the_line;
    words.push_back(fmt::format("largest {} up to the line's {:.1f} km/h ({:.1f} km/h with {}), {}",
                                amount_in_words(value.value, unit), line, kmh * *value.speed, value.train, all));
  } else {
    words.push_back(fmt::format("no speed up to the line's {:.1f} km/h was computed; largest {}", line, all));
  }
  return words;
}

}  // namespace railtab::assess
