#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/scene/scene_parameters.hpp"
#include "scene_fixture.hpp"

namespace railtab {
namespace {

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
  EXPECT_EQ(message("[[load]]\ndirection = 3\n"),
            "scene.toml:2: unknown key 'load.direction'; did you mean 'load.wind_direction'?");
  EXPECT_EQ(message("speed_kmh = 200\n"), "scene.toml:1: unknown key 'speed_kmh'; did you mean 'train.speed_kmh'?");
  EXPECT_EQ(message("[[bridge]]\nlenght = 200\n"),
            "scene.toml:2: unknown key 'bridge.lenght'; did you mean 'bridge.length'?");
  EXPECT_EQ(message("[track.pad]\nstiffness_in_the_vertical_direction = 1\n").substr(0, 70),
            "scene.toml:2: unknown key 'track.pad.stiffness_in_the_vertical_directi");
  EXPECT_EQ(message("[weather]\n"),
            "scene.toml:1: unknown key 'weather'; the sections are train, vehicle, contact, profiles, "
            "track, bridge, structure, support, irregularity, span_deviation, wheel, load, ground_motion, integration, "
            "output "
            "and assessment");
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
            "scene.toml:2: train.speed: found the text \"fast\", expected a number, 0.001 to 200 m/s");
  EXPECT_EQ(message("[train]\ncount = 2.5\n"), "scene.toml:2: train.count: found 2.5, expected an integer 1 to 100");
  EXPECT_EQ(message("[train]\ncount = 2.0\n"),
            "scene.toml:2: train.count: found 2.0, a number with a decimal point, expected an integer 1 to 100");
  EXPECT_EQ(message("[train]\ncount = 101\n"), "scene.toml:2: train.count: found 101, expected an integer 1 to 100");
  EXPECT_EQ(message("[contact]\nmode = true\n"),
            "scene.toml:2: contact.mode: found true, expected one of table, online, paper");
  EXPECT_EQ(message("train = 3\n"), "scene.toml:1: train: found 3, expected a section [train]");
  EXPECT_EQ(message("[bridge]\nlength = 3\n"),
            "scene.toml:1: bridge: found [bridge], expected one [[bridge]] per span");
  EXPECT_EQ(message("[contact]\nfriction = [0.1, 0.2]\n"),
            "scene.toml:2: contact.friction: found a value of type array, expected a number, 0 to 2");
}

TEST_F(Scene, NumbersOutOfRangeAreRejected) {
  for (const char* number : {"-1", "0", "nan", "inf", "201"}) {
    EXPECT_TRUE(
        message(std::string("[train]\nspeed = ") + number + "\n").starts_with("scene.toml:2: train.speed: found"))
        << number;
  }
  EXPECT_TRUE(message("[integration]\nalpha = -0.4\n").starts_with("scene.toml:2: integration.alpha: found -0.4"));
  EXPECT_EQ(read(std::string(online) + "[integration]\nalpha = -0.3333333333333333\n").integration.alpha,
            -0.3333333333333333);
}

TEST_F(Scene, RailInclinationIsOfBuiltInRails) {
  const std::string inclined = std::string(online) + "rail_inclination = \"1:20\"\n";
  EXPECT_EQ(read(inclined + "rail = \"uic60\"\n").contact.rail_inclination, 0.05);
  write("rail.txt", "stands for a profile");
  EXPECT_EQ(message(inclined + "rail = \"rail.txt\"\n"),
            "scene.toml:3: contact.rail_inclination: found the file contact.rail = \"rail.txt\", expected a built-in "
            "contact.rail, or no contact.rail_inclination");
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
            "scene.toml:5: train.speed: found train.speed_kmh too, expected no train.speed_kmh, or no train.speed");
}

TEST_F(Scene, MissingFilesAreNamed) {
  EXPECT_EQ(message("[contact]\ntable = \"none.h5\"\n"),
            "scene.toml:2: contact.table: found no file none.h5, expected an existing file, relative to the scene");
  EXPECT_EQ(message(std::string(online) + "[irregularity]\nfile = \"bumps.csv\"\n").substr(0, 58),
            "scene.toml:4: irregularity.file: found no file bumps.csv, ");
  const std::string too_long(300, 'f');
  EXPECT_TRUE(message(std::string(online) + "[irregularity]\nfile = \"" + too_long + "\"\n")
                  .starts_with("scene.toml:4: irregularity.file: found no file fff"));
  EXPECT_TRUE(message(std::string(online) + "wheel = \"" + too_long + "\"\n")
                  .starts_with("scene.toml:3: contact.wheel: found the text \"fff"));
  EXPECT_TRUE(message(std::string(online) + "wheel = \"S1003\"\n")
                  .starts_with("scene.toml:3: contact.wheel: found the "
                               "text \"S1003\", expected a built-in"));
  EXPECT_THROW(static_cast<void>(read_scene(folder_ / "absent.toml")), InputError);
}

TEST_F(Scene, FilesThatAreNotNeededMayBeMissing) {
  const auto read = [&](const std::string& text) {
    write("scene.toml", text);
    return read_scene(folder_ / "scene.toml", {}, SceneFiles::of_train_and_structure);
  };
  const std::string rest = "[irregularity]\nfile = \"none.csv\"\n";
  const SceneParameters by_table = read("[contact]\ntable = \"none.h5\"\n" + rest);
  EXPECT_EQ(by_table.contact.table, folder_ / "none.h5");
  EXPECT_TRUE(by_table.files.empty());
  EXPECT_EQ(read("[contact]\ntable = \"pair.h5\"\n" + rest).files,
            std::vector<std::filesystem::path>{folder_ / "pair.h5"});
  EXPECT_EQ(read(std::string(online) + "wheel = \"none.prw\"\n").contact.wheel, "none.prw");
  EXPECT_THROW(static_cast<void>(read(std::string(online) + "[train]\nspeed_file = \"none.csv\"\n")), InputError);
}

TEST_F(Scene, EmptyTextsAreNamed) {
  EXPECT_EQ(message("name = \"\"\n" + std::string(online)),
            "scene.toml:1: name: found the text \"\", expected a text that is not empty");
}

TEST_F(Scene, PartsThatDoNotFitTogetherAreRejected) {
  EXPECT_TRUE(message("[train]\n").starts_with("scene.toml: contact.mode: found \"table\" without"));
  EXPECT_TRUE(message(std::string(online) + "[track]\nkind = \"rigid\"\n[[bridge]]\n")
                  .starts_with("scene.toml:4: track.kind: found \"rigid\" and a [[bridge]]"));
  EXPECT_TRUE(message(std::string(online) + "[irregularity]\nspectrum = \"german-low\"\nfade_in = 100\n"
                                            "[assessment]\nend = 50\n")
                  .starts_with("scene.toml:7: assessment.end: found 50 m, and judging begins at 100 m"));
}

TEST_F(Scene, TomlErrorsNameTheLine) {
  EXPECT_TRUE(message("[train]\nspeed = = 3\n").starts_with("scene.toml:2: "));
  EXPECT_TRUE(message("[train]\nspeed = 3\nspeed = 4\n").starts_with("scene.toml:3: "));
}

TEST_F(Scene, DecimalCommasAreNamed) {
  EXPECT_EQ(message("[integration]\ntime_step = 0,5e-3  # half a millisecond\n"),
            "scene.toml:2: integration.time_step: found 0,5e-3, expected a number with a decimal point: 0.5e-3");
  for (const char* line : {"speed = ,5", "speed = 1,", "speed = 1,5,6", "speed = 1,5 m", "speed"}) {
    const std::string other = message("[train]\n" + std::string(line) + "\n");
    EXPECT_TRUE(other.starts_with("scene.toml:2: ") && other.find("decimal") == std::string::npos) << other;
  }
}

TEST_F(Scene, RulesOverSeveralKeysNameALine) {
  EXPECT_EQ(message(std::string(online) + "[track]\nrail.head_height = 0.2\n").substr(0, 40),
            "scene.toml:4: track.rail.head_height: fo");
}

TEST_F(Scene, SupportsOfAnImportedStructure) {
  std::string scene = std::string(online) + "[track]\nkind = \"imported\"\n[structure]\n";
  for (const char* file : {"mass", "stiffness", "damping", "dofs", "nodes"})
    scene += fmt::format("{} = \"pair.h5\"\n", file);
  scene += "rail_left.set = \"LEFT\"\nrail_right.set = \"RIGHT\"\n";
  const std::string supports =
      "[[support]]\nset = \"PIER\"\nx = 32.0\n[[support]]\nfrom = [0, 0, 0]\nto = [0, 2, 0]\nholds = [\"z\"]\n";
  const std::string wave = "[[ground_motion]]\nfile = \"pair.h5\"\nwave_speed = 300.0\n";
  ASSERT_EQ(message(scene + supports + wave), "no error");
  const std::vector<FeSupport> read = read_scene(folder_ / "scene.toml").structure.supports;
  ASSERT_EQ(read.size(), 2U);
  EXPECT_EQ(read[0].nodes.set, "PIER");
  EXPECT_EQ(read[0].x, 32.0);
  EXPECT_EQ(read[0].holds, (std::vector<std::string>{"x", "y", "z"}));
  EXPECT_FALSE(read[1].x);
  EXPECT_NE(message(scene + "[irregularity]\nspectrum = \"german-low\"\nshortest_wave = 50\nlongest_wave = 10\n")
                .find("irregularity.longest_wave: found 10 m with irregularity.shortest_wave = 50 m"),
            std::string::npos);
  EXPECT_EQ(read[1].holds, (std::vector<std::string>{"z"}));
  EXPECT_NE(message(scene + wave).find("under an imported structure without [[support]]"), std::string::npos);
  EXPECT_NE(
      message(std::string(online) + "[[support]]\nset = \"PIER\"\n").find("support.set: found no structure.nodes"),
      std::string::npos);
  EXPECT_EQ(message(scene + "[[ground_motion]]\nfile = \"pair.h5\"\n"), "no error");
}

// Keys with other values than the file's: as if the file had them, but for the scene's text, which says so.
TEST_F(Scene, ChangedKeysCountAsIfTheFileHadThem) {
  const std::string text = std::string(online) + R"([train]
speed_kmh = 180
[[bridge]]
length = 20
[[bridge]]
length = 30
)";
  static_cast<void>(read(text));
  const auto changed = [&](const std::vector<KeyChange>& changes) {
    return read_scene(folder_ / "scene.toml", changes);
  };
  const SceneParameters scene = changed({{"train.speed_kmh", ""},
                                         {"train.speed", "40"},
                                         {"bridge.2.length", "25.5"},
                                         {"bridge.2.damping_ratio", "0.02"},
                                         {"track.rail.mass", "54"},
                                         {"contact.material.nu", "0.3"},
                                         {"contact.creep_law", "\"polach\""}});
  EXPECT_EQ(scene.train.speed, 40.0);
  ASSERT_EQ(scene.spans.size(), 2u);
  EXPECT_EQ(scene.spans[0].length, 20.0);
  EXPECT_EQ(scene.spans[0].damping_ratio, BridgeParameters{}.damping_ratio);
  EXPECT_EQ(scene.spans[1].length, 25.5);
  EXPECT_EQ(scene.spans[1].damping_ratio, 0.02);
  EXPECT_EQ(scene.track.rail.mass, 54.0);
  EXPECT_EQ(scene.contact.material.nu, 0.3);
  EXPECT_EQ(scene.contact.creep_law, "polach");
  EXPECT_EQ(scene.text.substr(0, text.size()), text);
  EXPECT_NE(scene.text.find("# changed: without train.speed_kmh, train.speed = 40, "), std::string::npos);

  const auto rejected = [&](const KeyChange& change, const std::string& part) {
    try {
      static_cast<void>(changed({change}));
      ADD_FAILURE() << change.key;
    } catch (const InputError& wrong) {
      EXPECT_NE(std::string(wrong.what()).find(part), std::string::npos) << wrong.what();
    }
  };
  rejected({"train.speed_kmh", "fast"}, "scene.toml: train.speed_kmh: found the value fast");
  rejected({"train.speed_kmh", "1\ny = 2"}, "found the value");
  rejected({"train.speed_kmh", "-1"}, "train.speed_kmh: found -1, expected");
  rejected({"train.speed_kmh", "-1"}, "(changed: train.speed_kmh = -1)");
  rejected({"train.speeed", "1"}, "did you mean 'train.speed'");
  rejected({"bridge.length", "1"}, "found 2 [[bridge]] in the scene");
  rejected({"bridge.3.length", "1"}, "found 2 [[bridge]] in the scene");
  rejected({"bridge.01.length", "1"}, "bridge.01.length: found the number 01, expected 1, without a zero before it");
  rejected({"load.1.start", "1"}, "found 0 [[load]] in the scene");
  rejected({"train.speed_kmh.x", "1"}, "found speed_kmh, which is no section");
  rejected({"", "1"}, "unknown key ''");
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
