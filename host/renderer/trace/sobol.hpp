// Points that fill the unit square evenly, by index: Sobol's sequence in its first two dimensions,
// scrambled. Further dimensions are further pairs with scrambles of their own ("padding": Burley,
// "Practical hash-based Owen scrambling", 2020).
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include "trace/random_stream.hpp"

namespace photile::trace {

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
/// scrambled in the same way, so that pairs of dimensions know nothing of each other. Sequences of
/// different scrambles are independent: their scatter is an honest error.
inline glm::uvec2 sobol_words(std::uint32_t index, const RandomBlock& scramble) {
  const std::uint32_t place =
      reversed_bits(scrambled_digits(reversed_bits(index), scramble.word(0)));
  return {reversed_bits(scrambled_digits(place, scramble.word(1))),
          reversed_bits(scrambled_digits(second_sobol_digits(place), scramble.word(2)))};
}

/// The same point in [0, 1)^2.
inline glm::dvec2 sobol_point(std::uint32_t index, const RandomBlock& scramble) {
  return glm::dvec2(sobol_words(index, scramble)) * 0x1p-32;
}

}  // namespace photile::trace
