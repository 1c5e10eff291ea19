// What the camera sees, against geometry worked out by hand.
#include <catch2/catch.hpp>
#include <random>
#include <tuple>

#include "photile/errors.hpp"
#include "photile/ray_scene.hpp"
#include "photile/scene.hpp"
#include "statistical_tests.hpp"
#include "test_scenes.hpp"
#include "trace/hit_batch.hpp"
#include "trace/ray_scene.hpp"

namespace photile::test {
namespace {

/// 2 m above the origin, looking down; up in the picture is +y, right is +x. The film spans 2 x 2 m
/// of the plane z = 0, or so little that all rays are at right angles to it.
enum class Film { wide, narrow };
Camera camera_above(Film film = Film::wide) {
  Camera camera;
  camera.position = {0, 0, 2};
  camera.forward = {0, 0, -1};
  camera.up = {0, 1, 0};
  camera.right = {1, 0, 0};
  camera.vertical_field_of_view = film == Film::wide ? 2 * std::atan(0.5) : 0.01;
  return camera;
}

PrimaryHitBatch photograph(const Scene& scene, const PrimaryHitParameters& film,
                           Film size = Film::wide) {
  return trace_primary_hits(RayScene(scene), camera_above(size), film, 0, film.height);
}

/// In z = 0, and in z = 3 above the camera.
void add_floor_and_ceiling(SceneBuilder& builder) {
  const std::uint32_t grey = builder.add(diffuse(0.5f));
  builder.grid({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}, 1, grey);
  builder.grid({-5, -5, 3}, {0, 10, 0}, {10, 0, 0}, 1, grey);
}

glm::dvec3 total_emission(const PrimaryHitBatch& batch) {
  glm::dvec3 sum(0.0);
  for (const VisibleEmission& seen : batch.emission) sum += seen.radiance;
  return sum;
}

}  // namespace

TEST_CASE("Each sample of a pixel hits the plate in that pixel's own square, in its own stratum") {
  const Scene scene = plate(diffuse({0.2f, 0.4f, 0.6f}), 4);
  const PrimaryHitParameters film{.width = 10, .height = 10, .samples_per_pixel = 4};
  const PrimaryHitBatch batch = photograph(scene, film);
  REQUIRE(batch.hits.size() == 400);
  CHECK(batch.rays == 400);
  CHECK(batch.emission.empty());
  std::set<std::array<int, 2>> strata;
  for (std::size_t i = 0; i < batch.hits.size(); ++i) {
    const glm::vec3 p = batch.hits.position[i];
    const double x = (p.x + 1) * 5, y = (1 - p.y) * 5;  // film coordinates, y down
    const auto pixel = static_cast<int>(batch.hits.pixel[i]);
    CHECK(x == Approx(pixel % 10 + 0.5).margin(0.5 + 1e-5));
    CHECK(y == Approx(pixel / 10 + 0.5).margin(0.5 + 1e-5));
    strata.insert({static_cast<int>(2 * x), static_cast<int>(2 * y)});
    CHECK(p.z == 0.0f);
    CHECK(batch.hits.throughput[i] == glm::vec3(0.25f));
    CHECK(batch.hits.diffuse_albedo[i] == glm::vec3(0.2f, 0.4f, 0.6f));
    CHECK(face_normal(scene, batch.hits.oriented_face[i]).z == 1.0);
  }
  CHECK(strata.size() == 400);
  CHECK(batch.hits.outgoing.empty());
  CHECK(batch.hits.lobe.empty());
}

TEST_CASE("Samples fall evenly over a pixel, and rays beside the plate hit nothing") {
  const Scene scene = plate(diffuse(0.5f), 1);  // a quarter of the film
  const PrimaryHitBatch batch =
      photograph(scene, {.width = 1, .height = 1, .samples_per_pixel = 40'000});
  CHECK(batch.rays == 40'000);
  // With 200 x 200 strata only those on the border vary.
  CHECK(static_cast<double>(batch.hits.size()) == Approx(10'000).margin(200));
  std::vector<double> counts(64, 0.0);
  for (const glm::vec3& p : batch.hits.position)
    ++counts[static_cast<std::size_t>(8 * (p.x + 0.5f)) * 8 +
             static_cast<std::size_t>(8 * (p.y + 0.5f))];
  CHECK_VERDICT(
      counts_agree(counts, std::vector<double>(64, static_cast<double>(batch.hits.size()) / 64)));
}

TEST_CASE("Hits lie pixel by pixel, those of one by oriented face, then by Morton code") {
  const Scene scene = furnished_room(2);
  const RayScene rays(scene);
  Camera camera = camera_above();
  camera.position = {2, 1.5, 2.3};
  camera.vertical_field_of_view = 2.0;
  const PrimaryHits hits =
      trace_primary_hits(rays, camera, {.width = 64, .height = 48}, 0, 48).hits;
  REQUIRE(hits.size() > 10'000);
  const trace::HitCells cells(impl_of(rays).bounds);
  const auto key = [&](std::size_t i) {
    return std::tuple{hits.pixel[i], hits.oriented_face[i], cells.morton_code(hits.position[i])};
  };
  for (std::size_t i = 1; i < hits.size(); ++i) REQUIRE(key(i - 1) <= key(i));
}

TEST_CASE("The Morton code interleaves the bits of the cells of the three axes") {
  // Cells of 1 m.
  constexpr float side = 1 << trace::HitCells::bits_per_axis;
  const trace::HitCells cells({glm::vec3(0.0f), glm::vec3(side)});
  CHECK(cells.morton_code({0.0f, 0.0f, 0.0f}) == 0);
  CHECK(cells.morton_code({1.0f, 0.0f, 0.0f}) == 1);
  CHECK(cells.morton_code({0.0f, 1.0f, 0.0f}) == 2);
  CHECK(cells.morton_code({0.0f, 0.0f, 1.0f}) == 4);
  CHECK(cells.morton_code({5.0f, 3.0f, 0.0f}) == 0b001'010'011);
  constexpr std::uint64_t last = (1ull << 3 * trace::HitCells::bits_per_axis) - 1;
  CHECK(cells.morton_code(glm::vec3(side)) == last);
  CHECK(cells.morton_code(glm::vec3(side + 10)) == last);
  CHECK(cells.morton_code(glm::vec3(-10)) == 0);
  const trace::HitCells flat({glm::vec3(0.0f), {side, 0.0f, side}});
  CHECK(flat.morton_code({1.0f, 0.0f, 1.0f}) == 0b101);
}

TEST_CASE("Glossy scenes tell the direction to the eye and the lobe of each hit") {
  Scene scene = plate(glossy(glm::vec3(0.3f), {0.1f, 0.2f, 0.3f}, 0.4f), 4);
  const glm::vec3 tilted = glm::normalize(glm::vec3(0.1f, 0.0f, 1.0f));
  // Shading normals lie on the front; the lobe's lies on the side of the eye.
  const bool seen_from_front = GENERATE(true, false);
  const glm::vec3 on_front = seen_from_front ? tilted : -tilted;
  scene.corner_normal.assign(scene.triangle_count(), {on_front, on_front, on_front});
  scene = rewound(scene, [&](std::size_t) { return !seen_from_front; });
  const PrimaryHits hits = photograph(scene, {.width = 4, .height = 4}).hits;
  REQUIRE(hits.lobe.size() == 64);
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const glm::vec3 to_eye = glm::normalize(glm::vec3(0, 0, 2) - hits.position[i]);
    CHECK(glm::distance(hits.outgoing[i], to_eye) < 1e-6f);
    CHECK(glm::distance(hits.lobe[i].normal, tilted) < 1e-6f);
    CHECK(hits.lobe[i].specular == glm::vec3(0.1f, 0.2f, 0.3f));
    CHECK(hits.lobe[i].roughness == 0.4f);
  }
}

TEST_CASE("A lamp in view is seen from its front only, at 1 / (pi A), and reflects as well") {
  const bool two_sided = GENERATE(false, true);
  const bool facing = GENERATE(false, true);
  SceneBuilder builder;
  const std::uint32_t grey = builder.add(diffuse(0.5f));
  Light light = area_light("lamp", 70, two_sided);
  light.color = glm::vec3(2.0f, 1.0f, 0.5f) / static_cast<float>(luminance({2.0, 1.0, 0.5}));
  const std::uint32_t lamp = builder.add(light);
  const glm::vec3 u(4, 0, 0), v(0, 4, 0), corner(-2, -2, 0);
  builder.grid(corner, facing ? u : v, facing ? v : u, 2, grey, lamp);
  const Scene scene = builder.build();
  const PrimaryHitBatch batch = photograph(scene, {.width = 8, .height = 8});
  CHECK(batch.hits.size() == 8 * 8 * 4);
  const glm::dvec3 radiance = facing || two_sided
                                  ? glm::dvec3(light.color) / (M_PI * 16 * (two_sided ? 2 : 1))
                                  : glm::dvec3(0.0);
  CHECK(glm::distance(total_emission(batch) / 64.0, radiance) < 1e-6);
  CHECK(batch.emission.size() == (facing || two_sided ? batch.hits.size() : 0));
  CHECK(glm::distance(glm::dvec3(emitted_radiance_at_unit_power(scene)[0]),
                      glm::dvec3(light.color) / (M_PI * 16 * (two_sided ? 2 : 1))) < 1e-6);
}

TEST_CASE("A mirror shows the lamp above it, tinted, and stores no hit of its own") {
  SceneBuilder builder;
  const std::uint32_t silver = builder.add(mirror({0.9f, 0.8f, 0.7f}));
  const std::uint32_t lamp = builder.add(area_light("lamp"));
  builder.grid({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}, 1, silver);
  // Behind the camera, facing down, and large enough to fill the mirror.
  builder.grid({-5, -5, 3}, {0, 10, 0}, {10, 0, 0}, 1, builder.add(diffuse(0.5f)), lamp);
  const PrimaryHitBatch batch = photograph(builder.build(), {.width = 8, .height = 8});
  CHECK(batch.rays == 2 * 8 * 8 * 4);
  REQUIRE(batch.hits.size() == 8 * 8 * 4);
  for (std::size_t i = 0; i < batch.hits.size(); ++i) {
    CHECK(batch.hits.position[i].z == 3.0f);
    CHECK(glm::distance(batch.hits.throughput[i], 0.25f * glm::vec3(0.9f, 0.8f, 0.7f)) < 1e-6f);
  }
  const glm::dvec3 seen = total_emission(batch) / 64.0;
  CHECK(glm::distance(seen, glm::dvec3(0.9, 0.8, 0.7) / (M_PI * 100)) < 1e-6);
}

TEST_CASE("A window splits rays by Fresnel's probability and conserves their number") {
  SceneBuilder builder;
  builder.grid({-2, -2, 1}, {4, 0, 0}, {0, 4, 0}, 1, builder.add(glass(1.5f, true)));
  add_floor_and_ceiling(builder);
  const PrimaryHits hits =
      photograph(builder.build(), {.width = 64, .height = 64, .samples_per_pixel = 16},
                 Film::narrow)
          .hits;
  const double all = 64 * 64 * 16;
  double reflected = 0;
  for (const glm::vec3& p : hits.position) reflected += p.z > 2;
  CHECK(static_cast<double>(hits.size()) == all);
  const double reflectance = 2 * 0.04 / 1.04;
  CHECK_VERDICT(
      counts_agree({reflected, all - reflected}, {all * reflectance, all * (1 - reflectance)}));
}

TEST_CASE("A window parts rays by Fresnel's shares, where it is not left to chance") {
  const bool thin = GENERATE(true, false);
  SceneBuilder builder;
  const std::uint32_t pane = builder.add(glass(1.5f, thin));
  builder.grid({-2, -2, 1}, {4, 0, 0}, {0, 4, 0}, 1, pane);
  if (!thin) builder.grid({-2, -2, 0.5f}, {0, 4, 0}, {4, 0, 0}, 1, pane);
  add_floor_and_ceiling(builder);
  const int samples = 32 * 32 * 16;
  const PrimaryHits hits =
      photograph(builder.build(),
                 {.width = 32, .height = 32, .samples_per_pixel = 16, .split_at_glass = true},
                 Film::narrow)
          .hits;
  double reflected = 0, transmitted = 0, shares = 0;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    (hits.position[i].z > 2 ? reflected : transmitted) += double{hits.throughput[i].x} * 16;
    shares += double{hits.fraction[i]};
  }
  const double reflectance = 2 * 0.04 / 1.04;
  // A slab reflects at once, or after one way in it and back; where that is seen again is left to
  // chance, and 0.04 x 0.04 of the light.
  const double left_to_chance = thin ? 1e-6 : 2.5e-4;
  CHECK(reflected / samples == Approx(reflectance).margin(left_to_chance));
  CHECK(transmitted / samples == Approx(1 - reflectance).margin(left_to_chance));
  CHECK(hits.size() == static_cast<std::size_t>(thin ? 2 : 3) * samples);
  CHECK(shares / samples == Approx(1).epsilon(1e-6));
}

TEST_CASE("A surface that is partly there parts rays, where it is not left to chance") {
  SceneBuilder builder;
  Material curtain = diffuse(0.5f);
  curtain.opacity = 0.3f;
  builder.grid({-2, -2, 1}, {4, 0, 0}, {0, 4, 0}, 1, builder.add(curtain));
  builder.grid({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}, 1, builder.add(diffuse(0.5f)));
  const PrimaryHits hits =
      photograph(builder.build(),
                 {.width = 8, .height = 8, .samples_per_pixel = 4, .split_at_glass = true})
          .hits;
  REQUIRE(hits.size() == 2 * 8 * 8 * 4);  // each sample sees both
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const double there = hits.position[i].z > 0.5f ? 0.3 : 0.7;
    CHECK(double{hits.throughput[i].x} * 4 == Approx(there).epsilon(1e-6));
    CHECK(double{hits.fraction[i]} == Approx(there).epsilon(1e-6));
  }
}

TEST_CASE("Pixels that show an edge have more samples, which count as much together") {
  // The borders of a plate cross pixels; a border of two materials lies in the plane of the floor.
  SceneBuilder builder;
  const std::uint32_t grey = builder.add(diffuse(0.5f));
  const std::uint32_t other = builder.add(diffuse(0.5f));
  builder.grid({-4, -4, 0}, {8, 0, 0}, {0, 4.8f, 0}, 3, grey);
  builder.grid({-4, 0.8f, 0}, {8, 0, 0}, {0, 3.2f, 0}, 3, other);
  builder.grid({-0.31f, -0.33f, 0.5f}, {0.6f, 0, 0}, {0, 0.7f, 0}, 1, grey);
  const Scene scene = builder.build();
  const RayScene rays(scene);
  constexpr int side = 32, samples = 8, times = 4;
  struct Pixel {
    int hits = 0;
    double light = 0, fraction = 0, raised = 0, of_other = 0;
  };
  const auto pixels_of = [&](const PrimaryHitParameters& film) {
    const PrimaryHits hits = trace_primary_hits(rays, camera_above(), film, 0, side).hits;
    std::vector<Pixel> pixels(side * side);
    for (std::size_t i = 0; i < hits.size(); ++i) {
      Pixel& pixel = pixels[hits.pixel[i]];
      const double light = double{hits.throughput[i].x};
      ++pixel.hits;
      pixel.light += light;
      pixel.fraction += hits.fraction.empty() ? 1.0 : double{hits.fraction[i]};
      pixel.raised += hits.position[i].z > 0.25f ? light : 0.0;
      pixel.of_other += hits.position[i].z < 0.25f && hits.position[i].y > 0.8f ? light : 0.0;
    }
    return pixels;
  };
  PrimaryHitParameters film{.width = side, .height = side, .samples_per_pixel = samples};
  const std::vector<Pixel> usual = pixels_of(film);
  film.times_at_edges = times;
  const std::vector<Pixel> pixels = pixels_of(film);
  film = {.width = side, .height = side, .samples_per_pixel = 1024};
  const std::vector<Pixel> truth = pixels_of(film);
  double edges = 0, error = 0, usual_error = 0;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    CHECK(pixels[i].light == Approx(1).epsilon(1e-6));
    CHECK(pixels[i].fraction == Approx(samples).epsilon(1e-6));
    const double share = std::max(truth[i].raised, truth[i].of_other);
    if (share > 0.25 && share < 0.75) CHECK(pixels[i].hits == times * samples);
    if (share == 0 || share > 0.999) CHECK(pixels[i].hits == samples);
    if (pixels[i].hits == samples) continue;
    ++edges;
    error += std::pow(pixels[i].raised - truth[i].raised, 2);
    usual_error += std::pow(usual[i].raised - truth[i].raised, 2);
  }
  CHECK(edges > side);
  CHECK(error < usual_error / times);
}

TEST_CASE("Things smaller than a pixel count by their size where edges have more samples") {
  SceneBuilder builder;
  builder.grid({-4, -4, 0}, {8, 0, 0}, {0, 8, 0}, 1, builder.add(diffuse(0.5f)));
  builder.grid({-0.3f, -0.2f, 0.01f}, {0.6f, 0, 0}, {0, 0.6f, 0}, 1, builder.add(diffuse(0.5f)));
  const Scene scene = builder.build();
  PrimaryHitParameters film{.width = 1, .height = 1, .samples_per_pixel = 8};
  film.times_at_edges = 4;
  double share = 0;
  for (film.seed = 1; film.seed <= 4000; ++film.seed) {
    const PrimaryHits hits = photograph(scene, film).hits;
    for (std::size_t i = 0; i < hits.size(); ++i)
      share += hits.position[i].z > 0 ? double{hits.throughput[i].x} / 4000 : 0;
  }
  CHECK(share == Approx(0.36 / (1.99 * 1.99)).epsilon(0.08));
}

TEST_CASE("Glass parts the rays of pixels with an edge as it parts those of others") {
  SceneBuilder builder;
  builder.grid({-2, -2, 1}, {4, 0, 0}, {0, 4, 0}, 1, builder.add(glass(1.5f, true)));
  builder.grid({-2, -2, 0}, {2, 0, 0}, {0, 4, 0}, 1, builder.add(diffuse(0.5f)));
  const std::uint32_t grey = builder.add(diffuse(0.5f));
  builder.grid({0, -2, 0}, {2, 0, 0}, {0, 4, 0}, 1, grey);
  builder.grid({-5, -5, 3}, {0, 10, 0}, {10, 0, 0}, 1, grey);
  PrimaryHitParameters film{.width = 1, .height = 1, .samples_per_pixel = 16};
  film.times_at_edges = 4;
  film.split_at_glass = true;
  const PrimaryHits hits = photograph(builder.build(), film, Film::narrow).hits;
  REQUIRE(hits.size() == 2 * 4 * 16);  // each sample sees the floor, and the ceiling in the pane
  double reflected = 0;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if (hits.position[i].z > 2) reflected += double{hits.fraction[i]};
  }
  CHECK(reflected / 16 == Approx(2 * 0.04 / 1.04).epsilon(1e-3));
}

TEST_CASE("A lamp under water is seen from above by its radiance over the squared index") {
  const bool closed = GENERATE(false, true);  // the lamp is in the glass, or below it
  SceneBuilder builder;
  const std::uint32_t lamp = builder.add(area_light("lamp"));
  const std::uint32_t solid = builder.add(glass(1.5f));
  builder.grid({-2, -2, 1}, {4, 0, 0}, {0, 4, 0}, 1, solid);
  if (closed) builder.grid({-2, -2, 0.5f}, {0, 4, 0}, {4, 0, 0}, 1, solid);
  builder.grid({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}, 1, builder.add(diffuse(0.5f)), lamp);
  const PrimaryHitBatch batch = photograph(
      builder.build(), {.width = 64, .height = 64, .samples_per_pixel = 16}, Film::narrow);
  // A lamp below a slab of glass is seen as without it, but for what its faces reflect.
  const double expected = (closed ? 1.0 : 1 / 2.25) / (M_PI * 16);
  for (const VisibleEmission& seen : batch.emission) {
    CHECK(double{seen.radiance.x} == Approx(expected / 16).epsilon(1e-6));
  }
  const double passes = closed ? 1 - 2 * 0.04 / 1.04 : 0.96;
  CHECK(static_cast<double>(batch.emission.size()) == Approx(64 * 64 * 16 * passes).epsilon(0.01));
}

TEST_CASE("A ray between two mirrors ends at the bound on its depth") {
  SceneBuilder builder;
  const std::uint32_t silver = builder.add(mirror(1.0f));
  builder.grid({-50, -50, 0}, {100, 0, 0}, {0, 100, 0}, 1, silver);
  builder.grid({-50, -50, 3}, {0, 100, 0}, {100, 0, 0}, 1, silver);
  const PrimaryHitBatch batch = photograph(
      builder.build(), {.width = 2, .height = 2, .samples_per_pixel = 1, .max_specular_depth = 7});
  CHECK(batch.hits.size() == 0);
  CHECK(batch.rays == 4 * 8);
}

TEST_CASE("Films and rows out of range are refused") {
  const Scene scene = plate(diffuse(0.5f), 1);
  const RayScene rays(scene);
  const auto traced = [&](const PrimaryHitParameters& film, int first, int last) {
    trace_primary_hits(rays, camera_above(), film, first, last);
  };
  CHECK_THROWS_AS(traced({.width = 0}, 0, 1), UsageError);
  CHECK_THROWS_AS(traced({.height = 100'000}, 0, 1), UsageError);
  CHECK_THROWS_AS(traced({.samples_per_pixel = 0}, 0, 1), UsageError);
  CHECK_THROWS_AS(traced({.max_specular_depth = -1}, 0, 1), UsageError);
  CHECK_THROWS_AS(traced({.height = 10}, 3, 2), UsageError);
  CHECK_THROWS_AS(traced({.height = 10}, 0, 11), UsageError);
}

TEST_CASE("what comes by reflection and what is left out are the whole") {
  // A plate under the camera, half of it a mirror that sees a lamp above, a quarter glossy.
  SceneBuilder builder;
  const auto matt = builder.add(diffuse(0.5f));
  const auto shining = builder.add(glossy(0.4f, 0.04f, 0.3f));
  const auto mirror = builder.add(test::mirror(0.9f));
  builder.quad({-1, 0, 0}, {0, 0, 0}, {0, 1, 0}, {-1, 1, 0}, matt);
  builder.quad({-1, -1, 0}, {0, -1, 0}, {0, 0, 0}, {-1, 0, 0}, shining);
  builder.quad({0, -1, 0}, {1, -1, 0}, {1, 1, 0}, {0, 1, 0}, mirror);
  const auto light = builder.add(area_light("lamp", 10));
  builder.quad({-9, 9, 5}, {9, 9, 5}, {9, -9, 5}, {-9, -9, 5}, matt, light);  // faces down
  const Scene scene = builder.build();
  const PrimaryHitParameters film{.width = 16, .height = 16, .samples_per_pixel = 4};
  const RayScene rays(scene);
  const PrimaryHitBatch all = trace_primary_hits(rays, camera_above(), film, 0, 16);
  const PrimaryHitBatch reflected = trace::trace_reflected_hits(rays, camera_above(), film, 0, 16);

  // The mirror fills the right half: all that it shows is there, hits and lamp.
  REQUIRE(reflected.emission.size() == all.emission.size());
  CHECK(total_emission(reflected) == total_emission(all));
  std::size_t behind_mirror = 0, lobes = 0;
  for (std::size_t i = 0; i < reflected.hits.size(); ++i) {
    const bool right = reflected.hits.pixel[i] % 16 >= 8;
    const bool lower = reflected.hits.pixel[i] / 16 >= 8;
    CHECK((right || lower));  // the matt quarter reflects nothing
    ++(right ? behind_mirror : lobes);
    if (right) {
      CHECK(reflected.hits.diffuse_albedo[i] == glm::vec3(0.5f));
    } else {
      CHECK(reflected.hits.diffuse_albedo[i] == glm::vec3(0.0f));
      CHECK(reflected.hits.lobe[i].specular == glm::vec3(0.04f));
    }
  }
  CHECK(behind_mirror == 8 * 16 * 4);
  CHECK(lobes == 8 * 8 * 4);
}

TEST_CASE("what lies behind a pane of thin glass is seen, and not reflected") {
  SceneBuilder builder;
  const auto matt = builder.add(diffuse(0.5f));
  const auto pane = builder.add(glass(1.0f, true));  // of index 1: it reflects nothing
  builder.quad({-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}, matt);
  builder.quad({-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}, pane);
  const Scene scene = builder.build();
  const PrimaryHitParameters film{.width = 8, .height = 8, .samples_per_pixel = 1};
  const RayScene rays(scene);
  CHECK(trace_primary_hits(rays, camera_above(), film, 0, 8).hits.size() == 64);
  CHECK(trace::trace_reflected_hits(rays, camera_above(), film, 0, 8).hits.size() == 0);
}

TEST_CASE("The hits of a pixel's runs are sorted by map and cell, those without a map last") {
  const std::vector<std::uint32_t> map_of{5, none, 0, 2, none, 1'000'000, 5};
  const Scene scene = furnished_room(2);
  const RayScene rays(scene);
  const trace::HitCells cells(impl_of(rays).bounds);
  std::mt19937 random(1);
  std::uniform_real_distribution<float> uniform;
  std::vector<trace::EyeRecord> records(50);
  for (std::uint32_t row = 0; row < 50; ++row) {
    for (std::uint32_t i = 0; i < 40; ++i) {
      trace::EyeHit hit{};
      hit.position = {uniform(random), uniform(random), uniform(random)};
      hit.oriented_face = static_cast<std::uint32_t>(random() % map_of.size());
      hit.pixel = 2 * (2 * row + i / 20) + i % 2;  // two pixels a row, each of two runs
      records[row].hits.push_back(hit);
    }
  }
  const PrimaryHits hits = trace::batch_of(rays, records, 2, map_of).hits;
  REQUIRE(hits.size() == 2'000);
  const auto order_of = [&](std::size_t i) {
    return std::tuple(hits.pixel[i] / 2, map_of[hits.oriented_face[i]],
                      cells.morton_code(hits.position[i]));
  };
  for (std::size_t i = 1; i < hits.size(); ++i) REQUIRE(order_of(i - 1) <= order_of(i));
}

}  // namespace photile::test
