#include "railtab/runtime/report/history_store.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "railtab/runtime/base/printable_text.hpp"

namespace railtab::report {
namespace {

constexpr double steps = 65534.0;     // between the smallest and the largest value
constexpr std::uint16_t gap = 65535;  // no value

/// Smallest and largest value of every `every` records, in the order in which they come.
std::vector<double> thinned(std::span<const double> values, std::size_t every) {
  std::vector<double> pairs;
  for (std::size_t begin = 0; begin < values.size(); begin += every) {
    const std::size_t end = std::min(values.size(), begin + every);
    std::size_t least = values.size(), most = values.size();
    for (std::size_t i = begin; i < end; ++i) {
      if (!std::isfinite(values[i])) continue;
      if (least == values.size() || values[i] < values[least]) least = i;
      if (most == values.size() || values[i] > values[most]) most = i;
    }
    const bool none = least == values.size();
    pairs.push_back(none ? std::numeric_limits<double>::quiet_NaN() : values[std::min(least, most)]);
    pairs.push_back(none ? std::numeric_limits<double>::quiet_NaN() : values[std::max(least, most)]);
  }
  return pairs;
}

}  // namespace

std::string base64(std::span<const unsigned char> bytes) {
  constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t left = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t three = std::uint32_t{bytes[i]} << 16U;
    if (left > 1) three |= std::uint32_t{bytes[i + 1]} << 8U;
    if (left > 2) three |= bytes[i + 2];
    text += letters[three >> 18U];
    text += letters[three >> 12U & 63U];
    text += left > 1 ? letters[three >> 6U & 63U] : '=';
    text += left > 2 ? letters[three & 63U] : '=';
  }
  return text;
}

std::string float_base64(std::span<const double> values) {
  std::vector<unsigned char> bytes;
  bytes.reserve(4 * values.size());
  for (const double value : values) {
    const auto word = std::bit_cast<std::uint32_t>(static_cast<float>(value));
    for (unsigned shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<unsigned char>(word >> shift & 255U));
  }
  return base64(bytes);
}

std::string quantised_json(std::span<const double> values) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  if (low > high) low = high = 0.0;
  const double step = (high - low) / steps;
  std::vector<unsigned char> bytes;
  bytes.reserve(2 * values.size());
  for (const double value : values) {
    const std::uint16_t number = !std::isfinite(value) ? gap
                                 : step > 0.0          ? static_cast<std::uint16_t>(std::lround((value - low) / step))
                                                       : std::uint16_t{0};
    bytes.push_back(static_cast<unsigned char>(number & 255U));
    bytes.push_back(static_cast<unsigned char>(number >> 8U));
  }
  return fmt::format(R"({{"low":{},"step":{},"data":"{}"}})", low, step, base64(bytes));
}

std::string json_string(std::string_view text) {
  std::string result = "\"";
  for (const char c : printable(text)) {
    switch (c) {
      case '"':
        result += "\\\"";
        break;
      case '\\':
        result += "\\\\";
        break;
      case '<':  // never "</script>"
        result += "\\u003c";
        break;
      case '\n':
        result += "\\n";
        break;
      default:
        result += c;
    }
  }
  return result + '"';
}

std::size_t HistoryStore::add_run(std::string_view name, std::span<const double> time,
                                  std::span<const double> position) {
  runs_.push_back(fmt::format(R"({{"name":{},"time":"{}","position":"{}"}})", json_string(name), float_base64(time),
                              float_base64(position)));
  return runs_.size() - 1;
}

std::size_t HistoryStore::add(std::span<const double> values, Detail detail) {
  std::size_t every = 1;
  if (values.size() > detail.most_values) every = (2 * values.size() + detail.most_values - 1) / detail.most_values;
  coarsest_ = std::max(coarsest_, every);
  histories_.push_back(fmt::format(R"({{"every":{},"of":{}}})", every,
                                   every == 1 ? quantised_json(values) : quantised_json(thinned(values, every))));
  return histories_.size() - 1;
}

std::string HistoryStore::json() const {
  if (histories_.empty()) return "";
  return fmt::format("{{\"runs\":[{}],\n\"histories\":[{}]}}", fmt::join(runs_, ",\n"), fmt::join(histories_, ",\n"));
}

}  // namespace railtab::report
