#include <fmt/format.h>

#include <array>
#include <charconv>
#include <filesystem>

#include "command/json_text.hpp"
#include "command/print.hpp"
#include "command/progress_bar.hpp"
#include "commands.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/tablegen/creep_job.hpp"
#include "railtab/tables/files/array_file.hpp"
#include "railtab/tables/files/creep_table_file.hpp"
#include "table_command_line.hpp"

namespace railtab {

namespace {

namespace po = boost::program_options;

po::options_description creep_options() {
  po::options_description own("Options");
  own.add_options()("poisson", text_value("0.28")->value_name("NU"),
                    "Poisson's ratio that the table serves, 0..0.5")  //
      ("elements", text_value("40")->value_name("N"),
       "of the exact solution along each axis, even; extrapolated from N/2 and N")           //
      ("layout", text_value("default")->value_name("default|paper"), "layout of the nodes")  //
      ("nodes", po::value<std::string>()->value_name("R,T,A,B"),
       "of the default layout along a/b, radius, polar angle, azimuth; 5..200 each")                           //
      ("tolerance", text_value("1e-6")->value_name("T"), "on the residual of each solution")                   //
      ("shard", po::value<std::string>()->value_name("I/N"), "solve one of N parts only, for tablegen merge")  //
      ("output,o", po::value<std::string>()->value_name("FILE.h5"), "the table, or the shard");
  return own;
}

/// "R,T,A,B". @throws InputError
std::array<int, 4> parse_nodes(const std::string& text) {
  std::array<int, 4> nodes{};
  const char* at = text.data();
  const char* const end = at + text.size();
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const auto [stop, error] = std::from_chars(at, end, nodes[i]);
    const bool last = i + 1 == nodes.size();
    if (error != std::errc{} || (last ? stop != end : stop == end || *stop != ',')) {
      throw input_error("--nodes", fmt::format("\"{}\"", text), "R,T,A,B, four whole numbers");
    }
    at = stop + 1;
  }
  return nodes;
}

CreepJob creep_job(const TableCommandLine& line) {
  CreepJob job;
  job.layout.layout = creep_table_layout(line.text("layout"));
  job.layout.poisson = line.number("poisson");
  job.layout.elements = static_cast<int>(line.whole_number("elements", 8, 240));
  job.tolerance = line.number("tolerance");
  if (line.given("nodes")) {
    if (job.layout.layout == CreepTableLayout::paper) {
      throw input_error("--nodes", "a grid", "none with --layout paper, whose grid is fixed");
    }
    job.layout.nodes = parse_nodes(line.text("nodes"));
  }
  if (line.given("shard")) job.shard = line.shard("shard");
  job.validate();
  return job;
}

}  // namespace

void creep_command(const std::vector<std::string>& arguments) {
  const TableCommandLine line("tablegen creep [options] -o FILE.h5", creep_options(), {}, arguments);
  if (line.help_printed()) return;
  const std::string file = line.required("output");
  require_output(file, {creep_table_filetype, creep_shard_filetype});
  const CreepJob job = creep_job(line);
  ProgressBar bar("creep table", !line.quiet());
  const CreepJobOutcome done =
      run_creep_job(job, file, provenance("creep", arguments), [&](double share) { bar.show(share); });
  const std::size_t solved = done.cases - done.resumed;
  const double rate = done.seconds > 0.0 ? static_cast<double>(solved) / done.seconds : 0.0;
  if (line.json()) {
    nlohmann::ordered_json j{{"kind", job.shard ? "creep-shard" : "creep"},
                             {"file", file},
                             {"layout", creep_table_layout_name(job.layout.layout)},
                             {"poisson", job.layout.poisson},
                             {"elements", job.layout.elements},
                             {"cases", done.cases},
                             {"cases_resumed", done.resumed},
                             {"seconds", done.seconds},
                             {"cases_per_second", rate},
                             {"residual_max", done.worst_residual},
                             {"safe_method_cases", done.safe_method},
                             {"file_bytes", std::filesystem::file_size(file)}};
    if (job.shard) {
      j["shard"] = {job.shard->index, job.shard->count};
    } else {
      j["checksum"] = array_file_checksum(file);
    }
    print_json(j);
  } else if (!line.quiet()) {
    print_formatted("{}: {} cases", file, done.cases);
    if (done.resumed > 0) print_formatted(", {} of them from an interrupted run", done.resumed);
    print_formatted(", {:.1f} s, {:.0f} cases per second\n  worst residual {:.2g}, {} cases by the safe method\n",
                    done.seconds, rate, done.worst_residual, done.safe_method);
  }
}

}  // namespace railtab
