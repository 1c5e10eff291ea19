// Whether two results are the same, bit for bit.
#pragma once

#include <cstring>
#include <vector>

#include "photile/photons.hpp"
#include "photile/ray_scene.hpp"

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

inline bool same_bits(const PrimaryHits& a, const PrimaryHits& b) {
  return same_bits(a.position, b.position) && same_bits(a.oriented_face, b.oriented_face) &&
         same_bits(a.pixel, b.pixel) && same_bits(a.throughput, b.throughput) &&
         same_bits(a.diffuse_albedo, b.diffuse_albedo) && same_bits(a.outgoing, b.outgoing) &&
         same_bits(a.lobe, b.lobe) && same_bits(a.fraction, b.fraction);
}

}  // namespace photile::test
