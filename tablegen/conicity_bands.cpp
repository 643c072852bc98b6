#include "railtab/tablegen/conicity_bands.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "railtab/runtime/base/constants.hpp"
#include "railtab/runtime/base/text_lines.hpp"

namespace railtab {

namespace {

constexpr const char* row_form =
    "six numbers: amplitude [mm], reference, narrow upper and lower, wide upper and lower limit";

void require_order(const LineReader& reader, const ConicityBand& band) {
  for (const auto& [limits, name] : {std::pair{band.narrow, "narrow"}, std::pair{band.wide, "wide"}}) {
    if (limits.upper >= band.reference && limits.lower <= band.reference) continue;
    throw reader.error(
        fmt::format("the {} limits {} and {} of the reference {}", name, limits.upper, limits.lower, band.reference),
        "an upper limit not below and a lower limit not above the reference");
  }
}

}  // namespace

std::vector<ConicityBand> read_conicity_bands(const std::filesystem::path& file) {
  constexpr double most_amplitude = 100.0;  // mm
  LineReader reader(file, "a reference of the equivalent conicity");
  std::vector<ConicityBand> bands;
  while (reader.next()) {
    const std::string_view content = stripped(reader.line().substr(0, reader.line().find('#')));
    if (content.empty()) continue;
    std::array<std::string_view, 6> words;
    if (split(content, words) != words.size()) throw reader.error(fmt::format("\"{}\"", content), row_form);
    std::array<double, 6> v{};
    for (std::size_t i = 0; i < words.size(); ++i) v[i] = reader.number<double>(words[i], row_form);
    if (!(v[0] > (bands.empty() ? 0.0 : bands.back().amplitude / mm) && v[0] <= most_amplitude)) {
      throw reader.error(fmt::format("the amplitude {}", words[0]), "increasing amplitudes in mm, above 0, up to 100");
    }
    bands.push_back({v[0] * mm, v[1], {v[2], v[3]}, {v[4], v[5]}});
    require_order(reader, bands.back());
  }
  if (bands.empty()) throw reader.file_error("no rows", row_form);
  return bands;
}

double band_position(double tan_gamma, double reference, const ConicityLimits& limits) noexcept {
  const double deviation = tan_gamma - reference;
  if (deviation == 0.0) return 0.0;
  return deviation > 0.0 ? deviation / (limits.upper - reference) : deviation / (reference - limits.lower);
}

}  // namespace railtab
