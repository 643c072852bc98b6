#include <fmt/format.h>

#include <optional>

#include "command/json_text.hpp"
#include "command/print.hpp"
#include "command/progress_bar.hpp"
#include "commands.hpp"
#include "creep_report.hpp"
#include "railtab/runtime/base/in_file.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/tablegen/loaded_verification.hpp"
#include "railtab/tables/files/array_file.hpp"
#include "railtab/tables/files/creep_table_file.hpp"
#include "railtab/tables/files/geometry_table_file.hpp"
#include "table_command_line.hpp"

namespace railtab {

namespace {

template <class Verification>
nlohmann::ordered_json errors_json(const Verification& v) {
  nlohmann::ordered_json j;
  for (const auto& [quantity, errors] : v.errors()) {
    for (const auto& [name, value] : errors->named()) j[std::string(quantity)][std::string(name)] = value;
  }
  return j;
}

template <class Verification>
std::string errors_text(std::string_view heading, const Verification& v) {
  std::string out =
      fmt::format("{:24}{:>11}{:>11}{:>11}{:>11}{:>11}{:>11}\n", heading, "mean", "p50", "p95", "p99", "p99.9", "max");
  for (const auto& [quantity, errors] : v.errors()) {
    out += fmt::format("{:24}", quantity);
    for (const auto& [name, value] : errors->named()) out += fmt::format("{:11.2e}", value);
    out += '\n';
  }
  return out;
}

nlohmann::ordered_json description(const GeometryVerification& v) {
  nlohmann::ordered_json j;
  j["kind"] = "geometry";
  j["samples"] = v.samples;
  j["answered_by_table"] = v.answered_by_table;
  j["never_touching"] = v.never_touching;
  j["patches_compared"] = v.patches_compared;
  j["fallback_share"] = v.fallback_share;
  j["searched_share"] = v.searched_share;
  j["patch_mismatch_share"] = v.patch_mismatch_share;
  j["finer_mismatch_share"] = v.finer_mismatch_share;
  j["outline_mismatch_share"] = v.outline_mismatch_share;
  j["outline_in_band_share"] = v.outline_in_band_share;
  j["error"] = errors_json(v);
  j["time_ns"] = {{"table", v.time_table_ns},
                  {"online", v.time_online_ns},
                  {"table_with_fallback", v.time_with_fallback_ns},
                  {"paper", v.time_paper_ns}};
  j["bytes"] = v.bytes;
  return j;
}

std::string text(const GeometryVerification& v) {
  std::string out = fmt::format(
      "{} random queries, {} served by the table (fallback {:.3f} %; {:.2f} % with a short search), {} patches "
      "compared with the online search\n"
      "missed or spurious patches at {:.4f} % of the queries served ({:.4f} % against a finer search; against the "
      "exact "
      "overlap of the outlines {:.4f} %, and {:.4f} % with contacts shallower than 10 nm)\n\n",
      v.samples, v.answered_by_table, 100 * v.fallback_share, 100 * v.searched_share, v.patches_compared,
      100 * v.patch_mismatch_share, 100 * v.finer_mismatch_share, 100 * v.outline_mismatch_share,
      100 * v.outline_in_band_share);
  out += errors_text("error [m, rad, -]", v);
  out += fmt::format(
      "\ntime per query: table {:.0f} ns, online {:.0f} ns, table with fallback {:.0f} ns, "
      "point-discretised search with 1000 points {:.0f} ns\n",
      v.time_table_ns, v.time_online_ns, v.time_with_fallback_ns, v.time_paper_ns);
  return out;
}

nlohmann::ordered_json description(const LoadedVerification& v) {
  nlohmann::ordered_json j;
  j["samples"] = v.samples;
  j["answered"] = v.answered;
  j["above_5_kn"] = v.above_5_kn;
  j["from_1_to_5_kn"] = v.from_1_to_5_kn;
  j["error"] = errors_json(v);
  j["time_ns"] = v.time_ns;
  return j;
}

std::string text(const LoadedVerification& v) {
  std::string out = fmt::format(
      "\nloaded part: {} random poses, {} answered by the table alone; {} above 5 kN and {} from 1 to 5 kN compared "
      "with "
      "half-space solutions\n\n",
      v.samples, v.answered, v.above_5_kn, v.from_1_to_5_kn);
  out += errors_text("relative error", v);
  return out + fmt::format("\ntime per look-up: {:.0f} ns\n", v.time_ns);
}

void verify_creep(const TableCommandLine& line, const std::string& file) {
  line.reject({"dz", "loaded-samples", "modulus", "poisson"}, "a geometry table, or none of it");
  const TableCreep law =
      in_file(file, [&file] { return TableCreep{std::make_shared<const CreepTable>(read_creep_table(file))}; });
  CreepVerificationOptions options;
  options.samples = static_cast<int>(line.whole_number("samples", 1, 10'000'000));
  options.seed = static_cast<std::uint64_t>(line.whole_number("seed", 0, 1LL << 53));
  if (line.given("ratio")) options.ratio = line.interval("ratio");
  if (line.given("creepage")) options.creepage = line.interval("creepage");
  ProgressBar bar("verify", !line.quiet());
  const CreepVerification result = verify_creep_table(law, options, [&](double share) { bar.show(share); });
  if (line.json()) {
    print_json(verification_description(result));
  } else {
    print_formatted("{}", verification_text(result));
  }
}

void verify_geometry(const TableCommandLine& line, const std::string& file) {
  line.reject({"ratio", "creepage"}, "a creep table, or none of it");
  GeometryTableData table = read_geometry_table(file);
  std::optional<LoadedTableData> loaded = std::move(table.loaded);
  table.loaded.reset();
  const TableContact contact = in_file(file, [&] { return TableContact(GeometryTable(std::move(table))); });
  VerificationOptions options = verification_options(contact.table().data());
  options.samples = static_cast<int>(line.whole_number("samples", 1, 100'000'000));
  options.seed = static_cast<std::uint64_t>(line.whole_number("seed", 0, 1LL << 53));
  if (line.given("dz")) options.lowering = line.interval("dz");
  LoadedVerificationOptions check;
  if (loaded) {
    check.samples = static_cast<int>(line.whole_number("loaded-samples", 1, 10'000'000));
    check.seed = options.seed;
    check.material = {line.number("modulus"), line.number("poisson")};
    check.material.validate();
    if (!check.material.has_contact_modulus(loaded->contact_modulus)) {
      throw input_error(
          "--modulus, --poisson", fmt::format("{} Pa, {}", check.material.E, check.material.nu),
          fmt::format("those of the loaded part of {}, E/(2(1 - nu²)) = {} Pa", file, loaded->contact_modulus));
    }
  } else {
    line.reject({"loaded-samples", "modulus", "poisson"},
                "a table with a loaded part (tablegen loaded), or none of it");
  }
  ProgressBar bar("verify", !line.quiet());
  const GeometryVerification result = verify_geometry_table(contact, options, [&](double share) { bar.show(share); });
  std::optional<LoadedVerification> of_loaded;
  if (loaded) {
    ProgressBar loaded_bar("verify the loaded part", !line.quiet());
    of_loaded = verify_loaded_table(contact.search(), LoadedTable(std::move(*loaded)), check,
                                    [&](double share) { loaded_bar.show(share); });
  }
  if (line.json()) {
    nlohmann::ordered_json j = description(result);
    if (of_loaded) j["loaded"] = description(*of_loaded);
    print_json(j);
  } else {
    print_formatted("{}{}", text(result), of_loaded ? text(*of_loaded) : "");
  }
}

}  // namespace

void verify_command(const std::vector<std::string>& arguments) {
  namespace po = boost::program_options;
  po::options_description own("Options");
  own.add_options()("file", po::value<std::string>()->value_name("FILE.h5"), "a table")           //
      ("samples", text_value("10000")->value_name("N"), "random queries over the table's range")  //
      ("seed", text_value("1")->value_name("N"), "of the random numbers")                         //
      ("dz", po::value<std::string>()->value_name("LO:HI"),
       "geometry: lowering of the wheelset below first touch [m] (0:3e-4)")                                           //
      ("loaded-samples", text_value("500")->value_name("N"), "geometry: half-space solutions for its loaded part")    //
      ("modulus", text_value("210e9")->value_name("PA"), "geometry: Young's modulus of wheel and rail, loaded part")  //
      ("poisson", text_value("0.28")->value_name("NU"), "geometry: Poisson's ratio, loaded part")                     //
      ("ratio", po::value<std::string>()->value_name("LO:HI"), "creep: a/b, log-uniform (0.05:20)")                   //
      ("creepage", po::value<std::string>()->value_name("LO:HI"),
       "creep: size of (c11 ux/3, c22 uy/3, c23 phi), log-uniform (0.05:30)");
  const TableCommandLine line("tablegen verify FILE.h5 [options]", own, {"file"}, arguments);
  if (line.help_printed()) return;
  const std::string file = line.required("file");
  if (is_creep_table(file)) {
    verify_creep(line, file);
  } else {
    verify_geometry(line, file);
  }
}

}  // namespace railtab
