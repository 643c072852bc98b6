// Assessments made by hand: limits over speed and by stage, and what text, page and JSON tell of them.
#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "assessment.hpp"
#include "assessment_json.hpp"
#include "assessment_page.hpp"
#include "assessment_text.hpp"
#include "over_speed.hpp"

namespace railtab::assess {
namespace {

/// A deck and trains as moving forces: accelerations [m/s²] of the first at 40, 45, … m/s, and so on.
Assessment with_passages(const std::vector<std::vector<double>>& accelerations, double line_speed) {
  Assessment a;
  a.facts = {"ballasted", line_speed};
  a.clauses = library_clauses();
  DeckAssessment& deck = a.decks.emplace_back();
  deck.deck.name = "span 1";
  deck.deck.start = 100.0;
  deck.deck.knots = {0.0, 25.0};
  deck.deck.omega = Eigen::ArrayXd::Constant(1, 20.0);
  deck.deck.damping = Eigen::ArrayXd::Constant(1, 0.01);
  deck.deck.dynamic_modes = 1;
  deck.span = 25.0;
  for (const std::vector<double>& values : accelerations) {
    TrainResponse& response = deck.responses.emplace_back();
    response.train = deck.trains.size();
    deck.trains.emplace_back().name = "train " + std::string(1, static_cast<char>('a' + response.train));
    for (std::size_t i = 0; i < values.size(); ++i) {
      PassagePeaks& passage = response.passages.emplace_back();
      passage.speed = 40.0 + 5.0 * static_cast<double>(i);
      passage.acceleration = {values[i], 12.5, 1.0};
    }
  }
  a.values.push_back(largest_of_passages(deck, passage_measures[0]).front());
  a.verdicts = judge(a.clauses, a.facts, a.values, {});
  return a;
}

const Verdict& deck_verdict(const Assessment& a, AssessmentStage stage) {
  for (const Verdict& v : a.verdicts) {
    if (v.clause->id == "en1990.deck-acceleration.ballasted" && v.stage == stage) return v;
  }
  throw std::runtime_error("no verdict");
}

// Bands over speed: ends by the line between computed values, trains joined, open where the computed speeds end.
TEST(OverSpeed, BandsInWhichALimitIsExceeded) {
  // 3.5 m/s²:  40   45   50   55   60   65   70 m/s
  const Assessment a = with_passages({{1.0, 4.5, 3.0, 1.0, 3.0, 4.0, 5.5}, {1.0, 2.5, 4.0, 3.5, 1.0, 1.0, 3.0}}, 60.0);
  const Verdict& verdict = deck_verdict(a, AssessmentStage::moving_load);
  const OverSpeed over = *over_speed(a, verdict);
  ASSERT_EQ(over.bands.size(), 2U);
  EXPECT_NEAR(over.bands[0].from, 40.0 + 5.0 * 2.5 / 3.5, 1e-9) << "train a";
  EXPECT_NEAR(over.bands[0].to, 55.0, 1e-9) << "train b, which overlaps; at 55 m/s it meets the limit";
  EXPECT_EQ(over.bands[0].worst.train, "train a");
  EXPECT_EQ(over.bands[0].worst.value, 4.5);
  EXPECT_EQ(over.bands[0].worst.x, 112.5) << "along the track";
  EXPECT_EQ(over.bands[0].trains, (std::vector<std::string>{"train a", "train b"}));
  EXPECT_FALSE(over.bands[0].from_lowest || over.bands[0].to_highest);
  EXPECT_NEAR(over.bands[1].from, 62.5, 1e-9);
  EXPECT_EQ(over.bands[1].to, 70.0);
  EXPECT_TRUE(over.bands[1].to_highest);
  EXPECT_EQ(over.bands[1].trains, std::vector<std::string>{"train a"});
  EXPECT_EQ(over.to_the_line->value, 4.5) << "not the 5.5 m/s² above the line's speed";
  EXPECT_EQ(over.widest_step, 5.0);
  const std::vector<std::string> words = over_speed_in_words(a, verdict);
  ASSERT_EQ(words.size(), 4U);
  EXPECT_EQ(
      words[0],
      "exceeded from 156.9 km/h to 198.0 km/h: largest 4.500 m/s² at 162.0 km/h with train a; 2 trains exceed it");
  EXPECT_EQ(words[1],
            "exceeded from 225.0 km/h to 252.0 km/h, the highest speed computed: largest 5.500 m/s² at 252.0 km/h "
            "with train a");
  EXPECT_EQ(words[2], "speeds computed from 144.0 to 252.0 km/h, at most 18.0 km/h apart; ends of bands interpolated");
  EXPECT_EQ(words[3],
            "largest 4.500 m/s² up to the line's 216.0 km/h (162.0 km/h with train a), 5.500 m/s² over all speeds "
            "computed, up to 252.0 km/h");
  const std::string text = assessment_text(a), page = assessment_page(a);
  for (const std::string& sentence : {words[0], words[1], words[2]}) {
    EXPECT_NE(text.find(sentence + "\n"), std::string::npos) << text;
    EXPECT_NE(page.find("→ " + sentence + "<"), std::string::npos);
  }
  EXPECT_EQ(text.find("FAILS: 1 limit fails, worst with train a; "), 1U) << text;
  const auto json = assessment_json(a);
  const auto in_json = std::ranges::find_if(
      json["verdicts"], [](const auto& v) { return v["id"] == "en1990.deck-acceleration.ballasted"; });
  EXPECT_NEAR((*in_json)["over_speed"]["bands"][1]["from"].get<double>(), 62.5, 1e-9);
  EXPECT_EQ((*in_json)["over_speed"]["to_line_speed"]["value"], 4.5);
}

TEST(OverSpeed, OfALimitThatIsMetOrExceededThroughout) {
  const Assessment met = with_passages({{1.0, 2.0, 3.0}}, 45.0);
  const Verdict& pass = deck_verdict(met, AssessmentStage::moving_load);
  EXPECT_TRUE(over_speed(met, pass)->bands.empty());
  EXPECT_EQ(over_speed(met, pass)->to_the_line->value, 2.0);
  EXPECT_EQ(over_speed_in_words(met, pass)[0],
            "exceeded at none of the speeds computed from 144.0 to 180.0 km/h, at most 18.0 km/h apart");
  const Assessment all = with_passages({{4.0, 5.0, 6.0}}, 39.0);
  const OverSpeed over = *over_speed(all, deck_verdict(all, AssessmentStage::moving_load));
  ASSERT_EQ(over.bands.size(), 1U);
  EXPECT_TRUE(over.bands[0].from_lowest && over.bands[0].to_highest);
  EXPECT_FALSE(over.to_the_line) << "no speed up to 39 m/s was computed";
}

// Runs are few: their speeds are told one by one.
TEST(OverSpeed, OfRunsNothingIsInterpolated) {
  Assessment a = with_passages({{1.0, 1.0}}, 50.0);
  const auto add = [&](double run_speed, double value) {
    MeasuredValue v;
    v.measure = "deck_acceleration";
    v.stage = AssessmentStage::contact;
    v.value = value;
    v.speed = run_speed;
    v.train = "train r";
    v.run = "r";
    a.values.push_back(v);
  };
  for (const auto& [run_speed, value] : {std::pair(40.0, 4.0), {50.0, 3.0}, {60.0, 3.6}, {60.0, 3.8}}) {
    add(run_speed, value);
  }
  a.verdicts = judge(a.clauses, a.facts, a.values, {});
  const Verdict& verdict = deck_verdict(a, AssessmentStage::contact);
  const OverSpeed over = *over_speed(a, verdict);
  ASSERT_EQ(over.bands.size(), 2U);
  EXPECT_EQ(over.bands[0].from, 40.0);
  EXPECT_EQ(over.bands[0].to, 40.0);
  EXPECT_FALSE(over.bands[0].from_lowest || over.bands[1].to_highest);
  EXPECT_EQ(over.bands[1].worst.value, 3.8) << "of two seeds";
  EXPECT_EQ(over_speed_in_words(a, verdict)[2], "runs at 144.0, 180.0, 216.0 km/h; between them nothing is known");
}

// Moving forces and runs are judged by one limit: it is one row and counts once.
TEST(Assessment, OneLimitWithItsValuesByStage) {
  Assessment a = with_passages({{3.0, 4.2}}, 50.0);
  MeasuredValue v;
  v.measure = "deck_acceleration";
  v.stage = AssessmentStage::contact;
  v.value = 3.9;
  v.where = "deck";
  v.train = "train r";
  a.values.push_back(v);
  v.measure = "deck_displacement";
  a.values.push_back(v);
  a.verdicts = judge(a.clauses, a.facts, a.values, {});
  EXPECT_EQ(std::ranges::count_if(a.verdicts, [](const Verdict& verdict) { return verdict.failed(); }), 2);
  EXPECT_EQ(a.failures(false), 1);
  EXPECT_TRUE(verdict_in_words(a).starts_with("FAILS: 1 limit fails, worst with train a and train r; 0 pass, "))
      << verdict_in_words(a);
  const auto counted = [](const std::string& text, const std::string& what) {
    int count = 0;
    for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++count;
    return count;
  };
  const std::string text = assessment_text(a), page = assessment_page(a);
  EXPECT_EQ(counted(text, " FAIL  Deck acceleration, ballasted track\n"), 1) << text;
  EXPECT_NE(
      text.find("FAIL  moving forces: 4.200 m/s² of at most 3.500 m/s²\n             train a, 162.0 km/h, span 1, "
                "x = 112.50 m, t = 1.000 s\n"),
      std::string::npos)
      << text;
  EXPECT_NE(text.find("FAIL  wheel–rail contact: 3.900 m/s² of at most 3.500 m/s²\n             train r, deck\n"),
            std::string::npos)
      << text;
  EXPECT_EQ(counted(page, "Deck acceleration, ballasted track"), 2) << "once in the banner, once in the table";
  EXPECT_NE(
      page.find("<li>moving forces: 4.200 m/s², at most 3.500 m/s² permitted, with train a, 162.0 km/h, span 1, "),
      std::string::npos);
  EXPECT_NE(page.find("<li>wheel–rail contact: 3.900 m/s², at most 3.500 m/s² permitted, with train r, deck"),
            std::string::npos);
  a.values[1].value = 2.0;
  a.verdicts = judge(a.clauses, a.facts, a.values, {});
  const std::string half = assessment_page(a);
  EXPECT_NE(half.find("<li>wheel–rail contact (pass): 2.000 m/s²"), std::string::npos) << "not among the failures";
  EXPECT_NE(half.find("<li>moving forces: 4.200 m/s²"), std::string::npos);
  // a stage of which a part is missing leaves a limit open that the other meets
  a.values[0].value = 3.0;
  a.values[1].value = 2.0;
  a.verdicts =
      judge(a.clauses, a.facts, a.values, {{"deck_acceleration", AssessmentStage::contact, "one run ended", true}});
  EXPECT_EQ(a.failures(false), 0);
  EXPECT_EQ(a.count(Outcome::pass), 0);
}

// A value that is known to be too large passes, or leaves its limit open; another one still fails it.
TEST(Assessment, AnOverestimatedValueFailsNoLimit) {
  Assessment a = with_passages({{3.0, 4.2}}, 50.0);
  MeasuredValue v;
  v.measure = "deck_acceleration";
  v.stage = AssessmentStage::moving_load;
  v.value = 9.0;
  v.overestimated = "the end is free";
  a.values = {v};
  const auto verdict_of = [&]() -> const Verdict& {
    a.verdicts = judge(a.clauses, a.facts, a.values, {});
    return *std::ranges::find_if(a.verdicts, [](const Verdict& verdict) { return verdict.at.has_value(); });
  };
  EXPECT_EQ(verdict_of().outcome, Outcome::not_judged);
  EXPECT_EQ(verdict_of().reason, "the end is free");
  EXPECT_EQ(verdict_of().at->value, 9.0);
  a.values[0].value = 3.0;
  EXPECT_EQ(verdict_of().outcome, Outcome::pass);
  a.values[0].value = 9.0;
  v.value = 3.6;
  v.overestimated.clear();
  a.values.push_back(v);
  EXPECT_EQ(verdict_of().outcome, Outcome::fail);
  EXPECT_EQ(verdict_of().at->value, 3.6);
}

// Rounding alone fails no limit, of either sense.
TEST(Assessment, AValueAtItsLimitPasses) {
  const std::vector<Clause> clauses = library_clauses();
  const auto outcome = [&](const char* id, const char* measure, double value) {
    MeasuredValue v;
    v.measure = measure;
    v.stage = AssessmentStage::check;
    v.value = value;
    v.quantities["span"] = 20.0;
    const std::vector<Verdict> verdicts = judge(clauses, {"ballasted", 50.0}, {v}, {});
    return std::ranges::find_if(verdicts, [&](const Verdict& verdict) { return verdict.clause->id == id; })->outcome;
  };
  EXPECT_EQ(outcome("en1991.n0.lower.20", "first_frequency", 3.9999999999999996), Outcome::pass);
  EXPECT_EQ(outcome("en1991.n0.lower.20", "first_frequency", 3.99999), Outcome::fail);
  const double upper = upper_frequency_limit(20.0);
  EXPECT_EQ(outcome("en1991.n0.upper", "first_frequency", upper * (1.0 + 1e-12)), Outcome::pass);
  EXPECT_EQ(outcome("en1991.n0.upper", "first_frequency", upper * (1.0 + 1e-6)), Outcome::fail);
}

// How well a limit is known is told for each, and counted: a program that quotes the standard is not the standard.
TEST(Assessment, BannerCountsWhereLimitsWereRead) {
  Assessment a;
  a.facts = {"ballasted", 50.0};
  a.clauses = library_clauses();
  for (const char* measure : {"deck_acceleration", "car_body_vertical", "wheel_unloading"}) {
    MeasuredValue v;
    v.measure = measure;
    v.stage = AssessmentStage::contact;
    v.value = 0.1;
    a.values.push_back(v);
  }
  a.verdicts = judge(a.clauses, a.facts, a.values, {});
  const std::string standing = standing_in_words(a);
  EXPECT_EQ(
      standing,
      "Limits judged: 1 read in the standard or a national annex to it, 3 in a secondary source only, 1 unverified. "
      "Check all but the first in the standard.");
  const std::string page = assessment_page(a);
  EXPECT_NE(page.find("<p>" + standing + "</p>"), std::string::npos);
  EXPECT_NE(page.find("<span class=\"standing\">read in a secondary source</span> <small>bacadra (Python program)"),
            std::string::npos);
  EXPECT_NE(page.find("<small>read in: NBN EN 1990 ANB:2021"), std::string::npos);
  const auto json = assessment_json(a);
  const auto read_in = [&](std::string_view id) {
    return std::ranges::find_if(json["verdicts"], [&](const auto& v) { return v["id"] == id; })->at("read_in");
  };
  EXPECT_EQ(read_in("en1990.deck-acceleration.ballasted"), "standard");
  EXPECT_EQ(read_in("en1990.comfort.good"), "secondary source");
  EXPECT_EQ(read_in("en14363.unloading"), "nothing");
}

/// An assessment by hand: what its three forms say.
TEST(Assessment, TextPageAndJsonSayWhatFailsAndWhere) {
  Assessment a;
  a.scene_name = "a <bridge>";
  a.version = "test";
  a.facts = {"ballasted", 200.0 / 3.6};
  a.clauses = library_clauses();
  MeasuredValue v;
  v.measure = "deck_acceleration";
  v.stage = AssessmentStage::moving_load;
  v.value = 4.2;
  v.where = "span 1";
  v.x = 12.5;
  v.train = "hslm-a8";
  v.speed = 50.0;
  v.time = 3.25;
  a.values = {v};
  a.verdicts = judge(a.clauses, a.facts, a.values, {});
  EXPECT_EQ(a.failures(false), 1);
  EXPECT_EQ(a.failures(true), 1);
  EXPECT_TRUE(verdict_in_words(a).starts_with("FAILS: 1 limit fails, worst with hslm-a8; "));
  const std::string text = assessment_text(a);
  EXPECT_NE(
      text.find(" FAIL  Deck acceleration, ballasted track\n       EN 1990:2002/A1:2005 A2.4.4.2.1(4), read in the "
                "standard\n       FAIL  moving forces: 4.200 m/s² of at most 3.500 m/s²\n             hslm-a8, "
                "180.0 km/h, span 1, x = 12.50 m, t = 3.250 s\n"),
      std::string::npos)
      << text;
  const std::string page = assessment_page(a);
  EXPECT_NE(page.find("a &lt;bridge&gt;"), std::string::npos);
  EXPECT_EQ(page.find("://"), std::string::npos) << "it loads nothing";
  EXPECT_NE(page.find("<span class=\"mark fail\">FAIL</span>"), std::string::npos);
  const auto json = assessment_json(a);
  EXPECT_EQ(json["summary"]["fail"], 1);
  const auto deck = std::find_if(json["verdicts"].begin(), json["verdicts"].end(), [](const auto& verdict) {
    return verdict["id"] == "en1990.deck-acceleration.ballasted";
  });
  ASSERT_NE(deck, json["verdicts"].end());
  EXPECT_EQ((*deck)["outcome"], "fail");
  EXPECT_EQ((*deck)["limit"], 3.5);
  EXPECT_NEAR((*deck)["utilisation"].get<double>(), 1.2, 1e-12);
  EXPECT_EQ((*deck)["at"]["train"], "hslm-a8");
  EXPECT_EQ((*deck)["at"]["x"], 12.5);
}

// Every verdict on a deck has the unloading of its own run beside it; moving forces have none, and say so.
TEST(Assessment, DeckVerdictsHaveTheUnloadingOfTheirRun) {
  Assessment a;
  a.facts = {"ballasted", 200.0 / 3.6};
  a.clauses = library_clauses();
  const auto add = [&](const char* measure, AssessmentStage stage, double value, const char* run) {
    MeasuredValue v;
    v.measure = measure;
    v.stage = stage;
    v.value = value;
    v.where = std::string("place of ") + measure;
    v.run = run;
    a.values.push_back(v);
  };
  add("deck_acceleration", AssessmentStage::moving_load, 3.0, "");
  add("deck_acceleration", AssessmentStage::contact, 2.0, "slow");
  add("deck_acceleration", AssessmentStage::contact, 2.5, "fast");
  add("deck_twist", AssessmentStage::contact, 1e-3, "slow");
  add("horizontal_rotation", AssessmentStage::contact, 1e-3, "bare");
  add("wheel_unloading", AssessmentStage::contact, 0.55, "slow");
  add("wheel_unloading", AssessmentStage::contact, 0.3, "fast");
  add("wheel_unloading", AssessmentStage::contact, 0.35, "fast");
  a.verdicts = judge(a.clauses, a.facts, a.values, {});
  const auto beside = [&](std::string_view id, AssessmentStage stage) {
    for (const Verdict& v : a.verdicts) {
      if (v.clause->id == id && v.stage == stage) return unloading_beside(a, v);
    }
    throw std::runtime_error("no verdict");
  };
  const auto fast = beside("en1990.deck-acceleration.ballasted", AssessmentStage::contact);
  EXPECT_EQ(fast->value->value, 0.35) << "not 0.55 of another run";
  EXPECT_EQ(beside("en1990.twist.200", AssessmentStage::contact)->value->value, 0.55);
  EXPECT_EQ(beside("en1990.deck-acceleration.ballasted", AssessmentStage::moving_load)->reason,
            "moving forces have no wheels");
  EXPECT_EQ(beside("en1990.horizontal-rotation.200", AssessmentStage::contact)->reason, "the run has none");
  EXPECT_FALSE(beside("en14363.unloading", AssessmentStage::contact)) << "no verdict on a deck";
  const std::string text = assessment_text(a), page = assessment_page(a);
  EXPECT_NE(text.find("wheel unloading ΔQ/Q0 of the run: 0.350, place of wheel_unloading\n"), std::string::npos)
      << text;
  EXPECT_NE(text.find("wheel unloading ΔQ/Q0 of the run: none: moving forces have no wheels"), std::string::npos);
  EXPECT_NE(page.find("<td><b>0.350</b><br>"), std::string::npos);
  EXPECT_NE(page.find("<small>none: moving forces have no wheels</small>"), std::string::npos);
  int decks = 0, with_value = 0;
  const auto json = assessment_json(a);
  for (const auto& verdict : json["verdicts"]) {
    if (!verdict.contains("value") || !verdict["id"].get<std::string>().starts_with("en1990")) continue;
    ++decks;
    with_value += verdict["wheel_unloading"].contains("value");
    EXPECT_NE(verdict["wheel_unloading"].contains("value"), verdict["wheel_unloading"].contains("reason"));
  }
  EXPECT_EQ(decks, 4);
  EXPECT_EQ(with_value, 2);
}

}  // namespace
}  // namespace railtab::assess
