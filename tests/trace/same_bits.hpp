// Whether two results are the same, bit for bit.
#pragma once

#include <cstring>
#include <vector>

#include "photile/photons.hpp"

namespace photile::test {

template <class T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

inline bool same_bits(const Photons& a, const Photons& b) {
  return same_bits(a.position, b.position) && same_bits(a.flux, b.flux) &&
         same_bits(a.incoming, b.incoming) && same_bits(a.light, b.light) &&
         same_bits(a.oriented_face, b.oriented_face) && same_bits(a.first_of, b.first_of);
}

}  // namespace photile::test
