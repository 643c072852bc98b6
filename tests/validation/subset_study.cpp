// Writes docs/validation/subset_simulation.csv: repetitions of subset simulation on limit states of known
// probability. subset_study [FILE.csv]; docs/validation/many_runs.md quotes it.
#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include "railtab/runtime/base/process_end.hpp"
#include "railtab/runtime/base/text_file.hpp"
#include "railtab/runtime/reliability/standard_normal.hpp"
#include "subset_limit_states.hpp"

namespace railtab {
namespace {

constexpr const char* header =
    "limit_state,variables,exact,repetitions,mean_evaluations,most_evaluations,mean,bias,variation,own_estimate,least,"
    "greatest\n";

std::string row(const KnownLimitState& state, int repetitions) {
  const SubsetRepetitions r = repeat_subset(state, repetitions);
  return fmt::format("{},{},{:.3e},{},{:.0f},{},{:.4e},{:.3f},{:.3f},{:.3f},{:.3e},{:.3e}\n", state.name,
                     state.variables, state.exact, repetitions, r.mean_evaluations, r.most_evaluations, r.mean, r.bias,
                     r.variation, r.own_variation, r.least, r.greatest);
}

int write_study(const std::string& file) {
  std::string text = header;
  for (const KnownLimitState& state : known_limit_states()) {
    for (const int repetitions : {50, 1000}) {
      const std::string line = row(state, repetitions);
      print_text(line);
      text += line;
    }
  }
  write_text_file(file, text, header);
  return 0;
}

}  // namespace
}  // namespace railtab

int main(int argc, char** argv) {
  return railtab::run_process("subset_study",
                              [&] { return railtab::write_study(argc > 1 ? argv[1] : "subset_simulation.csv"); });
}
