#include "trace/surface_sight.hpp"

#include <algorithm>
#include <cmath>

#include "trace/ray_query.hpp"

namespace photile::trace {

bool see_each_other(const RayScene& rays, const SurfacePlace& from, const SurfacePlace& to,
                    const SightLine& line) {
  const glm::vec3 way = to.position - from.position;
  const float turn =
      std::max(std::abs(glm::dot(way, from.normal)), std::abs(glm::dot(way, to.normal)));
  const float height = line.lift + 0.5f * turn;
  const glm::vec3 start = from.position + height * from.normal;
  const glm::vec3 end = to.position + height * to.normal;
  return !occluded(rays, start, end + line.left_out * (start - end));
}

}  // namespace photile::trace
