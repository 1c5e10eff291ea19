// Photon tracing: energy, weights, what is stored, and what is refused.
#include "trace/photon_tracer.hpp"

#include <algorithm>
#include <atomic>
#include <catch2/catch.hpp>
#include <random>
#include <type_traits>

#include "photile/errors.hpp"
#include "photile/limits.hpp"
#include "photile/photons.hpp"
#include "statistical_tests.hpp"
#include "suns.hpp"

namespace photile::test {
namespace {

double stored_luminance(const Photons& photons) {
  double sum = 0;
  for (const glm::vec3& flux : photons.flux) sum += luminance(flux);
  return sum;
}

/// Stored luminance of 16 independent runs.
std::vector<double> stored_luminances(const Scene& scene, std::uint64_t emitted,
                                      int roulette_start = 1) {
  const RayScene rays(scene);
  return of_seeds([&](std::uint64_t seed) {
    const PhotonTracerParameters tracing{
        .emitted_photons = emitted, .seed = seed, .roulette_start = roulette_start};
    return stored_luminance(trace_photons(rays, tracing).photons);
  });
}

Scene scene_with_powers(const std::vector<double>& powers) {
  Scene scene = closed_box(diffuse(0.5f));
  scene.lights.clear();
  for (const double power : powers)
    scene.lights.push_back(
        point_light("lamp " + std::to_string(scene.lights.size()), glm::vec3(0.5f), power));
  return scene;
}

std::uint64_t sum(const std::vector<std::uint64_t>& values) {
  return std::accumulate(values.begin(), values.end(), std::uint64_t{0});
}

TEST_CASE("In a closed diffuse box the stored flux is 1 + rho + rho^2 + ... = 1 / (1 - rho)") {
  CHECK_VERDICT(mean_is(stored_luminances(closed_box(diffuse(0.2f)), 40'000), 1.25, 0.01));
  CHECK_VERDICT(mean_is(stored_luminances(closed_box(diffuse(0.5f)), 60'000), 2.0, 0.02));
  CHECK_VERDICT(mean_is(stored_luminances(closed_box(diffuse(0.8f)), 60'000), 5.0, 0.08));
  // Long paths: in the second case most of the light is that of more than a hundred bounces.
  CHECK_VERDICT(mean_is(stored_luminances(closed_box(diffuse(0.95f)), 20'000), 20.0, 0.4));
  CHECK_VERDICT(mean_is(stored_luminances(closed_box(diffuse(0.99f)), 8'000), 100.0, 4.0));
  // Without roulette for three bounces the flux shrinks instead of the number of photons.
  CHECK_VERDICT(mean_is(stored_luminances(closed_box(diffuse(0.5f)), 60'000, 4), 2.0, 0.02));
}

TEST_CASE("In a box that reflects all light paths end") {
  // Where the chance to go on is 0.99, a hundred more surfaces are expected.
  const Scene scene = closed_box(diffuse(1.0f));
  const PhotonTracerResult result = trace_photons(RayScene(scene), {.emitted_photons = 2'000});
  CHECK(static_cast<double>(result.photons.size()) / 2'000 ==
        Approx(defaults::long_path + 99).epsilon(0.1));
}

TEST_CASE("Each colour channel has its own sum: roulette by one of them biases none") {
  const Scene scene = closed_box(diffuse({0.8f, 0.5f, 0.2f}));
  const RayScene rays(scene);
  std::array<std::vector<double>, 3> fluxes;
  for (std::uint64_t seed = 1; seed <= 16; ++seed) {
    glm::dvec3 total(0.0);
    for (const glm::vec3& flux :
         trace_photons(rays, {.emitted_photons = 60'000, .seed = seed}).photons.flux)
      total += flux;
    for (int c = 0; c < 3; ++c) fluxes[c].push_back(total[c]);
  }
  CHECK_VERDICT(mean_is(fluxes[0], 5.0, 0.08));
  CHECK_VERDICT(mean_is(fluxes[1], 2.0, 0.02));
  CHECK_VERDICT(mean_is(fluxes[2], 1.25, 0.01));
}

TEST_CASE(
    "A mirror and a glass ball in the box change nothing in the sum over bounces on its walls") {
  // Lossless specular surfaces pass all flux on, so every wall hit still scales it by the albedo.
  SceneBuilder builder;
  builder.box(glm::vec3(0.0f), glm::vec3(1.0f), builder.add(diffuse(0.5f)), true);
  builder.box(glm::vec3(0.1f), glm::vec3(0.3f), builder.add(glass(1.5f)), false);
  builder.box({0.6f, 0.6f, 0.1f}, glm::vec3(0.8f), builder.add(mirror(1.0f)), false);
  builder.quad({0.1f, 0.5f, 0.2f}, {0.4f, 0.5f, 0.2f}, {0.4f, 0.5f, 0.8f}, {0.1f, 0.5f, 0.8f},
               builder.add(glass(1.5f, true)));
  builder.add(point_light("lamp", {0.4f, 0.7f, 0.9f}));
  CHECK_VERDICT(mean_is(stored_luminances(builder.build(), 60'000), 2.0, 0.02));
}

TEST_CASE("What each light emits is absorbed or escapes, to 1e-6") {
  Scene open = furnished_room();
  open.triangles.pop_back();
  for (auto* per_triangle : {&open.triangle_material, &open.triangle_light})
    per_triangle->pop_back();
  open.front_side.pop_back();
  open.materials[0].specular = glm::vec3(0.04f);
  open.materials[0].roughness = 0.3f;
  SceneBuilder outdoors("outdoors");
  outdoors.grid({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 1, outdoors.add(diffuse({0.9f, 0.2f, 0.4f})));
  outdoors.add(point_light("lamp", {0, 0, 1}));
  for (const Scene& scene : {open, outdoors.build()}) {
    const PhotonTracerResult result =
        trace_photons(RayScene(scene), {.emitted_photons = 100'000, .max_path_length = 5});
    for (std::size_t l = 0; l < scene.lights.size(); ++l)
      CHECK(result.absorbed_flux_per_light[l] + result.escaped_flux_per_light[l] ==
            Approx(1).epsilon(1e-6));
  }
  // Half of a point light's flux goes up; of the other half, the plate sees a known solid angle.
  const Scene plate_scene = outdoors.build();
  const PhotonTracerResult result = trace_photons(RayScene(plate_scene), {});
  CHECK(result.escaped_flux_per_light[0] > 0.8);
}

TEST_CASE("Photons of a light all carry the same flux in their strongest channel") {
  const Scene scene = furnished_room();
  const PhotonTracerResult result = trace_photons(RayScene(scene), {.emitted_photons = 20'000});
  const Photons& photons = result.photons;
  for (std::size_t i = 0; i < photons.size(); ++i) {
    const glm::vec3& flux = photons.flux[i];
    const double strongest = std::max({flux.r, flux.g, flux.b});
    REQUIRE(strongest ==
            Approx(1.0 / static_cast<double>(photons.emitted_per_light[photons.light[i]]))
                .epsilon(1e-4));
  }
}

TEST_CASE("A photon is stored where it lands, before it is reflected") {
  Scene scene = plate(diffuse(0.5f), 2);
  scene.materials[0].specular = glm::vec3(0.04f);
  Light sun = sun_along(glm::normalize(glm::vec3(1, 0, -2)));
  sun.color = glm::vec3(0.5f, 1.0f, 2.0f) / static_cast<float>(luminance({0.5, 1.0, 2.0}));
  scene.lights.push_back(sun);
  const Photons photons = trace_photons(RayScene(scene), {.emitted_photons = 1000}).photons;
  REQUIRE(photons.size() > 100);
  REQUIRE(photons.incoming.size() == photons.size());
  for (std::size_t i = 0; i < photons.size(); ++i) {
    CHECK(photons.position[i].z == 0.0f);
    CHECK(face_normal(scene, photons.oriented_face[i]).z == 1.0);
    CHECK(photons.incoming[i] == -sun.direction);
    CHECK(glm::distance(1000.0f * photons.flux[i], sun.color) < 1e-5f);
  }
}

TEST_CASE("Light from below is stored on the lower side") {
  Scene scene = plate(diffuse(0.5f), 2);
  scene.lights.push_back(point_light("lamp", {0, 0, -1}));
  const Photons photons = trace_photons(RayScene(scene), {.emitted_photons = 1000}).photons;
  REQUIRE(photons.size() > 100);
  for (const std::uint32_t s : photons.oriented_face) CHECK(face_normal(scene, s).z == -1.0);
}

TEST_CASE("Nothing is stored on mirrors and glass, and arrays that nobody needs stay empty") {
  Scene scene = closed_box(diffuse(0.5f));
  const Photons diffuse_only = trace_photons(RayScene(scene), {.emitted_photons = 1000}).photons;
  CHECK(diffuse_only.incoming.empty());
  CHECK(diffuse_only.light.empty());
  scene.materials.push_back(mirror(0.9f));
  scene.triangle_material[0] = scene.triangle_material[5] = 1;
  const Photons photons = trace_photons(RayScene(scene), {.emitted_photons = 10'000}).photons;
  for (const std::uint32_t s : photons.oriented_face) {
    CHECK(triangle_of(s) != 0);
    CHECK(triangle_of(s) != 5);
  }
}

TEST_CASE("Photons are in the order of their oriented faces, and counts per light add up") {
  const Scene scene = furnished_room(3);
  const PhotonTracerResult result = trace_photons(RayScene(scene), {.emitted_photons = 20'000});
  const Photons& photons = result.photons;
  CHECK(std::is_sorted(photons.oriented_face.begin(), photons.oriented_face.end()));
  CHECK(photons.first_of.size() == 2 * scene.triangle_count() + 1);
  CHECK(photons.first_of.back() == photons.size());
  std::vector<std::uint64_t> counted(2, 0);
  for (const std::uint16_t light : photons.light) ++counted[light];
  CHECK(counted == result.stored_per_light);
  CHECK(sum(photons.emitted_per_light) == 20'000);
}

TEST_CASE("Paths are shared between lights by quota, exactly, and none is left without") {
  const Scene scene = scene_with_powers({90, 9, 1});
  CHECK(photons_per_light(scene, 1000, PhotonQuota::power) ==
        std::vector<std::uint64_t>{900, 90, 10});
  CHECK(photons_per_light(scene, 900, PhotonQuota::equal) ==
        std::vector<std::uint64_t>{300, 300, 300});
  CHECK(photons_per_light(scene, 600, PhotonQuota::balanced) ==
        std::vector<std::uint64_t>{370, 127, 103});
  // 10 / 3 = 3.33 each: the first of three equal remainders gets the odd one.
  CHECK(photons_per_light(scene, 10, PhotonQuota::equal) == std::vector<std::uint64_t>{4, 3, 3});
  CHECK(photons_per_light(scene, 2, PhotonQuota::power) == std::vector<std::uint64_t>{1, 1, 1});
  CHECK(photons_per_light(scene_with_powers({1, 0}), 100, PhotonQuota::power) ==
        std::vector<std::uint64_t>{99, 1});
  CHECK(photons_per_light(scene_with_powers({0, 0}), 100, PhotonQuota::power) ==
        std::vector<std::uint64_t>{50, 50});
  for (const std::uint64_t total : {4ull, 97ull, 12'345ull, 10'000'000'000ull})
    for (const PhotonQuota quota : {PhotonQuota::balanced, PhotonQuota::power, PhotonQuota::equal})
      CHECK(sum(photons_per_light(scene_with_powers({1e6, 0.3, 7, 1e-9}), total, quota)) == total);
}

TEST_CASE("Parameters out of range and scenes without lights are refused in one line") {
  Scene scene = closed_box(diffuse(0.5f));
  const RayScene rays(scene);
  CHECK_THROWS_AS(trace_photons(rays, {.emitted_photons = 0}), UsageError);
  CHECK_THROWS_AS(trace_photons(rays, {.emitted_photons = limits::max_emitted_photons + 1}),
                  UsageError);
  CHECK_THROWS_AS(trace_photons(rays, {.max_path_length = 0}), UsageError);
  CHECK_THROWS_AS(trace_photons(rays, {.roulette_start = 0}), UsageError);
  scene.lights.clear();
  CHECK_THROWS_AS(trace_photons(rays, {}), InputError);
}

TEST_CASE("Tracing stops when it is cancelled, and reports all of its paths when it is not") {
  struct Recorder : Progress {
    std::atomic<std::uint64_t> done{0};
    std::uint64_t total = 0;
    std::uint64_t stop_after = ~0ull;
    void begin(std::string_view, std::uint64_t t, std::string_view) override { total = t; }
    void advance(std::uint64_t count) override { done += count; }
    bool cancelled() const override { return done >= stop_after; }
  };
  const Scene scene = closed_box(diffuse(0.5f));
  const RayScene rays(scene);
  Recorder all;
  trace_photons(rays, {.emitted_photons = 50'000}, all);
  CHECK(all.total == 50'000);
  CHECK(all.done == 50'000);
  Recorder stopped;
  stopped.stop_after = 10'000;
  CHECK_THROWS_AS(trace_photons(rays, {.emitted_photons = 5'000'000}, stopped), Interrupted);
  CHECK(stopped.done < 1'000'000);
}

// The order and the size of stored photons.

/// Photons on random oriented faces; the x of each position is its index.
Photons random_photons(std::size_t count, std::uint32_t oriented_faces, bool full) {
  std::mt19937 generator(99);
  Photons photons;
  for (std::size_t i = 0; i < count; ++i) {
    photons.position.emplace_back(i, 1, 2);
    photons.flux.emplace_back(3 * i, 4, 5);
    photons.oriented_face.push_back(generator() % oriented_faces);
    if (full) photons.incoming.emplace_back(5 * i, 0, 1);
    if (full) photons.light.push_back(static_cast<std::uint16_t>(i % 7));
  }
  return photons;
}

TEST_CASE("Photons sorted by oriented face agree with std::stable_sort in every array") {
  for (const std::size_t count : {0, 1, 1000, 300'000})
    for (const bool full : {false, true}) {
      constexpr std::uint32_t oriented_faces = 1001;
      const Photons given = random_photons(count, oriented_faces, full);
      std::vector<std::size_t> order(count);
      std::iota(order.begin(), order.end(), std::size_t{0});
      std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return given.oriented_face[a] < given.oriented_face[b];
      });
      const Photons sorted = sort_by_oriented_face(given, oriented_faces);
      REQUIRE(sorted.size() == count);
      REQUIRE(sorted.incoming.size() == (full ? count : 0));
      REQUIRE(sorted.light.size() == (full ? count : 0));
      bool same = true;
      for (std::size_t i = 0; i < count; ++i) {
        const std::size_t from = order[i];
        same &= sorted.position[i] == given.position[from] && sorted.flux[i] == given.flux[from] &&
                sorted.oriented_face[i] == given.oriented_face[from];
        if (full)
          same &=
              sorted.incoming[i] == given.incoming[from] && sorted.light[i] == given.light[from];
      }
      CHECK(same);
    }
}

TEST_CASE("Photons of runs are those of all runs in a row, sorted, and the runs are emptied") {
  for (const std::size_t count : {0, 1, 1000, 300'000})
    for (const bool full : {false, true}) {
      // Many oriented faces: too many for a table of counts for each thread.
      const std::uint32_t oriented_faces = count == 1000 ? 4000 : 501;
      Photons given = random_photons(count, oriented_faces, full);
      constexpr std::size_t run_size = 333;
      std::vector<trace::PhotonRun> parts(count / run_size + 2);  // the last is empty
      std::vector<trace::LayerRun> runs;
      given.light.clear();
      for (std::size_t r = 0; r < parts.size(); ++r) {
        const std::size_t first = std::min(count, r * run_size);
        const std::size_t last = std::min(count, first + run_size);
        const auto part_of = [&](const auto& all) {
          const auto begin = all.begin();
          return all.empty() ? all : std::decay_t<decltype(all)>(begin + first, begin + last);
        };
        parts[r] = {part_of(given.position), part_of(given.flux), part_of(given.incoming),
                    part_of(given.oriented_face)};
        runs.push_back({&parts[r], static_cast<std::uint16_t>(r % 5)});
        if (full) given.light.insert(given.light.end(), last - first, runs.back().layer);
      }
      const Photons expected = sort_by_oriented_face(given, oriented_faces);
      const Photons sorted = trace::sorted_photons(runs, full, oriented_faces);
      CHECK(sorted.position == expected.position);
      CHECK(sorted.flux == expected.flux);
      CHECK(sorted.incoming == expected.incoming);
      CHECK(sorted.light == expected.light);
      CHECK(sorted.oriented_face == expected.oriented_face);
      CHECK(sorted.first_of == expected.first_of);
      for (const trace::PhotonRun& run : parts)
        CHECK((run.size() == 0 && run.oriented_face.empty()));
    }
}

TEST_CASE("first_of delimits the photons of each oriented face, also of empty ones") {
  Photons photons;
  for (const std::uint32_t s : {3u, 1u, 3u, 3u}) {
    photons.oriented_face.push_back(s);
    photons.position.emplace_back(0.0f);
    photons.flux.emplace_back(0.0f);
  }
  CHECK(sort_by_oriented_face(photons, 5).first_of == std::vector<std::uint32_t>{0, 0, 1, 1, 4, 4});
  CHECK(sort_by_oriented_face({}, 2).first_of == std::vector<std::uint32_t>{0, 0, 0});
}

TEST_CASE("A photon takes 28 bytes, 12 more where surfaces are glossy and 2 with several lights") {
  CHECK(random_photons(1000, 10, false).bytes() == 28'000);
  CHECK(random_photons(1000, 10, true).bytes() == 42'000);
  CHECK(sort_by_oriented_face(random_photons(1000, 10, false), 10).bytes() == 28'000 + 11 * 4);
}

}  // namespace
}  // namespace photile::test
