#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace railtab::testing {

/// Attribute of an XML tag; empty where it is not there.
inline std::string attribute(std::string_view tag, const std::string& name) {
  const std::size_t at = tag.find(fmt::format(" {}=\"", name));
  if (at == std::string_view::npos) return {};
  const std::size_t from = at + name.size() + 3;
  return std::string(tag.substr(from, tag.find('"', from) - from));
}

inline std::vector<unsigned char> decoded(std::string_view base64) {
  constexpr std::string_view alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<unsigned char> bytes;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : base64) {
    if (c == '=') break;
    bits = (bits << 6U) | static_cast<std::uint32_t>(alphabet.find(c));
    count += 6;
    if (count >= 8) {
      count -= 8;
      bytes.push_back(static_cast<unsigned char>((bits >> static_cast<unsigned>(count)) & 0xFFU));
    }
  }
  return bytes;
}

/// A .vtu as its format says it, read with none of the writer's code: arrays by their name, inline and in base64 with
/// a 64-bit length before them; texts as the numbers of their bytes.
struct VtuFile {
  std::map<std::string, std::vector<double>> arrays;
  std::map<std::string, std::vector<std::string>> texts;
  long points = 0, cells = 0;

  explicit VtuFile(const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    EXPECT_NE(text.find("byte_order=\"LittleEndian\" header_type=\"UInt64\""), std::string::npos) << file;
    const std::size_t piece = text.find("<Piece ");
    if (piece == std::string::npos) {
      ADD_FAILURE() << file << " has no piece";
      return;
    }
    points = std::stol(attribute(text.substr(piece, 200), "NumberOfPoints"));
    cells = std::stol(attribute(text.substr(piece, 200), "NumberOfCells"));
    for (std::size_t at = text.find("Array type="); at != std::string::npos; at = text.find("Array type=", at + 1)) {
      const std::size_t end = text.find('>', at), close = text.find('<', end);
      const std::string tag = fmt::format(" {}", text.substr(at, end - at)),
                        body = text.substr(end + 1, close - end - 1);
      if (attribute(tag, "type") == "String") {
        add_texts(attribute(tag, "Name"), body);
      } else {
        arrays[attribute(tag, "Name")] = numbers(attribute(tag, "type"), decoded(body));
      }
    }
  }

  [[nodiscard]] std::array<double, 3> vector(const std::string& name, std::size_t i) const {
    const std::vector<double>& values = arrays.at(name);
    return {values.at(3 * i), values.at(3 * i + 1), values.at(3 * i + 2)};
  }

 private:
  template <class Value>
  static std::vector<double> as(const std::vector<unsigned char>& bytes) {
    std::uint64_t length = 0;
    std::memcpy(&length, bytes.data(), sizeof length);
    EXPECT_EQ(length, bytes.size() - sizeof length);
    std::vector<double> values;
    for (std::size_t i = sizeof length; i + sizeof(Value) <= bytes.size(); i += sizeof(Value)) {
      Value value{};
      std::memcpy(&value, bytes.data() + i, sizeof value);
      values.push_back(static_cast<double>(value));
    }
    return values;
  }
  static std::vector<double> numbers(const std::string& type, const std::vector<unsigned char>& bytes) {
    if (type == "Float32") return as<float>(bytes);
    if (type == "Float64") return as<double>(bytes);
    if (type == "UInt8") return as<std::uint8_t>(bytes);
    if (type == "Int32") return as<std::int32_t>(bytes);
    EXPECT_EQ(type, "Int64");
    return as<std::int64_t>(bytes);
  }
  void add_texts(const std::string& name, const std::string& body) {
    std::string one;
    for (std::size_t from = 0; from < body.size();) {
      const int byte = std::stoi(body.substr(from));
      if (byte == 0) texts[name].push_back(std::exchange(one, {}));
      if (byte != 0) one += static_cast<char>(byte);
      from = body.find(' ', from) + 1;
    }
  }
};

}  // namespace railtab::testing
