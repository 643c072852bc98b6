#include "assessment_csv.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace railtab::assess {
namespace {

std::vector<const MeasureKind*> measures_of_runs() {
  std::vector<const MeasureKind*> list;
  for (const MeasureKind& kind : measure_kinds()) {
    if (std::count(kind.stages.begin(), kind.stages.end(), AssessmentStage::contact) > 0) list.push_back(&kind);
  }
  return list;
}

}  // namespace

std::string run_columns() {
  std::string text = "run,train,speed[m/s],speed[km/h],seed,complete";
  for (const MeasureKind* kind : measures_of_runs()) text += fmt::format(",{}[{}]", kind->name, kind->unit);
  return text + "\n";
}

std::string run_rows(const Assessment& assessment) {
  std::string text = run_columns();
  for (const RunAssessment& run : assessment.runs) {
    std::string train = run.train;
    std::replace(train.begin(), train.end(), ',', ';');
    text += fmt::format("{},{},{:.8g},{:.8g},{},{}", run.name, train, run.speed, 3.6 * run.speed,
                        run.seed ? fmt::format("{}", *run.seed) : "", run.complete ? 1 : 0);
    for (const MeasureKind* kind : measures_of_runs()) {
      const MeasuredValue* largest = nullptr;
      for (const MeasuredValue& value : run.values) {
        if (value.measure == kind->name && (!largest || value.value > largest->value)) largest = &value;
      }
      text += largest ? fmt::format(",{:.8g}", largest->value) : ",";
    }
    text += "\n";
  }
  return text;
}

}  // namespace railtab::assess
