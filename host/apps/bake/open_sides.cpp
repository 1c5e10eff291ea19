#include <tbb/parallel_for.h>

#include <atomic>

#include "geometry/disjoint_sets.hpp"
#include "photile/camera.hpp"
#include "scene/panes.hpp"
#include "surface/surface_mesh.hpp"
#include "trace/random_stream.hpp"
#include "trace/ray_query.hpp"
#include "trace/sampling.hpp"
#include "trace/surface.hpp"

namespace photile::bake {
namespace {

/// The number of paths: a side that none of them meets, and that is joined to no side which one
/// meets, counts as hidden.
constexpr std::uint64_t open_paths = 131'072;
constexpr std::uint32_t open_bounces = 16;

struct PathStart {
  glm::vec3 position, direction;
};

/// A position to look from, or one that light comes from.
class PathSource {
 public:
  explicit PathSource(const glm::vec3& position) : position_(position) {}
  explicit PathSource(const Light& light) : position_(light.position), light_(&light) {}

  PathStart start(const Scene& scene, const trace::RandomBlock& place,
                  const trace::RandomBlock& way) const {
    const float u1 = way.uniform(0), u2 = way.uniform(1);
    if (!light_ || (light_->triangles.empty() && !light_->is_distant())) {
      return {position_, trace::sample_sphere(u1, u2)};
    }
    if (light_->is_distant()) {
      const BoundingSphere sphere = bounding_sphere(scene);
      const glm::vec3 outwards = trace::sample_sphere(place.uniform(0), place.uniform(1));
      return {glm::vec3(sphere.center + 1.01 * sphere.radius * glm::dvec3(outwards)),
              trace::Frame(-outwards).to_world(trace::sample_cosine_hemisphere(u1, u2))};
    }
    const auto count = static_cast<float>(light_->triangles.size());
    const std::uint32_t triangle =
        light_->triangles[static_cast<std::size_t>(place.uniform(0) * count)];
    const glm::vec2 uv = trace::sample_triangle(place.uniform(1), place.uniform(2));
    const std::uint32_t front = scene.front_side[triangle];
    const std::uint32_t side = light_->two_sided && place.bit(3) ? 1 - front : front;
    const trace::SurfacePoint point = trace::surface_point(scene, {triangle, uv.x, uv.y}, side);
    const glm::vec3 direction =
        trace::Frame(point.normal).to_world(trace::sample_cosine_hemisphere(u1, u2));
    return {point.origin_towards(direction), direction};
  }

 private:
  glm::vec3 position_;
  const Light* light_ = nullptr;
};

std::vector<PathSource> eyes_of(const Scene& scene) {
  std::vector<PathSource> sources;
  for (const Camera& camera : scene.cameras) sources.emplace_back(glm::vec3(camera.position));
  return sources;
}

/// Sides that paths meet.
std::vector<std::uint8_t> met_sides(const RayScene& rays, const std::vector<PathSource>& sources) {
  const Scene& scene = rays.scene();
  std::vector<std::uint8_t> met(2 * std::size_t{scene.triangle_count()});
  if (sources.empty()) return met;
  tbb::parallel_for(std::uint64_t{0}, open_paths, [&](std::uint64_t path) {
    const trace::FlushDenormals flush_denormals;
    const trace::RandomStream random(0, path, 0);
    const auto numbers = [&](std::uint32_t index) {
      return random.block(trace::Purpose::eye_scattering, index);
    };
    const PathStart start = sources[path % sources.size()].start(scene, numbers(0), numbers(1));
    trace::RayOrigin origin = start.position;
    glm::vec3 direction = start.direction;
    for (std::uint32_t bounce = 0; bounce < open_bounces; ++bounce) {
      const auto hit = trace::intersect(rays, origin, direction);
      if (!hit) return;
      const trace::SurfacePoint point = trace::surface_hit(scene, *hit, direction);
      std::atomic_ref(met[point.oriented_face()]).store(1, std::memory_order_relaxed);
      const Material& material = trace::material_of(scene, point);
      const trace::RandomBlock block = numbers(bounce + 2);
      const bool passes = (scene::is_glazing(material) || material.has_cutouts()) && block.bit(2);
      if (!passes) {
        direction =
            trace::Frame(point.normal)
                .to_world(trace::sample_cosine_hemisphere(block.uniform(0), block.uniform(1)));
      }
      origin = point.origin_towards(direction);
    }
  });
  return met;
}

}  // namespace

std::vector<std::uint8_t> seen_sides(const RayScene& rays) {
  return met_sides(rays, eyes_of(rays.scene()));
}

std::vector<std::uint8_t> open_sides(const RayScene& rays) {
  std::vector<PathSource> sources = eyes_of(rays.scene());
  for (const Light& light : rays.scene().lights) sources.emplace_back(light);
  std::vector<std::uint8_t> open = met_sides(rays, sources);
  const surface::SurfaceMesh mesh(rays.scene());
  geometry::DisjointSets joined(open.size());
  mesh.for_each_edge([&](std::span<const surface::MeshEdge> edges) {
    const surface::MeshEdge& first = edges.front();
    for (const surface::MeshEdge& edge : edges.subspan(1)) {
      const std::uint32_t flip = surface::flip_between(first, edge);
      for (const std::uint32_t side : {0u, 1u}) {
        joined.join(oriented(first.triangle, side), oriented(edge.triangle, side ^ flip));
      }
    }
  });
  for (std::uint32_t side = 0; side < open.size(); ++side) joined.join(side, mesh.original[side]);
  for (std::uint32_t side = 0; side < open.size(); ++side) {
    if (open[side]) open[joined.find(side)] = 1;
  }
  for (std::uint32_t side = 0; side < open.size(); ++side) open[side] = open[joined.find(side)];
  return open;
}

}  // namespace photile::bake
