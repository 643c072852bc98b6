#pragma once

#include <optional>
#include <string>

#include "command/command_line.hpp"
#include "railtab/runtime/vsi/vsi_model.hpp"

namespace railtab::vsi {

/// A vehicle on its profiles, with the contact at rest or the equivalent conicity of an amplitude.
struct HuntingCase {
  VsiModel model;
  std::optional<double> amplitude, conicity;  ///< [m, -]; none: the contact at rest
};

/// Sets amplitude and conicity by --amplitude, where it is given. @throws InputError
void set_conicity(const CommandLine& line, HuntingCase& hunting);

/// "manchester-coach, S1002 on 60E1, friction 0.3, the contact at rest"
[[nodiscard]] std::string name_of(const HuntingCase& hunting);

}  // namespace railtab::vsi
