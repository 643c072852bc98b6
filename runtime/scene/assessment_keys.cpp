#include "railtab/runtime/scene/key_table.hpp"

namespace railtab::scene {
namespace {

template <auto member>
auto& of_assessment(SceneDraft& draft) {
  return draft.parameters.assessment.*member;
}

}  // namespace

std::vector<KeyRow> assessment_keys() {
  return {
      {"assessment.line_speed_kmh", "km/h", "highest speed of the line; 0: the train's",
       NumberKey{of_assessment<&AssessmentParameters::line_speed_kmh>, {1.0, 600.0, true}}},
      {"assessment.track", "", "track on the deck, for the limit of its acceleration",
       choice<DeckTrack>(of_assessment<&AssessmentParameters::track>,
                         {{"ballasted", DeckTrack::ballasted}, {"direct", DeckTrack::direct}})},
      {"assessment.trains", "", "trains besides the scene's: axle loads or vehicles",
       TextListKey{of_assessment<&AssessmentParameters::trains>}},
      {"assessment.seeds",
       "1",
       "random tracks for each speed, from irregularity.seed on",
       IntegerKey{of_assessment<&AssessmentParameters::seeds>, 1, 1000},
       {&with_spectrum}},
      {"assessment.begin",
       "m",
       "where the judging of wheels and car bodies begins; absent: train.start, or the end of the fade-in",
       OptionalNumberKey{of_assessment<&AssessmentParameters::begin>, {-1e5, 1e5}},
       {},
       {&judging_outside_run}},
      {"assessment.end", "m", "where the judging ends; absent: where the run ends",
       OptionalNumberKey{of_assessment<&AssessmentParameters::end>, {-1e5, 1e5}}},
      {"assessment.section_length", "m", "of percentiles by section, from assessment.begin on; 0: all that is judged",
       NumberKey{of_assessment<&AssessmentParameters::section_length>, {2.0, 1e5, true}}},
      {"assessment.section_step", "m", "between the values of a section",
       NumberKey{of_assessment<&AssessmentParameters::section_step>, {0.01, 10.0}}},
      {"assessment.rules", "", "whose clauses apply: Europe, China, Japan, USA, or names of your own files",
       TextListKey{of_assessment<&AssessmentParameters::rules>}},
  };
}

}  // namespace railtab::scene
