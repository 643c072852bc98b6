#include "readers.hpp"

#include <unistd.h>

#include <fstream>

#include "railtab/runtime/assessment/verdict.hpp"
#include "railtab/runtime/base/column_file.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/fe/fe_files.hpp"
#include "railtab/runtime/profile/profile_curve.hpp"
#include "railtab/runtime/profile/profile_file.hpp"
#include "reading.hpp"

namespace railtab::fuzz {
namespace {

void read_wheel(const Path& file) { static_cast<void>(ProfileCurve(read_profile_file(file, ProfileKind::wheel))); }
void read_rail(const Path& file) { static_cast<void>(ProfileCurve(read_profile_file(file, ProfileKind::rail))); }

void read_clause_file(const Path& file) {
  const std::vector<Clause> clauses = clauses_with({file});
  std::vector<MeasuredValue> values;
  for (const MeasureKind& kind : measure_kinds()) {
    MeasuredValue& value = values.emplace_back();
    value.measure = kind.name;
    value.stage = kind.stages.empty() ? AssessmentStage::check : kind.stages.front();
    value.value = 1.0;
    value.quantities = {
        {"span", 25.0}, {"axle_load", 2e5}, {"static_wheel_load", 1e5}, {"nadal_limit", 1.3}, {"weinstock_limit", 1.6}};
  }
  const AssessmentFacts facts{"ballasted", 55.0};
  for (const Verdict& verdict : judge(clauses, facts, values, {})) require_finite({verdict.limit}, "a clause's limit");
}

/// Folder of this process, gone with it.
class OwnFolder {
 public:
  OwnFolder() : path_(std::filesystem::temp_directory_path() / ("railtab_fuzz_" + std::to_string(::getpid()))) {
    std::filesystem::remove_all(path_);
    std::filesystem::copy(RAILTAB_SOURCE_DIR "/tests/fuzz/companions", path_);
  }
  ~OwnFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  OwnFolder(const OwnFolder&) = delete;
  OwnFolder& operator=(const OwnFolder&) = delete;
  [[nodiscard]] const Path& path() const noexcept { return path_; }

 private:
  Path path_;
};

}  // namespace

const std::vector<Reader>& readers() {
  static const std::vector<Reader> all{
      {"simpack_wheel", ".prw", read_wheel},
      {"simpack_rail", ".prr", read_rail},
      {"miniprof_wheel", ".whl", read_wheel},
      {"miniprof_rail", ".ban", read_rail},
      {"two_columns", ".txt", read_wheel},
      {"scene", ".toml", read_scene_file, nullptr, scene_vocabulary},
      {"scene_model", ".toml", run_scene_file, nullptr, scene_vocabulary},
      {"matrix_market", ".mtx", read_matrix_market_file},
      {"calculix_matrix", ".sti", read_calculix_file},
      {"calculix_rows", ".dof", [](const Path& file) { static_cast<void>(read_calculix_rows(file)); }},
      {"abaqus_matrix", ".mtx", read_abaqus_file},
      {"abaqus_coordinates", ".mtx", read_abaqus_numbers},
      {"harwell_boeing", ".matrix", read_harwell_boeing_file},
      {"ansys_rows", ".mapping", [](const Path& file) { static_cast<void>(read_ansys_rows(file)); }},
      {"row_table", ".csv", read_row_file},
      {"fe_mesh", ".inp", read_node_file},
      {"mode_table", ".csv", read_mode_file},
      {"mode_shapes", ".csv", read_shape_file},
      {"structure_dofs", ".csv", read_structure_table},
      {"vehicle_dofs", ".csv", read_vehicle_file},
      {"vehicle_stiffness", ".mtx", read_vehicle_stiffness},
      {"vehicle_file", ".toml", read_vehicle_toml},
      {"fmu_track", "", read_fmu_track, write_fmu_track_seed},
      {"clauses", ".toml", read_clause_file},
      {"irregularity", ".csv", read_irregularity_file},
      {"load_history", ".csv", read_load_file},
      {"aerodynamics", ".csv", read_aerodynamics_file},
      {"wind_history", ".csv", read_wind_file},
      {"ground_record", ".csv", read_ground_file},
      {"speed_profile", ".csv", read_speed_file},
      {"creep_queries", ".csv",
       [](const Path& file) {
         static_cast<void>(read_number_rows(file, {"ratio", "ux", "uy", "phi"}));
       }},
      {"batch_list", ".toml", read_batch_file},
      {"geometry_table", ".h5", read_geometry_file, write_geometry_seed},
      {"geometry_numbers", ".txt", change_geometry_numbers},
      {"creep_table", ".h5", read_creep_file, write_creep_seed},
      {"creep_numbers", ".txt", change_creep_numbers},
      {"creep_partial", ".h5", read_creep_partial, write_creep_partial_seed},
      {"results", ".h5", read_result_file, write_result_seed},
      {"checkpoint_numbers", ".txt", change_checkpoint_numbers},
  };
  return all;
}

const Reader& reader(const std::string& name) {
  for (const Reader& candidate : readers()) {
    if (candidate.name == name) return candidate;
  }
  throw input_error("reader", name, "one of the list");
}

bool accepts(const Reader& reader, const std::string& bytes) {
  static const OwnFolder folder;
  const Path file = folder.path() / ("input" + reader.extension);
  std::ofstream(file, std::ios::binary) << bytes;
  try {
    reader.read(file);
    return true;
  } catch (const InputError&) {
    return false;
  }
}

}  // namespace railtab::fuzz
