#include "support/naive_build.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "support/host_search.hpp"

namespace photile::bench {
namespace {

struct Corners {
  glm::vec3 a, b, c;
};

float squared_distance_to_segment(const glm::vec3& p, const glm::vec3& from, const glm::vec3& to) {
  const glm::vec3 along = to - from;
  const float length = glm::dot(along, along);
  const float t = length > 0 ? glm::clamp(glm::dot(p - from, along) / length, 0.0f, 1.0f) : 0.0f;
  const glm::vec3 rest = p - from - t * along;
  return glm::dot(rest, rest);
}

/// Whether a point lies within a distance: above the face, or near an edge.
bool within(const glm::vec3& p, const Corners& t, float squared_reach) {
  const glm::vec3 ab = t.b - t.a, ac = t.c - t.a, ap = p - t.a;
  const glm::vec3 normal = glm::cross(ab, ac);
  const float height = glm::dot(ap, normal), squared_area = glm::dot(normal, normal);
  if (height * height > squared_reach * squared_area) return false;
  const bool inside = glm::dot(glm::cross(ab, ap), normal) >= 0 &&
                      glm::dot(glm::cross(t.c - t.b, p - t.b), normal) >= 0 &&
                      glm::dot(glm::cross(t.a - t.c, p - t.c), normal) >= 0;
  return inside || squared_distance_to_segment(p, t.a, t.b) <= squared_reach ||
         squared_distance_to_segment(p, t.b, t.c) <= squared_reach ||
         squared_distance_to_segment(p, t.c, t.a) <= squared_reach;
}

}  // namespace

NaiveBuild time_naive_build(const Scene& scene, const Photons& photons, double radius,
                            double angle_degrees, const Repeats& repeats, double most_pairs) {
  const NormalFilter filter(scene, angle_degrees);
  const auto triangles = static_cast<std::uint32_t>(scene.triangle_count());
  std::vector<Corners> corners;
  for (std::uint32_t t = 0; t < triangles; ++t) {
    const glm::uvec3& v = scene.triangles[t];
    corners.push_back({scene.vertices[v.x], scene.vertices[v.y], scene.vertices[v.z]});
  }
  const auto affordable = static_cast<std::size_t>(most_pairs / std::max(triangles, 1u)) + 1;
  const std::size_t step = (photons.size() + affordable - 1) / affordable;
  NaiveBuild build;
  build.tested = (photons.size() + step - 1) / step;
  const auto squared_reach = static_cast<float>(radius * radius);
  const auto references_of = [&](std::size_t photon) {
    const glm::vec3& p = photons.position[photon];
    const std::uint32_t own = photons.oriented_face[photon];
    std::uint64_t references = 0;
    for (std::uint32_t t = 0; t < triangles; ++t) {
      if (!within(p, corners[t], squared_reach)) continue;
      references += filter.agree(own, oriented(t, 0)) + filter.agree(own, oriented(t, 1));
    }
    return references;
  };
  std::uint64_t references = 0;
  build.timing = measure(repeats, [&] {
    references = tbb::parallel_reduce(
        tbb::blocked_range<std::size_t>(0, build.tested), std::uint64_t{0},
        [&](const tbb::blocked_range<std::size_t>& range, std::uint64_t sum) {
          for (std::size_t i = range.begin(); i < range.end(); ++i) sum += references_of(i * step);
          return sum;
        },
        std::plus<>());
  });
  build.references = static_cast<double>(references) / static_cast<double>(build.tested);
  const double share = static_cast<double>(photons.size()) / static_cast<double>(build.tested);
  for (double& seconds : build.timing.seconds) seconds *= share;
  return build;
}

}  // namespace photile::bench
