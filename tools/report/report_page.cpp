#include "report_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>

#include "contact_figure.hpp"
#include "headline.hpp"
#include "railtab/runtime/report/html_page.hpp"
#include "railtab/runtime/report/html_text.hpp"
#include "run_charts.hpp"
#include "train_frames.hpp"

namespace railtab::report {
namespace {

std::string tile(std::string_view name, const std::string& value, std::string_view unit, const std::string& where) {
  return fmt::format("<div><dt>{}</dt><dd class=\"value\">{} <small>{}</small></dd><dd class=\"where\">{}</dd></div>",
                     name, value, unit, escaped(where));
}

std::string tile(std::string_view name, const Extreme& extreme, double factor, std::string_view unit) {
  if (!extreme.found()) return "";
  return tile(name, shown(factor * extreme.value), unit,
              fmt::format("{}, t\u00a0=\u00a0{}\u00a0s", extreme.where, shown(extreme.time)));
}

/// Of the program itself: how the run was computed, not what came out.
std::string program_tiles(const Headline& headline, const RunSummary& summary) {
  std::string html;
  if (summary.contact_queries > 0) {
    html += tile("Served by the table", shown(100.0 * headline.table_share, 4), "%",
                 fmt::format("of {} contact queries", summary.contact_queries));
  }
  if (summary.seconds_total > 0.0) {  // else ended from outside: nobody wrote the times
    html += tile("Contact time", shown(summary.seconds_lookup + summary.seconds_contact), "s",
                 fmt::format("of {} s in all", shown(summary.seconds_total)));
  }
  if (headline.real_time_factor > 0.0) {
    html += tile("Real-time factor", shown(headline.real_time_factor), "×", "simulated time over run time");
  }
  return html.empty() ? "" : fmt::format("<dl class=\"tiles\">{}</dl>", html);
}

std::string tiles(const Headline& headline) {
  std::string html = "<dl class=\"tiles\">";
  html += tile("Deck acceleration", headline.deck_acceleration, 1.0, "m/s²");
  html += tile("Deck displacement", headline.deck_displacement, 1e3, "mm");
  html += tile("Car body, vertical", headline.car_body_vertical, 1.0, "m/s²");
  html += tile("Car body, lateral", headline.car_body_lateral, 1.0, "m/s²");
  html += tile("Largest Y/Q", headline.derailment, 1.0, "");
  html += tile("Wheel unloading ΔQ/Q0", headline.unloading, 100.0, "%");
  html += tile("Largest Q", headline.largest_Q, 1e-3, "kN");
  html += tile("Smallest Q", headline.smallest_Q, 1e-3, "kN");
  html += tile("Y/Q, mean over 2 m", headline.derailment_2m, 1.0, "");
  html += tile("ΣY, mean over 2 m", headline.track_shift_2m, 1e-3, "kN");
  return html +
         fmt::format("</dl><p class=\"lead\">Largest values of {}, unfiltered but for the means.</p>", headline.extent);
}

struct Share {
  const char* name;
  double seconds;
  const char* colour;
};

/// Where the run's wall time went: a stacked bar and its table.
std::string time_figure(const RunSummary& summary) {
  std::array<Share, 8> shares{{{"set-up without pre-roll", summary.seconds_setup - summary.seconds_pre_roll, "#8795a6"},
                               {"pre-roll", summary.seconds_pre_roll, "#b3a2c7"},
                               {"contact look-ups", summary.seconds_lookup, "#e58a6f"},
                               {"contact forces", summary.seconds_contact, "#c8442f"},
                               {"structure", summary.seconds_structure, "#0b6aa2"},
                               {"vehicle", summary.seconds_vehicle, "#2e7d52"},
                               {"output", summary.seconds_output, "#d98e04"},
                               {"other", summary.seconds_total, "#d5dbe2"}}};
  double named = 0.0;
  for (std::size_t i = 0; i + 1 < shares.size(); ++i) named += shares[i].seconds;
  shares.back().seconds = std::max(0.0, summary.seconds_total - named);
  const double total = std::max(named, summary.seconds_total);
  if (!(total > 0.0)) return "";
  std::string bar, rows;
  double from = 0.0;
  for (const Share& share : shares) {
    if (!(share.seconds > 0.0)) continue;
    const double width = 1000.0 * share.seconds / total;
    bar += fmt::format("<rect x=\"{:.2f}\" width=\"{:.2f}\" height=\"10\" fill=\"{}\"><title>{}: {} s</title></rect>",
                       from, width, share.colour, share.name, shown(share.seconds));
    rows += fmt::format(
        "<tr><th><i style=\"background:{}\"></i>{}</th><td class=\"n\">{} s</td><td class=\"n\">{} %</td></tr>",
        share.colour, share.name, shown(share.seconds), shown(0.1 * width));
    from += width;
  }
  return fmt::format(
      "<div class=\"share\"><svg viewBox=\"0 0 1000 10\" preserveAspectRatio=\"none\" role=\"img\" "
      "aria-label=\"where the time went\">{}</svg></div><div class=\"columns\"><table>{}</table>",
      bar, rows);
}

std::string run_table(const RunResults& results) {
  const RunSummary& summary = results.summary;
  std::string rows;
  const auto row = [&](std::string_view name, const std::string& value) {
    rows += fmt::format("<tr><th>{}</th><td>{}</td></tr>", name, escaped(value));
  };
  row("contact", summary.contact_mode);
  if (summary.complete && !summary.message.empty()) row("note", summary.message);
  row("recorded steps", std::to_string(results.steps.size()));
  row("steps, halved steps", fmt::format("{}, {}", summary.steps, summary.halved_steps));
  row("steps divided at impacts", std::to_string(summary.impact_steps));
  row("Newton iterations", std::to_string(summary.newton_iterations));
  row("contact queries", std::to_string(summary.contact_queries));
  row("of these from the table", std::to_string(summary.table_queries));
  row("creep forces from outside the creep table", std::to_string(summary.outside_creep_table));
  row("degrees of freedom of the structure", std::to_string(summary.structure_dofs));
  row("degrees of freedom of the vehicles", std::to_string(summary.vehicle_dofs));
  if (summary.window_error > 0.0) {
    row("motion at the window's ends", fmt::format("{:.2g} % of the largest", 100.0 * summary.window_error));
  }
  return "<table>" + rows + "</table></div>";
}

std::string warning_text(const std::string& warning) {
  return warning.empty() ? "" : fmt::format("<p class=\"warning\"><b>Warning:</b> {}</p>", escaped(warning));
}

std::string heading(const RunResults& results, const Headline& headline) {
  const ResultHeader& header = results.header;
  const std::string wheelsets =
      header.wheel_x.empty() ? "" : fmt::format("{} wheelsets, ", header.wheel_x.size() / 2);  // else not recorded
  const std::string profiles = header.wheel_profile.empty()
                                   ? ""  // rigid wheels
                                   : fmt::format("; wheel {} on rail {}", header.wheel_profile, header.rail_profile);
  std::string html = fmt::format("<h1>{}</h1><p class=\"lead\">{} km/h, {}{} m of track in {} s{}</p>",
                                 escaped(header.scene_name), shown(3.6 * header.speed), wheelsets,
                                 shown(headline.distance), shown(headline.simulated_time), escaped(profiles));
  if (!results.summary.complete) {
    html += fmt::format("<p class=\"warning\"><b>The run is not complete.</b> {}</p>",
                        escaped(results.summary.message.empty() ? "It was stopped; this page shows what was written."
                                                                : results.summary.message));
  }
  for (const std::string& warning : header.warnings) html += warning_text(warning);
  return html + warning_text(uncovered_queries(results.summary));
}

std::string list(std::string_view title, const std::vector<std::string>& parts) {
  if (parts.empty()) return "";
  std::string items;
  for (const std::string& part : parts) items += fmt::format("<li>{}</li>", escaped(part));
  return fmt::format("<div><h3>{}</h3><ul class=\"parts\">{}</ul></div>", title, items);
}

/// What was run: the parts of the model, those left out, the files, the scene.
std::string model(const ResultHeader& header) {
  const std::string parts =
      list("Built", header.built) + list("Left out", header.left_out) + list("Files read", header.input_files);
  return fmt::format("{}<details><summary>The scene as it was run</summary><pre>{}</pre></details>",
                     parts.empty() ? "" : fmt::format("<div class=\"columns\">{}</div>", parts),
                     escaped(header.scene_text));
}

std::string resolution_text(const HistoryStore& histories) {
  if (histories.coarsest() == 1) return "Charts hold every record of all channels.";
  return fmt::format(
      "Channels that are shown at first have up to 40\u00a0000 values, others 2000. Of a longer channel charts hold "
      "the "
      "smallest and the largest value of each group of records, at most {} here. Values are rounded to 1/65\u00a0534 "
      "of "
      "their channel's range.",
      histories.coarsest());
}

}  // namespace

std::string report_page(const RunResults& results) {
  const Headline headline = headline_of(results);
  RunCharts charts({&results, 1}, {results.header.scene_name});
  std::string body = heading(results, headline) + tiles(headline) + train_section(results);
  body += html_chart_section("Running safety", charts.running_safety());
  body += html_chart_section("Wheel forces", charts.wheel_forces());
  body += html_section("Wheel and rail", contact_figure(results));
  body += html_chart_section("Car bodies", charts.car_bodies());
  body += html_chart_section("Bridge and track", charts.structure());
  body += html_section("What was run", model(results.header));
  const std::string time = time_figure(results.summary);
  body += html_section("The program", program_tiles(headline, results.summary) +
                                          (time.empty() ? "" : time + run_table(results)) +
                                          fmt::format("<p class=\"lead\">{}</p>", resolution_text(charts.histories())));
  return live_html_page(page_kind, results.header.scene_name, body, results.header.program_version, charts.histories(),
                        train_script());
}

}  // namespace railtab::report
