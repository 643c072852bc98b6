#include "creep_figure.hpp"

#include <fmt/format.h>

#include "railtab/tablegen/creep_verification.hpp"
#include "railtab/tables/creep_table_file.hpp"

namespace railtab::work_precision {

WorkFigure creep_figure(const std::vector<std::filesystem::path>& tables, bool quick) {
  WorkFigure figure;
  figure.name = "creep";
  figure.title = "Creep force: a/b 0.05 to 20, creepages 0.05 to 30 times the linear limit";
  figure.error_label = "error of the force vector, 99 % point [of mu F_n]";
  figure.least_error = 1e-5;
  figure.advice =
      "Take the table with its default layout: it is an order of magnitude nearer to exact theory than FASTSIM on any "
      "grid "
      "and takes a fraction of its time. Polach's closed form is the fastest that saturates, for studies in which ten "
      "per "
      "cent of the friction force do not matter; linear theory only where creepages stay small.";
  CreepVerificationOptions options;
  options.samples = quick ? 200 : 4000;
  options.seed = 7;
  bool first = true;
  for (const std::filesystem::path& file : tables) {
    const CreepVerification v =
        verify_creep_table(TableCreep{std::make_shared<const CreepTable>(read_creep_table(file))}, options);
    const auto add = [&](const std::string& method, const std::string& setting, const CreepLawErrors& law,
                         const std::string& note) {
      figure.points.push_back({method, setting, law.time_ns, law.force.p99, law.force.max, note});
    };
    add("table", file.stem().string(), v.table, fmt::format("{:.1f} MiB", static_cast<double>(v.bytes) / 1048576.0));
    if (!first) continue;
    first = false;
    for (const CreepLawErrors& law : v.laws) {
      const std::string name(law.name);
      const bool fastsim = name.starts_with("fastsim");
      add(fastsim ? "FASTSIM" : name, fastsim ? name.substr(7) : "", law, "");
    }
  }
  return figure;
}

}  // namespace railtab::work_precision
