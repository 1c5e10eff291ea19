// What the path tracer sees of surfaces whose vertex normals bend, against closed forms.
#include <algorithm>
#include <catch2/catch.hpp>
#include <numbers>

#include "path_irradiance.hpp"
#include "smooth_meshes.hpp"
#include "statistical_tests.hpp"
#include "suns.hpp"
#include "test_scenes.hpp"

namespace photile::test {
namespace {

using std::numbers::pi;

constexpr double sun_lux = 1000, albedo = 0.6;
const glm::dvec3 to_sun = glm::normalize(glm::dvec3(0.4, -0.5, 0.7));

Scene sphere_in_sun(const SmoothMesh& sphere, bool with_normals = true) {
  SceneBuilder builder;
  sphere.add_to(builder, builder.add(diffuse(glm::vec3(albedo))), with_normals);
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

}  // namespace

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
  ring.add_to(builder, builder.add(diffuse(glm::vec3(albedo))));
  builder.add_surroundings("sky", EnvironmentMap("sky", 2, 1, std::vector(2, glm::vec3(1.0f))));
  const Scene scene = builder.build();
  const SmoothMesh::TestPoint test_point = ring.test_points({0.9, 0.07, 0.03}).front();
  const double cosine = glm::dot(test_point.sensor.normal, test_point.smooth);
  REQUIRE(cosine < 0.95);
  const PathMeans light = seen(scene, test_point.sensor, 20'000);
  CHECK(light.radiance.at(0) / light.irradiance.at(0) ==
        Approx(albedo / pi * (1 + cosine) / 2).epsilon(0.01));
}

}  // namespace photile::test
