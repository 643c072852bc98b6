// The functions of FMI 2.0 for co-simulation: arguments, phases, messages; no formulas.

#include <fmt/format.h>

#include <array>
#include <cctype>
#include <cmath>
#include <cstring>
#include <exception>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <iterator>
#include <new>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "fmi2.h"
#include "railtab/fmi/driven_track.hpp"
#include "railtab/fmi/track_simulation.hpp"
#include "railtab/runtime/base/input_error.hpp"

namespace railtab::fmi {
namespace {

constexpr const char* error_category = "logStatusError";

/// The importer's logger. A message is a format of printf in which "#" begins the name of a variable.
class Log {
 public:
  Log(const fmi2CallbackFunctions& callbacks, std::string instance)
      : callbacks_(callbacks), instance_(std::move(instance)) {}

  void error(std::string_view message) const {
    if (!callbacks_.logger) return;
    std::string text;
    for (char c : message) text.append(c == '%' || c == '#' ? 2 : 1, c);
    callbacks_.logger(callbacks_.componentEnvironment, instance_.c_str(), fmi2Error, error_category, text.c_str());
  }

 private:
  fmi2CallbackFunctions callbacks_;
  std::string instance_;
};

/// Phases of an instance, by their names in the standard.
enum class Phase { instantiated, initialization, stepping, terminated };
constexpr std::array<std::string_view, 4> phase_names{"instantiated", "initialization mode", "step complete",
                                                      "terminated"};

struct Instance {
  Log log;
  TrackSimulation track;
  Phase phase = Phase::instantiated;
  bool equilibrium_is_due = false;  ///< inputs were set since it was computed
  std::optional<double> stop{};     ///< [s]
};

/// fmi2OK; where `work` throws fmi2Error with a message, without memory for one fmi2Fatal: no exception leaves the
/// library.
template <class Work>
fmi2Status reported(const Log& log, std::string_view function, const Work& work) noexcept {
  try {
    work();
    return fmi2OK;
  } catch (const std::bad_alloc&) {
    return fmi2Fatal;
  } catch (const std::exception& failure) {
    log.error(fmt::format("{}: {}", function, failure.what()));
  } catch (...) {
    log.error(fmt::format("{}: an exception of unknown type", function));
  }
  return fmi2Error;
}

template <class Work>
fmi2Status on_instance(fmi2Component component, const char* function, const Work& work) noexcept {
  if (!component) return fmi2Error;
  auto& instance = *static_cast<Instance*>(component);
  return reported(instance.log, function, [&] { work(instance); });
}

fmi2Status unsupported(fmi2Component component, const char* function, std::string_view why) noexcept {
  return on_instance(component, function, [&](Instance&) { throw InputError(std::string(why)); });
}

/// @throws InputError where the instance is in another phase
void require_phase(const Instance& instance, std::initializer_list<Phase> allowed) {
  std::string expected;
  for (Phase phase : allowed) {
    if (instance.phase == phase) return;
    expected += fmt::format("{}{}", expected.empty() ? "" : " or ", phase_names[static_cast<std::size_t>(phase)]);
  }
  throw input_error("phase of the instance", phase_names[static_cast<std::size_t>(instance.phase)], expected);
}

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

TrackSimulation simulation(fmi2Type type, const char* guid, const char* resources) {
  if (type != fmi2CoSimulation) throw input_error("fmuType", "fmi2ModelExchange", "fmi2CoSimulation");
  const std::filesystem::path file = folder_of(resources ? resources : "") / "track";
  const std::string bytes = content_of(file), expected = track_guid(bytes);
  if (!guid || guid != expected) {
    throw input_error("fmuGUID", guid ? guid : "none", fmt::format("{}, that of {}", expected, file.string()));
  }
  return TrackSimulation(track_of_bytes(bytes, file.string()));
}

/// In initialization mode outputs follow the inputs, which may change again.
void settle(Instance& instance) {
  if (!instance.equilibrium_is_due) return;
  instance.track.rest();
  instance.equilibrium_is_due = false;
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

/// Values of types that the FMU has no variables of.
fmi2Status none_of_type(fmi2Component component, const char* function, std::size_t count) noexcept {
  if (count == 0) return on_instance(component, function, [](Instance&) {});
  return unsupported(component, function, "found a variable of this type, expected real ones only");
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

/// What fmi2FMUstate points to.
struct KeptState {
  TrackState track;
  Phase phase;
  bool equilibrium_is_due;
};

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

/// A state as numbers: phase, equilibrium_is_due, then packed().
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

}  // namespace
}  // namespace railtab::fmi

using namespace railtab::fmi;

const char* fmi2GetTypesPlatform() { return "default"; }
const char* fmi2GetVersion() { return "2.0"; }

fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid, fmi2String resources,
                              const fmi2CallbackFunctions* callbacks, fmi2Boolean, fmi2Boolean) {
  if (!callbacks) return nullptr;
  fmi2Component component = nullptr;
  const Log log(*callbacks, name ? name : "");
  static_cast<void>(reported(log, "fmi2Instantiate", [&] {
    component = new Instance{log, simulation(type, guid, resources)};
  }));
  return component;
}

void fmi2FreeInstance(fmi2Component component) { delete static_cast<Instance*>(component); }

// Errors are logged in any case; there are no other messages.
fmi2Status fmi2SetDebugLogging(fmi2Component component, fmi2Boolean, size_t count, const fmi2String categories[]) {
  return on_instance(component, "fmi2SetDebugLogging", [&](Instance&) {
    for (size_t i = 0; i < count; ++i) {
      const std::string_view category = categories[i] ? categories[i] : "";
      if (category != error_category) throw railtab::input_error("category", category, error_category);
    }
  });
}

fmi2Status fmi2SetupExperiment(fmi2Component component, fmi2Boolean, fmi2Real, fmi2Real start, fmi2Boolean stop_defined,
                               fmi2Real stop) {
  return on_instance(component, "fmi2SetupExperiment", [&](Instance& instance) {
    require_phase(instance, {Phase::instantiated});
    if (!std::isfinite(start)) {
      throw railtab::input_error("startTime", fmt::format("{}", start), "a finite time in s");
    }
    instance.track.begin_at(start);
    if (stop_defined) instance.stop = stop;
  });
}

fmi2Status fmi2EnterInitializationMode(fmi2Component component) {
  return on_instance(component, "fmi2EnterInitializationMode", [](Instance& instance) {
    require_phase(instance, {Phase::instantiated});
    instance.phase = Phase::initialization;
    instance.equilibrium_is_due = true;
  });
}

fmi2Status fmi2ExitInitializationMode(fmi2Component component) {
  return on_instance(component, "fmi2ExitInitializationMode", [](Instance& instance) {
    require_phase(instance, {Phase::initialization});
    settle(instance);
    instance.phase = Phase::stepping;
  });
}

fmi2Status fmi2Terminate(fmi2Component component) {
  return on_instance(component, "fmi2Terminate", [](Instance& instance) {
    require_phase(instance, {Phase::stepping});
    instance.phase = Phase::terminated;
  });
}

fmi2Status fmi2Reset(fmi2Component component) {
  return on_instance(component, "fmi2Reset", [](Instance& instance) {
    instance.track.reset();
    instance.phase = Phase::instantiated;
    instance.equilibrium_is_due = false;
    instance.stop.reset();
  });
}

fmi2Status fmi2GetReal(fmi2Component component, const fmi2ValueReference variables[], size_t count, fmi2Real values[]) {
  return on_instance(component, "fmi2GetReal", [&](Instance& instance) {
    settle(instance);
    for (size_t i = 0; i < count; ++i) {
      require_variable(instance, variables[i]);
      values[i] = instance.track.value(variables[i]);
    }
  });
}

fmi2Status fmi2SetReal(fmi2Component component, const fmi2ValueReference variables[], size_t count,
                       const fmi2Real values[]) {
  return on_instance(component, "fmi2SetReal", [&](Instance& instance) {
    require_phase(instance, {Phase::instantiated, Phase::initialization, Phase::stepping});
    for (size_t i = 0; i < count; ++i) {
      require_input(instance, variables[i]);
      instance.track.set(variables[i], values[i]);
    }
    instance.equilibrium_is_due = instance.phase == Phase::initialization;
  });
}

fmi2Status fmi2GetInteger(fmi2Component component, const fmi2ValueReference[], size_t count, fmi2Integer[]) {
  return none_of_type(component, "fmi2GetInteger", count);
}
fmi2Status fmi2GetBoolean(fmi2Component component, const fmi2ValueReference[], size_t count, fmi2Boolean[]) {
  return none_of_type(component, "fmi2GetBoolean", count);
}
fmi2Status fmi2GetString(fmi2Component component, const fmi2ValueReference[], size_t count, fmi2String[]) {
  return none_of_type(component, "fmi2GetString", count);
}
fmi2Status fmi2SetInteger(fmi2Component component, const fmi2ValueReference[], size_t count, const fmi2Integer[]) {
  return none_of_type(component, "fmi2SetInteger", count);
}
fmi2Status fmi2SetBoolean(fmi2Component component, const fmi2ValueReference[], size_t count, const fmi2Boolean[]) {
  return none_of_type(component, "fmi2SetBoolean", count);
}
fmi2Status fmi2SetString(fmi2Component component, const fmi2ValueReference[], size_t count, const fmi2String[]) {
  return none_of_type(component, "fmi2SetString", count);
}

fmi2Status fmi2GetFMUstate(fmi2Component component, fmi2FMUstate* state) {
  return on_instance(component, "fmi2GetFMUstate", [&](Instance& instance) {
    keep({instance.track.state(), instance.phase, instance.equilibrium_is_due}, state);
  });
}

fmi2Status fmi2SetFMUstate(fmi2Component component, fmi2FMUstate state) {
  return on_instance(component, "fmi2SetFMUstate", [&](Instance& instance) {
    const KeptState& of = kept(state);
    instance.track.set_state(of.track);
    instance.phase = of.phase;
    instance.equilibrium_is_due = of.equilibrium_is_due;
  });
}

fmi2Status fmi2FreeFMUstate(fmi2Component component, fmi2FMUstate* state) {
  return on_instance(component, "fmi2FreeFMUstate", [&](Instance&) {
    if (!state) return;
    delete static_cast<KeptState*>(*state);
    *state = nullptr;
  });
}

fmi2Status fmi2SerializedFMUstateSize(fmi2Component component, fmi2FMUstate state, size_t* size) {
  return on_instance(component, "fmi2SerializedFMUstateSize",
                     [&](Instance&) { *size = sizeof(double) * numbers_of(kept(state)).size(); });
}

fmi2Status fmi2SerializeFMUstate(fmi2Component component, fmi2FMUstate state, fmi2Byte bytes[], size_t size) {
  return on_instance(component, "fmi2SerializeFMUstate", [&](Instance&) {
    const std::vector<double> numbers = numbers_of(kept(state));
    const size_t needed = sizeof(double) * numbers.size();
    if (size < needed) {
      throw railtab::input_error("serialized state", fmt::format("{} bytes", size), fmt::format("{}", needed));
    }
    std::memcpy(bytes, numbers.data(), needed);
  });
}

fmi2Status fmi2DeSerializeFMUstate(fmi2Component component, const fmi2Byte bytes[], size_t size, fmi2FMUstate* state) {
  return on_instance(component, "fmi2DeSerializeFMUstate", [&](Instance& instance) {
    std::vector<double> numbers(size / sizeof(double));
    std::memcpy(numbers.data(), bytes, sizeof(double) * numbers.size());
    keep(state_of(std::move(numbers), instance.track.state()), state);
  });
}

fmi2Status fmi2GetDirectionalDerivative(fmi2Component component, const fmi2ValueReference[], size_t,
                                        const fmi2ValueReference[], size_t, const fmi2Real[], fmi2Real[]) {
  return unsupported(component, "fmi2GetDirectionalDerivative", "not supported (providesDirectionalDerivative)");
}

fmi2Status fmi2SetRealInputDerivatives(fmi2Component component, const fmi2ValueReference[], size_t, const fmi2Integer[],
                                       const fmi2Real[]) {
  return unsupported(component, "fmi2SetRealInputDerivatives", "not supported (canInterpolateInputs)");
}

fmi2Status fmi2GetRealOutputDerivatives(fmi2Component component, const fmi2ValueReference[], size_t,
                                        const fmi2Integer[], fmi2Real[]) {
  return unsupported(component, "fmi2GetRealOutputDerivatives", "not supported (maxOutputDerivativeOrder)");
}

fmi2Status fmi2DoStep(fmi2Component component, fmi2Real time, fmi2Real step, fmi2Boolean) {
  return on_instance(component, "fmi2DoStep", [&](Instance& instance) { do_step(instance, time, step); });
}

fmi2Status fmi2CancelStep(fmi2Component component) {
  return unsupported(component, "fmi2CancelStep", "not supported (canRunAsynchronuously)");
}

fmi2Status fmi2GetStatus(fmi2Component component, fmi2StatusKind, fmi2Status*) {
  return unsupported(component, "fmi2GetStatus", "steps end before fmi2DoStep returns");
}

fmi2Status fmi2GetRealStatus(fmi2Component component, fmi2StatusKind kind, fmi2Real* value) {
  return on_instance(component, "fmi2GetRealStatus", [&](Instance& instance) {
    if (kind != fmi2LastSuccessfulTime) {
      throw railtab::input_error("kind", fmt::format("{}", static_cast<int>(kind)), "fmi2LastSuccessfulTime");
    }
    *value = instance.track.time();
  });
}

fmi2Status fmi2GetIntegerStatus(fmi2Component component, fmi2StatusKind, fmi2Integer*) {
  return unsupported(component, "fmi2GetIntegerStatus", "no status of this type");
}

// No step ends a simulation.
fmi2Status fmi2GetBooleanStatus(fmi2Component component, fmi2StatusKind kind, fmi2Boolean* value) {
  return on_instance(component, "fmi2GetBooleanStatus", [&](Instance&) {
    if (kind != fmi2Terminated) {
      throw railtab::input_error("kind", fmt::format("{}", static_cast<int>(kind)), "fmi2Terminated");
    }
    *value = 0;
  });
}

fmi2Status fmi2GetStringStatus(fmi2Component component, fmi2StatusKind, fmi2String*) {
  return unsupported(component, "fmi2GetStringStatus", "no status of this type");
}
