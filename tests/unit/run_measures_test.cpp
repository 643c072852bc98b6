// Measures of a run from its records, which are made by hand: every value follows from them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "assessment.hpp"
#include "assessment_page.hpp"
#include "railtab/runtime/measures/comfort.hpp"
#include "railtab/runtime/measures/low_pass.hpp"
#include "railtab/runtime/measures/weighting.hpp"
#include "run_measures.hpp"

namespace railtab::assess {
namespace {

constexpr double pi = std::numbers::pi, speed = 50.0, step = 1e-3, Q0 = 50e3;

/// One wheelset at 50 m/s for 8 s under a coach, a deck node; slow motions, which filters leave alone.
RunResults made_run() {
  RunResults results;
  results.header.speed = speed;
  results.header.wheel_x = {0.0, 0.0};
  results.header.static_wheel_load = {Q0, Q0};
  results.header.body_names = {"coach-1/car-body"};
  results.header.node_names = {"deck-midspan-1", "rail-left-midspan-1"};
  results.header.node_x = {12.5, 12.5};
  for (int i = -45; i <= 40; ++i) {  // the flange's back at 80°, its tip at y = −40 mm, a flank of 70°, a flat tread
    results.header.wheel_y.push_back(1e-3 * i);
    const double flank = 20.0 * std::tan(70.0 * pi / 180.0), back = (i + 40) * std::tan(80.0 * pi / 180.0);
    results.header.wheel_z.push_back(1e-3 * (i < -40 ? flank + back : i < -20 ? -(i + 20) * flank / 20.0 : 0.0));
  }
  for (int k = 0; k <= 8000; ++k) {
    const double t = step * k;
    StepRecord r;
    r.time = t;
    r.position = speed * t - 100.0;
    r.wheels.resize(2);
    r.wheels[0].Q = Q0 * (1.0 - 0.3 * std::sin(2.0 * pi * 0.5 * t));
    r.wheels[1].Q = Q0;
    r.wheels[0].Y = 10e3;
    r.wheels[1].Y = -2e3;
    r.wheels[0].wear_number = 40.0 + 20.0 * (r.position > 20.0 && r.position < 30.5);
    r.wheels[1].wear_number = 10.0;
    r.wheels[1].pressure = 9e8 + 1e6 * t;
    r.bodies.resize(1);
    r.bodies[0].acceleration[1] = 0.1 * std::sin(2.0 * pi * 2.0 * t);
    r.bodies[0].acceleration[2] = 0.2 * std::sin(2.0 * pi * 5.0 * t);
    r.nodes.resize(2);
    r.nodes[0].acceleration[2] = std::sin(2.0 * pi * 4.0 * t) + 3.0 * std::sin(2.0 * pi * 120.0 * t);
    r.nodes[0].displacement[2] = 2e-3;
    r.nodes[1].acceleration[2] = 50.0;
    results.steps.push_back(r);
  }
  results.summary.complete = true;
  return results;
}

const MeasuredValue& of(const RunMeasures& found, std::string_view measure) {
  for (const MeasuredValue& value : found.values) {
    if (value.measure == measure) return value;
  }
  throw std::runtime_error("no " + std::string(measure));
}

TEST(RunMeasures, OfARunMadeByHand) {
  const RunMeasures found = run_measures(made_run(), {-100.0, 30.0, 20.0, 0.3});
  EXPECT_NEAR(of(found, "deck_acceleration").value, 1.0, 2e-3) << "120 Hz are gone";
  EXPECT_NEAR(of(found, "deck_acceleration_unfiltered").value, 4.0, 0.05);
  EXPECT_NEAR(of(found, "deck_displacement").value, 2e-3, 1e-12);
  EXPECT_NEAR(of(found, "wheel_unloading").value, 0.3, 1e-6);
  EXPECT_EQ(of(found, "wheel_unloading").where, "wheelset 1 left");
  EXPECT_NEAR(*of(found, "wheel_unloading").time, std::round(*of(found, "wheel_unloading").time * 2.0) / 2.0, 1e-2)
      << "at 0.5 s and every 2 s after";
  EXPECT_EQ(of(found, "unloading_duration").value, 0.0);
  EXPECT_NEAR(of(found, "wheel_force").value, 1.3 * Q0, 1.0);
  EXPECT_NEAR(of(found, "wheel_force").quantities.at("static_wheel_load"), Q0, 1e-9);
  EXPECT_NEAR(of(found, "derailment").value, 0.2 / 0.7, 1e-6);
  EXPECT_NEAR(of(found, "wear_number").value, 40.0 + 20.0 * 10.5 / 400.0, 5e-3) << "over 400 m";
  EXPECT_EQ(of(found, "wear_number").where, "wheelset 1 left");
  EXPECT_NEAR(of(found, "rail_wear").value, 60.0, 1e-9) << "a metre from 21 m to 30 m";
  EXPECT_EQ(of(found, "rail_wear").where, "left rail");
  EXPECT_GE(*of(found, "rail_wear").x, 21.0);
  EXPECT_LE(*of(found, "rail_wear").x, 29.0);
  EXPECT_NEAR(of(found, "contact_pressure").value, 9.08e8, 1.0);
  EXPECT_NEAR(of(found, "derailment_2m").value, 0.2 / 0.7, 1e-3) << "2 m are 40 ms of 2 s";
  EXPECT_NEAR(of(found, "weinstock_sum").value, 0.2 / 0.7 + 0.04, 1e-6);
  EXPECT_NEAR(of(found, "track_shift_2m").value, 8e3, 1e-6);
  EXPECT_NEAR(of(found, "track_shift_2m").quantities.at("axle_load"), 2.0 * Q0, 1e-9);
  const double tangent = std::tan(70.0 * pi / 180.0);
  EXPECT_NEAR(of(found, "derailment").quantities.at("nadal_limit"), (tangent - 0.3) / (1.0 + 0.3 * tangent), 1e-6);
  EXPECT_NEAR(of(found, "car_body_vertical").value, 0.2, 1e-6);
  EXPECT_NEAR(of(found, "comfort_vertical").value, 0.2 / std::numbers::sqrt2 * 0.958, 2e-3) << "W_b at 5 Hz";
  EXPECT_NEAR(of(found, "running_rms_vertical").value, 0.2 / std::numbers::sqrt2 * 1.039, 4e-3) << "W_k at 5 Hz";
  EXPECT_NEAR(of(found, "vibration_dose_vertical").value, std::pow(0.375 * 8.0, 0.25) * 0.2 * 1.039, 2e-3);
  EXPECT_NEAR(of(found, "sperling_vertical").value,
              std::pow(20.0 * sperling_weighting(SperlingDirection::vertical, 5.0), 0.3), 1e-6);
  EXPECT_NEAR(of(found, "car_body_vertical_6hz").value, 0.2 * low_pass_gain(5.0, 6.0), 1e-4);
  EXPECT_NEAR(of(found, "car_body_lateral").value, 0.1, 1e-6);
  EXPECT_NEAR(of(found, "car_body_lateral_6hz").value, 0.1 * low_pass_gain(2.0, 6.0), 2e-3)
      << "beyond its ends a series counts as constant";
  EXPECT_NEAR(of(found, "comfort_lateral").value, 0.1 / std::numbers::sqrt2 * 0.891, 1e-3) << "W_d at 2 Hz";
  EXPECT_NEAR(of(found, "vibration_dose_lateral").value, std::pow(0.375 * 8.0, 0.25) * 0.1 * 0.891, 1e-3);
  EXPECT_NEAR(of(found, "sperling_lateral").value,
              std::pow(10.0 * sperling_weighting(SperlingDirection::lateral, 2.0), 0.3), 1e-6);
  EXPECT_NEAR(of(found, "derailment_5ft").value, 0.2 / 0.7, 1e-3);
  EXPECT_NEAR(of(found, "derailment_5ft").quantities.at("fra_limit"), (tangent - 0.5) / (1.0 + 0.5 * tangent), 1e-6);
  EXPECT_NEAR(of(found, "track_shift_5ft").value, 8e3, 1e-6);
  EXPECT_NEAR(of(found, "wheel_unloading_5ft").value, 0.3, 1e-3);
  EXPECT_EQ(std::ranges::count(found.missing, "the run has no envelope of the deck (output.deck_envelope)",
                               &MissingMeasure::reason),
            6);
  const auto reason = [&](std::string_view measure) {
    return std::ranges::find(found.missing, measure, &MissingMeasure::measure)->reason;
  };
  // once the weighting has settled
  const RunMeasures settled = run_measures(made_run(), {0.0, 30.0, 20.0, 0.3});
  EXPECT_NEAR(of(settled, "running_rms_lateral").value, 0.1 / std::numbers::sqrt2 * 0.891, 2e-4);
  EXPECT_EQ(found.missing.size(), 10U);
  EXPECT_EQ(reason("comfort_longitudinal"), "car bodies have no longitudinal acceleration, or none for as long as 5 s");
  for (const char* mean : {"mean_comfort", "mean_comfort_seated", "mean_comfort_standing"}) {
    EXPECT_EQ(reason(mean), "no car body is judged for as long as 5 minutes, 60 windows of 5 s") << mean;
  }
}

// Load that rises along the track: percentiles of sections of 100 m, at every 0.5 m.
TEST(RunMeasures, PercentilesOfSections) {
  RunResults results = made_run();
  for (StepRecord& r : results.steps) r.wheels[0].Q = Q0 * (1.0 + 1e-3 * (r.position + 100.0));
  RunWindow window{-50.0, 30.0, 20.0, 0.3};
  window.section_length = 100.0;
  const RunMeasures found = run_measures(results, window);
  constexpr double place = 0.9985 * 199.0;  // of 200 values
  EXPECT_NEAR(of(found, "wheel_force_percentile").value, Q0 * (1.0 + 1e-3 * (250.0 + 0.5 * place)), 1e-6 * Q0);
  EXPECT_EQ(of(found, "wheel_force_percentile").where, "wheelset 1 left, x = 150 to 250 m")
      << "the last section, to 350 m, is not full";
  EXPECT_NEAR(of(found, "wheel_force").value, 1.4 * Q0, 2e-3 * Q0) << "at the end of the run";
  EXPECT_NEAR(of(found, "guiding_force_percentile").value, 10e3, 1e-6);
  EXPECT_NEAR(of(found, "track_shift_percentile").value, 8e3, 1e-6);
  EXPECT_NEAR(of(found, "track_shift_percentile").quantities.at("axle_load"), 2.0 * Q0, 1e-9);
  // Y/Q falls: its 99.85 % lies between the means over 2 m that begin at −50 and −49.5 m
  const auto mean = [](double s) { return 0.2 * 500.0 * std::log((1.0 + 1e-3 * (s + 2.0)) / (1.0 + 1e-3 * s)); };
  const double expected = mean(50.5) + (place - 198.0) * (mean(50.0) - mean(50.5));
  EXPECT_NEAR(of(found, "derailment_percentile").value, expected, 1e-7);
  EXPECT_GT(mean(50.0) - expected, 1e-5);
  window.end = 160.0;
  const RunMeasures ended = run_measures(results, window);
  EXPECT_EQ(of(ended, "wheel_force_percentile").where, "wheelset 1 left, x = 50 to 150 m");
  EXPECT_NEAR(of(ended, "wheel_force").value, Q0 * 1.26, 1e-4 * Q0);
  window.section_length = 500.0;
  const RunMeasures none = run_measures(results, window);
  EXPECT_EQ(std::ranges::find(none.missing, "wheel_force_percentile", &MissingMeasure::measure)->reason,
            "no wheel is judged over as long a way as a section of 500 m");
  window.section_length = 0.0;
  EXPECT_EQ(of(run_measures(results, window), "wheel_force_percentile").where, "wheelset 1 left, x = -50 to 160 m");
}

TEST(RunMeasures, UnloadingDurationOfASine) {
  RunResults results = made_run();
  for (StepRecord& r : results.steps) r.wheels[0].Q = Q0 * (1.0 - 0.8 * std::sin(2.0 * pi * 0.5 * r.time));
  const RunMeasures found = run_measures(results, {-100.0, 30.0, 20.0, 0.3});
  EXPECT_NEAR(of(found, "unloading_duration").value, (pi - 2.0 * std::asin(0.75)) / pi, 1e-6) << "above 0.6";
  EXPECT_EQ(of(found, "unloading_duration").where, "wheelset 1 left");
}

// Above the limit longest from t = 1 to 1.5 s, and most at 4 s: each has its own time and place.
TEST(RunMeasures, UnloadingDurationHasThePlaceOfTheLongestInterval) {
  RunResults results = made_run();
  for (StepRecord& r : results.steps) {
    const bool longest = r.time > 0.9995 && r.time<1.4995, most = r.time> 3.9995 && r.time < 4.0995;
    r.wheels[0].Q = Q0 * (longest ? 0.35 : most ? 0.0 : 1.0);
  }
  const RunMeasures found = run_measures(results, {-100.0, 30.0, 20.0, 0.3});
  const MeasuredValue &duration = of(found, "unloading_duration"), &largest = of(found, "wheel_unloading_unfiltered");
  EXPECT_NEAR(duration.value, 0.5, 2e-3);
  EXPECT_NEAR(*duration.time, 1.0, 2e-3);
  EXPECT_NEAR(*duration.x, -100.0 + speed * *duration.time, 1e-9);
  EXPECT_NEAR(*largest.time, 4.0, 1e-9);
}

/// A second wheelset, whose left wheel climbs.
RunResults with_second_wheelset() {
  RunResults results = made_run();
  results.header.wheel_x = {0.0, 0.0, -2.5, -2.5};
  results.header.static_wheel_load.assign(4, Q0);
  for (StepRecord& r : results.steps) {
    r.wheels.resize(4);
    r.wheels[2] = {.Q = Q0, .Y = 0.7 * Q0};
    r.wheels[3] = {.Q = Q0};
  }
  return results;
}

Verdict verdict_of(const std::vector<Clause>& clauses, const RunMeasures& found, std::string_view id) {
  const std::vector<Verdict> verdicts = judge(clauses, {"ballasted", 250.0 / 3.6}, found.values, found.missing);
  return *std::ranges::find_if(verdicts, [&](const Verdict& v) { return v.clause->id == id; });
}

// Loads that differ by rounding have one limit, and one row.
TEST(RunMeasures, LoadsThatDifferByRoundingAreOne) {
  RunResults results = with_second_wheelset();
  const auto rows = [&](double other_load) {
    results.header.static_wheel_load[2] = results.header.static_wheel_load[3] = other_load;
    const RunMeasures found = run_measures(results, {-100.0, 30.0, 20.0, 0.3});
    return std::ranges::count(found.values, "wheel_force", &MeasuredValue::measure);
  };
  EXPECT_EQ(rows(Q0 * (1.0 + 1e-13)), 1);
  EXPECT_EQ(rows(Q0 * (1.0 + 1e-6)), 2);
}

// Limits of the flange are those of wheels whose profile the results hold.
TEST(RunMeasures, OtherProfilesAreNotJudgedByTheFlangeOfTheFirst) {
  RunResults results = with_second_wheelset();
  const std::vector<Clause> clauses = library_clauses();
  const RunWindow window{-100.0, 30.0, 20.0, 0.3};
  EXPECT_EQ(verdict_of(clauses, run_measures(results, window), "nadal").outcome, Outcome::pass);
  results.header.wheel_outline = {1.0, 1.0, 0.0, 0.0};
  const RunMeasures mixed = run_measures(results, window);
  ASSERT_EQ(std::ranges::count(mixed.values, "derailment", &MeasuredValue::measure), 2);
  for (const MeasuredValue& value : mixed.values) {
    if (value.measure != "derailment") continue;
    const bool first = value.where == "wheelset 1 left";
    EXPECT_NEAR(value.value, first ? 0.2 / 0.7 : 0.7, 1e-6) << value.where;
    EXPECT_EQ(value.quantities.contains("nadal_limit"), first) << value.where;
  }
  EXPECT_EQ(std::ranges::count(mixed.values, "wheel_unloading", &MeasuredValue::measure), 1);
  const Verdict nadal = verdict_of(clauses, mixed, "nadal");
  EXPECT_EQ(nadal.outcome, Outcome::not_judged);
  EXPECT_EQ(nadal.reason,
            "nadal_limit of wheelset 2 left is not known: the results hold the profile of other wheels alone");
  EXPECT_EQ(verdict_of(clauses, mixed, "weinstock").outcome, Outcome::not_judged);
  for (StepRecord& r : results.steps) r.wheels[0].Y = 3.0 * Q0;
  EXPECT_EQ(verdict_of(clauses, run_measures(results, window), "nadal").outcome, Outcome::fail) << "the first one does";
}

TEST(RunMeasures, AConeHasNoFlange) {
  RunResults results = made_run();
  for (std::size_t i = 0; i < results.header.wheel_y.size(); ++i) {
    results.header.wheel_z[i] = -results.header.wheel_y[i] / 20.0;
  }
  const std::vector<Clause> clauses = library_clauses();
  const RunMeasures found = run_measures(results, {-100.0, 30.0, 20.0, 0.3});
  const Verdict nadal = verdict_of(clauses, found, "nadal");
  EXPECT_EQ(nadal.outcome, Outcome::not_judged);
  EXPECT_NE(nadal.reason.find("nowhere steeper than 2.9 degrees"), std::string::npos) << nadal.reason;
}

// Accelerations of car bodies without a lateral one.
TEST(RunMeasures, CarBodiesThatDoNotMoveLaterallyHaveNoLateralMeasures) {
  RunResults results = made_run();
  for (StepRecord& r : results.steps) r.bodies[0].acceleration[1] = 0.0;
  const RunMeasures found = run_measures(results, {-100.0, 30.0, 20.0, 0.3});
  for (const char* measure : {"car_body_lateral", "car_body_lateral_6hz", "comfort_lateral", "running_rms_lateral",
                              "vibration_dose_lateral", "sperling_lateral"}) {
    EXPECT_EQ(std::ranges::count(found.values, measure, &MeasuredValue::measure), 0) << measure;
    const auto missing = std::ranges::find(found.missing, measure, &MissingMeasure::measure);
    ASSERT_NE(missing, found.missing.end()) << measure;
    EXPECT_NE(missing->reason.find("none moves laterally"), std::string::npos) << missing->reason;
  }
  EXPECT_NEAR(of(found, "car_body_vertical").value, 0.2, 1e-6);
}

/// Every n-th record.
RunResults thinned(int n) {
  RunResults results = made_run();
  std::vector<StepRecord> some;
  for (std::size_t k = 0; k < results.steps.size(); k += static_cast<std::size_t>(n)) some.push_back(results.steps[k]);
  results.steps = some;
  return results;
}

TEST(RunMeasures, WeightedMeasuresNeedNearRecords) {
  const RunWindow window{-100.0, 30.0, 20.0, 0.3};
  const double weighted = 0.2 / std::numbers::sqrt2 * std::abs(weighting_b.response(5.0));
  EXPECT_NEAR(of(run_measures(thinned(2), window), "comfort_vertical").value, weighted, 0.01 * weighted);
  const RunMeasures far = run_measures(thinned(10), window);
  for (const char* measure : {"comfort_vertical", "comfort_lateral", "comfort_longitudinal", "mean_comfort",
                              "mean_comfort_seated", "mean_comfort_standing", "running_rms_vertical",
                              "running_rms_lateral", "vibration_dose_vertical", "vibration_dose_lateral"}) {
    EXPECT_EQ(std::ranges::count(far.values, measure, &MeasuredValue::measure), 0) << measure;
    const auto missing = std::ranges::find(far.missing, measure, &MissingMeasure::measure);
    ASSERT_NE(missing, far.missing.end()) << measure;
    EXPECT_EQ(missing->reason, "records 0.01 s apart are too far for the frequency weighting, at most 0.002 s");
  }
  EXPECT_NEAR(of(far, "sperling_vertical").value,
              std::pow(20.0 * sperling_weighting(SperlingDirection::vertical, 5.0), 0.3), 1e-6);
  EXPECT_NEAR(of(far, "car_body_vertical").value, 0.2, 1e-6);
  EXPECT_GT(of(far, "car_body_vertical_6hz").value, 0.1);
}

// Mean comfort takes five minutes, and all three directions. After 200 s, 40 of the 60 windows, motions are larger.
TEST(RunMeasures, MeanComfortOfFiveMinutes) {
  constexpr double coarse = 2e-3, later = 3.0;
  RunResults results = made_run();
  results.header.node_names.clear();
  results.header.static_wheel_load.clear();
  results.header.wheel_x.clear();
  results.steps.clear();
  for (int k = 0; k <= 151000; ++k) {
    StepRecord& r = results.steps.emplace_back();
    r.time = coarse * k;
    r.position = 0.1 * r.time;
    r.bodies.resize(1);
    const double factor = k < 100000 ? 1.0 : later;
    r.bodies[0].acceleration[0] = factor * 0.05 * std::sin(2.0 * pi * 4.0 * r.time);
    r.bodies[0].acceleration[1] = factor * 0.1 * std::sin(2.0 * pi * 2.0 * r.time);
    r.bodies[0].acceleration[2] = factor * 0.2 * std::sin(2.0 * pi * 5.0 * r.time);
  }
  const RunMeasures found = run_measures(results, {});
  const auto rms = [](double amplitude, const Weighting& weighting, double f) {
    return amplitude / std::numbers::sqrt2 * std::abs(weighting.response(f));
  };
  const double x = rms(0.05, weighting_d, 4.0), y = rms(0.1, weighting_d, 2.0), z = rms(0.2, weighting_b, 5.0);
  const double back = rms(0.05, weighting_c, 4.0);
  const auto expect = [&](const char* measure, double expected) {
    EXPECT_NEAR(of(found, measure).value, expected, 2e-3 * expected) << measure;
    EXPECT_EQ(of(found, measure).where, "coach-1");
  };
  expect("mean_comfort", later * 6.0 * std::hypot(x, y, z));
  expect("mean_comfort_standing", 3.0 * std::sqrt(16.0 * x * x + 4.0 * y * y + z * z) + later * 5.0 * y);
  expect("mean_comfort_seated", later * (4.0 * z + 2.0 * std::hypot(y, z) + 4.0 * back));
  expect("comfort_longitudinal", later * x);
  AssessmentFacts facts{"ballasted", 250.0 / 3.6};
  const std::vector<Clause> clauses = library_clauses();
  const std::vector<Verdict> verdicts = judge(clauses, facts, found.values, found.missing);
  const auto outcome = [&](std::string_view id) {
    return std::ranges::find_if(verdicts, [&](const Verdict& v) { return v.clause->id == id; })->outcome;
  };
  EXPECT_EQ(outcome("en12299.standing.very-comfortable"), Outcome::fail) << "1.54";
  EXPECT_EQ(outcome("en12299.standing.comfortable"), Outcome::pass);
  EXPECT_EQ(outcome("en12299.seated.comfortable"), Outcome::fail) << "2.95";
  results.steps.resize(147500);  // 295 s
  const RunMeasures shorter = run_measures(results, {});
  for (const char* mean : {"mean_comfort", "mean_comfort_seated", "mean_comfort_standing"}) {
    EXPECT_NE(std::ranges::find(shorter.missing, mean, &MissingMeasure::measure), shorter.missing.end()) << mean;
  }
}

/// The extremes of a deck with two edges.
RunResults with_envelope(double cut_off) {
  RunResults results = made_run();
  results.header.deck_cut_off = cut_off;
  const auto add = [&](const char* quantity, const char* unit, std::vector<double> smallest,
                       std::vector<double> largest) {
    DeckPlaces places{quantity, unit};
    for (std::size_t i = 0; i < smallest.size(); ++i) {
      places.x.push_back(12.0 + static_cast<double>(i));
      places.y.push_back(i % 2 == 0 ? -4.0 : 4.0);
    }
    results.header.deck.push_back(places);
    const std::vector<double> early(smallest.size(), 1.25), late(smallest.size(), 2.5);
    results.summary.deck.push_back({std::move(smallest), early, std::move(largest), late});
  };
  add("displacement", "m", {-1e-3, -2e-3}, {5e-3, 6e-3});
  add("twist", "m", {-1.6e-3}, {1.2e-3});
  add("end_rotation", "rad", {-3e-4, -1e-4}, {2e-4, 5e-4});
  add("joint_step", "m", {-1e-4}, {2.5e-3});
  add("joint_gap", "m", {-9e-3}, {1e-3});
  add("acceleration", "m/s^2", {-7.0, -6.0}, {6.5, 5.0});
  add("filtered_acceleration", "m/s^2", {-2.0, -3.75}, {3.0, 3.5});
  return results;
}

TEST(RunMeasures, WholeDeckInPlaceOfRecordedNodes) {
  const RunMeasures found = run_measures(with_envelope(30.0), {-100.0, 30.0, 20.0, 0.3});
  EXPECT_EQ(of(found, "deck_acceleration").value, 3.75) << "its midspan node has 1.0";
  EXPECT_EQ(spot_in_words(of(found, "deck_acceleration")), "deck, x = 13.00 m, y = 4.00 m, t = 1.250 s");
  EXPECT_EQ(of(found, "deck_acceleration").time, 1.25);
  EXPECT_EQ(of(found, "deck_acceleration_unfiltered").value, 7.0);
  EXPECT_EQ(of(found, "deck_displacement").value, 6e-3);
  EXPECT_EQ(of(found, "deck_displacement").time, 2.5);
  EXPECT_EQ(of(found, "deck_twist").value, 1.6e-3);
  EXPECT_EQ(of(found, "deck_twist").x, 12.0);
  EXPECT_FALSE(of(found, "deck_twist").y) << "all of its places have one";
  EXPECT_EQ(std::ranges::find(found.missing, "track_twist", &MissingMeasure::measure)->reason,
            "the scene's track is perfect: its twist without traffic is not known");
  RunWindow rough{-100.0, 30.0, 20.0, 0.3};
  rough.track_twist = [](double first, double last) { return 1e-3 * first + 2e-3 * last - 34e-3; };
  EXPECT_NEAR(of(run_measures(with_envelope(30.0), rough), "track_twist").value, 1.6e-3 + 2e-3, 1e-12)
      << "of x = 12 m, where alone the deck's twist is followed";
  EXPECT_EQ(of(found, "deck_end_rotation").value, 5e-4);
  EXPECT_EQ(of(found, "deck_joint_gap").value, 9e-3);
  EXPECT_EQ(std::ranges::count(found.missing, "horizontal_rotation", &MissingMeasure::measure), 1)
      << "a run in the vertical plane has none";

  AssessmentFacts facts{"ballasted", 250.0 / 3.6};
  const std::vector<Clause> clauses = library_clauses();
  const std::vector<Verdict> verdicts = judge(clauses, facts, found.values, found.missing);
  const auto outcome = [&](const char* id) {
    const auto verdict = std::ranges::find_if(verdicts, [&](const Verdict& v) { return v.clause->id == id; });
    return verdict == verdicts.end() ? Outcome::not_judged : verdict->outcome;
  };
  EXPECT_EQ(outcome("en1990.deck-acceleration.ballasted"), Outcome::fail) << "3.75 of 3.5 m/s², beside midspan";
  EXPECT_EQ(outcome("en1990.twist.above-200"), Outcome::fail);
  EXPECT_EQ(outcome("en1990.horizontal-rotation.above-200"), Outcome::not_judged);
  EXPECT_EQ(outcome("en1991.joint-step.above-160"), Outcome::fail);
  EXPECT_EQ(outcome("en1991.joint-step.160"), Outcome::not_applicable);
  EXPECT_EQ(outcome("en1991.joint-gap"), Outcome::fail);
}

TEST(RunMeasures, EnvelopeOfAnotherCutOffOrOfAKilledRunIsNotTaken) {
  const RunMeasures other = run_measures(with_envelope(40.0), {-100.0, 30.0, 20.0, 0.3});
  const auto missing = std::ranges::find(other.missing, "deck_acceleration", &MissingMeasure::measure);
  ASSERT_NE(missing, other.missing.end());
  EXPECT_EQ(missing->reason, "output.deck_cut_off is 40 Hz, and the decks ask for 30 Hz");
  EXPECT_EQ(of(other, "deck_acceleration_unfiltered").value, 7.0);
  // a lower one than is asked for: that of steps too long
  const RunMeasures slow = run_measures(with_envelope(20.0), {-100.0, 30.0, 20.0, 0.3});
  EXPECT_EQ(std::ranges::find(slow.missing, "deck_acceleration", &MissingMeasure::measure)->reason,
            "output.deck_cut_off is 20 Hz, and the decks ask for 30 Hz, which takes integration.time_step of at most "
            "0.00833 s");
  EXPECT_EQ(of(slow, "deck_twist").value, 1.6e-3) << "needs no filter";
  RunResults killed = with_envelope(30.0);
  killed.summary.deck.clear();
  const RunMeasures recorded = run_measures(killed, {-100.0, 30.0, 20.0, 0.3});
  EXPECT_NEAR(of(recorded, "deck_acceleration").value, 1.0, 2e-3) << "that of the recorded node";
  EXPECT_EQ(std::ranges::count(recorded.missing, "the run was ended before it wrote the envelope of the deck",
                               &MissingMeasure::reason),
            6);
}

TEST(RunMeasures, WhatStandsBeforeTheBeginIsNotJudged) {
  RunResults results = made_run();
  results.steps[3].wheels[0].Q = 0.0;  // in the fourth millisecond
  RunWindow window{-100.0, 30.0, 20.0, 0.3};
  EXPECT_NEAR(of(run_measures(results, window), "wheel_unloading_unfiltered").value, 1.0, 1e-12);
  window.begin = -90.0;
  EXPECT_NEAR(of(run_measures(results, window), "wheel_unloading_unfiltered").value, 0.3, 1e-6);
  window.begin = 280.0;  // 0.4 s before the end
  const RunMeasures late = run_measures(results, window);
  EXPECT_NEAR(of(late, "deck_acceleration").value, 1.0, 2e-3) << "the deck is judged throughout";
  const auto missing = std::find_if(late.missing.begin(), late.missing.end(),
                                    [](const MissingMeasure& m) { return m.measure == "comfort_vertical"; });
  ASSERT_NE(missing, late.missing.end());
  EXPECT_EQ(missing->reason, "no car body is judged for as long as 5 s");
  window.begin = 1e4;
  const RunMeasures never = run_measures(results, window);
  EXPECT_TRUE(std::none_of(never.values.begin(), never.values.end(),
                           [](const MeasuredValue& v) { return v.measure == "wheel_unloading"; }));
}

TEST(RunMeasures, WhatIsNotRecordedIsMissingWithItsReason) {
  RunResults results = made_run();
  results.header.node_names = {"rail", "rail"};
  results.header.body_names = {"coach-1/bogie-1"};
  results.header.static_wheel_load.clear();
  results.header.wheel_x.clear();
  const RunMeasures found = run_measures(results, {});
  EXPECT_TRUE(found.values.empty());
  std::size_t all = 0;
  for (const MeasureKind& kind : measure_kinds()) {
    all += static_cast<std::size_t>(std::count(kind.stages.begin(), kind.stages.end(), AssessmentStage::contact));
  }
  EXPECT_EQ(found.missing.size(), all) << "every measure of the stage, once";
  RunResults sparse = made_run();
  std::vector<StepRecord> some;
  for (std::size_t k = 0; k < sparse.steps.size(); k += 20) some.push_back(sparse.steps[k]);
  sparse.steps = some;
  const RunMeasures coarse = run_measures(sparse, {-100.0, 30.0, 20.0, 0.3});
  EXPECT_TRUE(std::any_of(coarse.missing.begin(), coarse.missing.end(), [](const MissingMeasure& m) {
    return m.measure == "deck_acceleration" && m.reason.find("too far for a filter") != std::string::npos;
  }));
  EXPECT_NEAR(of(coarse, "deck_displacement").value, 2e-3, 1e-12);
}

// The place of an extreme is that of its own wheel or body at its time.
TEST(RunMeasures, ExtremesOfWheelsAndCarBodiesHaveTheirPlace) {
  constexpr double behind = 2.5, start = -100.0;
  RunResults results = made_run();
  results.header.wheel_x = {-behind, -behind};
  results.header.body_x = {-9.0};
  const RunMeasures found = run_measures(results, {-100.0, 30.0, 20.0, 0.3});
  for (const char* measure :
       {"wheel_unloading", "wheel_unloading_unfiltered", "wheel_unloading_5ft", "wheel_force", "derailment",
        "derailment_2m", "derailment_5ft", "weinstock_sum", "track_shift_2m", "track_shift_5ft", "contact_pressure"}) {
    const MeasuredValue& value = of(found, measure);
    ASSERT_TRUE(value.x && value.time) << measure;
    EXPECT_NEAR(*value.x, start + speed * *value.time - behind, 1e-9) << measure;
    EXPECT_NE(spot_in_words(value).find(", x = "), std::string::npos) << spot_in_words(value);
  }
  for (const char* measure :
       {"car_body_vertical", "car_body_lateral_6hz", "comfort_vertical", "running_rms_vertical", "sperling_lateral"}) {
    const MeasuredValue& value = of(found, measure);
    ASSERT_TRUE(value.x && value.time) << measure;
    EXPECT_NEAR(*value.x, start + speed * *value.time - 9.0, 1e-9) << measure;
  }
  // of the unloading, whose time is known: 0.5 s and every 2 s after
  EXPECT_NEAR(std::fmod(*of(found, "wheel_unloading_unfiltered").x + behind - start - 0.5 * speed, 2.0 * speed), 0.0,
              1e-6);
  EXPECT_EQ(of(found, "deck_displacement").x, 12.5) << "of the recorded node";
  EXPECT_FALSE(of(found, "vibration_dose_vertical").time) << "of the whole way";
}

TEST(RunMeasures, SeriesOfTheWorstWheel) {
  const WheelSeries series = wheel_series(made_run(), {-100.0, 30.0, 20.0, 0.3});
  EXPECT_EQ(series.wheel, "wheelset 1 left");
  ASSERT_EQ(series.unloading.size(), 8001U);
  EXPECT_NEAR(series.filtered_unloading[500], 0.3, 1e-6);
  EXPECT_NEAR(series.position.front(), -100.0, 1e-12);
}

// Charts of the deck are about the node that the verdict is about, and say so where its history is not recorded.
TEST(RunMeasures, SeriesOfTheNodeThatGoverns) {
  const RunWindow window{-100.0, 30.0, 20.0, 0.3};
  RunResults results = with_envelope(30.0);
  results.header.node_names = {"deck-quarter", "rail-left-midspan-1", "deck-edge", "deck-edge-left"};
  results.header.node_x = {9.0, 13.0, 13.5, 13.0};
  results.header.node_y = {4.0, 4.0, 4.0, -4.0};
  for (StepRecord& r : results.steps) r.nodes.resize(4);
  for (StepRecord& r : results.steps) r.nodes[2].acceleration[2] = 2.0 * std::sin(2.0 * pi * 4.0 * r.time);
  const MeasuredValue governing = of(run_measures(results, window), "deck_acceleration");
  DeckSeries series = deck_series(results, window, governing);
  EXPECT_EQ(series.node, "deck-edge") << "half a metre away, not 8 m across";
  EXPECT_FALSE(series.node_governs);
  EXPECT_EQ(series.node_x, 13.5);
  EXPECT_EQ(series.node_y, 4.0);
  EXPECT_NEAR(std::ranges::max(series.judged), 2.0, 5e-3);
  EXPECT_EQ(series.envelope.x, (std::vector<double>{12.0, 13.0}));
  EXPECT_EQ(series.envelope.smallest, (std::vector<double>{-2.0, -3.75}));
  EXPECT_EQ(series.envelope.largest, (std::vector<double>{3.0, 3.5}));
  Assessment a;
  series.governing.run = "r1";
  a.deck_series = {series};
  a.window = window;
  std::string page = assessment_page(a);
  EXPECT_NE(page.find("The node that governs: x = 13.00 m, y = 4.00 m, 3.750 m/s² at t = 1.250 s."), std::string::npos);
  EXPECT_NE(page.find("The recorded node nearest to the one that governs (x = 13.00 m, y = 4.00 m, 3.750 m/s² at t = "
                      "1.250 s), whose history is not recorded; this one reaches 2.00"),
            std::string::npos);
  results.header.node_x[2] = 13.0;
  series = deck_series(results, window, governing);
  EXPECT_TRUE(series.node_governs);
  a.deck_series = {series};
  page = assessment_page(a);
  EXPECT_NE(page.find("The node that governs, 3.750 m/s² at t = 1.250 s; positive down."), std::string::npos);
  // without an envelope the recorded node itself is judged
  results.summary.deck.clear();
  const MeasuredValue recorded = of(run_measures(results, window), "deck_acceleration");
  EXPECT_EQ(recorded.where, "deck-edge");
  EXPECT_EQ(recorded.y, 4.0);
  series = deck_series(results, window, recorded);
  EXPECT_EQ(series.node, "deck-edge");
  EXPECT_TRUE(series.node_governs);
  EXPECT_TRUE(series.envelope.x.empty());
  const DeckSeries sag = deck_series(results, window, of(run_measures(results, window), "deck_displacement"));
  EXPECT_EQ(sag.node, "deck-quarter") << "the only one that moves";
  EXPECT_EQ(std::ranges::max(sag.judged), 2e-3);
}

}  // namespace
}  // namespace railtab::assess
