// Pages of the report: one file that loads nothing, every section, and histories that are those of the results.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "headline.hpp"
#include "railtab/runtime/report/history_store.hpp"
#include "report_page.hpp"
#include "report_run.hpp"

namespace railtab::report {
namespace {

using Json = nlohmann::json;

/// A page without what is inside its scripts, style sheet and quoted texts.
std::string markup(std::string page) {
  for (const std::string tag : {"script", "style", "pre"}) {
    for (std::size_t from = page.find("<" + tag); from != std::string::npos; from = page.find("<" + tag, from + 1)) {
      const std::size_t begin = page.find('>', from) + 1, end = page.find("</" + tag + ">", begin);
      page.erase(begin, end - begin);
    }
  }
  return page;
}

std::vector<std::uint8_t> decoded(const std::string& text) {
  const std::string letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<std::uint8_t> bytes;
  std::uint32_t bits = 0;
  int held = 0;
  for (const char c : text) {
    if (c == '=') break;
    bits = bits << 6U | static_cast<std::uint32_t>(letters.find(c));
    held += 6;
    if (held < 8) continue;
    held -= 8;
    bytes.push_back(static_cast<std::uint8_t>(bits >> static_cast<unsigned>(held)));
  }
  return bytes;
}

std::vector<double> quantised(const Json& of) {
  const std::vector<std::uint8_t> bytes = decoded(of.at("data"));
  std::vector<double> values;
  for (std::size_t i = 0; i + 1 < bytes.size(); i += 2) {
    const int number = bytes[i] + 256 * bytes[i + 1];
    values.push_back(number == 65535 ? std::numeric_limits<double>::quiet_NaN()
                                     : of.at("low").get<double>() + of.at("step").get<double>() * number);
  }
  return values;
}

std::vector<float> floats(const std::string& text) {
  const std::vector<std::uint8_t> bytes = decoded(text);
  std::vector<float> values;
  for (std::size_t i = 0; i + 3 < bytes.size(); i += 4) {
    const std::uint32_t word =
        bytes[i] | bytes[i + 1] << 8U | bytes[i + 2] << 16U | static_cast<std::uint32_t>(bytes[i + 3]) << 24U;
    values.push_back(std::bit_cast<float>(word));
  }
  return values;
}

Json script_data(const std::string& page, const std::string& begin_of_tag, std::size_t from = 0) {
  const std::size_t tag = page.find(begin_of_tag, from);
  if (tag == std::string::npos) return {};
  const std::size_t begin = page.find('>', tag) + 1;
  return Json::parse(page.substr(begin, page.find("</script>", begin) - begin));
}

/// What the chart of that title is drawn from.
Json chart_data(const std::string& page, const std::string& title) {
  const std::size_t figure = page.find("<h3>" + title + "</h3>");
  return figure == std::string::npos
             ? Json{}
             : script_data(page, "<script type=\"application/json\" class=\"chart-data\"", figure);
}

std::string figure(const std::string& page, const std::string& title) {
  const std::size_t begin = page.find("<h3>" + title + "</h3>");
  return begin == std::string::npos ? "" : page.substr(begin, page.find("</figure>", begin) - begin);
}

TEST(HistoryStore, KeepsShortHistoriesWholeAndPeaksOfLongOnes) {
  std::vector<double> time(10000), values(10000);
  for (std::size_t i = 0; i < values.size(); ++i) {
    time[i] = 0.001 * static_cast<double>(i);
    values[i] = std::sin(0.01 * static_cast<double>(i));
  }
  values[4321] = 9.0;
  values[4322] = -7.0;
  values[0] = std::numeric_limits<double>::quiet_NaN();
  HistoryStore store;
  store.add_run("a <run>", time, time);
  store.add(values, {values.size()});
  EXPECT_EQ(store.coarsest(), 1u);
  store.add(values, {400});
  EXPECT_EQ(store.coarsest(), 50u);
  EXPECT_EQ(store.json().find('<'), std::string::npos) << "a script element would end";
  const Json json = Json::parse(store.json());
  EXPECT_EQ(json["runs"][0]["name"], "a <run>");
  const std::vector<float> stored_time = floats(json["runs"][0]["time"]);
  ASSERT_EQ(stored_time.size(), time.size());
  EXPECT_EQ(stored_time[1234], static_cast<float>(time[1234]));
  const std::vector<double> whole = quantised(json["histories"][0]["of"]);
  ASSERT_EQ(whole.size(), values.size());
  EXPECT_TRUE(std::isnan(whole[0]));
  const double half_step = 0.5001 * 16.0 / 65534.0;
  for (std::size_t i = 1; i < values.size(); ++i) ASSERT_NEAR(whole[i], values[i], half_step) << i;
  const std::vector<double> thin = quantised(json["histories"][1]["of"]);
  ASSERT_EQ(thin.size(), 400u);
  EXPECT_EQ(json["histories"][1]["every"], 50);
  for (std::size_t k = 0; k < 200; ++k) {
    std::vector<double> of(values.begin() + static_cast<long>(50 * k), values.begin() + static_cast<long>(50 * k + 50));
    std::erase_if(of, [](double value) { return std::isnan(value); });
    const auto [low, high] = std::minmax_element(of.begin(), of.end());
    EXPECT_NEAR(std::min(thin[2 * k], thin[2 * k + 1]), *low, half_step);
    EXPECT_NEAR(std::max(thin[2 * k], thin[2 * k + 1]), *high, half_step);
  }
  EXPECT_GT(thin[2 * 86], thin[2 * 86 + 1]) << "in the order in which they come";
}

TEST(HistoryStore, AConstantAndAnEmptyHistoryAreValues) {
  EXPECT_EQ(quantised(Json::parse(quantised_json(std::vector<double>{3.5, 3.5}))), (std::vector<double>{3.5, 3.5}));
  EXPECT_TRUE(quantised(Json::parse(quantised_json(std::vector<double>{}))).empty());
}

TEST(ReportPage, IsOneFileWithEverySection) {
  const std::string page = report_page(small_run());
  for (const char* part : {"Running safety", "Wheel forces", "Wheel and rail", "Car bodies", "Bridge and track",
                           "What was run", "The program", "railtab 9.8.7", "Train and wheels over time"}) {
    EXPECT_NE(page.find(part), std::string::npos) << part;
  }
  const std::string html = markup(page);
  for (const char* outside : {"http:", "https:", "src=", "href=", "@import", "url("}) {
    EXPECT_EQ(html.find(outside), std::string::npos) << outside;
  }
  EXPECT_NE(page.find("content=\"default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'\""),
            std::string::npos)
      << "a browser must not load anything";
  EXPECT_EQ(html.find("nan"), std::string::npos);
  EXPECT_NE(page.find("Permission is hereby granted"), std::string::npos) << "the licence of dygraphs";
  EXPECT_LT(page.find("Running safety"), page.find("Contact time")) << "figures of the program stand last";
}

// A run that has followed its whole deck shows that, and its headline is the deck's, not a node's.
TEST(ReportPage, HasTheWholeDeckOverX) {
  RunResults run = small_run();
  EXPECT_EQ(report_page(run).find("whole deck"), std::string::npos);
  const auto add = [&](const char* quantity, const char* unit, double factor) {
    run.header.deck.push_back({quantity, unit, {0.0, 4.0, 8.0}, {0.0, 0.0, 0.0}});
    run.summary.deck.push_back(
        {{-1.0 * factor, -4.0 * factor, 0.0}, {0.1, 0.2, 0.3}, {2.0 * factor, 0.0, factor}, {0.4, 0.5, 0.6}});
  };
  add("displacement", "m", 1e-3);
  add("acceleration", "m/s^2", 1.0);
  add("filtered_acceleration", "m/s^2", 0.5);
  add("twist", "m", 1e-4);
  const std::string page = report_page(run);
  for (const char* title :
       {"Deck displacement, whole deck", "Deck acceleration, whole deck", "Deck twist, whole deck"}) {
    EXPECT_NE(page.find(title), std::string::npos) << title;
  }
  EXPECT_EQ(page.find("Bending moment"), std::string::npos) << "the run has none";
  const Headline headline = headline_of(run);
  EXPECT_EQ(headline.deck_acceleration.value, 4.0);
  EXPECT_EQ(headline.deck_acceleration.time, 0.2);
  EXPECT_EQ(headline.deck_acceleration.where, "deck, x = 4.0 m");
  EXPECT_EQ(headline.deck_displacement.value, 4e-3);
}

// The histories are those of the results, and each channel names its own.
TEST(ReportPage, ChannelsAreThoseOfTheResults) {
  const RunResults run = long_run(1500, 8);
  const std::string page = report_page(run);
  const Json store = script_data(page, "<script type=\"application/json\" id=\"histories\"");
  const std::vector<float> time = floats(store["runs"][0]["time"]), position = floats(store["runs"][0]["position"]);
  ASSERT_EQ(time.size(), run.steps.size());
  EXPECT_EQ(time[777], static_cast<float>(run.steps[777].time));
  EXPECT_EQ(position[777], static_cast<float>(run.steps[777].position));
  const auto expect_channel = [&](const std::string& title, std::size_t line, double shift_x, auto value) {
    const Json chart = chart_data(page, title);
    ASSERT_GT(chart["series"].size(), line) << title;
    const Json& series = chart["series"][line];
    EXPECT_EQ(series["offset"], shift_x);
    const Json& history = store["histories"][series["history"].get<std::size_t>()];
    ASSERT_EQ(history["every"], 1) << "few records are stored whole";
    const std::vector<double> stored = quantised(history["of"]);
    ASSERT_EQ(stored.size(), run.steps.size());
    const double step = std::abs(history["of"]["step"].get<double>() * series["factor"].get<double>());
    for (std::size_t i = 0; i < stored.size(); ++i) {
      const double shown = series["factor"].get<double>() * stored[i] + series["shift"].get<double>();
      ASSERT_NEAR(shown, value(run.steps[i]), 0.5001 * step + 1e-12) << title << ", record " << i;
    }
  };
  expect_channel("Vertical wheel force Q", 5, -12.0, [](const StepRecord& step) { return 1e-3 * step.wheels[5].Q; });
  expect_channel("Lateral wheel force Y", 2, -6.0, [](const StepRecord& step) { return 1e-3 * step.wheels[2].Y; });
  expect_channel("Wheel unloading ΔQ/Q0, unfiltered", 7, -18.0,
                 [](const StepRecord& step) { return 1.0 - step.wheels[7].Q / 50e3; });
  expect_channel("Deck displacement", 0, 0.0,
                 [](const StepRecord& step) { return 1e3 * step.nodes[0].displacement[2]; });
  expect_channel("Deck acceleration", 1, 0.0, [](const StepRecord& step) { return step.nodes[1].acceleration[2]; });
}

TEST(ReportPage, InstantsOfTheSliderAreThoseOfTheResults) {
  const RunResults run = long_run(3000, 8);
  const Json frames = script_data(report_page(run), "<script type=\"application/json\" id=\"frames\"");
  const std::vector<float> time = floats(frames["time"]);
  const std::vector<double> Q = quantised(frames["Q"]), table = quantised(frames["from_table"]);
  ASSERT_EQ(time.size(), frames["frames"]);
  ASSERT_EQ(Q.size(), 8 * time.size());
  EXPECT_LE(time.size(), 2000u);
  EXPECT_EQ(time.back(), static_cast<float>(run.steps.back().time));
  for (std::size_t f = 0; f < time.size(); ++f) {
    const auto record = static_cast<std::size_t>(std::lround(time[f] / 0.005));
    ASSERT_NEAR(Q[8 * f + 3], run.steps[record].wheels[3].Q, 0.2) << f;
    ASSERT_NEAR(table[8 * f + 3], 0.0, 1e-9);
    ASSERT_NEAR(table[8 * f + 4], 1.0, 1e-9);
  }
  EXPECT_EQ(frames["spans"], (Json{{0.0, 20.0}, {20.0, 40.0}}));
  EXPECT_EQ(frames["body_x"], (Json{-9.0, -33.0}));
}

// A limit stands on the chart of the measure that it is meant for, and on no other.
TEST(ReportPage, LimitsStandOnTheirMeasures) {
  const std::string page = report_page(long_run(1500, 4));
  const std::string mean = figure(page, "Derailment coefficient Y/Q, mean over 2 m");
  EXPECT_NE(mean.find("0.8 – EN 14363"), std::string::npos);
  EXPECT_EQ(figure(page, "Derailment coefficient Y/Q, unfiltered").find("class=\"limit\""), std::string::npos);
  EXPECT_EQ(figure(page, "Wheel unloading ΔQ/Q0, unfiltered").find("class=\"limit\""), std::string::npos);
  EXPECT_NE(figure(page, "Wheel unloading ΔQ/Q0, low-passed at 20 Hz").find("0.6 – EN 14363"), std::string::npos);
  // 10 kN + 100 kN/3
  EXPECT_NE(figure(page, "Track shift force ΣY, mean over 2 m").find("43.3 kN – EN 14363"), std::string::npos);
}

TEST(ReportPage, TheMeanOverTwoMetresIsTheHeadlines) {
  const RunResults run = long_run(1500, 4);
  const std::string page = report_page(run);
  const Json store = script_data(page, "<script type=\"application/json\" id=\"histories\"");
  double largest = 0.0, step = 0.0;
  const Json chart = chart_data(page, "Derailment coefficient Y/Q, mean over 2 m");
  for (const Json& series : chart["series"]) {
    const Json& of = store["histories"][series["history"].get<std::size_t>()]["of"];
    step = std::max(step, of["step"].get<double>());
    for (const double value : quantised(of)) {
      if (std::isfinite(value)) largest = std::max(largest, value);
    }
  }
  EXPECT_GT(largest, 0.05);
  EXPECT_NEAR(largest, headline_of(run).derailment_2m.value, step);
}

// Below the cut-off nothing is lost of 0.5 Hz; what changes from record to record is gone.
TEST(ReportPage, TheFilteredUnloadingIsWithoutFastParts) {
  RunResults run = long_run(1500, 2);
  for (std::size_t i = 0; i < run.steps.size(); ++i) run.steps[i].wheels[0].Q += i % 2 == 0 ? 30e3 : -30e3;
  const std::string page = report_page(run);
  const Json store = script_data(page, "<script type=\"application/json\" id=\"histories\"");
  const Json chart = chart_data(page, "Wheel unloading ΔQ/Q0, low-passed at 20 Hz");
  const std::vector<double> filtered =
      quantised(store["histories"][chart["series"][0]["history"].get<std::size_t>()]["of"]);
  ASSERT_EQ(filtered.size(), run.steps.size());
  for (std::size_t i = 200; i < 1300; ++i) {
    ASSERT_NEAR(filtered[i], -0.18 * std::sin(3.0 * run.steps[i].time), 1e-3) << i;
  }
}

TEST(ReportPage, BridgeAndItsPassageAreMarked) {
  const std::string page = report_page(long_run(1500, 4));
  const Json position = chart_data(page, "Vertical wheel force Q")["marks"];
  ASSERT_EQ(position.size(), 2u);
  EXPECT_EQ(position[1]["from"], 20.0);
  EXPECT_EQ(position[1]["to"], 40.0);
  EXPECT_NE(figure(page, "Vertical wheel force Q").find("class=\"mark\""), std::string::npos);
  const Json time = chart_data(page, "Deck displacement")["marks"];
  ASSERT_EQ(time.size(), 1u);  // from x = 0 of the first wheelset to x = 40 m of the last, 6 m behind; 20 m/s
  EXPECT_NEAR(time[0]["from"].get<double>(), 1.5, 0.006);
  EXPECT_NEAR(time[0]["to"].get<double>(), 3.8, 0.006);
}

TEST(ReportPage, WarningsAndPlanHaveTheirPlace) {
  RunResults run = long_run(50, 4);
  run.summary.contact_mode = "table";
  run.summary.table_queries = 10;
  const std::string page = report_page(run);
  EXPECT_LT(page.find("the track is rough"), page.find("Running safety"));
  EXPECT_LT(page.find("the table served 5.0 % of the contact queries"), page.find("Running safety"));
  const auto served = [&](long share) {
    run.summary.contact_queries = 100;
    run.summary.table_queries = share;
    return uncovered_queries(run.summary);
  };
  EXPECT_NE(served(75).find("measured profiles smooth enough (--smoothing)?"), std::string::npos) << served(75);
  EXPECT_EQ(served(85), "");
  EXPECT_GT(page.find("2 x coach"), page.find("What was run"));
  EXPECT_GT(page.find("wind: none acts"), page.find("Left out"));
}

TEST(ReportPage, FiguresHaveTextsInTheirPlace) {
  const std::string page = report_page(long_run(200, 4));
  std::size_t figures = 0;
  for (std::size_t at = page.find("<svg"); at != std::string::npos; at = page.find("<svg", at + 1)) {
    const std::string tag = page.substr(at, page.find('>', at) - at);
    EXPECT_NE(tag.find("aria-label=\""), std::string::npos) << tag.substr(0, 100);
    ++figures;
  }
  EXPECT_GT(figures, 8u);
  EXPECT_NE(page.find("aria-label=\"Deck displacement; deck-midspan-1 (x = 10.0 m): 0 to 2.00;"), std::string::npos);
}

TEST(ReportPage, OfALongTrainIsSmallAndStatesItsResolution) {
  const std::string page = report_page(long_run(12000, 64));
  EXPECT_LT(page.size(), 15'000'000u);
  const Json store = script_data(page, "<script type=\"application/json\" id=\"histories\"");
  for (const Json& history : store["histories"]) {
    const std::size_t values = decoded(history["of"]["data"]).size() / 2;
    EXPECT_TRUE(history["every"] == 1 || values <= 2000u) << values;
  }
  EXPECT_NE(page.find("of each group of records, at most 12 here"), std::string::npos)
      << "the page states its resolution";
}

TEST(ComparisonPage, LaysRunsOverEachOtherAndStatesTheirDifferences) {
  std::vector<RunResults> runs{long_run(1500, 4), long_run(1000, 4)};
  runs[1].header.scene_text += "friction = 0.2\n";
  for (StepRecord& step : runs[1].steps) step.nodes[0].displacement[2] *= 1.5;
  const std::string page = comparison_page(runs, {"dry", "<wet>"});
  EXPECT_NE(page.find("<th class=\"n\">against dry</th>"), std::string::npos);
  EXPECT_EQ(page.find("<wet>"), std::string::npos);
  const std::size_t row = page.find("<th>Deck displacement</th>");
  ASSERT_NE(row, std::string::npos);
  EXPECT_NE(page.substr(row, 500).find("(+50.0 %)"), std::string::npos) << page.substr(row, 500);
  EXPECT_NE(page.find("friction = 0.2"), std::string::npos);
  const Json chart = chart_data(page, "Vertical wheel force Q");
  ASSERT_EQ(chart["series"].size(), 8u);
  EXPECT_EQ(chart["series"][0]["label"], "dry: wheelset 1 left");
  EXPECT_EQ(chart["series"][4]["run"], 1);
  EXPECT_EQ(chart["series"][4]["shown"], true);
  const Json store = script_data(page, "<script type=\"application/json\" id=\"histories\"");
  EXPECT_EQ(floats(store["runs"][1]["time"]).size(), 1000u);
}

// Colours of similar brightness are one grey on paper.
TEST(ComparisonPage, LinesDifferOnPaperByTheirDashes) {
  const std::vector<RunResults> runs(2, long_run(50, 4));
  const std::string page = comparison_page(runs, {"a", "b"});
  const std::size_t print = page.find("@media print{.line");
  ASSERT_NE(print, std::string::npos);
  for (const char* line : {".line.c1{stroke-dasharray:", ".line.c2{stroke-dasharray:", ".line.c3{stroke-dasharray:"}) {
    EXPECT_NE(page.find(line, print), std::string::npos) << line;
  }
}

TEST(ReportPage, EscapesTheScene) {
  const std::string page = report_page(small_run());
  EXPECT_NE(page.find("small &lt;run&gt;"), std::string::npos);
  EXPECT_EQ(page.find("</pre><script>\n"), std::string::npos);
}

TEST(ReportPage, SaysWhenARunIsNotComplete) {
  RunResults run = small_run();
  EXPECT_EQ(report_page(run).find("not complete"), std::string::npos);
  run.summary.complete = false;
  run.summary.message = "the step at t = 0.3 s did not converge";
  EXPECT_NE(report_page(run).find("not complete.</b> the step at t = 0.3 s"), std::string::npos);
}

// Of a run that was ended from outside nobody has written the times.
TEST(ReportPage, TimesThatNobodyWroteAreNotShown) {
  RunResults run = small_run();
  run.summary.seconds_total = 2.0;
  EXPECT_NE(report_page(run).find("Contact time"), std::string::npos);
  run.summary.seconds_total = run.summary.seconds_lookup = run.summary.seconds_contact = 0.0;
  EXPECT_EQ(report_page(run).find("Contact time"), std::string::npos);
}

TEST(ReportPage, RunWithoutRecordsBridgeOrOutlinesIsStillAPage) {
  RunResults run;
  run.header.scene_name = "empty";
  const std::string page = report_page(run);
  EXPECT_NE(page.find("not complete"), std::string::npos);
  EXPECT_EQ(page.find("Bridge and track"), std::string::npos);
  EXPECT_EQ(page.find("<figure"), std::string::npos);
}

TEST(ReportPage, HeadNamesTheProfilesThatThereAre) {
  RunResults run = small_run();
  EXPECT_EQ(markup(report_page(run)).find(" on rail "), std::string::npos) << "rigid wheels";
  run.header.wheel_profile = "S1002";
  run.header.rail_profile = "60E1";
  EXPECT_NE(markup(report_page(run)).find(" s; wheel S1002 on rail 60E1</p>"), std::string::npos);
}

// A scene records what it chooses: what it leaves out leaves no empty figure behind.
TEST(ReportPage, ChannelsThatWereNotRecordedAreNotShown) {
  RunResults run = small_run();
  run.header.wheel_x.clear();
  run.header.static_wheel_load.clear();
  for (StepRecord& step : run.steps) step.wheels.clear();
  const std::string page = markup(report_page(run));
  for (const char* part : {"Contact positions", "Wheel forces", "Running safety", "wheelsets", "Largest Y/Q"})
    EXPECT_EQ(page.find(part), std::string::npos) << part;
  EXPECT_NE(page.find("Bridge and track"), std::string::npos);
}

}  // namespace
}  // namespace railtab::report
