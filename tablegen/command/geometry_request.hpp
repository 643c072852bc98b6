#pragma once

#include <string>
#include <vector>

#include "geometry_options.hpp"
#include "railtab/runtime/contact/contact_search.hpp"
#include "railtab/tablegen/geometry_sweep.hpp"
#include "table_command_line.hpp"

namespace railtab {

/// What `tablegen geometry` was asked for, read and checked; the profiles are loaded.
struct GeometryRequest {
  std::string file;
  GeometrySweepOptions options;
  ContactSearch search;
};

/// Of pair_options(): dimensions, the rail's inclination, and the noise of the profiles' points. @throws InputError
[[nodiscard]] PairDimensions requested_dimensions(const TableCommandLine& line);
[[nodiscard]] double requested_inclination(const TableCommandLine& line);
[[nodiscard]] double requested_noise(const TableCommandLine& line);

/// @throws InputError where --rail-inclination meets rail files alone, whose points stand as the rail does
void require_rail_to_incline(const TableCommandLine& line);

/// @throws InputError where --smoothing meets built-in profiles alone, on which it does not act, or as
/// require_rail_to_incline()
void require_options_of_profiles(const TableCommandLine& line);

/// @throws InputError where the flanges are wider apart at the gauge height than the track gauge
void require_flanges_between_rails(const WheelRailPair& pair);

/// The pair that pair_options() ask for, its profiles loaded. @throws InputError
[[nodiscard]] WheelRailPair requested_pair(const TableCommandLine& line);

/// @throws InputError
[[nodiscard]] GeometryRequest geometry_request(const TableCommandLine& line);

/// To stderr, before anything is computed: what was repaired in profile files should be looked at.
void print_notes(const std::string& command, const WheelRailPair& pair);

/// To stderr, of points that scatter: the equivalent conicity with and without the smoothing that print_notes() names.
void print_effect_of_smoothing(const TableCommandLine& line, const WheelRailPair& pair);

}  // namespace railtab
