// Every material by photon maps and by paths: the same picture.
#include <algorithm>

#include "path_irradiance.hpp"
#include "render/pictures.hpp"
#include "smooth_meshes.hpp"
#include "suns.hpp"

namespace photile::test {
namespace {

/// Mean radiance of a layer over the picture, green.
double mean_radiance(const LightLayers& layers) {
  double sum = 0;
  for (const glm::vec3& radiance : layers.layers[0].radiance) sum += double{radiance.g};
  return sum / static_cast<double>(layers.layers[0].radiance.size());
}

/// One texel over every triangle, whose coordinates run along two of its edges.
void cover(Scene& scene, std::array<std::uint8_t, 4> texel) {
  scene.textures.emplace_back("texel", 1, 1, std::vector<std::array<std::uint8_t, 4>>{texel});
  scene.corner_uv.assign(scene.triangle_count(),
                         {glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(0, 1)});
}

/// A room with a lamp at z = 0.7, its walls of the first material.
Scene room(const Material& walls) { return closed_box(walls, 2); }

/// The room with a plate of the material between lamp and floor.
Scene room_with_plate(const Material& plate) {
  SceneBuilder builder("room with a plate");
  builder.box(glm::vec3(0.0f), glm::vec3(1.0f), builder.add(diffuse(0.6f)), true, 2);
  builder.grid({0, 0, 0.3f}, {1, 0, 0}, {0, 1, 0}, 2, builder.add(plate));
  builder.add(point_light("lamp", {0.4f, 0.5f, 0.7f}));
  return builder.build();
}

double mean_illuminance(const LightLayers& layers) {
  return LayerMeans(layers.layers[0]).illuminance;
}

RenderParameters effort(std::uint64_t photons, int samples) {
  RenderParameters parameters = small_picture(photons, 16, 16, samples);
  parameters.radius = 0.1;
  return parameters;
}

/// Looks down at the floor, away from its edges by more than the estimates reach; paths and photons
/// see as much light, but for a share of it.
void check_agreement(const Scene& scene, RenderParameters parameters = effort(200'000, 36),
                     double share = 0.04, double (&mean_of)(const LightLayers&) = mean_radiance) {
  const Camera camera =
      Camera::look_at({0.5, 0.5, 0.9}, {0.5, 0.5, 0}, {0, 1, 0}, 2 * std::atan(0.3 / 0.9));
  std::vector<double> differences;
  double mean = 0;
  for (std::uint64_t seed = 1; seed <= 16; ++seed) {
    parameters.seed = seed;
    const double photons = mean_of(render(scene, camera, device(), parameters).layers);
    const double paths = mean_of(trace_paths(scene, camera, eye_rays(parameters)).layers);
    differences.push_back(photons - paths);
    mean += paths / 16;
  }
  CHECK_VERDICT(mean_is(differences, 0.0, share * mean));
}

TEST_CASE("paths and photon maps see the same light in a closed box, away from its edges") {
  RenderParameters parameters = effort(500'000, 64);
  parameters.neighbours = 200;  // the nodes of so small a floor are few
  check_agreement(room(diffuse(0.6f)), parameters, 0.015, mean_illuminance);
}

TEST_CASE("paths and photon maps agree on a coated wall") {
  check_agreement(room(glossy(0.5f, 0.04f, 0.4f)));
}

TEST_CASE("paths and photon maps agree on a rough metal", "[slow]") {
  check_agreement(room(glossy(0.0f, 0.7f, 0.6f)));
}

TEST_CASE("paths and photon maps agree under a normal map", "[slow]") {
  const auto [albedo, specular] =
      GENERATE(std::pair(0.6f, 0.0f), std::pair(0.5f, 0.04f), std::pair(0.0f, 0.7f));
  const Material walls = glossy(albedo, specular, 0.5f);
  Scene scene = room(walls);
  cover(scene, {145, 112, 253, 255});
  scene.materials[0].normal_texture = 0;
  CAPTURE(albedo, specular);
  check_agreement(scene);
}

TEST_CASE("paths and photon maps agree through holes", "[slow]") {
  Material plate = diffuse(0.4f);
  plate.opacity = GENERATE(0.0f, 0.4f);
  CAPTURE(plate.opacity);
  check_agreement(room_with_plate(plate));
}

// What the path tracer sees of surfaces whose vertex normals bend, against closed forms.

using std::numbers::pi;

constexpr double sun_lux = 1000, albedo = 0.6;
const glm::dvec3 to_sun = glm::normalize(glm::dvec3(0.4, -0.5, 0.7));

Scene sphere_in_sun(const SmoothMesh& sphere, bool with_normals = true) {
  SceneBuilder builder;
  sphere.add_to(builder, builder.add(diffuse(albedo)), with_normals);
  builder.add_distant(sun_along(glm::vec3(-to_sun)), sun_lux);
  return builder.build();
}

/// The light that arrives at one sensor by so many paths, at the light's power.
PathMeans seen(const Scene& scene, const Sensor& sensor, std::size_t paths) {
  PathMeans means = path_means(scene, {sensor}, 1, paths);
  means.irradiance[0] *= scene.lights[0].power;
  if (!means.radiance.empty()) means.radiance[0] *= scene.lights[0].power;
  return means;
}

TEST_CASE("The eye sees the sun on a sphere of facets by the cosine to the interpolated normal") {
  const SmoothMesh sphere = smooth_sphere(glm::dvec3(0.0), 0.5);
  const Scene scene = sphere_in_sun(sphere);
  REQUIRE(needs_of(scene).smooth_shading);
  for (const SmoothMesh::TestPoint& test_point : sphere.test_points()) {
    const double facet = glm::dot(test_point.sensor.normal, to_sun);
    const double smooth = glm::dot(test_point.smooth, to_sun);
    CAPTURE(facet, smooth);
    const PathMeans light = seen(scene, test_point.sensor, 1);
    // Lux is that of the facet, and what is below it is not seen.
    CHECK(light.irradiance.at(0) == Approx(sun_lux * std::max(0.0, facet)).margin(0.05));
    CHECK(light.radiance.at(0) ==
          Approx(facet > 0 ? albedo / pi * sun_lux * std::max(0.0, smooth) : 0.0).margin(0.05));
  }
}

TEST_CASE("Without vertex normals, or with those of its triangles, nothing is shaded smoothly") {
  const SmoothMesh sphere = smooth_sphere(glm::dvec3(0.0), 0.5);
  CHECK_FALSE(needs_of(sphere_in_sun(sphere, false)).smooth_shading);
  SmoothMesh flat;
  for (const glm::uvec3& triangle : sphere.triangles) {
    const auto first = static_cast<std::uint32_t>(flat.vertices.size());
    for (int i = 0; i < 3; ++i) flat.vertices.push_back(sphere.vertices[triangle[i]]);
    const auto corner = flat.vertices.end() - 3;
    flat.normals.insert(flat.normals.end(), 3,
                        glm::normalize(glm::cross(corner[1] - corner[0], corner[2] - corner[0])));
    flat.triangles.emplace_back(first, first + 1, first + 2);
  }
  const Scene scene = sphere_in_sun(flat);
  CHECK_FALSE(needs_of(scene).smooth_shading);
  CHECK(scene.corner_normal.empty());
}

TEST_CASE("Under an even sky a turned normal sees (1 + cosine) / 2 of it") {
  // A ring of few facets, whose normals are far from the round ones near its edges.
  const SmoothMesh ring = smooth_cylinder(glm::dvec3(0.0), 0.5, 1.0, 6);
  SceneBuilder builder;
  ring.add_to(builder, builder.add(diffuse(albedo)));
  builder.add_surroundings("sky", EnvironmentMap("sky", 2, 1, std::vector(2, glm::vec3(1.0f))));
  const Scene scene = builder.build();
  const SmoothMesh::TestPoint test_point = ring.test_points({0.9, 0.07, 0.03}).front();
  const double cosine = glm::dot(test_point.sensor.normal, test_point.smooth);
  REQUIRE(cosine < 0.95);
  const PathMeans light = seen(scene, test_point.sensor, 20'000);
  CHECK(light.radiance.at(0) / light.irradiance.at(0) ==
        Approx(albedo / pi * (1 + cosine) / 2).epsilon(0.01));
}

}  // namespace
}  // namespace photile::test
