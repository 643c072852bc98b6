#pragma once

#include <boost/program_options.hpp>

namespace railtab {

/// The options of `tablegen geometry`, all taking a text; "wheel", "rail" and "output" have no default.
[[nodiscard]] boost::program_options::options_description geometry_options();

}  // namespace railtab
