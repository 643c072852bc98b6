#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "../folder_fixture.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/scene/scene_parameters.hpp"

namespace railtab {

/// A scene in a folder of its own, with a file that may stand for a table.
class Scene : public testing::InFolder {
 protected:
  void SetUp() override {
    InFolder::SetUp();
    write("pair.h5", "stands for a table");
  }

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
};

inline constexpr const char* online = "[contact]\nmode = \"online\"\n";

}  // namespace railtab
