#include "interleaved_timing.hpp"

#include <algorithm>
#include <chrono>

namespace railtab::work_precision {

std::vector<double> interleaved_medians(const std::vector<std::function<double()>>& passes, int rounds) {
  std::vector<std::vector<double>> seconds(passes.size());
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i < passes.size(); ++i) {
      const auto begin = std::chrono::steady_clock::now();
      volatile double used = passes[i]();
      static_cast<void>(used);
      seconds[i].push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
    }
  }
  std::vector<double> medians;
  for (std::vector<double>& s : seconds) {
    std::nth_element(s.begin(), s.begin() + static_cast<std::ptrdiff_t>(s.size() / 2), s.end());
    medians.push_back(s[s.size() / 2]);
  }
  return medians;
}

}  // namespace railtab::work_precision
