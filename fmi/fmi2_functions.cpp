// The functions of FMI 2.0 for co-simulation: arguments and phases; no formulas.

#include <cmath>
#include <cstring>
#include <utility>
#include <vector>

#include "fmi2.h"
#include "instance.hpp"
#include "railtab/runtime/base/input_error.hpp"

using railtab::input_error;
using railtab::fmi::error_category;
using railtab::fmi::Instance;
using railtab::fmi::keep;
using railtab::fmi::kept;
using railtab::fmi::KeptState;
using railtab::fmi::Log;
using railtab::fmi::none_of_type;
using railtab::fmi::numbers_of;
using railtab::fmi::on_instance;
using railtab::fmi::Phase;
using railtab::fmi::reported;
using railtab::fmi::require_input;
using railtab::fmi::require_phase;
using railtab::fmi::require_variable;
using railtab::fmi::settle;
using railtab::fmi::state_of;
using railtab::fmi::unsupported;

const char* fmi2GetTypesPlatform() { return "default"; }
const char* fmi2GetVersion() { return "2.0"; }

fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid, fmi2String resources,
                              const fmi2CallbackFunctions* callbacks, fmi2Boolean, fmi2Boolean) {
  if (!callbacks) return nullptr;
  try {
    fmi2Component component = nullptr;
    const Log log(*callbacks, name ? name : "");
    static_cast<void>(reported(log, "fmi2Instantiate", [&] {
      component = new Instance{log, railtab::fmi::simulation_of(type, guid, resources)};
    }));
    return component;
  } catch (const std::bad_alloc&) {  // of the log
    return nullptr;
  }
}

void fmi2FreeInstance(fmi2Component component) { delete static_cast<Instance*>(component); }

fmi2Status fmi2SetDebugLogging(fmi2Component component, fmi2Boolean, size_t count, const fmi2String categories[]) {
  return on_instance(component, "fmi2SetDebugLogging", [&](Instance&) {
    for (size_t i = 0; i < count; ++i) {
      const std::string_view category = categories[i] ? categories[i] : "";
      if (category != error_category) throw input_error("category", category, error_category);
    }
  });
}

fmi2Status fmi2SetupExperiment(fmi2Component component, fmi2Boolean, fmi2Real, fmi2Real start, fmi2Boolean stop_defined,
                               fmi2Real stop) {
  return on_instance(component, "fmi2SetupExperiment", [&](Instance& instance) {
    require_phase(instance, {Phase::instantiated});
    if (!std::isfinite(start)) {
      throw input_error("startTime", fmt::format("{}", start), "a finite time in s");
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
    instance.equilibrium_is_due = instance.phase == Phase::initialization;  // also where a later value is wrong
    for (size_t i = 0; i < count; ++i) {
      require_input(instance, variables[i]);
      instance.track.set(variables[i], values[i]);
    }
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
      throw input_error("serialized state", fmt::format("{} bytes", size), fmt::format("{}", needed));
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
  return on_instance(component, "fmi2DoStep", [&](Instance& instance) { railtab::fmi::do_step(instance, time, step); });
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
      throw input_error("kind", fmt::format("{}", static_cast<int>(kind)), "fmi2LastSuccessfulTime");
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
      throw input_error("kind", fmt::format("{}", static_cast<int>(kind)), "fmi2Terminated");
    }
    *value = 0;
  });
}

fmi2Status fmi2GetStringStatus(fmi2Component component, fmi2StatusKind, fmi2String*) {
  return unsupported(component, "fmi2GetStringStatus", "no status of this type");
}
