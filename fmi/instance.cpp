#include "instance.hpp"

#include <array>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <utility>

#include "railtab/fmi/driven_track.hpp"
#include "railtab/runtime/base/input_error.hpp"

namespace railtab::fmi {
namespace {

constexpr std::array<std::string_view, 4> phase_names{"instantiated", "initialization mode", "step complete",
                                                      "terminated"};

/// The folder that a URI names, "file:///tmp/a%20b".
std::filesystem::path folder_of(std::string_view uri) {
  constexpr std::string_view scheme = "file:";
  const auto wrong = [&] { return input_error("fmuResourceLocation", uri, "the URI of a local folder, file:///..."); };
  if (!uri.starts_with(scheme)) throw wrong();
  std::string_view rest = uri.substr(scheme.size());
  if (rest.starts_with("//")) {  // a host follows, none or this one
    rest.remove_prefix(2);
    const std::string_view host = rest.substr(0, rest.find('/'));
    if (!host.empty() && host != "localhost") throw wrong();
    rest.remove_prefix(host.size());
  }
  std::string path;
  for (std::size_t i = 0; i < rest.size(); ++i) {
    if (rest[i] != '%') {
      path += rest[i];
      continue;
    }
    const std::string digits(rest.substr(i + 1, 2));
    std::size_t used = 0;
    if (digits.size() == 2 && std::isxdigit(static_cast<unsigned char>(digits[0]))) {
      path += static_cast<char>(std::stoi(digits, &used, 16));
    }
    if (used != 2) throw wrong();
    i += 2;
  }
  return path;
}

std::string content_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(stream), {}};
  if (!stream) throw input_error(file.string(), "no file that can be read", "resources/track of the unpacked FMU");
  return bytes;
}

}  // namespace

Log::Log(const fmi2CallbackFunctions& callbacks, std::string instance)
    : callbacks_(callbacks), instance_(std::move(instance)) {}

void Log::error(std::string_view message) const {
  if (!callbacks_.logger) return;
  std::string text;
  for (char c : message) text.append(c == '%' || c == '#' ? 2 : 1, c);
  callbacks_.logger(callbacks_.componentEnvironment, instance_.c_str(), fmi2Error, error_category, text.c_str());
}

fmi2Status unsupported(fmi2Component component, std::string_view function, std::string_view why) noexcept {
  return on_instance(component, function, [&](Instance&) { throw InputError(std::string(why)); });
}

fmi2Status none_of_type(fmi2Component component, std::string_view function, std::size_t count) noexcept {
  if (count == 0) return on_instance(component, function, [](Instance&) {});
  return unsupported(component, function, "found a variable of this type, expected real ones only");
}

TrackSimulation simulation_of(fmi2Type type, const char* guid, const char* resources) {
  if (type != fmi2CoSimulation) throw input_error("fmuType", "fmi2ModelExchange", "fmi2CoSimulation");
  const std::filesystem::path file = folder_of(resources ? resources : "") / "track";
  const std::string bytes = content_of(file), expected = track_guid(bytes);
  if (!guid || guid != expected) {
    throw input_error("fmuGUID", guid ? guid : "none", fmt::format("{}, that of {}", expected, file.string()));
  }
  return TrackSimulation(track_of_bytes(bytes, file.string()));
}

void require_phase(const Instance& instance, std::initializer_list<Phase> allowed) {
  std::string expected;
  for (Phase phase : allowed) {
    if (instance.phase == phase) return;
    expected += fmt::format("{}{}", expected.empty() ? "" : " or ", phase_names[static_cast<std::size_t>(phase)]);
  }
  throw input_error("phase of the instance", phase_names[static_cast<std::size_t>(instance.phase)], expected);
}

void require_input(const Instance& instance, fmi2ValueReference variable) {
  if (variable < instance.track.inputs()) return;
  throw input_error("value reference", fmt::format("{}", variable),
                    fmt::format("an input, 0 to {}", instance.track.inputs() - 1));
}

void require_variable(const Instance& instance, fmi2ValueReference variable) {
  const std::size_t count = instance.track.variables().size();
  if (variable < count) return;
  throw input_error("value reference", fmt::format("{}", variable), fmt::format("0 to {}", count - 1));
}

void settle(Instance& instance) {
  if (!instance.equilibrium_is_due) return;
  instance.track.rest();
  instance.equilibrium_is_due = false;
}

void do_step(Instance& instance, double time, double step) {
  constexpr double rounding = 1e-3;  // of a step, by an importer that sums up steps
  require_phase(instance, {Phase::stepping});
  const double now = instance.track.time();
  if (!(std::abs(time - now) <= rounding * instance.track.time_step())) {
    throw input_error("currentCommunicationPoint", fmt::format("{} s", time),
                      fmt::format("{} s, the end of the last step", now));
  }
  if (instance.stop && time + step > *instance.stop + rounding * instance.track.time_step()) {
    throw input_error("communicationStepSize", fmt::format("a step to {} s", time + step),
                      fmt::format("none beyond the stop time, {} s", *instance.stop));
  }
  instance.track.step(step);
}

KeptState& kept(fmi2FMUstate state) {
  if (!state) throw input_error("FMUstate", "none", "one of fmi2GetFMUstate");
  return *static_cast<KeptState*>(state);
}

void keep(KeptState state, fmi2FMUstate* place) {
  if (!place) throw input_error("FMUstate", "none", "a place for it");
  if (*place) {
    kept(*place) = std::move(state);
  } else {
    *place = new KeptState(std::move(state));
  }
}

// Phase, equilibrium_is_due, then packed().
std::vector<double> numbers_of(const KeptState& state) {
  std::vector<double> numbers = packed(state.track);
  numbers.insert(numbers.begin(), {static_cast<double>(state.phase), state.equilibrium_is_due ? 1.0 : 0.0});
  return numbers;
}

KeptState state_of(std::vector<double> numbers, const TrackState& like) {
  if (numbers.size() < 2 || !(numbers[0] >= 0.0 && numbers[0] < phase_names.size())) {
    throw input_error("serialized state", "other bytes", "those of fmi2SerializeFMUstate");
  }
  const auto phase = static_cast<Phase>(static_cast<int>(numbers[0]));
  const bool due = numbers[1] != 0.0;
  numbers.erase(numbers.begin(), numbers.begin() + 2);
  return {unpacked(numbers, like), phase, due};
}

}  // namespace railtab::fmi
