#pragma once

#include <array>
#include <cstddef>
#include <cstring>
#include <type_traits>

#include "railtab/runtime/base/lane_numbers.hpp"
#include "railtab/runtime/base/pack.hpp"

namespace railtab {

/// Numbers of things side by side, to each thing its own, one after the other. Of one thing: a copy.
/// @param to of each thing, room for `count`
template <class V>
void set_apart(const V* numbers, std::size_t count, const std::array<double*, lanes_of<V>>& to) noexcept {
  if constexpr (std::is_same_v<V, double>) {
    std::memcpy(to[0], numbers, count * sizeof(double));
  } else {
    constexpr std::size_t things = lanes_of<V>, block = 4;
    static_assert(things % block == 0);
    std::size_t q = 0;
    for (; q + block <= count; q += block) {
      for (std::size_t first = 0; first < things; first += block) {
        Pack of_number[block], of_thing[block];
        for (std::size_t k = 0; k < block; ++k) {
          std::memcpy(&of_number[k], reinterpret_cast<const double*>(&numbers[q + k]) + first,  // NOLINT
                      sizeof of_number[k]);
        }
        transpose(of_number[0], of_number[1], of_number[2], of_number[3], of_thing);
        for (std::size_t k = 0; k < block; ++k) std::memcpy(to[first + k] + q, &of_thing[k], sizeof of_thing[k]);
      }
    }
    for (; q < count; ++q)
      for (std::size_t i = 0; i < things; ++i) to[i][q] = lane(numbers[q], static_cast<int>(i));
  }
}

/// The other way round, of four numbers of each thing.
template <class V>
void set_side_by_side(const std::array<Pack, lanes_of<V>>& of_thing, V* numbers) noexcept {
  if constexpr (std::is_same_v<V, double>) {
    std::memcpy(numbers, of_thing.data(), sizeof of_thing);
  } else {
    for (std::size_t first = 0; first < of_thing.size(); first += 4) {
      Pack of_number[4];
      transpose(of_thing[first], of_thing[first + 1], of_thing[first + 2], of_thing[first + 3], of_number);
      for (int q = 0; q < 4; ++q) {
        std::memcpy(&lane(numbers[q], static_cast<int>(first)), &of_number[q], sizeof of_number[q]);
      }
    }
  }
}

}  // namespace railtab
