#include <fmt/format.h>
#include <cstdlib>

#include <cstdio>
#include <exception>
#include <filesystem>
#include <new>
#include <string_view>

#include "commands.hpp"
#include "railtab/tables/input_error.hpp"
#include "railtab/tables/text_file.hpp"

namespace railtab::vsi {
namespace {

constexpr int done = 0, failed = 1, wrong_input = 2;

constexpr const char* usage =
    "usage: vsi COMMAND [OPTIONS]; vsi COMMAND --help says more\n"
    "  contact TABLE.h5 --query Q.csv -o R.csv [--online]     contact patches of a wheelset's positions\n"
    "  creep   --query Q.csv -o R.csv [--law LAW]             normalised creep forces\n"
    "  run     SCENE.toml [-o RESULTS.h5]                     run a train over a track or bridge\n"
    "  sweep   SCENE.toml --speed LO:HI:STEP -o DIR           the same over speeds and random tracks\n"
    "  report  RESULTS.h5 -o REPORT.html                      the results as one page\n"
    "  structure SCENE.toml [--modes N]                       mass, extent and natural frequencies of its bridge\n";

int dispatch(const Arguments& arguments) {
  if (arguments.empty()) throw InputError(fmt::format("no command\n{}", usage));
  const std::string_view name = arguments.front();
  const Arguments rest(arguments.begin() + 1, arguments.end());
  if (name == "contact") return contact_command(rest);
  if (name == "creep") return creep_command(rest);
  if (name == "run") return run_command(rest);
  if (name == "sweep") return sweep_command(rest);
  if (name == "report") return report_command(rest);
  if (name == "structure") return structure_command(rest);
  if (name == "--help" || name == "-h") {
    fmt::print("{}", usage);
    return done;
  }
  if (name == "--version") {
    fmt::print("railtab {}\n", RAILTAB_VERSION);
    return done;
  }
  throw InputError(fmt::format("unknown command '{}'\n{}", name, usage));
}

int exit_code(const Arguments& arguments) {
  try {
    return dispatch(arguments);
  } catch (const InputError& wrong) {
    fmt::print(stderr, "vsi: {}\n", wrong.what());
    return wrong_input;
  } catch (const std::filesystem::filesystem_error& refused) {
    fmt::print(stderr, "vsi: {}: {}\n", refused.path1().string(), refused.code().message());
    return is_wrong_name(refused.code()) ? wrong_input : failed;
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "vsi: not enough memory\n");
    return failed;
  } catch (const std::exception& failure) {
    fmt::print(stderr, "vsi: {}\n", failure.what());
    return failed;
  }
}

}  // namespace
}  // namespace railtab::vsi

int main(int argc, char** argv) {
  int code = railtab::vsi::exit_code({argv + 1, argv + argc});
  // What was asked for on standard output has to have arrived there.
  if (code == 0 && (std::fflush(stdout) != 0 || std::ferror(stdout) != 0)) {
    std::fputs("vsi: standard output could not be written\n", stderr);
    code = 1;
  }
  if (code == 0) return 0;
  // What HDF5 could not write or read it keeps open, and its own clean-up at the end of a process crashes on a full
  // disk and complains of damaged files: every file has been closed as far as it can be, so leave without it.
  std::fflush(nullptr);
  std::_Exit(code);
}
