#include "creep_figure.hpp"

#include <fmt/format.h>

#include "railtab/runtime/scene/scene_parameters.hpp"
#include "railtab/tablegen/creep_verification.hpp"
#include "railtab/tables/files/creep_table_file.hpp"

namespace railtab::work_precision {

WorkFigure creep_figure(const std::vector<std::filesystem::path>& tables, bool quick) {
  WorkFigure figure;
  figure.name = "creep";
  figure.title = "Creep force: a/b 0.05 to 20, creepages 0.05 to 30 times the linear limit";
  figure.y_label = "error of the force vector, 99 % point [of mu F_n]";
  figure.least_error = 1e-5;
  figure.advice =
      "Take the table: its error is more than an order of magnitude below FASTSIM's on any grid, in less time. "
      "Polach's closed form takes less time than the table. Use it and linear theory only where large spin "
      "and slender ellipses do not occur, for their errors are largest there.";
  CreepVerificationOptions options;
  options.samples = quick ? 200 : 4000;
  options.seed = 7;
  const std::string standard_law = ContactParameters{}.creep_law;
  bool first = true;
  for (const std::filesystem::path& file : tables) {
    const CreepVerification v =
        verify_creep_table(TableCreep{std::make_shared<const CreepTable>(read_creep_table(file))}, options);
    const auto add = [&](const std::string& method, const std::string& setting, const CreepLawErrors& law,
                         const std::string& note, bool standard) {
      figure.points.push_back({method, setting, law.time_ns, law.force.p99, law.force.max, note, standard});
    };
    add("table", first ? "shipped" : file.stem().string(), v.table,
        fmt::format("{:.1f} MiB", static_cast<double>(v.bytes) / 1048576.0), first && standard_law == "table");
    if (!first) continue;
    first = false;
    for (const CreepLawErrors& law : v.laws) {
      const std::string name(law.name);
      const std::size_t stroke = name.find('_');
      const bool fastsim = name.starts_with("fastsim");
      const std::string grid = fastsim ? name.substr(stroke + 1) : "";
      add(fastsim            ? "FASTSIM"
          : name == "polach" ? "Polach"
                             : "linear saturated",
          fastsim ? grid + " x " + grid : "", law, "", standard_law == law.name);
    }
  }
  return figure;
}

}  // namespace railtab::work_precision
