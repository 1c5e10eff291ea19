// The random numbers of one path: a slice of Philox's counter space that no other path touches.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

namespace photile::trace {

using PhiloxCounter = std::array<std::uint32_t, 4>;
using PhiloxKey = std::array<std::uint32_t, 2>;

/// Four random words of Philox4x32-10, the counter-based generator of Salmon, Moraes, Dror and
/// Shaw, "Parallel random numbers: as easy as 1, 2, 3" (2011): a bijection of the counter for every
/// key. Any number of any path is computed from its counter, whatever order threads trace paths in.
constexpr PhiloxCounter philox4x32_10(PhiloxCounter counter, PhiloxKey key) {
  for (int round = 0; round < 10; ++round) {
    const std::uint64_t product0 = std::uint64_t{0xD2511F53u} * counter[0];
    const std::uint64_t product1 = std::uint64_t{0xCD9E8D57u} * counter[2];
    counter = {static_cast<std::uint32_t>(product1 >> 32) ^ counter[1] ^ key[0],
               static_cast<std::uint32_t>(product1),
               static_cast<std::uint32_t>(product0 >> 32) ^ counter[3] ^ key[1],
               static_cast<std::uint32_t>(product0)};
    key = {key[0] + 0x9E3779B9u, key[1] + 0xBB67AE85u};
  }
  return counter;
}

/// What a number is for. Part of the counter, so that two uses never share numbers.
enum class Purpose : std::uint32_t {
  emission,
  photon_scattering,
  film_position,
  eye_scattering,
  path_scattering,
  path_light,
  sensor_direction,
  sensor_light,
  eye_holes,
  photon_holes,
  path_holes,
  direct_light,
  gather_direction,
  hemisphere_direction,
  repeat
};

/// Four independent random words.
class RandomBlock {
 public:
  explicit RandomBlock(const PhiloxCounter& words) : words_(words) {}
  /// Uniform in [0, 1), a multiple of 2^-24.
  float uniform(int word) const { return static_cast<float>(words_[word] >> 8) * 0x1p-24f; }
  /// Uniform in [0, 1), a multiple of 2^-53, from this word and the next.
  double uniform_double(int word) const {
    const std::uint64_t bits = std::uint64_t{words_[word]} << 32 | words_[word + 1];
    return static_cast<double>(bits >> 11) * 0x1p-53;
  }
  bool bit(int word) const { return words_[word] >> 31; }
  std::uint32_t word(int word) const { return words_[word]; }

  /// The same block but for one word: its uniform() is `number`, in [0, 1), to 2^-24.
  RandomBlock with(int word, double number) const {
    RandomBlock block = *this;
    block.words_[word] = static_cast<std::uint32_t>(std::min(number * 0x1p32, 0x1p32 - 1));
    return block;
  }

  /// A block whose uniform_double(0) is `uniform`, in [0, 1), to 2^-53.
  static RandomBlock of(double uniform) {
    const auto bits = static_cast<std::uint64_t>(uniform * 0x1p53) << 11;
    return RandomBlock(
        {static_cast<std::uint32_t>(bits >> 32), static_cast<std::uint32_t>(bits), 0, 0});
  }

 private:
  PhiloxCounter words_;
};

/// Random numbers of path `path` of stream `stream` (a light, or 0). Paths below 2^48, streams
/// below 2^16.
class RandomStream {
 public:
  RandomStream(std::uint64_t seed, std::uint64_t path, std::uint32_t stream)
      : key_{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)},
        path_low_(static_cast<std::uint32_t>(path)),
        path_high_and_stream_(static_cast<std::uint32_t>(path >> 32) << 16 | stream) {}

  /// Block `index` (a bounce, say) of one purpose. The same arguments give the same numbers.
  RandomBlock block(Purpose purpose, std::uint32_t index) const {
    return RandomBlock(philox4x32_10(
        {path_low_, path_high_and_stream_, index, static_cast<std::uint32_t>(purpose)}, key_));
  }

 private:
  PhiloxKey key_;
  std::uint32_t path_low_;
  std::uint32_t path_high_and_stream_;
};

/// The seed of a repeat of what would be done with `seed`. Repeats of neighbouring seeds have
/// nothing in common, as seeds seed, seed + 1 ... of their repeats would.
constexpr std::uint64_t seed_of_repeat(std::uint64_t seed, std::uint32_t repeat) {
  const PhiloxCounter words =
      philox4x32_10({repeat, 0, 0, static_cast<std::uint32_t>(Purpose::repeat)},
                    {static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)});
  return std::uint64_t{words[1]} << 32 | words[0];
}

}  // namespace photile::trace
