// Cut-out materials: rays, photons and looking at lamps pass the holes, by how much is there.
#include <catch2/catch.hpp>
#include <glm/gtc/constants.hpp>

#include "photile/photons.hpp"
#include "photile/ray_scene.hpp"
#include "statistical_tests.hpp"
#include "test_scenes.hpp"
#include "trace/ray_query.hpp"

namespace photile::test {

using namespace photile::trace;

namespace {

/// A texture of one texel with this alpha.
Texture alpha_texel(std::uint8_t alpha) { return {"alpha", 1, 1, {{255, 255, 255, alpha}}}; }

/// A plate of 2 m in z = 0 of this opacity over a black floor in z = -1, a lamp above.
Scene plate_over_floor(float opacity, float cutoff = 0.0f) {
  SceneBuilder builder("plate over floor");
  Material material = diffuse(glm::vec3(0.5f));
  material.opacity = opacity;
  material.opacity_cutoff = cutoff;
  builder.grid({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 1, builder.add(material));
  builder.grid({-5, -5, -1}, {10, 0, 0}, {0, 10, 0}, 1, builder.add(diffuse(glm::vec3(0.0f))));
  Light sun;
  sun.name = "sun";
  sun.kind = LightKind::directional;
  sun.power = 1;
  builder.add(sun);
  return builder.build();
}

/// Share of rays straight down that end on the floor.
double share_through(const Scene& scene) {
  const RayScene rays(scene);
  constexpr int samples = 20'000;
  int through = 0;
  for (int i = 0; i < samples; ++i) {
    const RandomStream random(3, static_cast<std::uint64_t>(i), 0);
    const RandomBlock place = random.block(Purpose::film_position, 0);
    glm::vec3 origin(1.8f * place.uniform(0) - 0.9f, 1.8f * place.uniform(1) - 0.9f, 2);
    std::uint32_t holes = 0;
    const auto met = next_surface(rays, origin, {0, 0, -1}, random, Purpose::eye_holes, holes);
    REQUIRE(met);
    through += met->position.z < -0.5f;
  }
  return static_cast<double>(through) / samples;
}

}  // namespace

TEST_CASE("Rays pass a surface as often as it is not there", "[holes]") {
  CHECK(share_through(plate_over_floor(1.0f)) == 0);
  CHECK(share_through(plate_over_floor(0.0f)) == 1);
  // Standard deviation of the share: sqrt(0.3 x 0.7 / 20,000) = 0.0032.
  CHECK(share_through(plate_over_floor(0.3f)) == Approx(0.7).margin(0.016));
}

TEST_CASE("With a cutoff a surface is there or it is not", "[holes]") {
  CHECK(share_through(plate_over_floor(0.3f, 0.5f)) == 1);
  CHECK(share_through(plate_over_floor(0.5f, 0.5f)) == 0);
}

TEST_CASE("A texture's alpha multiplies the opacity", "[holes]") {
  Scene scene = plate_over_floor(1.0f, 0.5f);
  scene.corner_uv.assign(scene.triangle_count(), {});
  scene.textures = {alpha_texel(255), alpha_texel(60)};
  scene.materials[0].opacity_texture = 0;
  CHECK(share_through(scene) == 0);
  scene.materials[0].opacity_texture = 1;
  CHECK(share_through(scene) == 1);
}

TEST_CASE("Looking at a lamp sees through holes by what is not there", "[holes]") {
  const auto seen = [](const Scene& scene) {
    const RayScene rays(scene);
    return transmittance(rays, {0.2f, 0.1f, -0.5f}, {0.25f, 0.15f, 3.0f});
  };
  CHECK(seen(plate_over_floor(1.0f)) == glm::vec3(0.0f));
  CHECK(seen(plate_over_floor(0.0f)) == glm::vec3(1.0f));
  CHECK(seen(plate_over_floor(0.25f)).g == Approx(0.75));
}

TEST_CASE("Photons reach what lies behind holes, and are stored where they pass", "[holes]") {
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

TEST_CASE("A surface without holes asks for no random numbers", "[holes]") {
  const Scene scene = plate_over_floor(1.0f);
  const RayScene rays(scene);
  glm::vec3 origin(0.1f, 0.2f, 1.0f);
  std::uint32_t holes = 0;
  REQUIRE(next_surface(rays, origin, {0, 0, -1}, RandomStream(1, 1, 0), Purpose::eye_holes, holes));
  CHECK(holes == 0);
  CHECK(origin == glm::vec3(0.1f, 0.2f, 1.0f));
}

}  // namespace photile::test
