#pragma once

#include <functional>
#include <string>
#include <vector>

namespace railtab::stability {

/// How a stiff or extreme case may end.
enum class Outcome {
  converged,  ///< to its end, and within its stated error
  ended,      ///< before its end, with a message and the results so far
  refused,    ///< before it began, with a message
  wrong,      ///< none of these: to its end beyond the stated error, or ended without a word, or not finite
};
[[nodiscard]] const char* outcome_name(Outcome outcome) noexcept;

struct CaseResult {
  Outcome outcome = Outcome::wrong;
  double error = 0.0;     ///< what `StabilityCase::measure` names
  double seconds = 0.0;   ///< processor time
  long steps = 0;         ///< of a run
  long halved_steps = 0;  ///< of a run
  std::string note{};     ///< the message of a case that was refused or ended; what else is worth knowing
};

/// One cell of the matrix.
struct StabilityCase {
  std::string group;    ///< "contact stiffness and time step"
  std::string setting;  ///< "K_h x 1000, 1e-4 s"
  std::string measure;  ///< of the error
  double allowed;       ///< the stated error
  Outcome expected;
  bool quick;  ///< part of the reduced matrix
  std::function<CaseResult(double allowed)> run;
};

/// Cases of runs: train on track.
[[nodiscard]] std::vector<StabilityCase> run_cases();
/// Cases of the contact's parts: Hertz's ellipse, creep laws, profiles.
[[nodiscard]] std::vector<StabilityCase> contact_cases();
[[nodiscard]] std::vector<StabilityCase> all_cases();

/// Whether an outcome is the expected one, or better: to the end where an early end was expected.
[[nodiscard]] bool as_expected(const StabilityCase& one, const CaseResult& result) noexcept;

/// Runs a case; what it throws becomes its outcome: an InputError is a refusal, anything else is wrong.
[[nodiscard]] CaseResult outcome_of(const StabilityCase& one);

}  // namespace railtab::stability
