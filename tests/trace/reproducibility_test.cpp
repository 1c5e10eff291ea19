// Shards, passes and batches trace the photons and hits of one run; that threads and windings
// change none is in tests/equal_bits.
#include <array>
#include <catch2/catch.hpp>
#include <cstring>

#include "photile/photons.hpp"
#include "photile/ray_scene.hpp"
#include "test_scenes.hpp"

namespace photile::test {
namespace {

// Whether two results are the same, bit for bit.

template <class T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

bool same_bits(const Photons& a, const Photons& b) {
  return same_bits(a.position, b.position) && same_bits(a.flux, b.flux) &&
         same_bits(a.incoming, b.incoming) && same_bits(a.light, b.light) &&
         same_bits(a.oriented_face, b.oriented_face) && same_bits(a.first_of, b.first_of);
}

/// A room with glossy walls, a mirror and glass, whose floor is covered twice: of two triangles in
/// the same place a ray must always choose the same one.
Scene difficult_room() {
  SceneBuilder builder("difficult room");
  const std::uint32_t wall = builder.add(glossy({0.6f, 0.5f, 0.4f}, glm::vec3(0.04f), 0.3f));
  const std::uint32_t carpet = builder.add(diffuse({0.3f, 0.1f, 0.1f}));
  builder.box(glm::vec3(0.0f), glm::vec3(3.0f), wall, true, 20);
  builder.grid(glm::vec3(0.0f), {3, 0, 0}, {0, 3, 0}, 20, carpet);
  builder.grid(glm::vec3(0.0f), {3, 0, 0}, {0, 3, 0}, 20, wall);
  builder.box(glm::vec3(0.5f), glm::vec3(1.0f), builder.add(glass(1.5f)), false);
  builder.box({1.5f, 1.5f, 0.2f}, {2.0f, 2.5f, 1.0f}, builder.add(mirror(0.9f)), false);
  const std::uint32_t lamp = builder.add(area_light("lamp", 100));
  builder.grid({1, 1, 2.9f}, {0, 1, 0}, {1, 0, 0}, 2, carpet, lamp);
  builder.add(point_light("bulb", {2.5f, 0.5f, 1.5f}, 10));
  return builder.build();
}

Camera camera_into_room() {
  Camera camera;
  camera.position = {0.3, 0.3, 1.7};
  camera.forward = glm::normalize(glm::dvec3(1.0, 1.1, 0.3));
  camera.right = glm::normalize(glm::cross(camera.forward, glm::dvec3(0, 0, 1)));
  camera.up = glm::cross(camera.right, camera.forward);
  camera.vertical_field_of_view = 1.2;
  return camera;
}

constexpr PrimaryHitParameters film{.width = 61, .height = 47, .samples_per_pixel = 5};

}  // namespace

TEST_CASE("Photons of all shards are those of one process, bit for bit, caustics included") {
  const Scene scene = difficult_room();
  const RayScene rays(scene);
  PhotonTracerParameters parameters{.emitted_photons = 20'001, .seed = 5, .keep_caustics = true};
  const PhotonTracerResult one = trace_photons(rays, parameters);
  REQUIRE(one.caustics.size() > 0);
  for (const std::uint32_t count : {2u, 3u, 7u, 50'000u}) {  // more shards than paths
    std::vector<Photons> photons, caustics;
    for (std::uint32_t i = 0; i < count; ++i) {
      if (count == 50'000u && i % 12'500 != 0) continue;  // one of these has a path
      parameters.shard = {i, count};
      PhotonTracerResult shard = trace_photons(rays, parameters);
      photons.push_back(std::move(shard.photons));
      caustics.push_back(std::move(shard.caustics));
    }
    const Photons all = merge_runs(std::move(photons));
    if (count == 50'000u) {
      CHECK(all.size() < one.photons.size() / 100);
      continue;
    }
    CHECK(same_bits(all, one.photons));
    CHECK(all.emitted_per_light == one.photons.emitted_per_light);
    CHECK(same_bits(merge_runs(std::move(caustics)), one.caustics));
  }
}

TEST_CASE("Another seed gives other photons, and each light its own") {
  const Scene scene = furnished_room();
  const RayScene rays(scene);
  const Photons a = trace_photons(rays, {.emitted_photons = 1000, .seed = 5}).photons;
  const Photons b = trace_photons(rays, {.emitted_photons = 1000, .seed = 6}).photons;
  CHECK_FALSE(same_bits(a.position, b.position));

  Scene twins = closed_box(diffuse(0.0f));
  twins.lights.push_back(twins.lights[0]);
  const Photons photons = trace_photons(RayScene(twins), {.emitted_photons = 2}).photons;
  REQUIRE(photons.size() == 2);
  CHECK(photons.position[0] != photons.position[1]);
}

TEST_CASE("Each pixel's hits come in the same order however rows are split into batches") {
  const Scene scene = difficult_room();
  const RayScene rays(scene);
  // Positions and throughputs of each pixel, in the order of the batch.
  using PerPixel = std::vector<std::vector<glm::vec3>>;
  const auto collect = [&](const std::vector<int>& first_rows) {
    PerPixel pixels(static_cast<std::size_t>(film.width) * film.height);
    for (std::size_t b = 0; b + 1 < first_rows.size(); ++b) {
      const PrimaryHitBatch batch =
          trace_primary_hits(rays, camera_into_room(), film, first_rows[b], first_rows[b + 1]);
      for (std::size_t i = 0; i < batch.hits.size(); ++i) {
        pixels[batch.hits.pixel[i]].push_back(batch.hits.position[i]);
        pixels[batch.hits.pixel[i]].push_back(batch.hits.throughput[i]);
      }
      for (const VisibleEmission& seen : batch.emission)
        pixels[seen.pixel].push_back(seen.radiance);
    }
    return pixels;
  };
  const PerPixel whole = collect({0, film.height});
  CHECK(collect({0, 1, 20, film.height}) == whole);
  CHECK(collect({0, 17, 17, film.height}) == whole);
}

TEST_CASE("passes trace the paths of one pass, each path once") {
  const Scene scene = difficult_room();
  const RayScene rays(scene);
  PhotonTracerParameters parameters;
  parameters.quota = PhotonQuota::equal;
  parameters.emitted_photons = 2'000;
  const Photons all = trace_photons(rays, parameters).photons;
  parameters.emitted_photons = 1'000;
  const Photons first = trace_photons(rays, parameters).photons;
  parameters.paths_before = first.emitted_per_light;
  const Photons second = trace_photons(rays, parameters).photons;
  CHECK_FALSE(same_bits(first.position, second.position));
  // In the order of their triangles, lights and paths, the photons of the first pass come first.
  REQUIRE(first.size() + second.size() == all.size());
  std::size_t differences = 0;
  for (std::uint32_t s = 0; s + 1 < all.first_of.size(); ++s) {
    for (std::uint32_t i = all.first_of[s], a = first.first_of[s], b = second.first_of[s];
         i < all.first_of[s + 1]; ++i) {
      const bool of_first = a < first.first_of[s + 1] && first.position[a] == all.position[i] &&
                            first.light[a] == all.light[i];
      const bool of_second = !of_first && b < second.first_of[s + 1] &&
                             second.position[b] == all.position[i] &&
                             second.light[b] == all.light[i];
      differences += !of_first && !of_second;
      a += of_first;
      b += of_second;
    }
  }
  CHECK(differences == 0);
}

TEST_CASE("passes trace the samples of one pass, each sample once") {
  const Scene scene = difficult_room();
  const RayScene rays(scene);
  PrimaryHitParameters film;
  film.width = 16;
  film.height = 12;
  film.samples_per_pixel = 5;
  const auto traced = [&] { return trace_primary_hits(rays, camera_into_room(), film, 0, 12); };
  const PrimaryHitBatch all = traced();
  film.passes = 3;
  std::vector<std::array<float, 4>> together, expected;
  std::uint64_t ray_count = 0;
  const auto append = [](const PrimaryHits& hits, std::vector<std::array<float, 4>>& list) {
    for (std::size_t i = 0; i < hits.size(); ++i) {
      list.push_back(
          {hits.position[i].x, hits.position[i].y, hits.position[i].z, hits.throughput[i].x});
    }
  };
  append(all.hits, expected);
  for (film.pass = 0; film.pass < film.passes; ++film.pass) {
    const PrimaryHitBatch batch = traced();
    ray_count += batch.rays;
    append(batch.hits, together);
  }
  std::sort(together.begin(), together.end());
  std::sort(expected.begin(), expected.end());
  CHECK(together == expected);
  CHECK(ray_count == all.rays);
}

}  // namespace photile::test
