#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "railtab/runtime/scene/scene_keys.hpp"
#include "railtab/runtime/scene/scene_parameters.hpp"
#include "railtab/runtime/track/irregularity_spectrum.hpp"
#include "railtab/tables/input_error.hpp"

namespace railtab {
namespace {

/// A scene in a folder of its own, with a file that may stand for a table.
class Scene : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(::testing::TempDir()) /
              (std::string("scene_") + ::testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
    std::ofstream(folder_ / "pair.h5") << "stands for a table";
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  [[nodiscard]] SceneParameters read(const std::string& text) const {
    std::ofstream(folder_ / "scene.toml") << text;
    return read_scene(folder_ / "scene.toml");
  }

  /// The message of the error that this scene gives, without the folder's name.
  [[nodiscard]] std::string message(const std::string& text) const {
    try {
      static_cast<void>(read(text));
    } catch (const InputError& wrong) {
      std::string what = wrong.what();
      for (std::size_t at; (at = what.find(folder_.string() + "/")) != std::string::npos;) {
        what.erase(at, folder_.string().size() + 1);
      }
      return what;
    }
    return "no error";
  }

  std::filesystem::path folder_;
};

constexpr const char* online = "[contact]\nmode = \"online\"\n";

TEST_F(Scene, EverySectionReachesItsMember) {
  const SceneParameters scene = read(R"(name = "all sections"
[train]
count = 3
speed_kmh = 180
start = -12.5
initial_lateral_shift = 0.002
[contact]
mode = "table"
table = "pair.h5"
creep_law = "fastsim"
friction = 0.4
material = { E = 206e9, nu = 0.3 }
[track]
kind = "flexible"
elements_per_bay = 4
rail.mass = 54
pad.kz = 80e6
ballast_deck.cx = 0
[[bridge]]
length = 20
count = 2
[[bridge]]
[integration]
time_step = 1e-3
alpha = 0
max_halvings = 3
[output]
every = 5
)");
  EXPECT_EQ(scene.name, "all sections");
  EXPECT_EQ(scene.train.count, 3);
  EXPECT_DOUBLE_EQ(scene.train.speed, 50.0);
  EXPECT_EQ(scene.train.start, -12.5);
  EXPECT_EQ(scene.train.initial_lateral_shift, 0.002);
  EXPECT_EQ(scene.contact.mode, ContactMode::table);
  EXPECT_EQ(scene.contact.table, folder_ / "pair.h5");
  EXPECT_EQ(scene.contact.creep_law, "fastsim");
  EXPECT_EQ(scene.contact.friction, 0.4);
  EXPECT_EQ(scene.contact.material.E, 206e9);
  EXPECT_EQ(scene.contact.material.nu, 0.3);
  EXPECT_EQ(scene.track_kind, TrackKind::flexible);
  EXPECT_EQ(scene.track.elements_per_bay, 4);
  EXPECT_EQ(scene.track.rail.mass, 54.0);
  EXPECT_EQ(scene.track.pad.kz, 80e6);
  EXPECT_EQ(scene.track.ballast_deck.cx, 0.0);
  ASSERT_EQ(scene.spans.size(), 3u);
  EXPECT_EQ(scene.spans[0].length, 20.0);
  EXPECT_EQ(scene.spans[1].length, 20.0);
  EXPECT_EQ(scene.spans[2].length, BridgeParameters{}.length);
  EXPECT_EQ(scene.integration.time_step, 1e-3);
  EXPECT_EQ(scene.integration.alpha, 0.0);
  EXPECT_EQ(scene.integration.max_halvings, 3);
  EXPECT_EQ(scene.output.every, 5);
  EXPECT_FALSE(scene.irregularity.has_value());
}

TEST_F(Scene, ProfilesAndDimensionsCountWithoutATable) {
  const SceneParameters scene =
      read(std::string(online) + "rail_inclination = \"1:20\"\ndimensions.track_gauge = 1.437\n");
  EXPECT_DOUBLE_EQ(scene.contact.rail_inclination, 0.05);
  EXPECT_EQ(scene.contact.dimensions.track_gauge, 1.437);
}

TEST_F(Scene, KeepsItsTextAndTakesItsNameFromTheFile) {
  const SceneParameters scene = read(online);
  EXPECT_EQ(scene.text, online);
  EXPECT_EQ(scene.name, "scene");
  EXPECT_TRUE(scene.spans.empty());
}

TEST_F(Scene, UnknownKeyNamesItsLineAndTheNearestKey) {
  EXPECT_EQ(message(std::string(online) + "\n[tran]\nsped = 3\n"),
            "scene.toml:5: unknown key 'tran.sped'; did you mean 'train.speed'?");
  EXPECT_EQ(message(std::string(online) + "frction = 0.2\n"),
            "scene.toml:3: unknown key 'contact.frction'; did you mean 'contact.friction'?");
  EXPECT_EQ(message("speed_kmh = 200\n"), "scene.toml:1: unknown key 'speed_kmh'; did you mean 'train.speed_kmh'?");
  EXPECT_EQ(message("[[bridge]]\nlenght = 200\n"),
            "scene.toml:2: unknown key 'bridge.lenght'; did you mean 'bridge.length'?");
  EXPECT_EQ(message("[track.pad]\nstiffness_in_the_vertical_direction = 1\n").substr(0, 70),
            "scene.toml:2: unknown key 'track.pad.stiffness_in_the_vertical_directi");
  EXPECT_EQ(message("[weather]\n"),
            "scene.toml:1: unknown key 'weather'; the sections are train, contact, track, "
            "bridge, structure, irregularity, span_deviation, load, ground_motion, integration and output");
}

TEST_F(Scene, RigidWheelsNeedNoTableAndAnImportedStructureAllItsFiles) {
  const SceneParameters scene = read("[contact]\nnormal = \"rigid\"\n[track]\nkind = \"rigid\"\n");
  EXPECT_EQ(scene.contact.normal, NormalContact::rigid);
  EXPECT_TRUE(scene.contact.table.empty());
  EXPECT_NE(message("[contact]\nnormal = \"rigid\"\n[track]\nkind = \"imported\"\n").find("structure.stiffness"),
            std::string::npos);
  EXPECT_NE(message(std::string(online) + "[track]\nkind = \"imported\"\n[[bridge]]\n").find("[[bridge]]"),
            std::string::npos);
}

TEST_F(Scene, FirstWrongLineOfTheFileIsNamed) {
  EXPECT_TRUE(message("[train]\nzzz = 1\n[contact]\naaa = 2\n").starts_with("scene.toml:2: unknown key 'train.zzz'"));
}

TEST_F(Scene, WrongTypesSayWhatWasFoundAndExpected) {
  EXPECT_EQ(message("[train]\nspeed = \"fast\"\n"),
            "scene.toml:2: train.speed: found the text \"fast\", expected a number, > 0, <= 200 m/s");
  EXPECT_EQ(message("[train]\ncount = 2.5\n"), "scene.toml:2: train.count: found 2.5, expected an integer 1 to 100");
  EXPECT_EQ(message("[train]\ncount = 101\n"), "scene.toml:2: train.count: found 101, expected an integer 1 to 100");
  EXPECT_EQ(message("[contact]\nmode = true\n"),
            "scene.toml:2: contact.mode: found true, expected one of table, online, paper");
  EXPECT_EQ(message("train = 3\n"), "scene.toml:1: train: found 3, expected a section [train]");
  EXPECT_EQ(message("[bridge]\nlength = 3\n"),
            "scene.toml:1: bridge: found [bridge], expected one [[bridge]] per span");
  EXPECT_EQ(message("[contact]\nfriction = [0.1, 0.2]\n"),
            "scene.toml:2: contact.friction: found a value of type array, expected a number, 0 to 2");
}

TEST_F(Scene, NumbersOutOfRangeAreRefused) {
  for (const char* number : {"-1", "0", "nan", "inf", "201"}) {
    EXPECT_TRUE(
        message(std::string("[train]\nspeed = ") + number + "\n").starts_with("scene.toml:2: train.speed: found"))
        << number;
  }
  EXPECT_TRUE(message("[integration]\nalpha = -0.4\n").starts_with("scene.toml:2: integration.alpha: found -0.4"));
  EXPECT_EQ(read(std::string(online) + "[integration]\nalpha = -0.3333333333333333\n").integration.alpha,
            -0.3333333333333333);
}

TEST_F(Scene, RailInclinationAsRatioOrNumber) {
  EXPECT_DOUBLE_EQ(read(std::string(online) + "rail_inclination = \"1:40\"\n").contact.rail_inclination, 0.025);
  EXPECT_EQ(read(std::string(online) + "rail_inclination = 0.05\n").contact.rail_inclination, 0.05);
  for (const char* wrong : {"\"1:0\"", "\"1:\"", "\"2:40\"", "\"1:40x\"", "\"1:2\"", "0.5", "\"\""}) {
    EXPECT_TRUE(message(std::string(online) + "rail_inclination = " + wrong + "\n")
                    .starts_with("scene.toml:3: contact.rail_inclination: found"))
        << wrong;
  }
}

TEST_F(Scene, SpeedIsGivenOnce) {
  EXPECT_EQ(message(std::string(online) + "[train]\nspeed_kmh = 200\nspeed = 50\n"),
            "scene.toml:5: train.speed: found train.speed_kmh too, expected either train.speed or train.speed_kmh");
}

TEST_F(Scene, MissingFilesAreNamed) {
  EXPECT_EQ(message("[contact]\ntable = \"none.h5\"\n"),
            "scene.toml:2: contact.table: found no file none.h5, expected an existing file, relative to the scene");
  EXPECT_EQ(message(std::string(online) + "[irregularity]\nfile = \"bumps.csv\"\n").substr(0, 58),
            "scene.toml:4: irregularity.file: found no file bumps.csv, ");
  EXPECT_TRUE(message(std::string(online) + "wheel = \"S1003\"\n")
                  .starts_with("scene.toml:3: contact.wheel: found the "
                               "text \"S1003\", expected a built-in"));
  EXPECT_THROW(static_cast<void>(read_scene(folder_ / "absent.toml")), InputError);
}

TEST_F(Scene, PartsThatDoNotFitTogetherAreRefused) {
  EXPECT_TRUE(message("[train]\n").starts_with("scene.toml: scene: found contact.mode = \"table\" without"));
  EXPECT_TRUE(message(std::string(online) + "[track]\nkind = \"rigid\"\n[[bridge]]\n")
                  .starts_with("scene.toml: scene: found a [[bridge]] on track.kind = \"rigid\""));
}

TEST_F(Scene, TomlErrorsNameTheLine) {
  EXPECT_TRUE(message("[train]\nspeed = = 3\n").starts_with("scene.toml:2: "));
  EXPECT_TRUE(message("[train]\nspeed = 3\nspeed = 4\n").starts_with("scene.toml:3: "));
}

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

/// A scene with one key set, and what has to stand beside it.
/// What a key of no use by itself stands beside.
std::string companion(const std::string& key) {
  if (key.starts_with("span_deviation.")) return "span_deviation.shape = \"bending\"\n";
  const std::string both_waves = key.ends_with("shortest_wave")  ? "irregularity.longest_wave = 500.0\n"
                                 : key.ends_with("longest_wave") ? "irregularity.shortest_wave = 0.1\n"
                                                                 : "";
  if (key.starts_with("irregularity."))
    return "irregularity.spectrum = \"" + spectrum_names().front() + "\"\n" + both_waves;
  if (key == "structure.modes") return "structure.reduction = \"modal\"\n";
  if (key.starts_with("structure.window")) return "structure.reduction = \"window\"\n";
  if (key.starts_with("structure.") && key.find("damping") != std::string::npos) {
    std::string files = "track.kind = \"imported\"\n";
    for (const char* file : {"mass", "stiffness", "damping", "dofs"})
      files += fmt::format("structure.{} = \"pair.h5\"\n", file);
    return files;
  }
  return "";
}

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
    bridge += "[[load]]\nFy = 1.0\n" + line(5);
  } else if (key.starts_with("ground_motion."))
    bridge += "[[ground_motion]]\nfile = \"pair.h5\"\n" + line(14);
  else
    rest = companion(key) + line(0);
  if (key.find("damping") != std::string::npos && key.starts_with("structure.")) bridge.clear();
  return rest + "[contact]\n" + contact + bridge;
}

/// What the guide says of a range holds to its ends, through every check that a scene passes before it is built.
TEST_F(Scene, RangesHoldToTheirEnds) {
  // the rail's height and that of its head bound each other, and so do the two wavelengths
  int checked = 0;
  for (const SceneKey& key : scene_keys()) {
    if (key.type != "number" && key.type != "integer" && key.type != "ratio") continue;
    const bool integer = key.type == "integer";
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
  EXPECT_GT(checked, 80);
}

TEST_F(Scene, RulesOverSeveralKeysNameALine) {
  EXPECT_EQ(message(std::string(online) + "[track]\nrail.head_height = 0.2\n").substr(0, 40),
            "scene.toml:4: track.rail.head_height: fo");
}

TEST_F(Scene, KeysThatNothingWouldUseAreRefused) {
  const auto refused = [&](const std::string& rest) { return message(online + rest); };
  EXPECT_EQ(refused("[irregularity]\nseed = 3\n"),
            "scene.toml:4: irregularity.seed: found no irregularity.spectrum, expected one, or no seed");
  EXPECT_EQ(refused("[structure]\nmodes = 30\n"),
            "scene.toml:4: structure.modes: found a structure.reduction without modes, expected \"modal\" or "
            "\"craig-bampton\"");
  EXPECT_EQ(refused("[structure]\nreduction = \"modal\"\nwindow_ahead = 30\n"),
            "scene.toml:5: structure.window_ahead: found a structure.reduction without window, expected \"window\"");
  EXPECT_EQ(refused("[structure]\nreduction = \"none\"\nwindow_ahead = 30\nmodes = 20\n"), "no error");
  EXPECT_EQ(refused("[structure]\ndamping_ratio = 0.01\n[[bridge]]\n"),
            "scene.toml:4: structure.damping_ratio: found no structure.stiffness, expected an imported structure, or "
            "damping_ratio and damping_type in [[bridge]]");
  EXPECT_NE(refused("[[load]]\nFy = 1.0\n[[load]]\nFy = 1.0\nstart = 2.0\n").find("[[load]] 2 of 2"),
            std::string::npos);
  EXPECT_NE(refused("[[ground_motion]]\nfile = \"pair.h5\"\nx = 3.0\n").find("ground_motion.x = 3 m of a single"),
            std::string::npos);
}

/// The guide's key list is written from the reader's own table; a key, range or default that changes must change there.
TEST(SceneGuide, ListsEveryKeyAsTheReaderKnowsIt) {
  std::ifstream stream(RAILTAB_SOURCE_DIR "/docs/guide/scene.md");
  const std::string guide((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  std::string missing;
  for (const SceneKey& key : scene_keys()) {
    const std::string row = "| `" + key.path + "` | " + key.type + " | " + key.unit + " | " + key.range + " | " +
                            key.standard + " | " + key.meaning + " |\n";
    if (guide.find(row) == std::string::npos) missing += row;
  }
  EXPECT_EQ(missing, "") << "rows that docs/guide/scene.md should have";
  EXPECT_GT(scene_keys().size(), 60u);
}

TEST(SceneExamples, TheDemoSceneNamesOnlyTheTableThatTheDemoMakes) {
  try {
    const SceneParameters scene = read_scene(RAILTAB_SOURCE_DIR "/docs/examples/demo.toml");
    EXPECT_EQ(scene.spans.size(), 1u);
  } catch (const InputError& wrong) {
    EXPECT_NE(std::string(wrong.what()).find("contact.table: found no file"), std::string::npos) << wrong.what();
  }
}

}  // namespace
}  // namespace railtab
