#include "railtab/runtime/profile/profile_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <string_view>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/text_file.hpp"
#include "railtab/runtime/profile/miniprof_profile.hpp"
#include "railtab/runtime/profile/outline.hpp"
#include "railtab/runtime/profile/profile_axes.hpp"
#include "railtab/runtime/profile/simpack_profile.hpp"
#include "railtab/runtime/profile/standard_profiles.hpp"
#include "railtab/runtime/profile/two_column_profile.hpp"

namespace railtab {

namespace {

std::string lower_case(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

enum class ProfileFormat { simpack, miniprof, two_columns };

/// By extension. @throws InputError where it is that of the other kind
ProfileFormat format_of(const std::filesystem::path& file, ProfileKind kind) {
  const std::string extension = lower_case(file.extension().string());
  const bool wheel = kind == ProfileKind::wheel;
  if (extension == (wheel ? ".prr" : ".prw") || extension == (wheel ? ".ban" : ".whl")) {
    throw input_error(file.string(), fmt::format("the extension {}", extension),
                      wheel ? ".prw or .whl for a wheel" : ".prr or .ban for a rail");
  }
  if (extension == ".prw" || extension == ".prr") return ProfileFormat::simpack;
  if (extension == ".whl" || extension == ".ban") return ProfileFormat::miniprof;
  return ProfileFormat::two_columns;
}

ProfilePoints read_points(std::istream& in, const std::filesystem::path& file, ProfileKind kind) {
  const std::string name = file.string();
  switch (format_of(file, kind)) {
    case ProfileFormat::simpack:
      return read_simpack(in, name, kind);
    case ProfileFormat::miniprof:
      return read_miniprof(in, name, kind);
    case ProfileFormat::two_columns:
      break;
  }
  return read_two_columns(in, name);
}

}  // namespace

ProfileKnots read_profile_file(const std::filesystem::path& file, ProfileKind kind, double noise, RailOrigin origin) {
  const std::string name = file.string();
  std::ifstream in(file);
  if (!in || std::filesystem::is_directory(file)) throw input_error(name, "no readable file", "a profile file");
  ProfilePoints outline = read_points(in, file, kind);
  repair_outline(name, outline);
  check_outline(name, kind, outline.points);
  orient(name, kind, outline);
  std::vector<double> y, z;
  for (const OutlinePoint& p : outline.points) {
    y.push_back(p.y);
    z.push_back(p.z);
  }
  const std::string title = file.filename().string();
  ProfileKnots knots;
  if (noise > 0.0) {
    SmoothedProfile smoothed = smoothing_spline(kind, title, y, z, noise);
    outline.notes.push_back(fmt::format("{}: smoothed: points moved by {:.3g} um rms, {:.3g} um at most", name,
                                        1e6 * smoothed.rms_distance, 1e6 * smoothed.largest_distance));
    knots = std::move(smoothed.knots);
  } else {
    knots = spline_through_points(kind, title, y, z);
  }
  if (kind == ProfileKind::rail && origin == RailOrigin::highest_point) centre_rail(name, knots);
  knots.notes = std::move(outline.notes);
  return knots;
}

ProfileKnots load_profile(const std::string& name_or_file, ProfileKind kind, double rail_inclination, double noise,
                          RailOrigin origin) {
  if (is_standard_profile(kind, name_or_file)) return standard_profile(kind, name_or_file, rail_inclination);
  if (is_file(name_or_file)) return read_profile_file(name_or_file, kind, noise, origin);
  throw input_error(kind == ProfileKind::wheel ? "wheel profile" : "rail profile",
                    fmt::format("\"{}\", neither a built-in name nor a file", name_or_file),
                    fmt::format("one of {}, or a profile file", fmt::join(standard_profile_names(kind), ", ")));
}

}  // namespace railtab
