// The random numbers of one path: a slice of Philox's counter space that no other path touches.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/glm.hpp>

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

/// The purpose of a number: part of the counter, so that two uses never share numbers.
enum class Purpose : std::uint32_t {
  emission,
  photon_scattering,
  film_position,
  eye_scattering,
  path_scattering,
  path_light,
  sensor_direction,
  sensor_light,
  eye_cutouts,
  photon_cutouts,
  path_cutouts,
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

  /// The block with one word replaced: its uniform() is `number`, in [0, 1), to 2^-24.
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

/// The seed of a repeat of what would be done with `seed`. Repeats of neighbouring seeds share
/// nothing, which they would if repeats used seed, seed + 1 and so on.
constexpr std::uint64_t seed_of_repeat(std::uint64_t seed, std::uint32_t repeat) {
  const PhiloxCounter words =
      philox4x32_10({repeat, 0, 0, static_cast<std::uint32_t>(Purpose::repeat)},
                    {static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)});
  return std::uint64_t{words[1]} << 32 | words[0];
}

// Points that fill the unit square evenly, by index: Sobol's sequence in its first two dimensions,
// scrambled. Further dimensions are further pairs, each with its own scramble ("padding": Burley,
// "Practical hash-based Owen scrambling", 2020).

constexpr std::uint32_t reversed_bits(std::uint32_t x) {
  x = (x & 0x5555'5555u) << 1 | (x >> 1 & 0x5555'5555u);
  x = (x & 0x3333'3333u) << 2 | (x >> 2 & 0x3333'3333u);
  x = (x & 0x0F0F'0F0Fu) << 4 | (x >> 4 & 0x0F0F'0F0Fu);
  x = (x & 0x00FF'00FFu) << 8 | (x >> 8 & 0x00FF'00FFu);
  return x << 16 | x >> 16;
}

/// Nested uniform scrambling (Owen, "Randomly permuted (t,m,s)-nets and (t,s)-sequences", 1995) of
/// binary digits, the first of them in the lowest bit: whether a digit is flipped depends on the
/// digits before it and on `seed`. A permutation in which low bits act on higher ones alone (Laine
/// and Karras, "Stratified sampling for stochastic transparency", 2011), with the constants of
/// Vegdahl's search ("Building a better LK hash", 2021).
constexpr std::uint32_t scrambled_digits(std::uint32_t digits, std::uint32_t seed) {
  digits ^= digits * 0x3D20'ADEAu;
  digits += seed;
  digits *= seed >> 16 | 1;
  digits ^= digits * 0x0552'6C56u;
  digits ^= digits * 0x53A2'2864u;
  return digits;
}

/// Digits of point `index` in the second dimension of Sobol's sequence, the first digit in the
/// lowest bit; those of the first dimension are the index itself. A product with Pascal's triangle
/// modulo 2, which is a Kronecker power of that of 2 x 2 (Ahmed, "An implementation algorithm of 2D
/// Sobol sequence fast, elegant, and compact", 2024).
constexpr std::uint32_t second_sobol_digits(std::uint32_t index) {
  index ^= index >> 1 & 0x5555'5555u;
  index ^= index >> 2 & 0x3333'3333u;
  index ^= index >> 4 & 0x0F0F'0F0Fu;
  index ^= index >> 8 & 0x00FF'00FFu;
  return index ^ index >> 16;
}

/// Point `index` of the sequence that `scramble` names, each coordinate times 2^32. Uniform over
/// the square for random scrambles; of any 2^n points from a multiple of 2^n on there is one in
/// each of the 2^n rectangles that halving the square's sides leaves. The order of points is
/// scrambled in the same way, so that pairs of dimensions are independent of each other. Sequences
/// of different scrambles are independent: their scatter is an unbiased measure of the error.
inline glm::uvec2 sobol_words(std::uint32_t index, const RandomBlock& scramble) {
  const std::uint32_t position =
      reversed_bits(scrambled_digits(reversed_bits(index), scramble.word(0)));
  return {reversed_bits(scrambled_digits(position, scramble.word(1))),
          reversed_bits(scrambled_digits(second_sobol_digits(position), scramble.word(2)))};
}

/// The Sobol point in [0, 1)^2.
inline glm::dvec2 sobol_point(std::uint32_t index, const RandomBlock& scramble) {
  return glm::dvec2(sobol_words(index, scramble)) * 0x1p-32;
}

}  // namespace photile::trace
