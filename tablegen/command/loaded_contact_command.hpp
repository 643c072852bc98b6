#pragma once

#include <boost/program_options.hpp>
#include <string_view>
#include <vector>

#include "table_command_line.hpp"

namespace railtab {

/// A list of finite numbers, "1,2.5,-3". @throws InputError where there are not `count`; `expected` says what they are
[[nodiscard]] std::vector<double> parse_numbers(const std::string& option, const std::string& text, std::size_t count,
                                                const std::string& expected);

/// Options of `tablegen contact` for a wheel on its rail; "poisson" and "elements" are those of the ellipse too.
[[nodiscard]] boost::program_options::options_description loaded_contact_options();

/// `tablegen contact --pose`: the half-space solution of a wheel on its rail, with friction where it is asked for.
/// @throws InputError, ComputationError
void loaded_contact_command(const TableCommandLine& line);

}  // namespace railtab
