// Layers of lights.
#include <random>

#include "photile/layered_picture.hpp"
#include "pictures.hpp"
#include "render/film.hpp"

namespace photile::test {
namespace {

// The layer of a group of lights beside the layers of its lights alone.

constexpr int neighbours = 30, samples = 2;

/// A room with a lamp that is seen and eleven standing ones, of different powers and colours.
Scene room_of_lamps() {
  Scene scene = furnished_room(4);
  while (scene.lights.size() < 12) {
    Light light = scene.lights.back();
    const auto i = static_cast<float>(scene.lights.size());
    light.name = "lamp" + std::to_string(scene.lights.size());
    light.position.x = 0.3f * i;
    light.power = 1.0 + i * i;
    light.color = glm::vec3(1.0f, 0.6f + 0.05f * i, 0.3f);
    light.color /= static_cast<float>(luminance(glm::dvec3(light.color)));
    scene.lights.push_back(light);
  }
  return scene;
}

RenderResult rendered(const Scene& scene, bool glossy) {
  RenderParameters parameters = small_picture(20'000, 24, 18, samples);
  parameters.neighbours = neighbours;
  // Light maps leave out photons behind walls, where they are most of a layer's.
  if (glossy) parameters.light_maps = LightMapMode::off;
  parameters.radius = glossy ? 0.4 : 0;  // one that is chosen is the same in both, too
  const Camera camera = Camera::look_at({3.6, 0.4, 1.2}, {1, 2, 1.9}, {0, 0, 1}, 1.3);
  return render(scene, camera, device(), parameters);
}

TEST_CASE("the layer of a group is the sum of its lights at their powers") {
  const bool glossy = GENERATE(false, true);
  CAPTURE(glossy);
  Scene scene = room_of_lamps();
  if (glossy) scene.materials[0] = test::glossy({0.5f, 0.4f, 0.3f}, glm::vec3(0.1f), 0.4f);
  const RenderResult alone = rendered(scene, glossy);
  const LightMix mix = LightMix::of(scene, 683);
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    if (i != 5) scene.lights[i].group = i % 3 == 0 ? "first" : "second";
  }
  const RenderResult together = rendered(scene, glossy);
  const LightMix grouped = LightMix::of(scene, 683);
  REQUIRE(alone.layers.sparse());
  REQUIRE_FALSE(together.layers.sparse());
  REQUIRE(together.layers.layers.size() == 3);
  CHECK(together.stored_photons == alone.stored_photons);
  CHECK(together.used.radius == alone.used.radius);

  // Both sum the same terms, none negative: up to k photons of each sample and, of lights alone,
  // the lights. A sum of n terms is right to n units of 2^-24, and each term is a product of at
  // most twelve factors.
  const double tolerance = (2 * (neighbours + samples + 12) + 12) * std::ldexp(1.0, -24);
  const LightLayers dense = alone.layers.dense();
  const LightGroups groups = light_groups_of(scene);
  double worst = 0, brightest = 0;
  const auto compare = [&](double value, double expected) {
    worst = std::max(worst, std::abs(value - expected) / std::max({value, expected, 1e-30}));
    brightest = std::max(brightest, expected);
  };
  for (std::size_t g = 0; g < 3; ++g) {
    const LightLayers::Layer& layer = together.layers.layers[g];
    CHECK(layer.light == groups.groups[g].name);
    for (std::size_t pixel = 0; pixel < layer.radiance.size(); ++pixel) {
      glm::dvec3 radiance(0.0);
      double illuminance = 0;
      for (const std::uint32_t light : groups.groups[g].lights) {
        radiance += mix.lights[light].power * glm::dvec3(dense.layers[light].radiance[pixel]);
        illuminance += mix.lights[light].power * dense.layers[light].illuminance[pixel];
      }
      for (int c = 0; c < 3; ++c) {
        compare(grouped.lights[g].power * layer.radiance[pixel][c], radiance[c]);
      }
      compare(grouped.lights[g].power * layer.illuminance[pixel], illuminance);
    }
  }
  CHECK(brightest > 0);
  CHECK(worst <= tolerance);
}

// Sparse layers hold what dense ones do.

constexpr int width = 13, height = 11;
constexpr std::size_t lights = 20;

std::vector<std::string> named_lights() {
  std::vector<std::string> all;
  for (std::size_t i = 0; i < lights; ++i) all.push_back("light" + std::to_string(i));
  return all;
}

/// Layers with a plane for each of many lights, for comparison.
LightLayers dense_layers() { return LightLayers(width, height, named_lights()).dense(); }

/// Hits of random pixels and lamps seen, in rows [first, last).
PrimaryHitBatch random_batch(int first, int last, std::mt19937& random) {
  std::uniform_real_distribution<float> uniform(0.1f, 1.0f);
  const auto pixel = [&] {
    const auto row = static_cast<std::uint32_t>(first) +
                     static_cast<std::uint32_t>(random() % static_cast<unsigned>(last - first));
    return row * width + static_cast<std::uint32_t>(random() % width);
  };
  PrimaryHitBatch batch;
  for (int i = 0; i < 300; ++i) {
    batch.hits.position.emplace_back(0.0f);
    batch.hits.pixel.push_back(pixel());
    batch.hits.throughput.emplace_back(uniform(random), uniform(random), uniform(random));
    batch.hits.diffuse_albedo.emplace_back(uniform(random));
    batch.hits.fraction.push_back(uniform(random));
  }
  for (int i = 0; i < 20; ++i) {
    batch.emission.push_back(
        {pixel(), static_cast<std::uint32_t>(random() % lights), glm::vec3(uniform(random))});
  }
  return batch;
}

/// Estimates in both forms: a few lights per hit, in no order.
struct BothForms {
  LightTable dense, sparse;
};

BothForms random_both_forms(std::size_t hits, bool glossy, std::mt19937& random) {
  std::uniform_real_distribution<float> uniform(0.1f, 1.0f);
  BothForms both{LightTable(lights, false), LightTable(lights, true)};
  both.dense.irradiance.assign(hits * lights, glm::vec3(0.0f));
  if (glossy) both.dense.radiance = both.dense.irradiance;
  for (std::size_t hit = 0; hit < hits; ++hit) {
    std::vector<std::uint16_t> order(lights);
    for (std::size_t i = 0; i < lights; ++i) order[i] = static_cast<std::uint16_t>(i);
    std::shuffle(order.begin(), order.end(), random);
    order.resize(random() % 5);
    for (const std::uint16_t light : order) {
      const glm::vec3 irradiance(uniform(random), uniform(random), uniform(random));
      both.dense.irradiance[hit * lights + light] = irradiance;
      both.sparse.irradiance.push_back(irradiance);
      if (glossy) {
        both.dense.radiance[hit * lights + light] = 0.3f * irradiance;
        both.sparse.radiance.push_back(0.3f * irradiance);
      }
      both.sparse.light.push_back(light);
    }
    both.sparse.first.push_back(both.sparse.light.size());
  }
  return both;
}

TEST_CASE("a sparse film sums to the bits of a dense one, in batches of any rows") {
  const bool glossy = GENERATE(false, true);
  LightLayers dense = dense_layers();
  LightLayers sparse(width, height, named_lights());
  REQUIRE(sparse.sparse());
  REQUIRE_FALSE(dense.sparse());
  std::mt19937 random(5);
  // Rows that are apart, that overlap, and that are met again.
  for (const auto& [first, last] : {std::pair{0, 3}, {2, 6}, {9, 11}, {0, 11}}) {
    const PrimaryHitBatch batch = random_batch(first, last, random);
    const BothForms both = random_both_forms(batch.hits.size(), glossy, random);
    add_to_film(dense, batch, both.dense, 0.25f);
    add_to_film(sparse, batch, both.sparse, 0.25f);
  }
  CHECK(same_bits(dense, sparse));
  for (const LightLayers::Row& row : sparse.rows) {
    REQUIRE(row.first.size() == width + 1);
    for (std::size_t x = 0; x < width; ++x) {
      CHECK(std::is_sorted(row.light.begin() + row.first[x], row.light.begin() + row.first[x + 1],
                           std::less_equal<>()));
    }
  }
}

TEST_CASE("sparse layers grow with the lights that reach a pixel, not with all") {
  PrimaryHitBatch batch;
  batch.hits.position.emplace_back(0.0f);
  batch.hits.pixel.push_back(5);
  batch.hits.throughput.emplace_back(1.0f);
  batch.hits.diffuse_albedo.emplace_back(0.5f);
  LightTable estimates(8, true);
  estimates.first = {0, 1};
  estimates.light = {7};
  estimates.irradiance = {glm::vec3(2.0f)};
  std::vector<std::uint64_t> bytes;
  for (const std::size_t count : {20u, 2000u}) {
    const std::vector<std::string> all(count);
    LightLayers layers(width, height, all);
    add_to_film(layers, batch, estimates, 1.0f);
    CHECK(layers.rows[0].light == std::vector<std::uint16_t>{7});
    CHECK(layers.rows[0].illuminance == std::vector<float>{2.0f});
    bytes.push_back(layers.bytes());
  }
  CHECK(bytes[0] == bytes[1]);
  // An offset per pixel and row end, and one value of 2 + 12 + 4 bytes.
  CHECK(bytes[0] == std::uint64_t{height} * (width + 1) * 4 + 18);
}

TEST_CASE("a batch that saw nothing leaves sparse layers black") {
  LightLayers layers(width, height, named_lights());
  add_to_film(layers, PrimaryHitBatch{}, LightTable{}, 1.0f);
  CHECK(same_bits(layers, dense_layers()));
}

}  // namespace
}  // namespace photile::test
