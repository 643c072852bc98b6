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
    constexpr std::size_t blocks = lanes_of<V> / 4;
    Pack of_number[blocks][4];
    for (std::size_t b = 0; b < blocks; ++b) {
      transpose(of_thing[4 * b], of_thing[4 * b + 1], of_thing[4 * b + 2], of_thing[4 * b + 3], of_number[b]);
    }
    for (std::size_t q = 0; q < 4; ++q) {
      if constexpr (V::width == 8) {
        // As one register: two halves stored would be read as a whole before they have left the processor's buffer.
        for (std::size_t b = 0; b < blocks; b += 2) {
          numbers[q].part[b / 2] =
              __builtin_shufflevector(of_number[b][q], of_number[b + 1][q], 0, 1, 2, 3, 4, 5, 6, 7);
        }
      } else {
        for (std::size_t b = 0; b < blocks; ++b) {
          std::memcpy(&lane(numbers[q], static_cast<int>(4 * b)), &of_number[b][q], sizeof(Pack));
        }
      }
    }
  }
}

}  // namespace railtab
