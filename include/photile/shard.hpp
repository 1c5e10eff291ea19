// A part of the work that several processes share.
#pragma once

#include <cstdint>

namespace photile {

/// Part `index` (from 0) of `count` parts of a sequence, which are of one length but for one
/// element.
struct Shard {
  std::uint32_t index = 0, count = 1;

  /// Of n elements this part has those from `begin(n)` up to, but without, `end(n)`.
  std::uint64_t begin(std::uint64_t n) const { return place(index, n); }
  std::uint64_t end(std::uint64_t n) const { return place(index + std::uint64_t{1}, n); }

  bool operator==(const Shard&) const = default;

 private:
  /// n * i / count, where the product may need more than 64 bits.
  std::uint64_t place(std::uint64_t i, std::uint64_t n) const {
    return n / count * i + n % count * i / count;
  }
};

}  // namespace photile
