// Random numbers for tests of rays.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <random>

#include "trace/sampling.hpp"

namespace photile::test {

/// Uniform floats, the same on every platform.
class Uniform {
 public:
  explicit Uniform(std::uint64_t seed) : generator_(seed) {}
  float operator()() { return static_cast<float>(generator_() >> 40) * 0x1p-24f; }
  glm::vec3 direction() {
    const float u = (*this)();
    return trace::sample_sphere(u, (*this)());
  }

 private:
  std::mt19937_64 generator_;
};

}  // namespace photile::test
