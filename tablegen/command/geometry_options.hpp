#pragma once

#include <boost/program_options.hpp>
#include <string>

namespace railtab {

/// Those of its options that make a pair: profiles and dimensions, all taking a text; "wheel" and "rail" have no
/// default.
[[nodiscard]] boost::program_options::options_description pair_options(const std::string& caption);

/// The options of `tablegen geometry`, all taking a text; "wheel", "rail" and "output" have no default.
[[nodiscard]] boost::program_options::options_description geometry_options();

}  // namespace railtab
