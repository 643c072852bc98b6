#pragma once

#include <optional>
#include <string>
#include <vector>

#include "railtab/runtime/assessment/dynamic_need.hpp"
#include "railtab/runtime/assessment/verdict.hpp"
#include "railtab/runtime/moving_load/speed_range.hpp"
#include "run_measures.hpp"

namespace railtab::assess {

/// A deck and its trains of moving forces.
struct DeckAssessment {
  ModalDeck deck;
  double span = 0.0;                        ///< of the simply supported span [m]; 0: an imported deck
  std::optional<double> lateral_frequency;  ///< [Hz]
  DynamicNeedResult need;
  double cut_off = 30.0;          ///< of its acceleration [Hz]
  std::vector<AxleTrain> trains;  ///< HSLM-A, then the scene's own train; none: stage not asked for
  std::vector<TrainResponse> responses;
};

/// One run with contact.
struct RunAssessment {
  std::string name, train;
  double speed = 0.0;       ///< [m/s]
  std::optional<int> seed;  ///< of the random track
  bool there = false, complete = false;
  std::string message;  ///< why it is not there or ended early
  std::string results;  ///< file
  std::vector<MeasuredValue> values;
};

/// What a stage did.
struct StageReport {
  AssessmentStage stage = AssessmentStage::check;
  bool done = false;
  std::string skipped;             ///< why, where it was not done
  std::vector<std::string> notes;  ///< what was chosen, changed or left out, sentence by sentence
  double seconds = 0.0;
};

struct Assessment {
  std::string scene_name, scene_file, scene_text, version;
  AssessmentFacts facts;
  double low_speed = 0.0, high_speed = 0.0;  ///< of moving loads [m/s]
  std::vector<StageReport> stages;
  std::vector<std::string> warnings;  ///< of the runs, each with the runs that have it
  std::vector<DeckAssessment> decks;
  std::vector<RunAssessment> runs;
  WheelSeries wheel;                    ///< of the run with the largest unloading
  std::string wheel_run;                ///< its name
  std::vector<DeckSeries> deck_series;  ///< of acceleration and displacement, each of the run that governs it
  RunWindow window;                     ///< of all runs
  std::vector<MeasuredValue> values;
  std::vector<MissingMeasure> missing;
  std::vector<Clause> clauses;
  std::vector<Verdict> verdicts;  ///< point into `clauses`

  /// Limits of this outcome, see LimitVerdicts; one that is not met counts whatever follows from it.
  [[nodiscard]] int count(Outcome outcome) const;
  [[nodiscard]] int failures(bool verified_only) const;  ///< limits that fail and count
};

/// One limit with its verdicts, one for each stage that has values for it. Its outcome is the worst of them: it fails,
/// has a consequence, is not judged, passes, does not apply.
struct LimitVerdicts {
  const Clause* clause = nullptr;
  std::vector<const Verdict*> stages;  ///< in the order of stages, one at least
  [[nodiscard]] const Verdict& worst() const;
};
/// In the order of pages: failures, consequences, the others by how near they are, those without values.
[[nodiscard]] std::vector<LimitVerdicts> by_limit(const std::vector<Verdict>& verdicts);

/// "FAILS: 2 limits fail, worst with hslm-a2; …", "PASSES …": in words, for text and page.
[[nodiscard]] std::string verdict_in_words(const Assessment& assessment);
/// "hslm-a8, 200.0 km/h, span 1, x = 12.50 m, t = 3.200 s"
[[nodiscard]] std::string place_in_words(const MeasuredValue& value);
/// The same without train, speed and seed.
[[nodiscard]] std::string spot_in_words(const MeasuredValue& value);
/// "x = 12.50 m, y = 2.00 m", as far as known.
[[nodiscard]] std::string position_in_words(const std::optional<double>& x, const std::optional<double>& y);
/// "moving forces"
[[nodiscard]] std::string_view stage_in_words(AssessmentStage stage) noexcept;
/// "read in the standard", "read in a secondary source", "unverified"
[[nodiscard]] std::string_view standing_in_words(const Clause& clause) noexcept;
/// Wheel unloading of the run that a verdict on a deck stands for: research puts the safety of the train beside what
/// the deck does. None of verdicts on other things, and of decks without a value.
struct UnloadingBeside {
  std::optional<MeasuredValue> value;  ///< the largest of the run, low-passed
  std::string reason;                  ///< why there is none
};
[[nodiscard]] std::optional<UnloadingBeside> unloading_beside(const Assessment& assessment, const Verdict& verdict);
/// "0.312, wheelset 2 left, x = 31.40 m, t = 1.200 s", or "none: …".
[[nodiscard]] std::string unloading_in_words(const UnloadingBeside& beside);
/// Where the limits judged were read, each kind with its number; empty where none is judged.
[[nodiscard]] std::string standing_in_words(const Assessment& assessment);
/// Whether EN 1991-2 asks for a dynamic analysis of any deck; empty without decks.
[[nodiscard]] std::string need_in_words(const Assessment& assessment);
/// A measure's value or limit with its unit as pages show it: "3.50 m/s²".
[[nodiscard]] std::string amount_in_words(double value, std::string_view unit);

}  // namespace railtab::assess
