// Lamps whose light is a picture: flux, photons, paths and eyes against integrals of the picture.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "path_irradiance.hpp"
#include "scene/light_emission.hpp"
#include "textured_square.hpp"
#include "trace/light_emitter.hpp"

namespace photile::test {
namespace {

using std::numbers::pi;

/// The glowing square of square_document, 100 cd/m2 where the picture is white. The picture has one
/// row: white, red, black, black. Between texels it is linear, and it repeats.
struct TexturedSquare : SceneFolderOnDisk {
  TexturedSquare() {
    write("square.bin", square_buffer());
    write_picture<std::uint8_t>(path / "glow.png", 4, 1, 3,
                                {255, 255, 255, 255, 0, 0, 0, 0, 0, 0, 0, 0});
  }
  nlohmann::json document() const {
    nlohmann::json document = square_document();
    document["images"] = {{{"uri", "glow.png"}}};
    document["textures"] = {{{"source", 0}}};
    document["materials"][0]["emissiveTexture"] = {{"index", 0}};
    return document;
  }
  Scene load(const nlohmann::json& document) const {
    return load_scene(write("scene.gltf", document.dump()));
  }
};

constexpr double red = 0.2126;

/// Luminance of the picture at a place along its row.
double picture(double x) {
  const std::array<double, 4> texels{1, red, 0, 0};
  const double texel = 4 * x + 3.5;
  const auto first = static_cast<std::size_t>(texel) % 4;
  return std::lerp(texels[first], texels[(first + 1) % 4], texel - std::floor(texel));
}

TEST_CASE("the flux of a textured light is the integral of its texture", "[emission]") {
  const TexturedSquare square;
  nlohmann::json document = square.document();
  const Scene scene = square.load(document);
  REQUIRE(scene.lights.size() == 1);
  const double mean = (1 + red) / 4;
  CHECK(scene.lights[0].power == Approx(100 * pi * mean).epsilon(1e-3));
  // Its colour is that of all its light: red 2, green and blue 1 of four texels.
  CHECK(scene.lights[0].color.r == Approx(2.0 * scene.lights[0].color.g).epsilon(1e-3));
  CHECK(luminance(scene.lights[0].color) == Approx(1));
  CHECK(scene.report.warnings.empty());
  document["materials"][0]["doubleSided"] = true;
  CHECK(square.load(document).lights.at(0).power == Approx(200 * pi * mean).epsilon(1e-3));
  document["nodes"][0]["extras"]["photile_lumens"] = 700;
  CHECK(square.load(document).lights.at(0).power == Approx(700));
  // A transform of its coordinates alone: half a picture, twice.
  document = square.document();
  document["materials"][0]["emissiveTexture"]["extensions"]["KHR_texture_transform"]["scale"] = {
      0.25, 1};
  double quarter = 0;
  for (int i = 0; i < 1000; ++i) quarter += picture((i + 0.5) / 4000) / 1000;
  CHECK(square.load(document).lights.at(0).power == Approx(100 * pi * quarter).epsilon(1e-3));
}

TEST_CASE("a missing emission texture leaves the factor, with a warning", "[emission]") {
  const TexturedSquare square;
  nlohmann::json document = square.document();
  document["images"][0]["uri"] = "gone.png";
  const Scene scene = square.load(document);
  CHECK(scene.lights.at(0).power == Approx(100 * pi));
  CHECK(warns(scene, {"'glow'", "gone.png", "emissive factor"}));
}

TEST_CASE("an OBJ lamp takes its map_Ke", "[emission]") {
  const TexturedSquare square;
  square.write("lamp.mtl", "newmtl lamp\nKd 0 0 0\nKe 2 2 2\nmap_Ke glow.png\n");
  const Scene scene = load_scene(square.write(
      "lamp.obj", "mtllib lamp.mtl\n" + unit_square + "usemtl lamp\nf 1/1 2/2 3/3 4/4\n"));
  CHECK(scene.lights.at(0).power == Approx(2 * pi * (1 + red) / 4).epsilon(1e-3));
}

TEST_CASE("cells of a textured light are chosen with the density that they state", "[emission]") {
  const Scene scene = TexturedSquare().load(TexturedSquare().document());
  const scene::EmissionCells cells(scene, scene.lights.at(0));
  // The density integrates to 1, and what is drawn in 8 columns follows it.
  std::vector<double> counts(8, 0.0), expected(8, 0.0);
  constexpr int steps = 400, trials = 200'000;
  double all = 0;
  for (const std::uint32_t triangle : scene.lights[0].triangles) {
    const auto [a, b, c] = scene.corners(triangle);
    for (int i = 0; i < steps; ++i) {
      for (int j = 0; i + j < steps; ++j) {
        for (const double third : {1.0 / 3, 2.0 / 3}) {
          const double u = (i + third) / steps, v = (j + third) / steps;
          if (u + v > 1) continue;
          const double x = a.x + u * (b.x - a.x) + v * (c.x - a.x);
          const double share = cells.density({triangle, u, v}) * 0.5 / (double{steps} * steps);
          expected[std::min<std::size_t>(static_cast<std::size_t>(8 * x), 7)] += trials * share;
          all += share;
        }
      }
    }
  }
  CHECK(all == Approx(1).epsilon(2e-3));
  // Points of the slanted edge, with its corners, belong to the cell below them.
  for (const std::uint32_t triangle : scene.lights[0].triangles) {
    for (int i = 0; i <= 20; ++i) {
      constexpr double e = 1e-4;
      const double u = i / 20.0, v = (20 - i) / 20.0;
      CAPTURE(triangle, u);
      CHECK(cells.density({triangle, u, v}) ==
            cells.density({triangle, std::max(u - e, e / 4), std::min(v + e / 4, 1 - e)}));
    }
  }
  for (int i = 0; i < trials; ++i) {
    const trace::RandomBlock numbers =
        trace::RandomStream(3, static_cast<std::uint64_t>(i), 0).block(trace::Purpose::emission, 0);
    const auto place =
        cells.sample(numbers.uniform_double(0), numbers.uniform(2), numbers.uniform(3));
    const auto [a, b, c] = scene.corners(place.triangle);
    const double x = a.x + place.u * (b.x - a.x) + place.v * (c.x - a.x);
    ++counts[std::min<std::size_t>(static_cast<std::size_t>(8 * x), 7)];
  }
  CHECK_VERDICT(counts_agree(counts, expected));
}

TEST_CASE("photons of a textured light carry its picture's light and colour", "[emission]") {
  const Scene scene = TexturedSquare().load(TexturedSquare().document());
  const trace::LightEmitter emitter(scene, 0, bounding_sphere(scene));
  constexpr int paths = 20'000;
  std::vector<double> all, left, blue;
  for (std::uint64_t seed = 1; seed <= 16; ++seed) {
    double total = 0, quarter = 0, blue_total = 0;
    for (int i = 0; i < paths; ++i) {
      const auto ray = emitter.emit(trace::RandomStream(seed, static_cast<std::uint64_t>(i), 0));
      REQUIRE(ray.direction.z > 0);
      total += luminance(glm::dvec3(ray.color)) / paths;
      blue_total += double{ray.color.b} / paths;
      if (ray.origin.x < 0.25f) quarter += luminance(glm::dvec3(ray.color)) / paths;
    }
    all.push_back(total);
    left.push_back(quarter);
    blue.push_back(blue_total);
  }
  double quarter = 0;
  for (int i = 0; i < 1000; ++i) quarter += picture((i + 0.5) / 4000) / 4000;
  CHECK_VERDICT(mean_is(all, 1, 0.02));
  CHECK_VERDICT(mean_is(left, quarter / ((1 + red) / 4), 0.03));
  CHECK_VERDICT(mean_is(blue, 1 / (1 + red), 0.03));
}

TEST_CASE("paths and eyes see the picture of a textured light", "[emission]") {
  // A floor of 2 x 2 m faces the lamp from 0.5 m, in the plane z = 0.5.
  const TexturedSquare square;
  nlohmann::json document = square.document();
  document["materials"].push_back(
      {{"name", "dark"},
       {"pbrMetallicRoughness",
        {{"baseColorFactor", {0, 0, 0, 1}}, {"metallicFactor", 0}, {"roughnessFactor", 1}}}});
  document["meshes"].push_back(document["meshes"][0]);
  document["meshes"][1]["primitives"][0]["material"] = 1;
  document["nodes"].push_back(
      {{"name", "floor"}, {"mesh", 1}, {"translation", {-0.5, 1.5, 0.5}}, {"scale", {2, -2, 1}}});
  document["scenes"][0]["nodes"] = {0, 1};
  const Scene scene = square.load(document);
  REQUIRE(scene.lights.size() == 1);

  const glm::dvec3 point(0.3, 0.4, 0.5);
  constexpr int steps = 400;
  double truth = 0;  // the midpoint rule
  for (int i = 0; i < steps; ++i) {
    for (int j = 0; j < steps; ++j) {
      const double x = (i + 0.5) / steps - point.x, y = (j + 0.5) / steps - point.y;
      const double squared = x * x + y * y + 0.25;
      truth += 100 * picture((i + 0.5) / steps) * 0.25 / (squared * squared) / (steps * steps);
    }
  }
  truth /= scene.lights[0].power;
  CHECK_VERDICT(mean_is(path_irradiances(scene, {{point, {0, 0, -1}}}, 4000), truth, 0.03 * truth));

  const RayScene rays(scene);
  const PrimaryHitParameters film{.width = 1, .height = 1, .samples_per_pixel = 1};
  for (const double x : {0.125, 0.3, 0.5, 0.9}) {
    const Camera camera = Camera::look_at({x, 0.5, 0.4}, {x, 0.5, 0}, {0, 1, 0}, 1e-4);
    const PrimaryHitBatch batch = trace_primary_hits(rays, camera, film, 0, 1);
    REQUIRE(batch.emission.size() == 1);
    CHECK(luminance(glm::dvec3(batch.emission[0].radiance)) * scene.lights[0].power ==
          Approx(100 * picture(x)).epsilon(1e-3).margin(1e-3));
  }
}

}  // namespace
}  // namespace photile::test
