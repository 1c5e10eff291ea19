#include "support/workload.hpp"

#include <cstdlib>
#include <random>

#include "estimate/map_order.hpp"
#include "photile/load_scene.hpp"
#include "photile/photons.hpp"
#include "photile/scene_builder.hpp"
#include "support/morton_order.hpp"

namespace photile::bench {
namespace {

/// Side of the plane's triangle that looks up.
std::uint32_t upper_side(const Scene& scene, std::uint32_t triangle) {
  return face_normal(scene, oriented(triangle, 0)).z > 0 ? oriented(triangle, 0)
                                                         : oriented(triangle, 1);
}

/// The plane's first triangle holds the points below the diagonal.
std::uint32_t plane_triangle(const glm::vec3& point) { return point.y <= point.x ? 0 : 1; }

std::shared_ptr<const Scene> plane_scene() {
  SceneBuilder builder("plane");
  builder.add(lamp_at({0.5f, 0.5f, 1.0f}));
  builder.quad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, builder.add(white_material()));
  return std::make_shared<const Scene>(std::move(builder).build());
}

std::vector<glm::vec3> uniform_points(std::size_t count, std::uint32_t seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<float> uniform(0, 1);
  std::vector<glm::vec3> points(count);
  for (glm::vec3& point : points) {
    point.x = uniform(generator);
    point.y = uniform(generator);
  }
  return points;
}

Photons plane_photons(const Scene& scene, std::uint64_t count) {
  std::mt19937 generator(2);
  std::uniform_real_distribution<float> uniform(0.5f, 1.5f);
  Photons photons;
  photons.position = uniform_points(count, 1);
  for (const glm::vec3& position : photons.position) {
    photons.oriented_face.push_back(upper_side(scene, plane_triangle(position)));
    const float flux = uniform(generator) / static_cast<float>(count);
    photons.flux.emplace_back(flux, 0.8f * flux, 0.6f * flux);
  }
  photons.emitted_per_light = {count};
  return sort_by_oriented_face(std::move(photons), 2 * scene.triangle_count());
}

PrimaryHits plane_hits(const Scene& scene, std::size_t count) {
  const std::vector<glm::vec3> points = uniform_points(count, 3);
  const std::vector<std::uint32_t> order = morton_order(points);
  PrimaryHits hits;
  const std::uint32_t first = upper_side(scene, 0) < upper_side(scene, 1) ? 0 : 1;
  for (const std::uint32_t triangle : {first, 1 - first}) {
    for (const std::uint32_t i : order) {
      if (plane_triangle(points[i]) != triangle) continue;
      hits.position.push_back(points[i]);
      hits.oriented_face.push_back(upper_side(scene, triangle));
      hits.pixel.push_back(i);
    }
  }
  hits.throughput.assign(count, glm::vec3(1.0f));
  hits.diffuse_albedo.assign(count, glm::vec3(0.5f));
  return hits;
}

}  // namespace

Material white_material() {
  Material material;
  material.name = "white";
  material.diffuse = glm::vec3(0.5f);
  return material;
}

Light lamp_at(const glm::vec3& position) {
  Light light;
  light.name = "lamp";
  light.kind = LightKind::point;
  light.position = position;
  light.power = 1000;
  return light;
}

Workload plane_workload(std::size_t queries) {
  const std::shared_ptr<const Scene> scene = plane_scene();
  return {"plane", scene, plane_hits(*scene, queries),
          [scene](std::uint64_t count) { return plane_photons(*scene, count); }};
}

Workload interior_workload(const std::string& name, Scene scene, int width, int height) {
  const auto shared = std::make_shared<const Scene>(std::move(scene));
  const auto rays = std::make_shared<const RayScene>(*shared);
  PrimaryHitParameters film;
  film.width = width;
  film.height = height;
  film.samples_per_pixel = 1;
  return {name, shared, trace_primary_hits(*rays, shared->cameras.front(), film, 0, height).hits,
          [shared, rays](std::uint64_t count) { return traced_photons(*rays, count); }};
}

void make_diffuse(Scene& scene) {
  for (Material& material : scene.materials) {
    if (material.interaction != Interaction::opaque) continue;
    material.specular = glm::vec3(0.0f);
    material.normal_texture = none;  // light at its hits is asked for without directions
  }
}

Scene living_room(Surfaces surfaces) {
  Scene scene = load_scene(PHOTILE_SOURCE_DIR "/scenes/living-room/living-room.gltf");
  if (surfaces == Surfaces::diffuse) make_diffuse(scene);
  return scene;
}

NeighbourGroups default_groups(const Scene& scene, const Photons& photons, double radius) {
  return find_map_groups(scene, photons, product_maps.mode, {radius});
}

PrimaryHits in_map_order(const PrimaryHits& hits, const NeighbourGroups& groups) {
  std::vector<std::uint32_t> maps = hits.oriented_face;
  if (!groups.patches.empty()) {
    for (std::uint32_t& map : maps) map = groups.patches.map_of[map];
  }
  const auto order = estimate::order_by_map(maps, hits.position);
  if (order.empty()) return hits;
  PrimaryHits ordered = estimate::reordered(hits, order);
  for (const std::uint32_t hit : order) {
    ordered.pixel.push_back(hits.pixel[hit]);
    ordered.throughput.push_back(hits.throughput[hit]);
  }
  return ordered;
}

Photons traced_photons(const RayScene& rays, std::uint64_t count) {
  PhotonTracerParameters parameters;
  parameters.emitted_photons = 50'000;
  const double per_path = static_cast<double>(trace_photons(rays, parameters).photons.size()) /
                          static_cast<double>(parameters.emitted_photons);
  parameters.emitted_photons =
      static_cast<std::uint64_t>(static_cast<double>(count) / per_path) + 1;
  return trace_photons(rays, parameters).photons;
}

std::optional<Scene> shared_interior(const std::string& name) {
  const char* folder = std::getenv("PHOTILE_SHARED_SCENES");
  const std::filesystem::path file =
      std::filesystem::path(folder ? folder : PHOTILE_SOURCE_DIR "/../shared/scenes") / name /
      (name + "-diffuse.gltf");
  if (!std::filesystem::exists(file)) return std::nullopt;
  return load_scene(file);
}

std::optional<Scene> classroom() { return shared_interior("classroom"); }

}  // namespace photile::bench
