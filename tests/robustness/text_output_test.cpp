// Text outputs: written whole, to a temporary file that nobody can guess, and in the place of their own kind only.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "../folder_fixture.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/temporary_file.hpp"
#include "railtab/runtime/base/text_file.hpp"

namespace railtab {
namespace {

namespace fs = std::filesystem;

class TextOutput : public testing::InFolder {
 protected:
  [[nodiscard]] std::string text(const std::string& name) const {
    std::ifstream in(folder_ / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  [[nodiscard]] std::string rejection(const std::string& name, const std::string& content) const {
    try {
      write_text_file(folder_ / name, content);
    } catch (const InputError& wrong) {
      return wrong.what();
    }
    return "";
  }
  [[nodiscard]] long files() const { return std::distance(fs::directory_iterator(folder_), fs::directory_iterator()); }
};

TEST_F(TextOutput, NamesBesideItAreNeitherFollowedNorLost) {
  write("precious", "mine");
  fs::create_symlink("precious", folder_ / "r.csv.part");
  write_text_file(folder_ / "r.csv", "a,b\n1,2\n");
  EXPECT_EQ(text("r.csv"), "a,b\n1,2\n");
  EXPECT_EQ(text("precious"), "mine");
  EXPECT_TRUE(fs::is_symlink(folder_ / "r.csv.part"));
  fs::remove(folder_ / "r.csv.part");
  write("r.csv.part", "mine too");
  write_text_file(folder_ / "r.csv", "a,b\n3,4\n");
  EXPECT_EQ(text("r.csv"), "a,b\n3,4\n");
  EXPECT_EQ(text("r.csv.part"), "mine too");
  EXPECT_EQ(files(), 3) << "and no temporary file";
}

TEST_F(TextOutput, ReplacesAnEmptyFileAndItsOwnKindOnly) {
  write("r.csv", "");
  for (const char* rows : {"1,2\n", "3,4\n", ""}) {
    const std::string content = std::string("a,b\n") + rows;
    EXPECT_EQ(rejection("r.csv", content), "");
    EXPECT_EQ(text("r.csv"), content);
  }
  write("r.csv", "a,b\r\n1,2\r\n");
  EXPECT_EQ(rejection("r.csv", "a,b\n5,6\n"), "") << "saved once more by a spreadsheet";

  for (const char* foreign : {"Dear diary\n", "a", "a,b,c\n1,2,3\n", "\na,b\n"}) {
    write("notes.txt", foreign);
    const std::string message = rejection("notes.txt", "a,b\n1,2\n");
    EXPECT_NE(message.find("notes.txt: found a file that begins with '"), std::string::npos) << message;
    EXPECT_NE(message.find("expected a new name, or"), std::string::npos) << message;
    EXPECT_NE(message.find("begins with 'a,b'"), std::string::npos) << message;
    EXPECT_EQ(text("notes.txt"), foreign);
  }
  write("escape.txt", "\x1b[2Jgone");
  EXPECT_EQ(rejection("escape.txt", "a,b\n").find('\x1b'), std::string::npos);
}

TEST_F(TextOutput, AMarkTellsKindsWhoseFirstLineVaries) {
  write_text_file(folder_ / "f.csv", "# railtab, Monday\n1\n", "# railtab");
  write_text_file(folder_ / "f.csv", "# railtab, Tuesday\n1\n", "# railtab");
  EXPECT_EQ(text("f.csv"), "# railtab, Tuesday\n1\n");
  write("f.csv", "# other\n");
  EXPECT_THROW(write_text_file(folder_ / "f.csv", "# railtab, Friday\n", "# railtab"), InputError);
}

TEST_F(TextOutput, ALinkIsFollowedToWhatItNames) {
  fs::create_directory(folder_ / "elsewhere");
  fs::create_symlink("elsewhere/r.csv", folder_ / "link.csv");
  for (const char* content : {"a\n1\n", "a\n2\n"}) {
    write_text_file(folder_ / "link.csv", content);
    EXPECT_EQ(text("elsewhere/r.csv"), content);
  }
  EXPECT_TRUE(fs::is_symlink(folder_ / "link.csv"));
  write("elsewhere/r.csv", "somebody's");
  EXPECT_THROW(write_text_file(folder_ / "link.csv", "a\n"), InputError);
  EXPECT_EQ(text("elsewhere/r.csv"), "somebody's");
}

TEST_F(TextOutput, LeftOversGoAndWhatIsBeingWrittenStays) {
  write("r.csv.part-abcdefghijkl", "of a process that was killed");
  write("other.csv.part-abcdefghijkl", "of another output");
  write("r.csv.part-abcdefghijk", "shorter");
  write("r.csv.part-ABCDEFGHIJKL", "other letters");
  write("precious", "mine");
  fs::create_symlink("precious", folder_ / "r.csv.part-aaaaaaaaaaaa");
  const TemporaryFile living = create_temporary(folder_ / "r.csv");
  EXPECT_FALSE(fs::exists(folder_ / "r.csv.part-abcdefghijkl"));
  write_text_file(folder_ / "r.csv", "a\n");
  EXPECT_TRUE(fs::exists(living.name)) << "its writer holds the lock";
  EXPECT_EQ(files(), 7);
  EXPECT_EQ(text("precious"), "mine");
}

TEST_F(TextOutput, TemporaryFilesAreNewAndHaveNamesThatCannotBeGuessed) {
  const TemporaryFile one = create_temporary(folder_ / "r.h5"), other = create_temporary(folder_ / "r.h5");
  EXPECT_NE(one.name, other.name);
  for (const TemporaryFile* file : {&one, &other}) {
    EXPECT_TRUE(file->name.filename().string().starts_with("r.h5.part-")) << file->name;
    EXPECT_TRUE(file->lock.held());
    EXPECT_FALSE(WriterLock::if_free(file->name).held());
  }
  EXPECT_THROW(static_cast<void>(create_temporary(folder_ / "none" / "r.h5")), InputError);
}

}  // namespace
}  // namespace railtab
