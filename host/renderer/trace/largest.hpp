// The largest component of a vector.
#pragma once

#include <algorithm>
#include <glm/glm.hpp>

namespace photile::trace {

inline float largest(const glm::vec3& v) { return std::max({v.x, v.y, v.z}); }
inline double largest(const glm::dvec3& v) { return std::max({v.x, v.y, v.z}); }

}  // namespace photile::trace
