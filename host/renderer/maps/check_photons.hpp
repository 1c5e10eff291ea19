// Checks of photons from outside the library.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "photile/photons.hpp"
#include "photile/scene.hpp"

namespace photile::maps {

/// What is wrong with photons on a scene of `oriented_faces` oriented faces; "" = nothing.
std::string problem_of(const Photons& photons, const SceneNeeds& needs,
                       std::uint64_t oriented_faces);

/// Rows of compressed sparse rows: from 0, ascending, to the number of elements.
template <class T>
bool are_rows(const std::vector<T>& first, std::uint64_t rows, std::uint64_t elements) {
  return first.size() == rows + 1 && first.front() == 0 && first.back() == elements &&
         std::is_sorted(first.begin(), first.end());
}

template <class T>
bool all_below(const std::vector<T>& values, std::uint64_t end) {
  return std::all_of(values.begin(), values.end(), [&](T value) { return value < end; });
}

}  // namespace photile::maps
