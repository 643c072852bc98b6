#pragma once

#include <string>
#include <vector>

#include "command_line.hpp"
#include "railtab/runtime/contact/contact_search.hpp"
#include "railtab/tablegen/geometry_sweep.hpp"

namespace railtab {

/// What `tablegen geometry` was asked for, read and checked; the profiles are loaded.
struct GeometryRequest {
  std::string file;
  GeometrySweepOptions options;
  ContactSearch search;
};

/// The options of `tablegen geometry`, all taking a text; "wheel", "rail" and "output" have no default.
[[nodiscard]] boost::program_options::options_description geometry_options();

/// @throws InputError
[[nodiscard]] GeometryRequest geometry_request(const CommandLine& line);

/// To stderr, before the table is made: what was repaired in profile files should be looked at.
void print_notes(const GeometryRequest& request);

}  // namespace railtab
