#include "machine.hpp"

#include <fmt/format.h>

#include <array>
#include <cstdio>
#include <fstream>
#include <memory>
#include <thread>

namespace railtab::work_precision {

std::string machine_kind() {
  std::ifstream info("/proc/cpuinfo");
  std::string model = "processor of unknown kind";
  for (std::string line; std::getline(info, line);) {
    const std::size_t colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) {
      model = line.substr(colon + 2);
      break;
    }
  }
  return fmt::format("{}, {} cores", model, std::thread::hardware_concurrency());
}

std::string source_commit() {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> git(
      popen("cd '" RAILTAB_SOURCE_DIR "' && git rev-parse --short=10 HEAD 2>/dev/null && "
            "(git diff --quiet HEAD -- . ':!docs' ':!tests/benchmark/baseline.csv' || echo -dirty)",
            "r"),
      pclose);
  std::string commit;
  std::array<char, 64> text{};
  while (git && std::fgets(text.data(), text.size(), git.get())) {
    commit += text.data();
    if (commit.ends_with('\n')) commit.pop_back();
  }
  return commit.empty() ? "unknown" : commit;
}

}  // namespace railtab::work_precision
