#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace railtab {

/// One table of a batch list: the arguments of `tablegen geometry` that make it.
struct BatchPair {
  std::string place;                   ///< "pairs.toml:12", for messages
  std::filesystem::path output;        ///< the table
  std::vector<std::string> arguments;  ///< all options written out as --name=value, the output last
};

/// Reads a TOML file with one [[pair]] per table and an optional [defaults]; the keys are the options of
/// `tablegen geometry`, their values numbers, texts as on the command line, or [low, high] for intervals. Profile files
/// and outputs are relative to the list. If it acts on another pair, a default rail inclination is dropped from pairs
/// whose rail is a file, and a default smoothing from pairs of built-in profiles.
/// @throws InputError naming file, line and key: unknown keys, wrong types, no wheel, rail or output, two pairs with
/// one output.
[[nodiscard]] std::vector<BatchPair> read_batch_list(const std::filesystem::path& file);

/// The options that decide the numbers of a table besides its profiles (with smoothing and inclination, which their
/// points show) and output, numbers in their shortest form: "gauge=1.435 ...". Equal texts, equal options. @param
/// arguments of `tablegen geometry`
/// @throws boost::program_options::error
[[nodiscard]] std::string geometry_options_text(const std::vector<std::string>& arguments);

}  // namespace railtab
