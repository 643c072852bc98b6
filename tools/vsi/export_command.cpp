#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string_view>

#include "command/command_line.hpp"
#include "command/json_text.hpp"
#include "command/output_place.hpp"
#include "command/print.hpp"
#include "commands.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/results/result_file.hpp"
#include "run_export.hpp"

namespace railtab::vsi {
namespace po = boost::program_options;
namespace {

constexpr std::size_t standard_instants = 101, most_instants = 10'000;

std::size_t nearest_record(const std::vector<StepRecord>& steps, double time) {
  const auto after =
      std::lower_bound(steps.begin(), steps.end(), time, [](const StepRecord& s, double t) { return s.time < t; });
  if (after == steps.begin()) return 0;
  const auto before = after - 1;
  const bool later = after != steps.end() && after->time - time < time - before->time;
  return static_cast<std::size_t>((later ? after : before) - steps.begin());
}

/// "0.5,1.0,1.5"
std::vector<std::size_t> at_times(const std::vector<StepRecord>& steps, std::string_view list) {
  std::vector<std::size_t> records;
  const double last_spacing = steps.size() > 1 ? steps.back().time - (steps.end() - 2)->time : 0.0;
  while (true) {
    const std::size_t comma = list.find(',');
    const std::string_view text = list.substr(0, comma);
    const std::optional<double> time = parse_number(text);
    if (!time || *time < steps.front().time - last_spacing || *time > steps.back().time + last_spacing) {
      throw input_error("--times", fmt::format("'{}'", text),
                        fmt::format("times within the records, {:.6g} to {:.6g} s, with commas between them",
                                    steps.front().time, steps.back().time));
    }
    records.push_back(nearest_record(steps, *time));
    if (comma == std::string_view::npos) break;
    list.remove_prefix(comma + 1);
  }
  return records;
}

std::vector<std::size_t> at_intervals(const std::vector<StepRecord>& steps, double interval) {
  if (!(std::isfinite(interval) && interval > 0.0)) {
    throw input_error("--every", fmt::format("{} s", interval), "a time above 0 s");
  }
  const double first = steps.front().time, length = steps.back().time - first;
  const auto last = static_cast<double>(steps.size() - 1);
  if (length > 0.0 && interval < length / last) {  // every record
    interval = length / last;
  }
  std::vector<std::size_t> records;
  for (double k = 0.0; first + k * interval <= steps.back().time + 1e-9 * length; k += 1.0) {
    records.push_back(nearest_record(steps, first + k * interval));
  }
  return records;
}

std::vector<std::size_t> chosen_records(const CommandLine& line, const std::vector<StepRecord>& steps) {
  if (line.given("times") && line.given("every")) {
    throw input_error("--every", "--times too", "one of them");
  }
  std::vector<std::size_t> records;
  if (line.given("times")) {
    records = at_times(steps, line.text("times"));
  } else if (line.given("every")) {
    records = at_intervals(steps, line.number("every"));
  } else {
    const std::size_t count = std::min(standard_instants, steps.size());
    for (std::size_t i = 0; i < count; ++i) {
      records.push_back(count == 1 ? 0 : i * (steps.size() - 1) / (count - 1));
    }
  }
  std::sort(records.begin(), records.end());
  records.erase(std::unique(records.begin(), records.end()), records.end());
  if (records.size() > most_instants) {
    throw input_error(line.given("times") ? "--times" : "--every", fmt::format("{} instants", records.size()),
                      fmt::format("at most {}: a longer interval", most_instants));
  }
  return records;
}

double chosen_scale(const CommandLine& line) {
  const double scale = line.number("scale");
  constexpr double most = 1e6;
  if (scale >= 0.0 && scale <= most) return scale;
  throw input_error("--scale", fmt::format("{}", scale), fmt::format("0 to {:g}", most));
}

void print_summary(const vtk::ExportSummary& summary, const vtk::ExportPlace& place, const RunResults& results,
                   const vtk::ExportOptions& options) {
  print_formatted("Export: {}, {} files in {}\n", place.collection.string(), summary.files, place.folder.string());
  print_formatted("  parts: {}\n", fmt::join(summary.parts, ", "));
  print_formatted("  {} of {} records, t = {:.6g} to {:.6g} s; displacement scale {:g}\n", options.records.size(),
                  results.steps.size(), results.steps[options.records.front()].time,
                  results.steps[options.records.back()].time, options.scale);
  for (const std::string& missing : summary.not_recorded) print_formatted("  not recorded: {}\n", missing);
}

}  // namespace

int export_command(const Arguments& arguments) {
  po::options_description own("Options");
  own.add_options()("results", text_value()->value_name("RESULTS.h5"), "results of a run")  //
      ("output,o", text_value()->value_name("FILE.pvd|FOLDER"),
       "collection for ParaView, with a folder of its name beside it; or a folder for all; absent: the name of the "
       "results, in the current folder")                                                                     //
      ("times", text_value()->value_name("T1,T2,..."), "instants [s], of each the nearest record")           //
      ("every", text_value()->value_name("DT"), "instants DT apart [s]; absent: 101 evenly spaced records")  //
      ("scale", text_value("1")->value_name("S"), "points are placed at rest + S times their displacement")  //
      ("z-up", "x forward, y left, z up, in place of railtab's x forward, y right, z down");
  const CommandLine line("vsi export RESULTS.h5 [-o FILE.pvd|FOLDER] [--times ...|--every DT] [--scale S] [--z-up]",
                         own, {"results"}, arguments);
  if (line.help_printed()) return 0;
  const std::string file = line.required("results");
  const std::string output =
      line.given("output") ? line.text("output") : std::filesystem::path(file).stem().string() + ".pvd";
  require_fitting_name(output, "-o", "a collection for ParaView, or a folder", {".pvd"});
  const vtk::ExportPlace place = vtk::export_place(output);
  require_writable_place(place.folder.string() + ".part", "-o");
  vtk::ExportOptions options;
  options.scale = chosen_scale(line);
  options.z_up = line.given("z-up");
  const RunResults results = read_results(file);
  if (results.steps.empty()) {
    throw input_error(file, "no record", "results with one: the run had ended before its first step was done");
  }
  options.records = chosen_records(line, results.steps);
  const vtk::ExportSummary summary = vtk::write_export(results, options, place);
  if (line.json()) {
    print_json_line({{"collection", place.collection.string()},
                     {"folder", place.folder.string()},
                     {"files", summary.files},
                     {"parts", summary.parts},
                     {"instants", options.records.size()},
                     {"displacement_scale", options.scale},
                     {"not_recorded", summary.not_recorded}});
  } else if (!line.quiet()) {
    print_summary(summary, place, results, options);
  }
  return 0;
}

}  // namespace railtab::vsi
