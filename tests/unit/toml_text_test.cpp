// TOML texts that would end the parser by recursion, or occupy it for minutes, are rejected before it sees them.

#include "railtab/runtime/base/toml_text.hpp"

#include <gtest/gtest.h>

#include <string>

#include "../folder_fixture.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/scene/scene_parameters.hpp"

namespace railtab {
namespace {

std::string repeated(const std::string& text, int times) {
  std::string result;
  for (int i = 0; i < times; ++i) result += text;
  return result;
}

std::string message(const std::string& text) {
  try {
    check_toml_bounds(text, "f.toml");
  } catch (const InputError& wrong) {
    return wrong.what();
  }
  return "accepted";
}

TEST(TomlBoundsTest, PartsOfKeysAndHeadings) {
  EXPECT_EQ(message("\n[" + repeated("a.", 39999) + "a]\n"),
            "f.toml:2: found 40000 parts of a key, separated by dots, expected at most 16");
  EXPECT_EQ(message("a = 1\nb = 2\n" + repeated("a.", 19999) + "a = 1\n"),
            "f.toml:3: found 20000 parts of a key, separated by dots, expected at most 16");
  EXPECT_EQ(message("x = {" + repeated("'a.b' . ", 17) + "c = 1}"),
            "f.toml:1: found 18 parts of a key, separated by dots, expected at most 16");
  EXPECT_EQ(message("[" + repeated("a.", 15) + "a]\n"), "accepted");
}

TEST(TomlBoundsTest, DepthOfArraysAndInlineTables) {
  EXPECT_EQ(message("a = " + repeated("[", 17)),
            "f.toml:1: found 17 arrays and inline tables within each other, expected at most 16");
  EXPECT_EQ(message("a = [\n" + repeated("{b = ", 40000)),
            "f.toml:2: found 17 arrays and inline tables within each other, expected at most 16");
  EXPECT_EQ(message("a = " + repeated("[", 16) + repeated("]", 16)), "accepted");
  EXPECT_EQ(message(repeated("[[bridge]]\na = [[1, 2], [3, 4]]\n", 1000)), "accepted");
}

// Dots and brackets of texts and comments are none.
TEST(TomlBoundsTest, TextsAndComments) {
  const std::string many = repeated(".", 100) + repeated("[", 100);
  for (const std::string& text :
       {"# " + many, "a = '" + many + "'", "a = \"\\\"" + many + "\\\\\"", "a = '''\n'" + many + "\n'''",
        "a = \"\"\"\n" + many + "\\\n \"quoted\" \\\"\"\"" + many + "\"\"\"", "a = [1.5, 2.5] # " + many,
        "'" + many + "' = 1"}) {
    EXPECT_EQ(message(text), "accepted") << text;
  }
  const std::string deep = repeated("a.", 30) + "a = 1";
  EXPECT_TRUE(message("a = '''\n\n'''\n" + deep).starts_with("f.toml:4: ")) << message("a = '''\n\n'''\n" + deep);
  EXPECT_TRUE(message("a = \"never closed\n" + deep).starts_with("f.toml:2: "));
  EXPECT_TRUE(message("# [\n" + deep).starts_with("f.toml:2: "));
}

class TomlFiles : public testing::InFolder {};

TEST_F(TomlFiles, ScenesAreBounded) {
  const auto rejected = [&](const std::string& text) {
    try {
      static_cast<void>(read_scene(write("s.toml", text)));
    } catch (const InputError& wrong) {
      return std::string(wrong.what()).substr(folder_.string().size() + 1);
    }
    return std::string("accepted");
  };
  EXPECT_EQ(rejected("[" + repeated("a.", 39999) + "a]\n"),
            "s.toml:1: found 40000 parts of a key, separated by dots, expected at most 16");
  EXPECT_EQ(rejected("name = \"" + std::string(TomlBounds::bytes, 'x') + "\"\n"),
            "s.toml: found more than 4 MB, expected a TOML scene of at most that size");
}

TEST_F(TomlFiles, OfAnotherKindAreNamed) {
  const auto rejected = [&](const char* name, const std::string& text) {
    try {
      static_cast<void>(read_scene(write(name, text)));
    } catch (const InputError& wrong) {
      return std::string(wrong.what()).substr(folder_.string().size() + 1);
    }
    return std::string("accepted");
  };
  EXPECT_EQ(rejected("s.toml", ""), "s.toml: found a file without keys, expected a scene (vsi new writes one)");
  EXPECT_EQ(rejected("p.toml", "scene = \"s.toml\"\n[[vary]]\nkey = \"train.speed\"\n"),
            "p.toml: found a plan of a study, expected a scene");
  EXPECT_EQ(rejected("v.toml", "name = \"v\"\n[car_body]\nmass = 1\n"), "v.toml: found a vehicle, expected a scene");
  EXPECT_EQ(rejected("c.csv", "x,y\n0,0\n"), "c.csv: found a file of columns (.csv), expected a TOML scene");
  EXPECT_EQ(rejected("r.h5", "railtab\n1 bytes follow"),
            "r.h5: found a table or results of railtab, expected a TOML scene");
  EXPECT_EQ(rejected("h.h5", "\x89HDF\r\n\x1a\n"), "h.h5: found an HDF5 file, expected a TOML scene");
  EXPECT_EQ(rejected("b.toml", std::string("a = 1\0", 6)), "b.toml: found a binary file, expected a TOML scene");
}

}  // namespace
}  // namespace railtab
