// Sorting by keys of few bits, whose digits need no comparisons.
#pragma once

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <utility>
#include <vector>

namespace photile::geometry {

/// Sorts items in ascending order of key_of(item), an unsigned number below 2^bits, of at most 64
/// bits; items with equal keys keep their order. Digits are processed from the lowest on, each by
/// all cores: 2 (bits / 8) moves per item, and memory for a second copy of all items. (Zagha and
/// Blelloch, "Radix sort for vector multiprocessors", Supercomputing 1991.)
template <class Item, class KeyOf>
void radix_sort(std::vector<Item>& items, int bits, const KeyOf& key_of) {
  constexpr int digit_bits = 8;  // as many write positions as caches and TLBs can hold
  constexpr std::size_t digits = std::size_t{1} << digit_bits, least_chunk = 4096;
  const auto threads = static_cast<std::size_t>(tbb::this_task_arena::max_concurrency());
  const std::size_t chunks = std::clamp<std::size_t>(items.size() / least_chunk, 1, threads);
  const auto begin_of = [&](std::size_t chunk) { return chunk * items.size() / chunks; };

  std::vector<Item> moved(items.size());
  std::vector<std::array<std::size_t, digits>> next(chunks);  // position of a digit's next item
  for (int shift = 0; shift < bits; shift += digit_bits) {
    const auto digit_of = [&](const Item& item) {
      return static_cast<std::size_t>(key_of(item) >> shift) & (digits - 1);
    };
    tbb::parallel_for(std::size_t{0}, chunks, [&](std::size_t chunk) {
      next[chunk].fill(0);
      for (std::size_t i = begin_of(chunk); i < begin_of(chunk + 1); ++i) {
        ++next[chunk][digit_of(items[i])];
      }
    });
    std::size_t position = 0;
    for (std::size_t digit = 0; digit < digits; ++digit) {
      for (auto& of_chunk : next) position += std::exchange(of_chunk[digit], position);
    }
    tbb::parallel_for(std::size_t{0}, chunks, [&](std::size_t chunk) {
      for (std::size_t i = begin_of(chunk); i < begin_of(chunk + 1); ++i) {
        moved[next[chunk][digit_of(items[i])]++] = items[i];
      }
    });
    items.swap(moved);
  }
}

/// Interleaves the bits of a cell's numbers, those of x lowest. Numbers are below 2^21.
inline std::uint64_t morton_code(const glm::uvec3& cell) {
  // Puts two zero bits before each bit but the lowest.
  const auto spread = [](std::uint64_t x) {
    x = (x | x << 32) & 0x001F00000000FFFFull;
    x = (x | x << 16) & 0x001F0000FF0000FFull;
    x = (x | x << 8) & 0x100F00F00F00F00Full;
    x = (x | x << 4) & 0x10C30C30C30C30C3ull;
    return (x | x << 2) & 0x1249249249249249ull;
  };
  return spread(cell.x) | spread(cell.y) << 1 | spread(cell.z) << 2;
}

}  // namespace photile::geometry
