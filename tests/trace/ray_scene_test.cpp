// Intersections and the points they give.
#include "photile/ray_scene.hpp"

#include <malloc.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <limits>
#include <optional>

#include "instanced_scenes.hpp"
#include "photon_sets.hpp"
#include "statistical_tests.hpp"
#include "suns.hpp"
#include "test_scenes.hpp"
#include "trace/ray_query.hpp"
#include "trace/ray_scene.hpp"
#include "trace/surface.hpp"
#include "uniform.hpp"

namespace photile::test {

using namespace trace;

TEST_CASE("A ray hits the point of the plate below it, on the side that it comes from") {
  const Scene scene = plate(diffuse(0.5f), 2, 8);
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
  const Scene scene = closed_box(diffuse(0.5f));
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
        const std::uint32_t material = builder.add(diffuse(0.5f));
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
  Scene scene = closed_box(diffuse(0.5f), 40);
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
  const Scene small = closed_box(diffuse(0.5f));
  const Scene large = closed_box(diffuse(0.5f), 60);
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
  const Scene scene = closed_box(diffuse(0.5f), 40);
  const std::uint64_t of_one = RayScene(scene).bytes();
  const std::size_t before = in_use();
  for (int i = 0; i < 10; ++i) RayScene{scene};
  CHECK(in_use() < before + of_one);
}

// Meshes that are shared, and meshes with holes.

namespace {

// Meshes that Embree shares between places: the same hits as without, in less memory.

/// Distance along the ray to the nearest triangle, in double precision and one by one.
std::optional<double> nearest_distance(const Scene& scene, const glm::dvec3& origin,
                                       const glm::dvec3& direction) {
  std::optional<double> nearest;
  for (std::size_t t = 0; t < scene.triangle_count(); ++t) {
    const auto [a, b, c] = scene.corners(t);
    const glm::dvec3 e1 = glm::dvec3(b) - glm::dvec3(a), e2 = glm::dvec3(c) - glm::dvec3(a);
    const glm::dvec3 p = glm::cross(direction, e2);
    const double determinant = glm::dot(e1, p);
    if (determinant == 0) continue;
    const glm::dvec3 s = origin - glm::dvec3(a);
    const glm::dvec3 q = glm::cross(s, e1);
    const double u = glm::dot(s, p) / determinant, v = glm::dot(direction, q) / determinant;
    const double distance = glm::dot(e2, q) / determinant;
    if (u >= 0 && v >= 0 && u + v <= 1 && distance > 0 && (!nearest || distance < *nearest)) {
      nearest = distance;
    }
  }
  return nearest;
}

std::uint32_t first_of_instances(const Scene& scene) { return scene.instances[0].first_triangle; }

TEST_CASE("rays meet turned, scaled and mirrored instances where the world's triangles are") {
  const Scene scene = room_of_balls(6);
  const RayScene rays(scene);
  Uniform uniform(3);
  int on_instances = 0;
  for (int i = 0; i < 5'000; ++i) {
    const glm::vec3 origin(0.2f + 3.6f * uniform(), 0.1f + 2.8f * uniform(),
                           1.4f + 0.9f * uniform());
    const glm::vec3 direction = uniform.direction();
    const auto expected = nearest_distance(scene, origin, direction);
    REQUIRE(expected);
    const auto hit = impl_of(rays).intersect(origin, direction);
    REQUIRE(hit);
    on_instances += hit->triangle >= first_of_instances(scene);
    const SurfacePoint point = surface_hit(scene, *hit, direction);
    const glm::dvec3 at = glm::dvec3(origin) + *expected * glm::dvec3(direction);
    CAPTURE(i, hit->triangle);
    CHECK(glm::distance(glm::dvec3(point.position), at) < 1e-5);
    CHECK(glm::dot(point.normal, direction) <= 0);
  }
  CHECK(on_instances > 200);  // the balls cover a few hundredths of all directions
}

TEST_CASE("triangles before, between and after instances are met where they are") {
  Scene scene = empty_scene();
  const SharedMesh ball = dented_ball(4);
  const auto add_plate_and_ball = [&](float x) {
    add_plate(scene, {x - 1, -1, -1}, {2, 0, 0}, {0, 2, 0}, 1);
    add_instances(scene, ball, {glm::mat4x3(glm::translate(glm::mat4(1.0f), {x, 0, 0}))}, 0);
  };
  add_plate_and_ball(0);
  add_plate_and_ball(5);
  add_plate(scene, {9, -1, -1}, {2, 0, 0}, {0, 2, 0}, 1);
  const RayScene rays(scene);
  for (std::uint32_t t = 0; t < scene.triangle_count(); ++t) {
    const SurfacePoint point = surface_point(scene, {t, 0.3f, 0.3f}, 0);
    const auto hit = impl_of(rays).intersect(point.position + 1e-3f * point.normal, -point.normal);
    REQUIRE(hit);
    CHECK(hit->triangle == t);
  }
}

TEST_CASE("a hit on an instance has the weights of the corners as the scene orders them") {
  const Scene scene = room_of_balls(6);
  const RayScene rays(scene);
  Uniform uniform(4);
  for (std::uint32_t t = first_of_instances(scene); t < scene.triangle_count(); ++t) {
    // From close by, so that nothing else is in the way.
    const SurfacePoint point = surface_point(scene, {t, 0.25f, 0.35f}, t % 2);
    const glm::vec3 origin = point.position + 1e-3f * point.normal;
    const auto hit = impl_of(rays).intersect(origin, -point.normal);
    REQUIRE(hit);
    if (hit->triangle != t) continue;  // where two balls intersect
    CHECK(hit->u == Approx(0.25f).margin(1e-3));
    CHECK(hit->v == Approx(0.35f).margin(1e-3));
  }
}

TEST_CASE(
    "a ray that leaves an instance never meets its own triangle again, at any place and size") {
  Uniform uniform(7);
  const SharedMesh ball = dented_ball(8);
  for (const float size : {1e-2f, 1.0f, 1e2f}) {
    for (const glm::vec3& offset :
         {glm::vec3(0.0f), glm::vec3(20.0f, -3.0f, 1.0f), glm::vec3(-481.0f, 212.0f, 97.0f)}) {
      if (size < 1e-4f * glm::length(offset)) continue;
      for (int turn = 0; turn < 20; ++turn) {
        Scene scene = furnished_room();
        const auto place = [&] {
          glm::mat4 moved = glm::translate(glm::mat4(1.0f), offset);
          moved = glm::rotate(moved, 6.0f * uniform(), uniform.direction());
          const float sign = turn % 2 == 0 ? 1.0f : -1.0f;
          return glm::mat4x3(glm::scale(moved, size * glm::vec3(sign, 0.3f, 2.0f)));
        };
        add_instances(scene, ball, {place(), place()}, 0);
        const RayScene rays(scene);
        for (int r = 0; r < 500; ++r) {
          const std::uint32_t first = scene.instances[r % 2].first_triangle;
          const auto t = first + static_cast<std::uint32_t>(
                                     uniform() * static_cast<float>(ball.triangles.size()));
          const float u = uniform();
          const glm::vec2 uv = sample_triangle(u, uniform());
          const SurfacePoint point = surface_point(scene, {t, uv.x, uv.y}, r % 2);
          glm::vec3 direction = uniform.direction();
          // Nearly along the surface, where the offset has least to spare.
          if (r % 4 < 2) {
            direction = glm::normalize(direction -
                                       0.999f * glm::dot(direction, point.normal) * point.normal);
          }
          const auto hit = impl_of(rays).intersect(point.origin_towards(direction), direction);
          CAPTURE(size, turn, r);
          REQUIRE_FALSE((hit && hit->triangle == t));
        }
      }
    }
  }
}

TEST_CASE("photons of a room with instances are those of the flattened room") {
  const Scene scene = room_of_balls();
  const Scene flat = flattened(scene);
  const PhotonTracerParameters parameters{.emitted_photons = 40'000};
  const PhotonTracerResult shared = trace_photons(RayScene(scene), parameters);
  const PhotonTracerResult single = trace_photons(RayScene(flat), parameters);
  // Paths part where a ray passes within rounding of an edge; after that their fates are their own.
  const auto count = static_cast<double>(single.photons.size());
  CHECK(std::abs(static_cast<double>(shared.photons.size()) - count) < 2e-3 * count);
  const auto flux = [](const Photons& photons) {
    double sum = 0;
    for (const glm::vec3& each : photons.flux) sum += luminance(glm::dvec3(each));
    return sum;
  };
  CHECK(flux(shared.photons) == Approx(flux(single.photons)).epsilon(2e-3));
  // Both lie in the order of their oriented faces: nearly all have a twin on the same one.
  std::vector<std::uint32_t> together;
  std::set_intersection(shared.photons.oriented_face.begin(), shared.photons.oriented_face.end(),
                        single.photons.oriented_face.begin(), single.photons.oriented_face.end(),
                        std::back_inserter(together));
  CHECK(static_cast<double>(together.size()) > 0.998 * count);
}

TEST_CASE("nothing escapes from a closed instance whose triangles meet at every edge") {
  Scene scene = furnished_room();
  add_instances(scene, dented_ball(20), places_in_room(), 0);
  const RayScene rays(scene);
  Uniform uniform(11);
  for (const MeshInstance& instance : scene.instances) {
    // The centre of a place is inside its ball.
    const glm::vec3 centre = instance.to_world[3];
    int escaped = 0;
    for (int i = 0; i < 20'000; ++i) {
      const auto hit = impl_of(rays).intersect(centre, uniform.direction());
      escaped += !hit || hit->triangle < first_of_instances(scene);
    }
    CHECK(escaped == 0);
  }
}

TEST_CASE("the memory of 1,000 instances of 10,000 triangles is that of one and 1,000 places") {
  const SharedMesh ball = dented_ball(51);
  REQUIRE(ball.triangles.size() >= 10'000);
  std::vector<glm::mat4x3> indices;
  for (int i = 0; i < 1'000; ++i) {
    const glm::vec3 at(i % 10, i / 10 % 10, i / 100);
    indices.emplace_back(glm::translate(glm::mat4(1.0f), at));
  }
  const auto bytes_of = [&](std::size_t count, bool flat) {
    Scene scene = furnished_room();
    add_instances(scene, ball, {indices.begin(), indices.begin() + static_cast<long>(count)}, 0);
    return RayScene(flat ? flattened(std::move(scene)) : scene).bytes();
  };
  const std::uint64_t of_one = bytes_of(1, true);
  // A node of Embree's top-level BVH, a transform and its inverse, and the instance's own record.
  constexpr std::uint64_t of_a_place = 2'048;
  CHECK(bytes_of(1'000, false) < 2 * of_one + 1'000 * of_a_place);
  // Ten flattened ones show what a mesh costs that is not shared.
  CHECK(bytes_of(10, true) > 8 * of_one);
}

// Cut-out materials: rays, photons and looking at lamps pass the holes, by how much is there.

/// A texture of one texel with this alpha.
Texture alpha_texel(std::uint8_t alpha) { return {"alpha", 1, 1, {{255, 255, 255, alpha}}}; }

/// A plate of 2 m in z = 0 of this opacity over a black floor in z = -1, a lamp above.
Scene plate_over_floor(float opacity, float cutoff = 0.0f) {
  SceneBuilder builder("plate over floor");
  Material material = diffuse(0.5f);
  material.opacity = opacity;
  material.opacity_cutoff = cutoff;
  builder.grid({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 1, builder.add(material));
  builder.grid({-5, -5, -1}, {10, 0, 0}, {0, 10, 0}, 1, builder.add(diffuse(0.0f)));
  builder.add(sun_along({0, 0, -1}));
  return builder.build();
}

/// Share of rays straight down that end on the floor.
double fraction_through(const Scene& scene) {
  const RayScene rays(scene);
  constexpr int samples = 20'000;
  int through = 0;
  for (int i = 0; i < samples; ++i) {
    const RandomStream random(3, static_cast<std::uint64_t>(i), 0);
    const RandomBlock place = random.block(Purpose::film_position, 0);
    RayOrigin origin(glm::vec3(1.8f * place.uniform(0) - 0.9f, 1.8f * place.uniform(1) - 0.9f, 2));
    std::uint32_t holes = 0;
    const auto met = next_surface(rays, origin, {0, 0, -1}, random, Purpose::eye_cutouts, holes);
    REQUIRE(met);
    through += met->position.z < -0.5f;
  }
  return static_cast<double>(through) / samples;
}

TEST_CASE("Rays pass a surface as often as it is not there") {
  CHECK(fraction_through(plate_over_floor(1.0f)) == 0);
  CHECK(fraction_through(plate_over_floor(0.0f)) == 1);
  // Standard deviation of the share: sqrt(0.3 x 0.7 / 20,000) = 0.0032.
  CHECK(fraction_through(plate_over_floor(0.3f)) == Approx(0.7).margin(0.016));
}

TEST_CASE("With a cutoff a surface is there or it is not") {
  CHECK(fraction_through(plate_over_floor(0.3f, 0.5f)) == 1);
  CHECK(fraction_through(plate_over_floor(0.5f, 0.5f)) == 0);
}

TEST_CASE("A texture's alpha multiplies the opacity") {
  Scene scene = plate_over_floor(1.0f, 0.5f);
  scene.corner_uv.assign(scene.triangle_count(), {});
  scene.textures = {alpha_texel(255), alpha_texel(60)};
  scene.materials[0].opacity_texture = 0;
  CHECK(fraction_through(scene) == 0);
  scene.materials[0].opacity_texture = 1;
  CHECK(fraction_through(scene) == 1);
}

TEST_CASE("Looking at a lamp sees through holes by what is not there") {
  const auto seen = [](const Scene& scene) {
    const RayScene rays(scene);
    return transmittance(rays, glm::vec3(0.2f, 0.1f, -0.5f), {0.25f, 0.15f, 3.0f});
  };
  CHECK(seen(plate_over_floor(1.0f)) == glm::vec3(0.0f));
  CHECK(seen(plate_over_floor(0.0f)) == glm::vec3(1.0f));
  CHECK(seen(plate_over_floor(0.25f)).g == Approx(0.75));
}

TEST_CASE("Photons reach what lies behind holes, and are stored where they pass") {
  for (const float opacity : {0.0f, 0.3f, 1.0f}) {
    const Scene scene = plate_over_floor(opacity);
    const RayScene rays(scene);
    PhotonTracerParameters parameters;
    parameters.emitted_photons = 400'000;
    const Photons photons = trace_photons(rays, parameters).photons;
    double on_plate = 0, on_floor = 0;
    for (std::size_t i = 0; i < photons.size(); ++i) {
      const glm::vec3& at = photons.position[i];
      if (std::abs(at.x) > 1 || std::abs(at.y) > 1) continue;
      (at.z > -0.5f ? on_plate : on_floor) += double{photons.flux[i].g};
    }
    // The sun's flux falls on the disc of the bounding sphere.
    const double radius = bounding_sphere(scene).radius;
    const double arrives = 4 / (glm::pi<double>() * radius * radius);
    // 7000 photons or more: 1.2% standard deviation.
    CAPTURE(opacity);
    CHECK(on_plate == Approx(arrives).epsilon(0.06));
    CHECK(on_floor == Approx((1.0 - double{opacity}) * arrives).margin(0.06 * arrives));
  }
}

TEST_CASE("A surface without holes asks for no random numbers") {
  const Scene scene = plate_over_floor(1.0f);
  const RayScene rays(scene);
  RayOrigin origin(glm::vec3(0.1f, 0.2f, 1.0f));
  std::uint32_t holes = 0;
  REQUIRE(
      next_surface(rays, origin, {0, 0, -1}, RandomStream(1, 1, 0), Purpose::eye_cutouts, holes));
  CHECK(holes == 0);
  CHECK(origin.position == glm::vec3(0.1f, 0.2f, 1.0f));
}

}  // namespace

}  // namespace photile::test
