// Which numbers a scene may give to its keys, and which keys it may give.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "railtab/runtime/line/irregularity_spectrum.hpp"
#include "railtab/runtime/scene/scene_keys.hpp"
#include "scene_fixture.hpp"

namespace railtab {
namespace {

/// An imported structure with the one way of damping that a key of damping needs beside itself.
std::string imported_with(const std::string& key) {
  std::string text = "track.kind = \"imported\"\n";
  for (const char* file : {"mass", "stiffness", "dofs", "nodes"})
    text += fmt::format("structure.{} = \"pair.h5\"\n", file);
  text += "structure.rail_left.set = \"LEFT\"\nstructure.rail_right.set = \"RIGHT\"\n";
  if (key.ends_with("span")) text += "structure.damping_type = \"steel-composite\"\n";
  if (key.find("frequency") != std::string::npos) text += "structure.damping_ratio = 0.01\n";
  if (key.ends_with("frequency_low")) text += "structure.damping_frequency_high = 1e4\n";
  if (key.ends_with("frequency_high")) text += "structure.damping_frequency_low = 1e-3\n";
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
  if (key == "output.deck_cut_off") return "output.deck_envelope = true\n";
  if (key.starts_with("span_deviation.")) return "span_deviation.shape = \"bending\"\n";
  const std::string both_waves = key.ends_with("shortest_wave")  ? "irregularity.longest_wave = 500.0\n"
                                 : key.ends_with("longest_wave") ? "irregularity.shortest_wave = 0.1\n"
                                                                 : "";
  if (key.starts_with("irregularity.") || key == "assessment.seeds")
    return "irregularity.spectrum = \"" + spectrum_names().front() + "\"\n" + both_waves;
  if (key.starts_with("structure.window")) return "structure.reduction = \"window\"\n";
  if (key.starts_with("structure.rail_")) return imported_with(key) + "structure.damping_ratio = 0.01\n";
  if (key == "structure.axis_depth") {
    return imported_with(key) +
           "structure.damping_ratio = 0.01\nstructure.deck.set = \"DECK\"\nstructure.sections = [3.0]\n"
           "output.deck_envelope = true\n";
  }
  if (key.starts_with("structure.") && key.find("damping") != std::string::npos) return imported_with(key);
  return "";
}

/// A scene with one key set, and what has to stand beside it.
std::string scene_with(const std::string& key, double value, bool integer) {
  std::string contact = "mode = \"online\"\n", bridge = "[[bridge]]\n", rest;
  const std::string number = integer ? fmt::format("{}", static_cast<long>(value)) : fmt::format("{:.17e}", value);
  const auto line = [&](std::size_t prefix) { return key.substr(prefix) + " = " + number + "\n"; };
  if (key.starts_with("contact.")) {
    if (key.starts_with("contact.k_")) contact += "creep_law = \"polach\"\n";
    if (key == "contact.creep_speed_floor") rest = "train.speed_file = \"pair.h5\"\n";
    contact += line(8);
  } else if (key.starts_with("profiles."))
    bridge += "[[profiles]]\n" + line(9);
  else if (key.starts_with("wheel."))
    bridge +=
        std::string("[[wheel]]\n") + (key == "wheel.run_out" ? "flat_length = 0.05\n" : "run_out = 1e-4\n") + line(6);
  else if (key.starts_with("bridge."))
    bridge += line(7);
  else if (key.starts_with("load.")) {
    rest = "train.count = 100\n";
    const bool wind =
        key.starts_with("load.wind_") || key == "load.air_density" || key == "load.area" || key == "load.length";
    bridge += wind               ? "[[load]]\naerodynamics = \"pair.h5\"\n"
              : key == "load.Fy" ? "[[load]]\n"
                                 : "[[load]]\nFy = 1.0\n";
    if (wind && key != "load.wind_speed") bridge += "wind_speed = 1.0\n";
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

/// Keys whose values another key bounds too, from below (or above).
bool bounded_below(const std::string& key) {
  return key == "track.rail.height" || key == "irregularity.longest_wave" || key.ends_with("frequency_high") ||
         key == "assessment.end";
}
bool bounded_above(const std::string& key) {
  return key == "track.rail.head_height" || key == "irregularity.shortest_wave" || key.ends_with("frequency_low") ||
         key == "output.deck_cut_off";
}

/// What the guide says of a range holds to its ends, through every check that a scene passes before it is built.
TEST_F(Scene, RangesHoldToTheirEnds) {
  int checked = 0;
  for (const SceneKey& key : scene_keys()) {
    if (!key.bounds) continue;
    const bool integer = key.type == "integer";
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
    const auto [low, high, zero, either_sign] = *key.bounds;
    const bool positive = low > 0.0 && low < 1e-4;  // an end so low that what is beyond it is negative
    EXPECT_NE(outcome(positive ? 0.5 * low : beyond(low, -1.0)), "no error") << key.path;
    EXPECT_NE(outcome(beyond(high, 1.0)), "no error") << key.path;
    if (!bounded_below(key.path)) {
      EXPECT_EQ(outcome(low), "no error") << key.path << ' ' << low;
    }
    if (!bounded_above(key.path)) {
      EXPECT_EQ(outcome(high), "no error") << key.path << ' ' << high;
    }
    if (either_sign) {
      EXPECT_EQ(outcome(-high), "no error") << key.path;
      EXPECT_NE(outcome(-0.5 * low), "no error") << key.path;
    }
    if (zero && key.path.find("frequency") == std::string::npos) {
      EXPECT_EQ(outcome(0.0), "no error") << key.path;
    }
    ++checked;
  }
  EXPECT_GT(checked, 110);
}

/// Every number is read or rejected with its range, however small or large: none reaches a loop that would not end.
TEST_F(Scene, ExtremesAreReadOrRejectedWithTheRange) {
  constexpr double tiny = 1e-300, huge = 1e300, least = std::numeric_limits<double>::denorm_min();
  int rejected = 0;
  for (const SceneKey& key : scene_keys()) {
    if (!key.bounds || key.type == "integer") continue;
    EXPECT_TRUE(std::isfinite(key.bounds->low) && std::isfinite(key.bounds->high)) << key.path;
    for (const double value : {tiny, -tiny, least, huge, -huge, std::numeric_limits<double>::max()}) {
      const std::string what = message(scene_with(key.path, value, false));
      if (key.bounds->accepts(value)) continue;
      EXPECT_NE(what.find(": " + key.path + ": found "), std::string::npos) << what;
      EXPECT_NE(what.find(key.range), std::string::npos) << what;
      ++rejected;
    }
  }
  EXPECT_GT(rejected, 400);
  EXPECT_EQ(message(std::string(online) + "[span_deviation]\nshape = \"bending\"\nspan = 1e-300\n"),
            "scene.toml:5: span_deviation.span: found 1e-300, expected a number, 0.5 to 1000 m");
  EXPECT_EQ(message(std::string(online) + "[span_deviation]\nshape = \"bending\"\nbeta = 1e-300\n"),
            "scene.toml:5: span_deviation.beta: found 1e-300, expected a number, 0 or 0.01 to 100 1/m");
  EXPECT_EQ(message(imported_with("") + "structure.origin = [0, 1e300, 0]\n").substr(0, 77),
            "scene.toml:8: structure.origin: found 1e+300 in the list, expected three numb");
  for (const char* number : {"nan", "inf", "-inf"}) {
    EXPECT_TRUE(message(std::string(online) + "friction = " + number + "\n")
                    .starts_with("scene.toml:3: contact.friction: found"))
        << number;
  }
}

/// A scene that a program puts together passes the same ranges.
TEST_F(Scene, RangesHoldForParametersOfAProgram) {
  const auto what = [](auto&& change) -> std::string {
    SceneParameters scene;
    scene.contact.mode = ContactMode::online;
    change(scene);
    try {
      scene.validate();
    } catch (const InputError& wrong) {
      return wrong.what();
    }
    return "no error";
  };
  EXPECT_EQ(what([](SceneParameters&) {}), "no error");
  EXPECT_EQ(what([](SceneParameters& scene) { scene.span_deviation.emplace().beta = 1e-300; }),
            "span_deviation.beta: found 1e-300, expected a number, 0 or 0.01 to 100 1/m");
  EXPECT_EQ(what([](SceneParameters& scene) { scene.train.speed = 0.0; }),
            "train.speed: found 0, expected a number, 0.001 to 200 m/s");
  EXPECT_EQ(what([](SceneParameters& scene) { scene.train.count = 0; }),
            "train.count: found 0, expected an integer 1 to 100");
  EXPECT_EQ(what([](SceneParameters& scene) {
              scene.loads.emplace_back().load[1] = 1.0;
              scene.loads.emplace_back().load[1] = 1e300;
            }),
            "load.Fy: found 1e+300, expected a number, -1e+08 to 1e+08 N");
}

// Another unit than the guide's is off by orders of magnitude, and no number of any sense is rejected.
TEST_F(Scene, NumbersOfAnotherUnitAreRejected) {
  const auto rejected = [&](const std::string& rest) { return message(online + rest); };
  EXPECT_EQ(rejected("[[bridge]]\nE = 34500\n"),
            "scene.toml:4: bridge.E: found 34500, expected a number, 1e+09 to 1e+13 Pa");
  EXPECT_EQ(rejected("[track]\nrail.E = 2.1e8\n"),
            "scene.toml:4: track.rail.E: found 210000000, expected a number, 1e+10 to 1e+13 Pa");
  EXPECT_NE(rejected("[track]\nrail.Iy = 3038.0\n"), "no error") << "cm4";
  EXPECT_NE(rejected("[track]\npad.kz = 65.0\n"), "no error") << "kN/mm";
  EXPECT_NE(rejected("[track]\nsleeper.mass = 0.25\n"), "no error") << "t";
  EXPECT_NE(rejected("[[bridge]]\nmass = 33.9\n"), "no error") << "t/m";
  EXPECT_NE(rejected("[[load]]\nFy = 1e12\n"), "no error");
  // a steel footbridge, a bridge of 1 km wholly of concrete, rails as good as rigid, soft ballast
  EXPECT_EQ(rejected("[[bridge]]\nlength = 12\nE = 2.1e11\nA = 0.02\nIy = 2e-4\nmass = 400\n"), "no error");
  EXPECT_EQ(rejected("[[bridge]]\nlength = 1000\nA = 60.0\nIy = 900.0\nmass = 3e5\n"), "no error");
  EXPECT_EQ(rejected("[track]\nrail.E = 1e13\npad.kz = 1e12\nballast_ground.kz = 2e6\n"), "no error");
}

TEST_F(Scene, KeysThatNothingWouldUseAreRejected) {
  const auto rejected = [&](const std::string& rest) { return message(online + rest); };
  EXPECT_EQ(rejected("[irregularity]\nseed = 3\n"),
            "scene.toml:4: irregularity.seed: found no irregularity.spectrum, expected irregularity.spectrum, or no "
            "irregularity.seed");
  EXPECT_EQ(
      rejected("[structure]\nwindow_ahead = 30\n"),
      "scene.toml:4: structure.window_ahead: found structure.reduction = \"none\", expected structure.reduction = "
      "\"window\", or no structure.window_ahead");
  EXPECT_EQ(rejected("[structure]\nreduction = \"none\"\nwindow_ahead = 30\n"), "no error");
  EXPECT_EQ(rejected("[structure]\ndamping_ratio = 0.01\n[[bridge]]\n"),
            "scene.toml:4: structure.damping_ratio: found no structure.stiffness, expected structure.stiffness, or "
            "structure.format = \"modes\", or no structure.damping_ratio");
  EXPECT_NE(rejected("[[load]]\nFy = 1.0\n[[load]]\nFy = 1.0\nstart = 2.0\n").find("[[load]] 2 of 2"),
            std::string::npos);
  EXPECT_NE(rejected("[[ground_motion]]\nfile = \"pair.h5\"\nx = 3.0\n").find("ground_motion.x = 3 m of a single"),
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
TEST_F(Scene, KeysOfWhatASceneDoesNotHaveAreRejected) {
  const std::string follow = "contact.normal = \"rigid\"\n";
  const std::string rigid = "contact.mode = \"online\"\ntrack.kind = \"rigid\"\n";
  const std::string rails = "contact.mode = \"online\"\n" + imported_with("") + "structure.damping_ratio = 0.01\n";
  EXPECT_EQ(
      message(follow + "contact.friction = 0.3\n"),
      "scene.toml:2: contact.friction: found contact.normal = \"rigid\", expected contact.normal = \"hertz\", or no "
      "contact.friction");
  EXPECT_EQ(message(rigid + "track.pad.kz = 1e8\n"),
            "scene.toml:3: track.pad.kz: found track.kind = \"rigid\", expected track.kind = \"flexible\", or no "
            "track.pad.kz");
  EXPECT_EQ(message(rigid + "structure.reduction = \"window\"\n"),
            "scene.toml:3: structure.reduction: found track.kind = \"rigid\", expected track.kind = \"flexible\" or "
            "\"imported\", or no structure.reduction");
  struct Case {
    std::string scene, key, value;
  };
  const std::string online_text = "contact.mode = \"online\"\n";
  for (const auto& [text, key, value] :
       {Case{follow, "contact.table", "\"pair.h5\""},
        Case{follow, "contact.mode", "\"online\""},
        Case{follow, "contact.dimensions.track_gauge", "1.437"},
        Case{follow, "train.initial_yaw", "0.001"},
        Case{follow, "train.initial_lateral_shift", "0.001"},
        Case{follow, "integration.contact_force", "\"energy\""},
        Case{rigid, "track.length_before", "10.0"},
        Case{rigid, "structure.mass", "\"pair.h5\""},
        Case{rigid, "structure.window_ahead", "10.0"},
        Case{online_text, "track.ballast_deck.kz", "1e8"},
        Case{online_text + "contact.creep_law = \"polach\"\n", "contact.creep_table", "\"pair.h5\""},
        Case{online_text, "structure.units", "\"m-N-kg\""},
        Case{online_text, "structure.rail_left.set", "\"LEFT\""},
        Case{rails, "track.length_before", "10.0"},
        Case{rails, "structure.deck.set", "\"DECK\""},
        Case{rails, "structure.report", "[3.0]"},
        Case{rails, "structure.sections", "[3.0]"},
        Case{follow, "integration.impact_step", "1e-4"},
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
  EXPECT_EQ(message(rails + "structure.deck.set = \"DECK\"\noutput.deck_envelope = true\nstructure.sections = [3.0]\n"
                            "structure.axis_depth = 2.0\n"),
            "no error");
}

}  // namespace
}  // namespace railtab
