// Clauses as data, and verdicts by them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "../folder_fixture.hpp"
#include "railtab/runtime/assessment/verdict.hpp"
#include "railtab/runtime/base/input_error.hpp"

namespace railtab {
namespace {

using enum AssessmentStage;

const std::string own_clause =
    "edition = \"NA to test\"\n[[clause]]\nid = \"own\"\nclause = \"1\"\ntitle = \"own limit\"\nmeasure = "
    "\"track_shift_2m\"\nunit = \"N\"\nlimit_by = { of = \"axle_load\", factor = 0.5, constant = 1e3, at_most = 30e3 "
    "}\n";

MeasuredValue value(std::string measure, AssessmentStage stage, double amount, double span = 25.0) {
  MeasuredValue v;
  v.measure = std::move(measure);
  v.stage = stage;
  v.value = amount;
  v.where = "here";
  v.quantities = {{"span", span}, {"axle_load", 40e3}};
  return v;
}

const Verdict& of(const std::vector<Verdict>& verdicts, std::string_view id) {
  const auto found =
      std::find_if(verdicts.begin(), verdicts.end(), [&](const Verdict& v) { return v.clause->id == id; });
  if (found == verdicts.end()) throw std::runtime_error("no verdict");
  return *found;
}

class Clauses : public testing::InFolder {
 protected:
  [[nodiscard]] std::string message_of(const std::string& text) const {
    write("own.toml", text);
    try {
      static_cast<void>(clauses_with({folder_ / "own.toml"}));
    } catch (const InputError& wrong) {
      return wrong.what();
    }
    return "no error";
  }
};

TEST_F(Clauses, OfTheLibraryAreWellFormed) {
  const std::vector<Clause> clauses = library_clauses();
  EXPECT_GE(clauses.size(), 50U);
  std::set<std::string> ids;
  for (const Clause& clause : clauses) {
    EXPECT_TRUE(ids.insert(clause.id).second) << clause.id;
    EXPECT_FALSE(clause.source.empty()) << clause.id;
    const auto says = [&](std::string_view words) { return clause.source.find(words) != std::string::npos; };
    EXPECT_FALSE(clause.read_in != ReadIn::nothing && says("not checked")) << clause.id;
    EXPECT_FALSE(clause.verified() && says("program")) << clause.id << ": a program is no standard";
  }
}

TEST_F(Clauses, OfAUsersFileAreAddedOrReplaceThoseOfTheSameId) {
  write("own.toml", own_clause +
                        "[[clause]]\nid = \"en1990.deck-acceleration.ballasted\"\nclause = \"NA.1\"\ntitle = "
                        "\"t\"\nmeasure = \"deck_acceleration\"\nunit = \"m/s2\"\nlimit = 7.0\n");
  const std::vector<Clause> clauses = clauses_with({folder_ / "own.toml"});
  EXPECT_EQ(clauses.size(), library_clauses().size() + 1);
  const auto replaced = std::find_if(clauses.begin(), clauses.end(),
                                     [](const Clause& c) { return c.id == "en1990.deck-acceleration.ballasted"; });
  EXPECT_EQ(replaced->limit.constant, 7.0);
  EXPECT_EQ(replaced->edition, "NA to test");
  EXPECT_EQ(replaced->read_in, ReadIn::nothing);
  EXPECT_TRUE(replaced->track.empty()) << "the whole clause is replaced";
}

TEST_F(Clauses, WrongFilesAreRejectedWithTheirLine) {
  EXPECT_NE(message_of("edition = \"x\"\n[[clause]]\nid = \"a\"\nclause = \"1\"\ntitle = \"t\"\nmeasure = \"deck\"\n")
                .find("own.toml:6: clause[1].measure: found the text \"deck\", expected one of first_frequency"),
            std::string::npos);
  std::string wrong_unit = own_clause;
  wrong_unit.replace(wrong_unit.find("\"N\""), 3, "\"kN\"");
  EXPECT_NE(message_of(wrong_unit).find("clause[1].unit: found the text \"kN\", expected one of N"), std::string::npos);
  EXPECT_NE(message_of(own_clause + "limit = 3\n").find("found limit and limit_by"), std::string::npos);
  EXPECT_NE(message_of(own_clause + "read_in = \"standard\"\n").find("expected a text: where the limit was read"),
            std::string::npos);
  EXPECT_NE(message_of(own_clause + "read_in = \"a book\"\n")
                .find("clause[1].read_in: found the text \"a book\", expected one of standard, secondary source"),
            std::string::npos);
  EXPECT_NE(
      message_of(own_clause + "standing = \"verified\"\n")
          .find("clause[1].standing: found \"verified\", expected read_in = \"standard\" or \"secondary source\""),
      std::string::npos);
  EXPECT_NE(message_of(own_clause + "limits = 3\n").find("unknown key 'clause[1].limits'; did you mean"),
            std::string::npos);
  EXPECT_NE(message_of("edition = \"x\"\n").find("expected at least one [[clause]]"), std::string::npos);
  EXPECT_NE(message_of("edition = \n").find("own.toml:1"), std::string::npos);
}

TEST_F(Clauses, LimitsMayBeZeroOrBelow) {
  const auto met = [&](const std::string& limit, double amount) {
    write("own.toml",
          "edition = \"x\"\n[[clause]]\nid = \"own\"\nclause = \"1\"\ntitle = \"t\"\nmeasure = "
          "\"deck_acceleration\"\nunit = \"m/s2\"\n" +
              limit);
    const std::vector<Clause> clauses = clauses_with({folder_ / "own.toml"});
    const std::vector<Verdict> verdicts =
        judge(clauses, {"ballasted", 50.0}, {value("deck_acceleration", moving_load, amount)}, {});
    const Verdict& own = of(verdicts, "own");
    EXPECT_EQ(own.outcome == Outcome::pass, own.utilisation() <= 1.0) << limit << ": " << amount;
    return own.outcome == Outcome::pass;
  };
  const std::string least = "sense = \"at least\"\n";
  EXPECT_TRUE(met("limit = -1.0\n", -2.0));
  EXPECT_FALSE(met("limit = -1.0\n", -0.5));
  EXPECT_TRUE(met("limit = 0.0\n", 0.0));
  EXPECT_FALSE(met("limit = 0.0\n", 0.1));
  EXPECT_TRUE(met("limit = -1.0\n" + least, -0.5));
  EXPECT_FALSE(met("limit = -1.0\n" + least, -2.0));
  EXPECT_TRUE(met("limit = 0.0\n" + least, 0.0));
  EXPECT_FALSE(met("limit = 0.0\n" + least, -0.1));
}

TEST_F(Clauses, TheWorstValueDecides) {
  const std::vector<Clause> clauses = library_clauses();
  const AssessmentFacts facts{"ballasted", 200.0 / 3.6};
  const std::vector<Verdict> verdicts =
      judge(clauses, facts,
            {value("deck_acceleration", moving_load, 3.0), value("deck_acceleration", moving_load, 3.6),
             value("deck_acceleration", contact, 1.0), value("first_frequency", check, 3.0, 25.0),
             value("lateral_frequency", check, 1.1), value("car_body_vertical", contact, 1.2)},
            {});
  const Verdict& deck = of(verdicts, "en1990.deck-acceleration.ballasted");
  EXPECT_EQ(deck.outcome, Outcome::fail);
  EXPECT_TRUE(deck.failed());
  EXPECT_NEAR(deck.at->value, 3.6, 0.0);
  EXPECT_NEAR(deck.utilisation(), 3.6 / 3.5, 1e-12);
  EXPECT_EQ(std::count_if(verdicts.begin(), verdicts.end(),
                          [&](const Verdict& v) { return v.clause == deck.clause && v.outcome == Outcome::pass; }),
            1)
      << "the contact stage's own verdict";
  EXPECT_EQ(of(verdicts, "en1990.deck-acceleration.direct").outcome, Outcome::not_applicable);
  EXPECT_EQ(of(verdicts, "en1990.twist.200").outcome, Outcome::not_judged);
  EXPECT_EQ(of(verdicts, "en1990.twist.200").reason, "needs stage contact");
  EXPECT_EQ(of(verdicts, "en1990.twist.above-200").outcome, Outcome::not_applicable) << "200 km/h is not above 200";
  const Verdict& n0 = of(verdicts, "en1991.n0.lower.100");
  EXPECT_NEAR(n0.limit, 23.58 * std::pow(25.0, -0.592), 1e-12);
  EXPECT_EQ(n0.outcome, Outcome::fail);
  EXPECT_FALSE(n0.failed()) << "it has a consequence";
  EXPECT_EQ(of(verdicts, "en1991.n0.lower.20").outcome, Outcome::not_applicable);
  EXPECT_EQ(of(verdicts, "en1991.n0.upper").outcome, Outcome::pass);
  EXPECT_EQ(of(verdicts, "en1990.lateral-frequency").outcome, Outcome::fail) << "at least 1.2 Hz";
  EXPECT_EQ(of(verdicts, "en1990.comfort.acceptable").outcome, Outcome::pass);
}

TEST_F(Clauses, WhatIsNotKnownOrNoNumberIsNotJudged) {
  const std::vector<Clause> clauses = library_clauses();
  const AssessmentFacts facts{"ballasted", 200.0 / 3.6};
  MeasuredValue imported = value("first_frequency", check, 3.0);
  imported.quantities.erase("span");
  const auto judged = [&](const std::vector<MeasuredValue>& values, std::string_view id) {
    return of(judge(clauses, facts, values, {}), id);
  };
  const Verdict unknown = judged({imported}, "en1991.n0.upper");
  EXPECT_EQ(unknown.outcome, Outcome::not_judged);
  EXPECT_EQ(unknown.reason, "the span of here is not known");
  EXPECT_EQ(judged({imported, value("first_frequency", check, 4.0, 25.0)}, "en1991.n0.upper").outcome,
            Outcome::not_judged)
      << "one deck of two";
  const Verdict none =
      judged({value("deck_acceleration", contact, std::nan("")), value("deck_acceleration", contact, 1.0)},
             "en1990.deck-acceleration.ballasted");
  EXPECT_EQ(none.outcome, Outcome::not_judged);
  EXPECT_EQ(none.reason, "the value of here is not a number");
}

TEST_F(Clauses, LimitsFollowTheQuantitiesOfTheValue) {
  write("own.toml", own_clause);
  const std::vector<Clause> clauses = clauses_with({folder_ / "own.toml"});
  MeasuredValue light = value("track_shift_2m", contact, 20e3), heavy = light;
  heavy.quantities["axle_load"] = 100e3;
  heavy.value = 29e3;
  const std::vector<Verdict> verdicts = judge(clauses, {}, {heavy, light}, {});
  const Verdict& own = of(verdicts, "own");
  EXPECT_NEAR(own.limit, 30e3, 1e-9) << "29 of 30 kN, the most, is nearer than 20 of 21 kN";
  MeasuredValue percentile = light;
  percentile.measure = "track_shift_percentile";
  const std::vector<Verdict> en14363 = judge(clauses, {}, {percentile}, {});
  EXPECT_NEAR(of(en14363, "en14363.track-shift").limit, 10e3 + 40e3 / 3.0, 0.1);
}

TEST_F(Clauses, OfOtherRulesApplyWhereTheSceneAsksForThem) {
  const std::vector<Clause> clauses = library_clauses();
  MeasuredValue unloading = value("wheel_unloading", contact, 0.7), climb = value("derailment_5ft", contact, 0.9),
                shift = value("track_shift_5ft", contact, 30e3);
  climb.quantities["fra_limit"] = 0.95;
  const std::vector<MeasuredValue> values{unloading, climb, shift};
  const std::vector<Verdict> europe = judge(clauses, {}, values, {});
  EXPECT_EQ(of(europe, "en14363.unloading").outcome, Outcome::fail);
  EXPECT_EQ(of(europe, "japan.unloading").outcome, Outcome::not_applicable);
  EXPECT_EQ(of(europe, "japan.unloading").reason, "of the rules \"Japan\"; assessment.rules has Europe");
  const std::vector<Verdict> others = judge(clauses, {"ballasted", 50.0, {"Japan", "USA", "China"}}, values, {});
  EXPECT_EQ(of(others, "en14363.unloading").outcome, Outcome::not_applicable);
  EXPECT_EQ(of(others, "japan.unloading").outcome, Outcome::pass) << "0.7 of 0.8";
  EXPECT_EQ(of(others, "china.unloading").outcome, Outcome::fail) << "0.7 of 0.6";
  EXPECT_EQ(of(others, "usa.single-wheel").outcome, Outcome::pass) << "0.9 of 0.95";
  EXPECT_EQ(of(others, "usa.net-axle").outcome, Outcome::pass);
  EXPECT_NEAR(of(others, "usa.net-axle").limit, 0.4 * 40e3 + 5e3 * 4.4482216, 1.0) << "5 kips of 4.448 kN";
  EXPECT_EQ(of(others, "nadal").outcome, Outcome::not_judged) << "of no rules: always";
}

TEST_F(Clauses, OfEn1990AndEn14363Added) {
  const std::vector<Clause> clauses = library_clauses();
  const std::vector<Verdict> verdicts =
      judge(clauses, {"ballasted", 40.0},
            {value("deck_twist", contact, 1e-3), value("car_body_vertical", contact, 1.1),
             value("car_body_lateral_6hz", contact, 3.1)},
            {});
  EXPECT_EQ(of(verdicts, "en1990.twist.total").outcome, Outcome::not_judged) << "the deck's twist alone is not it";
  EXPECT_EQ(of(verdicts, "en1990.twist.total").clause->read_in, ReadIn::standard);
  EXPECT_EQ(of(verdicts, "en1990.comfort.good").clause->read_in, ReadIn::secondary_source);
  EXPECT_EQ(of(verdicts, "en1990.comfort.very-good").outcome, Outcome::fail);
  EXPECT_EQ(of(verdicts, "en1990.comfort.good").outcome, Outcome::pass);
  EXPECT_TRUE(of(verdicts, "en14363.car-body.lateral").failed());
}

TEST_F(Clauses, AValueOfAPartFailsOrIsNotJudged) {
  const std::vector<Clause> clauses = library_clauses();
  const MissingMeasure part{"derailment_percentile", contact, "one of two runs ended early", true};
  EXPECT_EQ(
      of(judge(clauses, {}, {value("derailment_percentile", contact, 0.9)}, {part}), "en14363.derailment").outcome,
      Outcome::fail);
  const std::vector<Verdict> partial = judge(clauses, {}, {value("derailment_percentile", contact, 0.4)}, {part});
  EXPECT_EQ(of(partial, "en14363.derailment").outcome, Outcome::not_judged);
  EXPECT_EQ(of(partial, "en14363.derailment").reason, part.reason);
  const MissingMeasure none{"derailment_percentile", contact, "rigid contact", false};
  EXPECT_EQ(of(judge(clauses, {}, {}, {none}), "en14363.derailment").reason, "contact: rigid contact");
}

}  // namespace
}  // namespace railtab
