#include "railtab/runtime/profile/simpack_profile.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string_view>
#include <utility>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/profile/profile_text.hpp"

namespace railtab {

namespace {

constexpr std::array<std::string_view, 13> spline_keys{
    "point.dist.min", "shift.y",  "shift.z",  "rotate",    "bound.y.min", "bound.y.max", "bound.z.min",
    "bound.z.max",    "mirror.y", "mirror.z", "inversion", "units.len.f", "units.ang.f"};

/// The processing options of the spline section. Lengths in the file's unit, until the last step.
struct Processing {
  double point_dist_min = 0.0;
  double shift_y = 0.0, shift_z = 0.0;
  double rotate = 0.0;                          ///< about x, right-hand rule [file's unit of angle]
  double bound_y_min = 1.0, bound_y_max = 0.0;  ///< inactive unless min < max
  double bound_z_min = 1.0, bound_z_max = 0.0;
  double mirror_y = 0.0, mirror_z = 0.0, inversion = 0.0;
  std::optional<double> units_len;  ///< file's units per metre
  double units_ang = 1.0;           ///< file's units per radian

  void set(std::string_view key, std::string_view value, const std::string& place);
};

double positive(double value, std::string_view key, const std::string& place) {
  if (value > 0.0) return value;
  throw input_error(place, fmt::format("{} = {}", key, value), "a number above 0");
}

double flag(double value, std::string_view key, const std::string& place) {
  if (value == 0.0 || value == 1.0) return value;
  throw input_error(place, fmt::format("{} = {}", key, value), "0 or 1");
}

void Processing::set(std::string_view key, std::string_view value, const std::string& place) {
  const std::map<std::string_view, double*> lengths{{"point.dist.min", &point_dist_min},
                                                    {"shift.y", &shift_y},
                                                    {"shift.z", &shift_z},
                                                    {"rotate", &rotate},
                                                    {"bound.y.min", &bound_y_min},
                                                    {"bound.y.max", &bound_y_max},
                                                    {"bound.z.min", &bound_z_min},
                                                    {"bound.z.max", &bound_z_max}};
  const std::map<std::string_view, double*> flags{
      {"mirror.y", &mirror_y}, {"mirror.z", &mirror_z}, {"inversion", &inversion}};
  const auto value_of = [&] { return number(value, place, fmt::format("a number for {}", key)); };
  if (const auto it = lengths.find(key); it != lengths.end()) {
    *it->second = value_of();
  } else if (const auto is = flags.find(key); is != flags.end()) {
    *is->second = flag(value_of(), key, place);
  } else if (key == "units.len.f") {
    units_len = positive(value_of(), key, place);
  } else if (key == "units.ang.f") {
    units_ang = positive(value_of(), key, place);
  }
  // Other keys (file, comment, type, approx.smooth, ...) describe where the points come from.
}

void drop_close_points(std::vector<OutlinePoint>& points, double distance) {
  if (!(distance > 0.0) || points.empty()) return;
  std::size_t kept = 1;
  for (std::size_t i = 1; i < points.size(); ++i) {
    if (std::hypot(points[i].y - points[kept - 1].y, points[i].z - points[kept - 1].z) < distance) continue;
    points[kept++] = points[i];
  }
  points.resize(kept);
}

void process(const Processing& o, std::vector<OutlinePoint>& points) {
  drop_close_points(points, o.point_dist_min);
  const double cosine = std::cos(o.rotate / o.units_ang);
  const double sine = std::sin(o.rotate / o.units_ang);
  for (OutlinePoint& p : points) {
    const double y = p.y + o.shift_y;
    const double z = p.z + o.shift_z;
    p.y = y * cosine - z * sine;
    p.z = y * sine + z * cosine;
  }
  if (o.bound_y_min < o.bound_y_max) {
    std::erase_if(points, [&](const OutlinePoint& p) { return p.y < o.bound_y_min || p.y > o.bound_y_max; });
  }
  if (o.bound_z_min < o.bound_z_max) {
    std::erase_if(points, [&](const OutlinePoint& p) { return p.z < o.bound_z_min || p.z > o.bound_z_max; });
  }
  for (OutlinePoint& p : points) {
    if (o.mirror_y == 1.0) p.y = -p.y;
    if (o.mirror_z == 1.0) p.z = -p.z;
  }
  if (o.inversion == 1.0) std::reverse(points.begin(), points.end());
  for (OutlinePoint& p : points) {
    p.y /= *o.units_len;
    p.z /= *o.units_len;
  }
}

std::string_view without_comment(std::string_view text) {
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '\'') quoted = !quoted;
    if (text[i] == '!' && !quoted) return text.substr(0, i);
  }
  return text;
}

/// The state of reading: which section the line stands in and what was found so far.
class SimpackReader {
 public:
  SimpackReader(std::istream& in, const std::string& file, ProfileKind kind) : text_{in, file, 0}, kind_(kind) {}

  ProfilePoints read() {
    while (!ended_) {
      const std::optional<std::string> line = text_.next();
      if (!line) throw input_error(text_.file, "the end of the file", "point.end and spline.end");
      const std::string_view content = trimmed(without_comment(*line));
      if (!content.empty()) take(content);
    }
    if (!type_found_) throw input_error(text_.file, "no type in the header section", "type = 0 (rail) or 1 (wheel)");
    if (!processing_.units_len) {
      throw input_error(text_.file, "no units.len.f in the spline section", "units.len.f, the file's units per metre");
    }
    process(processing_, outline_.points);
    return std::move(outline_);
  }

 private:
  enum class Section { none, header, spline, point };

  void take(std::string_view content) {
    if (change_section(content)) return;
    if (section_ == Section::point) return take_point(content);
    const std::size_t equals = content.find('=');
    if (equals == std::string_view::npos || section_ == Section::none) {
      throw input_error(text_.place(), fmt::format("\"{}\"", content),
                        "a section (header.begin, spline.begin) with lines \"key = value\"");
    }
    const std::string_view key = trimmed(content.substr(0, equals));
    const std::string_view value = trimmed(content.substr(equals + 1));
    if (section_ == Section::header) {
      if (key == "type") check_type(value);
      return;
    }
    processing_.set(key, value, text_.place());
    if (std::string note = note_of_case(text_, key, spline_keys); !note.empty())
      outline_.notes.push_back(std::move(note));
  }

  bool change_section(std::string_view content) {
    struct Change {
      std::string_view word;
      Section from, to;
    };
    static constexpr Change changes[] = {
        {"header.begin", Section::none, Section::header}, {"header.end", Section::header, Section::none},
        {"spline.begin", Section::none, Section::spline}, {"spline.end", Section::spline, Section::none},
        {"point.begin", Section::spline, Section::point}, {"point.end", Section::point, Section::spline}};
    for (const Change& c : changes) {
      if (content != c.word) continue;
      if (section_ != c.from) throw input_error(text_.place(), content, "sections that are nested as the format says");
      section_ = c.to;
      ended_ = c.word == "spline.end";
      return true;
    }
    return false;
  }

  void check_type(std::string_view value) {
    const bool wheel = kind_ == ProfileKind::wheel;
    if (value != (wheel ? "1" : "0")) {
      throw input_error(text_.place(), fmt::format("type = {}", value),
                        wheel ? "1 (wheel profile)" : "0 (rail profile)");
    }
    type_found_ = true;
  }

  void take_point(std::string_view content) {
    const std::vector<std::string_view> field = fields(content);
    if (field.size() < 2 || field.size() > 3) {
      throw input_error(text_.place(), fmt::format("\"{}\"", content),
                        expected_numbers(content, "two numbers y z, and a weight if any"));
    }
    const std::string place = text_.place();
    // The weight steers smoothing alone, and points are not smoothed here.
    if (field.size() == 3) static_cast<void>(number(field[2], place, "a number for the weight"));
    outline_.points.push_back(
        {number(field[0], place, "a number for y"), number(field[1], place, "a number for z"), text_.line});
  }

  ProfileText text_;
  ProfileKind kind_;
  Section section_ = Section::none;
  bool ended_ = false;
  bool type_found_ = false;
  Processing processing_;
  ProfilePoints outline_;
};

}  // namespace

ProfilePoints read_simpack(std::istream& in, const std::string& file, ProfileKind kind) {
  return SimpackReader(in, file, kind).read();
}

}  // namespace railtab
