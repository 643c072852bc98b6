#pragma once

#include <string_view>

namespace railtab {

/// Car bodies are named "car-body" or "<vehicle>/car-body".
[[nodiscard]] inline bool is_car_body(std::string_view body_name) noexcept {
  return body_name == "car-body" || body_name.ends_with("/car-body");
}
[[nodiscard]] inline bool is_wheelset(std::string_view body_name) noexcept {
  return body_name.find("wheelset") != std::string_view::npos;
}

}  // namespace railtab
