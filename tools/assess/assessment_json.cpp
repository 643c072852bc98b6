#include "assessment_json.hpp"

#include "over_speed.hpp"

namespace railtab::assess {
namespace {

using Json = nlohmann::ordered_json;

Json value_json(const MeasuredValue& value) {
  Json json{{"measure", value.measure},
            {"stage", stage_name(value.stage)},
            {"value", value.value},
            {"unit", find_measure(value.measure)->unit},
            {"where", value.where}};
  if (!value.train.empty()) json["train"] = value.train;
  if (value.speed) json["speed"] = *value.speed;
  if (value.seed) json["seed"] = *value.seed;
  if (value.time) json["time"] = *value.time;
  if (value.x) json["x"] = *value.x;
  if (value.y) json["y"] = *value.y;
  if (!value.run.empty()) json["run"] = value.run;
  return json;
}

Json over_speed_json(const OverSpeed& over) {
  Json bands = Json::array();
  for (const SpeedBand& band : over.bands) {
    bands.push_back({{"from", band.from},
                     {"to", band.to},
                     {"from_lowest", band.from_lowest},
                     {"to_highest", band.to_highest},
                     {"worst", value_json(band.worst)},
                     {"trains", band.trains}});
  }
  Json json{{"bands", bands}, {"computed", {over.speeds.front(), over.speeds.back()}}};
  if (over.runs) json["speeds"] = over.speeds;
  if (!over.runs) json["widest_step"] = over.widest_step;
  if (over.to_the_line) json["to_line_speed"] = value_json(*over.to_the_line);
  return json;
}

Json verdict_json(const Assessment& assessment, const Verdict& verdict) {
  const Clause& clause = *verdict.clause;
  Json json{{"id", clause.id},
            {"outcome", outcome_name(verdict.outcome)},
            {"read_in", read_in_name(clause.read_in)},
            {"edition", clause.edition},
            {"clause", clause.clause},
            {"title", clause.title},
            {"measure", clause.measure},
            {"unit", clause.unit},
            {"source", clause.source}};
  if (!clause.note.empty()) json["note"] = clause.note;
  if (!clause.consequence.empty()) json["consequence"] = clause.consequence;
  if (verdict.stage) json["stage"] = stage_name(*verdict.stage);
  if (!verdict.reason.empty()) json["reason"] = verdict.reason;
  if (verdict.at) {
    json["limit"] = verdict.limit;
    json["sense"] = clause.limit.lower ? "at least" : "at most";
    json["utilisation"] = verdict.utilisation();
    json["value"] = verdict.at->value;
    json["at"] = value_json(*verdict.at);
    if (const auto beside = unloading_beside(assessment, verdict)) {
      json["wheel_unloading"] = beside->value ? value_json(*beside->value) : Json{{"reason", beside->reason}};
    }
    if (const auto over = over_speed(assessment, verdict)) json["over_speed"] = over_speed_json(*over);
  }
  return json;
}

Json deck_json(const DeckAssessment& deck) {
  std::vector<double> frequencies;
  for (int n = 0; n < deck.deck.dynamic_modes; ++n) frequencies.push_back(deck.deck.frequency(n));
  Json json{{"name", deck.deck.name},
            {"length", deck.deck.length()},
            {"frequencies", frequencies},
            {"first_bending_frequency", deck.deck.frequency(deck.deck.first_bending)},
            {"third_bending_frequency", deck.deck.frequency(deck.deck.third_bending)},
            {"cut_off", deck.cut_off},
            {"dynamic_analysis", {{"need", need_name(deck.need.need)}, {"reason", deck.need.reason}}}};
  if (deck.lateral_frequency) json["lateral_frequency"] = *deck.lateral_frequency;
  Json trains = Json::array();
  for (const TrainResponse& response : deck.responses) {
    Json passages = Json::array();
    for (const PassagePeaks& p : response.passages) {
      passages.push_back({{"speed", p.speed},
                          {"acceleration", p.acceleration.value},
                          {"displacement", p.displacement.value},
                          {"end_rotation", p.end_rotation.value}});
    }
    trains.push_back({{"train", deck.trains[response.train].name},
                      {"static_displacement", response.standing.value},
                      {"passages", passages}});
  }
  json["trains"] = trains;
  return json;
}

Json run_json(const RunAssessment& run) {
  Json json{{"run", run.name},
            {"train", run.train},
            {"speed", run.speed},
            {"complete", run.complete},
            {"message", run.message}};
  if (run.seed) json["seed"] = *run.seed;
  json["results"] = run.results;
  Json values = Json::object();
  for (const MeasuredValue& value : run.values) {
    if (!values.contains(value.measure) || values[value.measure] < value.value) values[value.measure] = value.value;
  }
  json["measures"] = values;
  return json;
}

}  // namespace

Json assessment_json(const Assessment& assessment) {
  Json json{{"railtab", assessment.version},
            {"scene", assessment.scene_name},
            {"scene_file", assessment.scene_file},
            {"verdict", verdict_in_words(assessment)},
            {"summary",
             {{"fail", assessment.failures(false)},
              {"fail_verified", assessment.failures(true)},
              {"pass", assessment.count(Outcome::pass)},
              {"not_judged", assessment.count(Outcome::not_judged)}}},
            {"line_speed", assessment.facts.line_speed},
            {"track", assessment.facts.track},
            {"moving_load_speeds", {assessment.low_speed, assessment.high_speed}}};
  Json stages = Json::object();
  for (const StageReport& stage : assessment.stages) {
    stages[std::string(stage_name(stage.stage))] = {
        {"done", stage.done}, {"skipped", stage.skipped}, {"notes", stage.notes}, {"seconds", stage.seconds}};
  }
  json["stages"] = stages;
  json["warnings"] = assessment.warnings;
  Json verdicts = Json::array(), decks = Json::array(), runs = Json::array(), measures = Json::array();
  for (const Verdict& verdict : assessment.verdicts) verdicts.push_back(verdict_json(assessment, verdict));
  for (const DeckAssessment& deck : assessment.decks) decks.push_back(deck_json(deck));
  for (const RunAssessment& run : assessment.runs) runs.push_back(run_json(run));
  for (const MeasuredValue& value : assessment.values) measures.push_back(value_json(value));
  json["verdicts"] = verdicts;
  json["decks"] = decks;
  json["runs"] = runs;
  json["measures"] = measures;
  return json;
}

}  // namespace railtab::assess
