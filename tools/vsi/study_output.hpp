#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "study_analysis.hpp"

namespace railtab::vsi {

/// A finished study.
struct StudyReport {
  const StudyPlan& plan;
  const StudyRuns& runs;
  const StudyResult& result;
  std::string scene_name, scene_text;
  RunCount count;
  std::vector<StudyRow> rows;      ///< of the finished runs
  std::vector<std::string> names;  ///< of these
  std::vector<StudyPoint> points;  ///< of these
  std::vector<double> weights;     ///< how many points of the study each of these is
};

/// What a study's HDF5 file says that it is.
inline constexpr const char* study_filetype = "railtab-study";

/// Outputs must replace nothing but their like. @throws InputError
void require_study_places(const StudyPlan& plan, const StudyRuns& runs, const std::filesystem::path& folder);
/// runs.csv, study.h5, study.json and the table of the method.
void write_study(const StudyReport& report, const std::string& run_rows, const std::filesystem::path& folder);
[[nodiscard]] nlohmann::ordered_json study_json(const StudyReport& report);
[[nodiscard]] std::string study_text(const StudyReport& report);

}  // namespace railtab::vsi
