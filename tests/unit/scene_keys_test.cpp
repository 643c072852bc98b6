// Which numbers a scene may give to its keys, and which keys it may give.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <optional>
#include <string>

#include "railtab/runtime/line/irregularity_spectrum.hpp"
#include "railtab/runtime/scene/scene_keys.hpp"
#include "scene_fixture.hpp"

namespace railtab {
namespace {

/// The ends of "0.2 to 5", "> 0, <= 1000", ">= 0"; nothing where there is none.
struct Ends {
  std::optional<double> low, high;
  bool open_low = false;
};
Ends ends_of(const std::string& range) {
  Ends ends;
  double low = 0, high = 0;
  if (std::sscanf(range.c_str(), "> %lf, <= %lf", &low, &high) == 2) return {low, high, true};
  if (std::sscanf(range.c_str(), "%lf to %lf", &low, &high) == 2) return {low, high, false};
  if (std::sscanf(range.c_str(), ">= %lf", &low) == 1) return {low, {}, false};
  if (std::sscanf(range.c_str(), "> %lf", &low) == 1) return {low, {}, true};
  return ends;
}

/// An imported structure with the one way of damping that a key of damping needs beside itself.
std::string imported_with(const std::string& key) {
  std::string text = "track.kind = \"imported\"\n";
  for (const char* file : {"mass", "stiffness", "dofs", "nodes"})
    text += fmt::format("structure.{} = \"pair.h5\"\n", file);
  text += "structure.rail_left.set = \"LEFT\"\nstructure.rail_right.set = \"RIGHT\"\n";
  if (key.ends_with("span")) text += "structure.damping_type = \"steel-composite\"\n";
  if (key.find("frequency") != std::string::npos) text += "structure.damping_ratio = 0.01\n";
  return text;
}

/// What a key of no use by itself stands beside.
std::string companion(const std::string& key) {
  if (key.starts_with("vehicle.")) {
    std::string text = "vehicle.wheelsets = [\"front\", \"rear\"]\nvehicle.car_body = \"box\"\n";
    for (const char* file : {"mass", "damping", "stiffness", "dofs"})
      text += fmt::format("vehicle.{} = \"pair.h5\"\n", file);
    return text;
  }
  if (key.starts_with("span_deviation.")) return "span_deviation.shape = \"bending\"\n";
  const std::string both_waves = key.ends_with("shortest_wave")  ? "irregularity.longest_wave = 500.0\n"
                                 : key.ends_with("longest_wave") ? "irregularity.shortest_wave = 0.1\n"
                                                                 : "";
  if (key.starts_with("irregularity."))
    return "irregularity.spectrum = \"" + spectrum_names().front() + "\"\n" + both_waves;
  if (key.starts_with("structure.window")) return "structure.reduction = \"window\"\n";
  if (key.starts_with("structure.rail_")) return imported_with(key) + "structure.damping_ratio = 0.01\n";
  if (key.starts_with("structure.") && key.find("damping") != std::string::npos) return imported_with(key);
  return "";
}

/// A scene with one key set, and what has to stand beside it.
std::string scene_with(const std::string& key, double value, bool integer) {
  std::string contact = "mode = \"online\"\n", bridge = "[[bridge]]\n", rest;
  const std::string number = integer ? fmt::format("{}", static_cast<long>(value)) : fmt::format("{:.17e}", value);
  const auto line = [&](std::size_t prefix) { return key.substr(prefix) + " = " + number + "\n"; };
  if (key.starts_with("contact."))
    contact += line(8);
  else if (key.starts_with("bridge."))
    bridge += line(7);
  else if (key.starts_with("load.")) {
    rest = "train.count = 100\n";
    bridge += key == "load.Fy" ? "[[load]]\n" : "[[load]]\nFy = 1.0\n";
    bridge += (key == "load.start" ? "gust_duration = 1.0\n" : "") + line(5);
  } else if (key.starts_with("support.")) {
    rest = "track.kind = \"imported\"\n";
    for (const char* file : {"mass", "stiffness", "damping", "dofs", "nodes"})
      rest += fmt::format("structure.{} = \"pair.h5\"\n", file);
    rest += "structure.rail_left.set = \"LEFT\"\nstructure.rail_right.set = \"RIGHT\"\n";
    contact += "[[support]]\nset = \"PIER\"\n" + line(8);
  } else if (key.starts_with("ground_motion.")) {
    const std::string record = "[[ground_motion]]\nfile = \"pair.h5\"\n";
    const bool last = value >= 0.0;  // a place is for one of several, in the order of x
    if (key == "ground_motion.x" && last) bridge += record;
    bridge += record + line(14);
    if (key == "ground_motion.x" && !last) bridge += record;
  } else
    rest = companion(key) + line(0);
  if (rest.find("\"imported\"") != std::string::npos) bridge.clear();
  return rest + "[contact]\n" + contact + bridge;
}

/// What the guide says of a range holds to its ends, through every check that a scene passes before it is built.
TEST_F(Scene, RangesHoldToTheirEnds) {
  // the rail's height and that of its head bound each other, and so do the two wavelengths and the two frequencies
  int checked = 0;
  for (const SceneKey& key : scene_keys()) {
    if (key.type != "number" && key.type != "integer" && key.type != "ratio") continue;
    const bool integer = key.type == "integer";
    if (key.path.starts_with("structure.damping_frequency")) continue;
    const Ends ends = ends_of(key.range);
    const auto outcome = [&](double value) {
      const std::string what = message(scene_with(key.path, value, integer));
      if (what != "no error") return what;
      try {
        read_scene(folder_ / "scene.toml").contact.dimensions.validate();
      } catch (const InputError& wrong) {
        return std::string(wrong.what());
      }
      return what;
    };
    const auto beyond = [&](double end, double way) {
      return integer ? end + way : end + way * std::max(1e-9, 1e-5 * std::abs(end));
    };
    // the printed ends have six digits, and a low end that is excluded may stand for a small number
    if (ends.low) {
      EXPECT_NE(outcome(beyond(*ends.low, -1.0)), "no error") << key.path;
      const double in = ends.open_low ? beyond(*ends.low, 1.0) : *ends.low == -0.333333 ? -1.0 / 3.0 : *ends.low;
      if (key.path != "track.rail.height" && key.path != "irregularity.longest_wave") {
        EXPECT_EQ(outcome(in), "no error") << key.path << ' ' << in;
      }
      ++checked;
    }
    if (ends.high && key.path != "track.rail.head_height" && key.path != "irregularity.shortest_wave") {
      EXPECT_EQ(outcome(*ends.high), "no error") << key.path << ' ' << *ends.high;
      EXPECT_NE(outcome(beyond(*ends.high, 1.0)), "no error") << key.path;
      ++checked;
    }
  }
  EXPECT_GT(checked, 180);
}

// Another unit than the guide's is off by orders of magnitude, and no number of any sense is refused.
TEST_F(Scene, NumbersOfAnotherUnitAreRefused) {
  const auto refused = [&](const std::string& rest) { return message(online + rest); };
  EXPECT_EQ(refused("[[bridge]]\nE = 34500\n"),
            "scene.toml:4: bridge.E: found 34500, expected a number, 1e+09 to 1e+13 Pa");
  EXPECT_EQ(refused("[track]\nrail.E = 2.1e8\n"),
            "scene.toml:4: track.rail.E: found 210000000, expected a number, 1e+10 to 1e+13 Pa");
  EXPECT_NE(refused("[track]\nrail.Iy = 3038.0\n"), "no error") << "cm4";
  EXPECT_NE(refused("[track]\npad.kz = 65.0\n"), "no error") << "kN/mm";
  EXPECT_NE(refused("[track]\nsleeper.mass = 0.25\n"), "no error") << "t";
  EXPECT_NE(refused("[[bridge]]\nmass = 33.9\n"), "no error") << "t/m";
  EXPECT_NE(refused("[[load]]\nFy = 1e12\n"), "no error");
  // a steel footbridge, a bridge of 1 km wholly of concrete, rails as good as rigid, soft ballast
  EXPECT_EQ(refused("[[bridge]]\nlength = 12\nE = 2.1e11\nA = 0.02\nIy = 2e-4\nmass = 400\n"), "no error");
  EXPECT_EQ(refused("[[bridge]]\nlength = 1000\nA = 60.0\nIy = 900.0\nmass = 3e5\n"), "no error");
  EXPECT_EQ(refused("[track]\nrail.E = 1e13\npad.kz = 1e12\nballast_ground.kz = 2e6\n"), "no error");
}

TEST_F(Scene, KeysThatNothingWouldUseAreRefused) {
  const auto refused = [&](const std::string& rest) { return message(online + rest); };
  EXPECT_EQ(refused("[irregularity]\nseed = 3\n"),
            "scene.toml:4: irregularity.seed: found no irregularity.spectrum, expected one, or no seed");
  EXPECT_EQ(refused("[structure]\nwindow_ahead = 30\n"),
            "scene.toml:4: structure.window_ahead: found a structure.reduction without window, expected \"window\"");
  EXPECT_EQ(refused("[structure]\nreduction = \"none\"\nwindow_ahead = 30\n"), "no error");
  EXPECT_EQ(refused("[structure]\ndamping_ratio = 0.01\n[[bridge]]\n"),
            "scene.toml:4: structure.damping_ratio: found no structure.stiffness, expected an imported structure, or "
            "damping_ratio and damping_type in [[bridge]]");
  EXPECT_NE(refused("[[load]]\nFy = 1.0\n[[load]]\nFy = 1.0\nstart = 2.0\n").find("[[load]] 2 of 2"),
            std::string::npos);
  EXPECT_NE(refused("[[ground_motion]]\nfile = \"pair.h5\"\nx = 3.0\n").find("ground_motion.x = 3 m of a single"),
            std::string::npos);
}

// Scenes written for earlier versions name reductions that were deleted.
TEST_F(Scene, DeletedReductionsAreNamedWithWhatToTake) {
  for (const std::string name : {"modal", "craig-bampton"}) {
    EXPECT_EQ(message(std::string(online) + "[structure]\nreduction = \"" + name + "\"\nmodes = 200\n"),
              "scene.toml:4: structure.reduction: found \"" + name +
                  "\", a reduction that has been removed, expected \"none\" or \"window\": take \"window\" for a "
                  "long line of built track, and \"none\" else; remove structure.modes and "
                  "structure.static_correction");
  }
}

// Wheels that follow the rails, rigid track and imported rails leave keys without use; what is left of them stays.
TEST_F(Scene, KeysOfWhatASceneDoesNotHaveAreRefused) {
  const std::string follow = "contact.normal = \"rigid\"\n";
  const std::string rigid = "contact.mode = \"online\"\ntrack.kind = \"rigid\"\n";
  const std::string rails = "contact.mode = \"online\"\n" + imported_with("") + "structure.damping_ratio = 0.01\n";
  EXPECT_EQ(message(follow + "contact.friction = 0.3\n"),
            "scene.toml:2: contact.friction: found contact.normal = \"rigid\", expected no other key of contact: such "
            "wheels follow the rails");
  EXPECT_EQ(message(rigid + "track.pad.kz = 1e8\n"),
            "scene.toml:3: track.pad.kz: found track.kind = \"rigid\", expected track.kind = \"flexible\", or no other "
            "key of track");
  EXPECT_EQ(message(rigid + "structure.reduction = \"window\"\n"),
            "scene.toml:3: structure.reduction: found track.kind = \"rigid\", expected a structure to reduce, or "
            "\"none\"");
  struct Case {
    std::string scene, key, value;
  };
  const std::string online_text = "contact.mode = \"online\"\n";
  for (const auto& [text, key, value] :
       {Case{follow, "contact.table", "\"pair.h5\""}, Case{follow, "contact.mode", "\"online\""},
        Case{follow, "contact.dimensions.track_gauge", "1.437"}, Case{follow, "train.initial_yaw", "0.001"},
        Case{follow, "train.initial_lateral_shift", "0.001"}, Case{follow, "integration.contact_force", "\"energy\""},
        Case{rigid, "track.length_before", "10.0"}, Case{rigid, "structure.mass", "\"pair.h5\""},
        Case{rigid, "structure.window_ahead", "10.0"}, Case{online_text, "track.ballast_deck.kz", "1e8"},
        Case{online_text, "structure.units", "\"m-N-kg\""}, Case{online_text, "structure.rail_left.set", "\"LEFT\""},
        Case{rails, "track.length_before", "10.0"}, Case{rails, "structure.deck.set", "\"DECK\""},
        Case{rails, "structure.report", "[3.0]"}, Case{follow, "integration.impact_step", "1e-4"},
        Case{"contact.mode = \"paper\"\n", "integration.impact_step", "1e-4"},
        Case{online_text + "integration.contact_force = \"energy\"\n", "integration.impact_step", "1e-4"}}) {
    const auto line = 1 + std::count(text.begin(), text.end(), '\n');
    const std::string place = fmt::format("scene.toml:{}: {}: found ", line, key);
    EXPECT_EQ(message(text + key + " = " + value + "\n").substr(0, place.size()), place);
  }
  EXPECT_EQ(message(follow + "track.pad.kz = 1e8\n"), "no error");
  const std::string impact = "integration.impact_step = 1e-4\n";
  for (const char* reduction : {"", "structure.reduction = \"window\"\n"}) {
    EXPECT_EQ(message(online_text + reduction + impact), "no error") << reduction;
  }
  EXPECT_EQ(message(rigid + "structure.reduction = \"none\"\nstructure.window_ahead = 20\n"), "no error");
  EXPECT_EQ(message(online_text + "track.ballast_deck.kz = 1e8\n[[bridge]]\n"), "no error");
  EXPECT_EQ(message(rails + "structure.deck.set = \"DECK\"\nstructure.report = [3.0]\n"), "no error");
}

}  // namespace
}  // namespace railtab
