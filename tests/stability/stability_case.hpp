#pragma once

#include <functional>
#include <string>
#include <vector>

namespace railtab::stability {

/// How a stiff or extreme case may end.
enum class Outcome {
  converged,  ///< to its end, and within its stated error
  ended,      ///< before its end, with a message and the results so far
  rejected,   ///< before it began, with a message
  wrong,      ///< none of these: to its end beyond the stated error, or ended without a word, or not finite
};
[[nodiscard]] const char* outcome_name(Outcome outcome) noexcept;

/// What the time integration gains (positive) or loses of the energy, by the run's energy account.
struct EnergyResult {
  bool kept = false;  ///< the run keeps an account, and something moves
  /// Largest of a step, relative to the energy that the motion moves: the most of kinetic energy and of the changes of
  /// strain energy, potential and contact springs.
  double step = 0.0;
  double total = 0.0;  ///< of the run, relative to the same
  int impacts = 0;     ///< wheels that land after at least 2 ms in the air
  /// Largest that the contacts gain in an impact, relative to the most that their springs take up in it; of impacts
  /// with at least 1 % of the hardest one's energy.
  double impact = 0.0;
};

struct CaseResult {
  Outcome outcome = Outcome::wrong;
  double error = 0.0;     ///< what `StabilityCase::measure` names
  double seconds = 0.0;   ///< processor time
  long steps = 0;         ///< of a run
  long halved_steps = 0;  ///< of a run
  EnergyResult energy{};
  std::string note{};  ///< the message of a case that was rejected or ended; other remarks
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
/// Cases whose energy is the question: systems without contact, landings.
[[nodiscard]] std::vector<StabilityCase> energy_cases();
/// Cases of the contact's parts: Hertz's ellipse, creep laws, profiles.
[[nodiscard]] std::vector<StabilityCase> contact_cases();
[[nodiscard]] std::vector<StabilityCase> all_cases();

/// Whether an outcome is the expected one, or better: to the end where an early end was expected.
[[nodiscard]] bool as_expected(const StabilityCase& one, const CaseResult& result) noexcept;

/// Runs a case; what it throws becomes its outcome: an InputError is a rejection, anything else is wrong.
[[nodiscard]] CaseResult outcome_of(const StabilityCase& one);

}  // namespace railtab::stability
