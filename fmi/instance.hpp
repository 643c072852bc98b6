#pragma once

#include <fmt/format.h>

#include <exception>
#include <initializer_list>
#include <new>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fmi2.h"
#include "railtab/fmi/track_simulation.hpp"

namespace railtab::fmi {

/// The one category of messages.
inline constexpr const char* error_category = "logStatusError";

/// The importer's logger. Errors are logged in any case; there are no other messages.
class Log {
 public:
  Log(const fmi2CallbackFunctions& callbacks, std::string instance);
  /// A message, which becomes a format of printf in which "#" begins the name of a variable.
  void error(std::string_view message) const;

 private:
  fmi2CallbackFunctions callbacks_;
  std::string instance_;
};

/// Phases of an instance (4.2.4): instantiated, initialization mode, step complete, terminated.
enum class Phase { instantiated, initialization, stepping, terminated };

/// What fmi2Component points to.
struct Instance {
  Log log;
  TrackSimulation track;
  Phase phase = Phase::instantiated;
  bool equilibrium_is_due = false;  ///< inputs were set in initialization mode since it was computed
  std::optional<double> stop{};     ///< [s]
};

/// What fmi2FMUstate points to.
struct KeptState {
  TrackState track;
  Phase phase;
  bool equilibrium_is_due;
};

/// fmi2Error with a message; without memory for it fmi2Fatal.
inline fmi2Status failed(const Log& log, std::string_view function, std::string_view why) noexcept {
  try {
    log.error(fmt::format("{}: {}", function, why));
    return fmi2Error;
  } catch (...) {
    return fmi2Fatal;
  }
}

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
    return failed(log, function, failure.what());
  } catch (...) {
    return failed(log, function, "an exception of unknown type");
  }
}

/// The same of work on an instance; fmi2Error where there is none.
template <class Work>
fmi2Status on_instance(fmi2Component component, std::string_view function, const Work& work) noexcept {
  if (!component) return fmi2Error;
  auto& instance = *static_cast<Instance*>(component);
  return reported(instance.log, function, [&] { work(instance); });
}

/// fmi2Error with this message.
fmi2Status unsupported(fmi2Component component, std::string_view function, std::string_view why) noexcept;
/// Values of types that the FMU has no variables of: fmi2Error, fmi2OK for no value.
fmi2Status none_of_type(fmi2Component component, std::string_view function, std::size_t count) noexcept;

/// Of the arguments of fmi2Instantiate. @throws InputError where they are not those of a slave of this FMU
[[nodiscard]] TrackSimulation simulation_of(fmi2Type type, const char* guid, const char* resources);

/// @throws InputError where the instance is in another phase
void require_phase(const Instance& instance, std::initializer_list<Phase> allowed);
/// @throws InputError where the value reference is none of an input, of a variable
void require_input(const Instance& instance, fmi2ValueReference variable);
void require_variable(const Instance& instance, fmi2ValueReference variable);

/// Computes the equilibrium where it is due: in initialization mode outputs follow the inputs, which may change again.
void settle(Instance& instance);
/// A communication step from `time` [s]. @throws InputError where it does not follow the last one
void do_step(Instance& instance, double time, double step);

/// @throws InputError where there is none
[[nodiscard]] KeptState& kept(fmi2FMUstate state);
/// Puts a state where there is one already, or a new one.
void keep(KeptState state, fmi2FMUstate* place);
/// A state as numbers, and back. @param like a state of the same track @throws InputError where it is none of it
[[nodiscard]] std::vector<double> numbers_of(const KeptState& state);
[[nodiscard]] KeptState state_of(std::vector<double> numbers, const TrackState& like);

}  // namespace railtab::fmi
