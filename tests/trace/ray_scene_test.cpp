// Intersections and the points they give.
#include "photile/ray_scene.hpp"

#include <malloc.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <limits>

#include "photon_sets.hpp"
#include "test_scenes.hpp"
#include "trace/ray_scene.hpp"
#include "trace/sampling.hpp"
#include "trace/surface.hpp"
#include "uniform.hpp"

namespace photile::test {

using namespace photile::trace;

TEST_CASE("A ray hits the point of the plate below it, on the side that it comes from") {
  const Scene scene = plate(diffuse(glm::vec3(0.5f)), 2, 8);
  const RayScene rays(scene);
  Uniform uniform(1);
  for (int i = 0; i < 1000; ++i) {
    const float x = 1.9f * uniform() - 0.95f, y = 1.9f * uniform() - 0.95f;
    for (const float z : {-1.0f, 1.0f}) {
      const glm::vec3 direction(0, 0, -z);
      const auto hit = impl_of(rays).intersect(glm::vec3(x, y, z), direction);
      REQUIRE(hit);
      const SurfacePoint point = surface_hit(scene, *hit, direction);
      CHECK(glm::distance(point.position, glm::vec3(x, y, 0)) < 1e-6f);
      CHECK(point.normal == glm::vec3(0, 0, z));
      CHECK(glm::dvec3(point.normal) == face_normal(scene, point.oriented_face()));
      CHECK(on_front(scene, point) == (z > 0));
    }
  }
}

TEST_CASE("The weights of a place on a triangle are found, and beside it those of a point within") {
  Uniform uniform(2);
  for (int i = 0; i < 1000; ++i) {
    Scene scene = empty_scene();
    add_triangle(scene, uniform.direction(), uniform.direction(), uniform.direction());
    if (triangle_area(scene, 0) < 0.1) continue;
    const float u = uniform();
    const glm::vec2 uv = sample_triangle(u, uniform());
    const auto [a, b, c] = scene.corners(0);
    const trace::TriangleHit found = nearest_on_triangle(
        scene, 0,
        glm::dvec3(a) + double{uv.x} * glm::dvec3(b - a) + double{uv.y} * glm::dvec3(c - a));
    CHECK(found.u == Approx(uv.x).margin(1e-5));
    CHECK(found.v == Approx(uv.y).margin(1e-5));
    const trace::TriangleHit within =
        nearest_on_triangle(scene, 0, 2.0 * glm::dvec3(uniform.direction()));
    CHECK(within.u >= 0);
    CHECK(within.v >= 0);
    CHECK(within.u + within.v < 1 + 1e-6);
  }
}

TEST_CASE("Rays with a NaN or an infinity hit nothing") {
  const Scene scene = closed_box(diffuse(glm::vec3(0.5f)));
  const RayScene rays(scene);
  REQUIRE(impl_of(rays).intersect(glm::vec3(0.5f), glm::vec3(0, 0, 1)));
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(),
                          std::numeric_limits<float>::infinity(), -1.0f / 0.0f})
    for (int axis = 0; axis < 3; ++axis) {
      glm::vec3 origin(0.5f), direction(0, 0, 1);
      origin[axis] = bad;
      CHECK_FALSE(impl_of(rays).intersect(origin, direction));
      origin[axis] = 0.5f;
      direction[axis] = bad;
      CHECK_FALSE(impl_of(rays).intersect(origin, direction));
    }
}

TEST_CASE("A ray that leaves a triangle never meets it again, at any size, place and orientation") {
  Uniform uniform(7);
  for (const float size : {1e-6f, 1e-3f, 1.0f, 1e3f, 1e6f})
    for (const glm::vec3& offset : {glm::vec3(0.0f), glm::vec3(20.0f, -3.0f, 1.0f),
                                    glm::vec3(148376.0f, 1234.0f, -223423.0f)}) {
      // A triangle smaller than the rounding of its place is a line or a point.
      if (size < 1e-4f * glm::length(offset)) continue;
      for (int t = 0; t < 100; ++t) {
        SceneBuilder builder;
        const std::uint32_t material = builder.add(diffuse(glm::vec3(0.5f)));
        const auto corner = [&] { return offset + size * uniform.direction(); };
        const glm::vec3 a = corner(), b = corner(), c = corner();
        builder.triangle(a, b, c, material);
        const Scene scene = builder.build();
        const RayScene rays(scene);
        for (int r = 0; r < 100; ++r) {
          const float u = uniform();
          const glm::vec2 uv = sample_triangle(u, uniform());
          const SurfacePoint point = surface_point(scene, {0, uv.x, uv.y}, r % 2);
          glm::vec3 direction = uniform.direction();
          CAPTURE(size, t, r);
          REQUIRE_FALSE(impl_of(rays).intersect(point.origin_towards(direction), direction));
          // Nearly along the surface, where the offset has least to spare.
          direction =
              glm::normalize(direction - 0.999f * glm::dot(direction, point.normal) * point.normal);
          REQUIRE_FALSE(impl_of(rays).intersect(point.origin_towards(direction), direction));
        }
      }
    }
}

TEST_CASE("The ray_offset of a room's surfaces is below a twentieth of a millimetre") {
  const Scene scene = furnished_room(4);
  for (std::uint32_t t = 0; t < scene.triangle_count(); ++t)
    CHECK(surface_point(scene, {t, 0.3f, 0.3f}, 0).ray_offset < 5e-5f);
}

TEST_CASE("No ray from inside a closed room of many triangles escapes through its seams") {
  Scene scene = closed_box(diffuse(glm::vec3(0.5f)), 40);
  for (const glm::vec3& offset : {glm::vec3(0.0f), glm::vec3(100.0f, -77.0f, 3.0f)}) {
    for (glm::vec3& vertex : scene.vertices) vertex += offset;
    const RayScene rays(scene);
    Uniform uniform(11);
    int escaped = 0;
    for (int i = 0; i < 200'000; ++i)
      escaped += !impl_of(rays).intersect(offset + 0.5f, uniform.direction());
    CHECK(escaped == 0);
    for (glm::vec3& vertex : scene.vertices) vertex -= offset;
  }
}

TEST_CASE("Any number of lines of sight at once are hidden as each is alone") {
  const Scene scene = furnished_room();
  const RayScene rays(scene);
  Uniform uniform(5);
  const auto point = [&] {
    const float x = uniform(), y = uniform();
    return glm::vec3(4.0f * x, 3.0f * y, 2.5f * uniform());
  };
  std::size_t hidden_of_all = 0, all = 0;
  for (int i = 0; i < 20; ++i) {
    for (const std::size_t count : {1u, 15u, 16u, 17u, 33u}) {
      std::vector<LineOfSight> lines(count);
      for (LineOfSight& line : lines) line = {point(), point()};
      std::vector<std::uint8_t> hidden(count, 2), expected;
      occluded(rays, lines, hidden);
      for (const LineOfSight& line : lines) expected.push_back(occluded(rays, line.from, line.to));
      CHECK(hidden == expected);
      hidden_of_all += static_cast<std::size_t>(std::count(hidden.begin(), hidden.end(), 1));
      all += count;
    }
  }
  CHECK(hidden_of_all > all / 20);
  CHECK(hidden_of_all < all / 2);
}

TEST_CASE("Embree's memory is counted and grows with the scene") {
  const Scene small = closed_box(diffuse(glm::vec3(0.5f)));
  const Scene large = closed_box(diffuse(glm::vec3(0.5f)), 60);
  const RayScene small_rays(small), large_rays(large);
  // 43,200 triangles and their vertices cannot take less than the vertices alone.
  CHECK(large_rays.bytes() > large.vertices.size() * sizeof(glm::vec3));
  CHECK(large_rays.bytes() > small_rays.bytes());
}

TEST_CASE("A ray scene gives its memory back") {
  const auto in_use = [] {  // bytes of the heap
    const auto info = ::mallinfo2();
    return info.uordblks + info.hblkhd;
  };
  const Scene scene = closed_box(diffuse(glm::vec3(0.5f)), 40);
  const std::uint64_t of_one = RayScene(scene).bytes();
  const std::size_t before = in_use();
  for (int i = 0; i < 10; ++i) RayScene{scene};
  CHECK(in_use() < before + of_one);
}

}  // namespace photile::test
