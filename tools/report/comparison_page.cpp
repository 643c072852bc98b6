#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <set>
#include <sstream>

#include "headline.hpp"
#include "railtab/runtime/report/html_page.hpp"
#include "railtab/runtime/report/html_text.hpp"
#include "report_page.hpp"
#include "run_charts.hpp"

namespace railtab::report {
namespace {

/// Input files of both runs whose contents differ, by their names.
std::string differing_files(const ResultHeader& one, const ResultHeader& other) {
  std::string names;
  for (std::size_t i = 0; i < std::min(one.input_files.size(), other.input_files.size()); ++i) {
    if (one.input_files[i] != other.input_files[i] || one.input_checksums[i] == other.input_checksums[i]) continue;
    names += (names.empty() ? "" : ", ") + one.input_files[i];
  }
  return names;
}

struct Quantity {
  const char* name;
  const char* unit;
  double factor;
  Extreme Headline::*extreme;
};

constexpr std::array quantities{Quantity{"Deck acceleration", "m/s²", 1.0, &Headline::deck_acceleration},
                                Quantity{"Deck displacement", "mm", 1e3, &Headline::deck_displacement},
                                Quantity{"Car body, vertical", "m/s²", 1.0, &Headline::car_body_vertical},
                                Quantity{"Car body, lateral", "m/s²", 1.0, &Headline::car_body_lateral},
                                Quantity{"Largest Y/Q", "–", 1.0, &Headline::derailment},
                                Quantity{"Y/Q, mean over 2 m", "–", 1.0, &Headline::derailment_2m},
                                Quantity{"ΣY, mean over 2 m", "kN", 1e-3, &Headline::track_shift_2m},
                                Quantity{"Wheel unloading ΔQ/Q0", "%", 100.0, &Headline::unloading},
                                Quantity{"Largest Q", "kN", 1e-3, &Headline::largest_Q},
                                Quantity{"Smallest Q", "kN", 1e-3, &Headline::smallest_Q}};

std::string difference(const Extreme& first, const Extreme& other, double factor) {
  if (!first.found() || !other.found()) return "–";
  const double by = other.value - first.value;
  std::string text = (by > 0.0 ? "+" : "") + shown(factor * by);
  if (first.value != 0.0) {
    const double share = 100.0 * by / std::abs(first.value);
    text += fmt::format(" ({}{} %)", share > 0.0 ? "+" : "", shown(share));
  }
  return text;
}

std::string value(const Extreme& extreme, double factor) {
  if (!extreme.found()) return "–";
  return fmt::format("{}<br><small>{}, t\u00a0=\u00a0{}\u00a0s</small>", shown(factor * extreme.value, 4),
                     escaped(extreme.where), shown(extreme.time));
}

std::string extremes(const std::vector<Headline>& headlines, const std::vector<std::string>& names) {
  std::string head = "<th>Quantity</th><th>Unit</th>", rows;
  for (std::size_t r = 0; r < names.size(); ++r) {
    head += fmt::format("<th class=\"n\">{}</th>", escaped(names[r]));
    if (r > 0) head += fmt::format("<th class=\"n\">against {}</th>", escaped(names[0]));
  }
  for (const Quantity& quantity : quantities) {
    const auto has = [&](const Headline& headline) { return (headline.*quantity.extreme).found(); };
    if (std::none_of(headlines.begin(), headlines.end(), has)) continue;
    rows += fmt::format("<tr><th>{}</th><td>{}</td>", quantity.name, quantity.unit);
    for (std::size_t r = 0; r < names.size(); ++r) {
      const Extreme& extreme = headlines[r].*quantity.extreme;
      rows += fmt::format("<td class=\"n\">{}</td>", value(extreme, quantity.factor));
      if (r > 0) {
        rows += fmt::format("<td class=\"n\">{}</td>",
                            difference(headlines[0].*quantity.extreme, extreme, quantity.factor));
      }
    }
    rows += "</tr>";
  }
  return fmt::format("<div class=\"scroll\"><table><thead><tr>{}</tr></thead><tbody>{}</tbody></table></div>", head,
                     rows);
}

std::string runs_table(std::span<const RunResults> runs, const std::vector<Headline>& headlines,
                       const std::vector<std::string>& names) {
  std::string rows;
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const ResultHeader& header = runs[r].header;
    rows += fmt::format(
        "<tr><th>{}</th><td>{}</td><td class=\"n\">{} km/h</td><td class=\"n\">{} s</td><td>{}</td><td>{}</td></tr>",
        escaped(names[r]), escaped(header.scene_name), shown(3.6 * header.speed), shown(headlines[r].simulated_time),
        escaped(runs[r].summary.contact_mode), runs[r].summary.complete ? "complete" : "not complete");
  }
  return fmt::format(
      "<div class=\"scroll\"><table><thead><tr><th>Run</th><th>Scene</th><th class=\"n\">Speed</th><th "
      "class=\"n\">Simulated</th><th>Contact</th><th>State</th></tr></thead><tbody>{}</tbody></table></div>",
      rows);
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

/// Lines of each scene that the first scene lacks, and those of the first that each lacks.
std::string scene_differences(std::span<const RunResults> runs, const std::vector<std::string>& names) {
  const auto missing = [](const std::string& in, const std::string& of) {
    const std::vector<std::string> there = lines_of(in);
    const std::set<std::string> known(there.begin(), there.end());
    std::string text;
    for (const std::string& line : lines_of(of)) {
      if (!known.contains(line)) text += "  " + line + "\n";
    }
    return text;
  };
  std::string html;
  for (std::size_t r = 1; r < runs.size(); ++r) {
    const std::string &first = runs[0].header.scene_text, &other = runs[r].header.scene_text;
    const std::string files = differing_files(runs[0].header, runs[r].header);
    if (first == other) {
      html += fmt::format("<p>The scenes of {} and {} are equal{}.</p>", escaped(names[0]), escaped(names[r]),
                          files.empty() ? "" : ", but not the contents of " + escaped(files));
      continue;
    }
    if (!files.empty()) {
      html += fmt::format("<p>The contents of {} differ between {} and {}.</p>", escaped(files), escaped(names[0]),
                          escaped(names[r]));
    }
    html += fmt::format("<pre>only in {}:\n{}only in {}:\n{}</pre>", escaped(names[0]), escaped(missing(other, first)),
                        escaped(names[r]), escaped(missing(first, other)));
  }
  return html;
}

}  // namespace

std::string comparison_page(std::span<const RunResults> runs, const std::vector<std::string>& names) {
  std::vector<Headline> headlines;
  std::transform(runs.begin(), runs.end(), std::back_inserter(headlines), headline_of);
  RunCharts charts(runs, names);
  const std::string title = fmt::format("Comparison of {} runs", runs.size());
  std::string body = fmt::format("<h1>{}</h1>{}", title, runs_table(runs, headlines, names));
  body += html_section(
      "Extremes", extremes(headlines, names) +
                      "<p class=\"lead\">Q, Y/Q and unloading of all steps where the results have them, else of the "
                      "recorded steps, as the others; unfiltered but for the means.</p>");
  body += html_chart_section("Running safety", charts.running_safety());
  body += html_chart_section("Wheel forces", charts.wheel_forces());
  body += html_chart_section("Car bodies", charts.car_bodies());
  body += html_chart_section("Bridge and track", charts.structure());
  body += html_section("Scenes", scene_differences(runs, names));
  return live_html_page(page_kind, title, body, runs.front().header.program_version, charts.histories(), "");
}

}  // namespace railtab::report
