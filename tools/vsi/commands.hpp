#pragma once

#include <string>
#include <vector>

namespace railtab::vsi {

/// The subcommands of vsi. `arguments` are those after the subcommand's name.
/// @return exit code 0 (done) or 1 (the computation failed, reason on stderr). @throws InputError for exit code 2,
/// ComputationError for exit code 1.
using Arguments = std::vector<std::string>;
int contact_command(const Arguments& arguments);
int critical_speed_command(const Arguments& arguments);
int creep_command(const Arguments& arguments);
int run_command(const Arguments& arguments);
int sweep_command(const Arguments& arguments);
int study_command(const Arguments& arguments);
int assess_command(const Arguments& arguments);
int moving_load_command(const Arguments& arguments);
int export_command(const Arguments& arguments);
int fmu_command(const Arguments& arguments);
int report_command(const Arguments& arguments);
int structure_command(const Arguments& arguments);
int vehicle_command(const Arguments& arguments);
int check_command(const Arguments& arguments);
int new_command(const Arguments& arguments);
/// vsi FILE: what the file is, and what can be done with it.
int describe_command(const Arguments& arguments);

}  // namespace railtab::vsi
