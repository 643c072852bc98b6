#include "stability_case.hpp"

#include <cmath>
#include <ctime>
#include <exception>

#include "railtab/runtime/base/input_error.hpp"

namespace railtab::stability {

const char* outcome_name(Outcome outcome) noexcept {
  switch (outcome) {
    case Outcome::converged:
      return "converged";
    case Outcome::ended:
      return "ended";
    case Outcome::rejected:
      return "rejected";
    case Outcome::wrong:
      break;
  }
  return "wrong";
}

std::vector<StabilityCase> all_cases() {
  std::vector<StabilityCase> cases = run_cases();
  for (StabilityCase& one : energy_cases()) cases.push_back(std::move(one));
  for (StabilityCase& one : contact_cases()) cases.push_back(std::move(one));
  return cases;
}

bool as_expected(const StabilityCase& one, const CaseResult& result) noexcept {
  return result.outcome == one.expected || (one.expected == Outcome::ended && result.outcome == Outcome::converged);
}

CaseResult outcome_of(const StabilityCase& one) {
  const std::clock_t begin = std::clock();
  CaseResult result;
  try {
    result = one.run(one.allowed);
    if (result.outcome == Outcome::converged && !(result.error <= one.allowed)) result.outcome = Outcome::wrong;
  } catch (const InputError& rejection) {
    result = {.outcome = Outcome::rejected, .note = rejection.what()};
  } catch (const std::exception& failure) {
    result = {.outcome = Outcome::wrong, .note = failure.what()};
  }
  if ((result.outcome == Outcome::ended || result.outcome == Outcome::rejected) && result.note.empty()) {
    result.outcome = Outcome::wrong;
    result.note = "no message";
  }
  result.seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  return result;
}

}  // namespace railtab::stability
