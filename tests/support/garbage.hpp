// OBJ files whose numbers are of every size and kind.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

namespace photile::test {

/// Text of numbers of every size: denormals, zeros, signs, NaN, infinities.
inline std::string wild_number(std::mt19937& random) {
  static const std::vector<std::string> special = {"nan",    "inf",   "-inf", "1e400", "-1e-400",
                                                   "1e-320", "1e-45", "0",    "-0",    "3.4e38",
                                                   "1e38",   "1e-38", "."};
  if (random() % 4 == 0) return special[random() % special.size()];
  const int spread = 1 << random() % 7;
  const int exponent = static_cast<int>(random() % static_cast<unsigned>(2 * spread + 1)) - spread;
  return fmt::format("{:.6f}e{}", std::ldexp(static_cast<double>(random()), -31) - 1.0, exponent);
}

/// An OBJ text of up to 22 vertices and 20 faces at random, all of the material `lamp`. Every
/// second one also has a sound square.
inline std::string garbage_obj(unsigned seed) {
  std::mt19937 random(seed);
  std::string text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";  // so that some load
  const unsigned vertex_count = 3 + random() % 20;
  for (unsigned v = 0; v < vertex_count; ++v) {
    text += "v";
    for (int axis = 0; axis < 3; ++axis) text += " " + wild_number(random);
    text += "\n";
  }
  text += "usemtl lamp\n";
  if (seed % 2 == 0) text += "f 1 2 3 4\n";
  for (unsigned f = 0; f < 20; ++f) {
    text += "f";
    for (unsigned c = 0, corners = 3 + random() % 3; c < corners; ++c) {
      text += fmt::format(" {}", 1 + random() % (4 + vertex_count));
    }
    text += "\n";
  }
  return text;
}

}  // namespace photile::test
