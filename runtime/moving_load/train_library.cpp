#include "railtab/runtime/moving_load/train_library.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/moving_load/axle_train.hpp"
#include "railtab/runtime/vehicle/toml_section.hpp"

namespace railtab {
namespace {

constexpr NumberKind length_kind{"m", -100.0, 100.0}, load_kind{"N", 1.0, 1e6}, line_kind{"N/m", 1.0, 1e6},
    mass_kind{"kg", 1.0, 1e5};
constexpr double gravity = 9.81;  // [m/s²]

/// A static load model: axles, and loads along lines whose ends may be infinitely far away.
struct LineLoad {
  double from = -INFINITY, to = INFINITY, load = 0.0;
};

struct LibraryTrain {
  AxleTrain train;
  std::vector<LineLoad> lines;  // places ahead of its middle [m]; with them `train.behind` are places too
};

LibraryTrain hslm_a(TomlSection& s) {
  constexpr int most_coaches = 100;
  const int coaches = s.whole_number("coaches", 1, most_coaches, 1);
  const double coach_length = s.number("coach_length", length_kind), wheelbase = s.number("wheelbase", length_kind);
  return {hslm_a_train(coaches, coach_length, wheelbase, s.number("axle_load", load_kind)), {}};
}

LibraryTrain wagon(TomlSection& s) {
  AxleTrain train;
  const double load = gravity * s.number("axle_mass", mass_kind), wheelbase = s.number("wheelbase", length_kind);
  const double inner = s.number("inner_spacing", length_kind);
  train.front = s.number("overhang", length_kind);
  train.behind = {0.0, wheelbase, wheelbase + inner, 2.0 * wheelbase + inner};
  train.load.assign(4, load);
  train.length = train.behind.back() + 2.0 * train.front;
  return {train, {}};
}

LibraryTrain static_load(TomlSection& s) {
  LibraryTrain found;
  found.train.only_static = true;
  if (s.has("axles")) {
    found.train.behind = s.numbers("axles", length_kind);
    found.train.load.assign(found.train.behind.size(), s.number("axle_load", load_kind));
  }
  for (TomlSection& line : s.sections("line")) {
    found.lines.push_back({line.number("from", length_kind, -INFINITY), line.number("to", length_kind, INFINITY),
                           line.number("load", line_kind)});
    line.reject_others();
  }
  return found;
}

void read_family(const LibraryFile& file, std::vector<LibraryTrain>& trains) {
  const std::string place = fmt::format("library/{}.toml", file.name);
  const toml::table table = parse_toml(std::string(file.text), place);
  SourcedValues values;
  TomlSection root(place, "", table, {}, values);
  static_cast<void>(root.text("name"));
  static_cast<void>(root.text("description"));
  const auto read = [&](std::string_view key, LibraryTrain (*read_train)(TomlSection&)) {
    for (TomlSection& section : root.sections(key)) {
      const std::string name = section.text("name");
      trains.push_back(read_train(section));
      trains.back().train.name = name;
      trains.back().train.provenance = root.provenance();
      section.reject_others();
    }
  };
  read("hslm_a", hslm_a);
  read("wagon", wagon);
  read("static_load", static_load);
  root.reject_others();
}

const std::vector<LibraryTrain>& library() {
  static const std::vector<LibraryTrain> trains = [] {
    std::vector<LibraryTrain> read;
    for (const std::string_view family : {"hslm-a", "en15528", "static"}) {
      for (const LibraryFile& file : train_library_files()) {
        if (file.name == family) read_family(file, read);
      }
    }
    return read;
  }();
  return trains;
}

/// Line loads as forces at the middles of pieces of at most 0.1 m: the midpoint rule for the modes' loads.
AxleTrain with_line_forces(const LibraryTrain& entry, double deck_length) {
  constexpr double longest_piece = 0.1;  // [m]
  double nearest = 0.0, farthest = 0.0;
  for (const LineLoad& line : entry.lines) {
    for (const double end : {line.from, line.to}) {
      if (std::isfinite(end)) nearest = std::min(nearest, end), farthest = std::max(farthest, end);
    }
  }
  std::vector<std::pair<double, double>> forces;
  for (std::size_t k = 0; k < entry.train.behind.size(); ++k)
    forces.emplace_back(entry.train.behind[k], entry.train.load[k]);
  for (const LineLoad& line : entry.lines) {
    const double from = std::max(line.from, nearest - deck_length), to = std::min(line.to, farthest + deck_length);
    const int pieces = static_cast<int>(std::ceil((to - from) / longest_piece - 1e-9));
    const double piece = (to - from) / pieces;
    for (int i = 0; i < pieces; ++i) forces.emplace_back(from + (i + 0.5) * piece, line.load * piece);
  }
  std::sort(forces.begin(), forces.end());
  AxleTrain train = entry.train;
  train.behind.clear();
  train.load.clear();
  for (const auto& [place, load] : forces) {
    train.behind.push_back(place - forces.front().first);
    train.load.push_back(load);
  }
  return train;
}

/// "en15528-d2*6" as name and count. @throws InputError
std::pair<std::string, int> name_and_count(std::string_view text) {
  const std::size_t star = text.rfind('*');
  if (star == std::string_view::npos) return {std::string(text), 1};
  constexpr int most = 500;
  int count = 0;
  const std::string_view digits = text.substr(star + 1);
  const auto [stop, status] = std::from_chars(digits.data(), digits.data() + digits.size(), count);
  if (status != std::errc() || stop != digits.data() + digits.size() || count < 1 || count > most) {
    throw input_error("axle train", fmt::format("'{}'", text), fmt::format("NAME or NAME*N, N from 1 to {}", most));
  }
  return {std::string(text.substr(0, star)), count};
}

}  // namespace

std::vector<std::string> train_names() {
  std::vector<std::string> names;
  for (const LibraryTrain& entry : library()) names.push_back(entry.train.name);
  return names;
}

AxleTrain find_axle_train(std::string_view text, double deck_length) {
  if (text.ends_with(".csv")) return read_axle_file(std::string(text));
  const auto [name, count] = name_and_count(text);
  for (const LibraryTrain& entry : library()) {
    if (entry.train.name != name) continue;
    return repeated(entry.lines.empty() ? entry.train : with_line_forces(entry, deck_length), count);
  }
  throw input_error("axle train", fmt::format("'{}'", text),
                    fmt::format("a file that ends with .csv, hslm-a (all ten), or one of {}; wagons also as NAME*N",
                                fmt::join(train_names(), ", ")));
}

std::vector<std::string> expanded_names(const std::vector<std::string>& texts) {
  std::vector<std::string> names;
  for (const std::string& text : texts) {
    if (text != "hslm-a") {
      names.push_back(text);
      continue;
    }
    for (const std::string& name : train_names()) {
      if (name.starts_with("hslm-a")) names.push_back(name);
    }
  }
  return names;
}

}  // namespace railtab
