// Normal maps: which way they turn, and that surfaces under them reflect no more than they get.
#include <catch2/catch.hpp>
#include <glm/gtc/constants.hpp>

#include "statistical_tests.hpp"
#include "test_scenes.hpp"
#include "trace/opaque_bsdf.hpp"
#include "trace/scatter.hpp"
#include "trace/surface.hpp"

namespace photile::test {

using namespace photile::trace;

namespace {

/// A plate in z = 0 seen from above whose texture's u is x and whose v is -y, as a picture lies;
/// the map is one texel of this normal.
Scene mapped_plate(const Material& material, const glm::vec3& normal) {
  Scene scene = plate(material, 2);
  const glm::vec3 byte = 255.0f * (0.5f * glm::normalize(normal) + 0.5f);
  scene.textures.emplace_back("normal", 1, 1,
                              std::vector<std::array<std::uint8_t, 4>>{
                                  {static_cast<std::uint8_t>(std::lround(byte.x)),
                                   static_cast<std::uint8_t>(std::lround(byte.y)),
                                   static_cast<std::uint8_t>(std::lround(byte.z)), 255}});
  scene.materials[0].normal_texture = 0;
  for (std::uint32_t t = 0; t < scene.triangle_count(); ++t) {
    const auto corners = scene.corners(t);
    auto& uv = scene.corner_uv.emplace_back();
    for (std::size_t c = 0; c < 3; ++c) uv[c] = {corners[c].x, -corners[c].y};
  }
  return scene;
}

SurfacePoint at(const Scene& scene, const glm::vec3& direction) {
  return surface_hit(scene, {0, 0.3f, 0.3f}, direction);
}

}  // namespace

TEST_CASE("Red turns the normal towards u, green towards -v", "[normal_map]") {
  const glm::vec3 down(0, 0, -1);
  for (const glm::vec3 normal :
       {glm::vec3(0.3f, 0, 1), glm::vec3(0, 0.3f, 1), glm::vec3(-0.2f, 0.4f, 1)}) {
    const Scene scene = mapped_plate(diffuse(glm::vec3(0.5f)), normal);
    for (std::uint32_t triangle = 0; triangle < 2; ++triangle) {
      const SurfacePoint point = surface_hit(scene, {triangle, 0.3f, 0.3f}, down);
      const ShadingNormals normals = shading_normals(scene, point, down);
      CHECK(normals.smooth == glm::vec3(0, 0, 1));
      // A byte resolves 1 / 255 of the slope.
      CHECK(glm::distance(normals.mapped, glm::normalize(normal)) < 0.01f);
      CHECK(normals.seen == normals.mapped);
    }
  }
}

TEST_CASE("A triangle of which any one corner has no normal is flat") {
  const glm::vec3 down(0, 0, -1), tilted = glm::normalize(glm::vec3(0.3f, 0.1f, 1.0f));
  for (std::size_t missing = 0; missing < 3; ++missing) {
    Scene scene = plate(diffuse(glm::vec3(0.5f)), 2);
    scene.corner_normal.assign(scene.triangle_count(), {tilted, tilted, tilted});
    CHECK(shading_normals(scene, at(scene, down), down).smooth != glm::vec3(0, 0, 1));
    for (auto& corner : scene.corner_normal) corner[missing] = glm::vec3(0.0f);
    CHECK(shading_normals(scene, at(scene, down), down).smooth == glm::vec3(0, 0, 1));
  }
}

TEST_CASE("The winding and the mirroring of coordinates do not turn the map", "[normal_map]") {
  const glm::vec3 down(0, 0, -1), normal = glm::normalize(glm::vec3(0.3f, 0.2f, 1));
  Scene scene = mapped_plate(diffuse(glm::vec3(0.5f)), normal);
  for (auto& uv : scene.corner_uv)
    for (glm::vec2& corner : uv) corner.x = -corner.x;  // red is now along -x
  CHECK(glm::distance(shading_normals(scene, at(scene, down), down).mapped,
                      glm::vec3(-normal.x, normal.y, normal.z)) < 0.01f);
  // The other side is the front: from above the plate is seen from behind, where bumps are dents.
  scene = rewound(mapped_plate(diffuse(glm::vec3(0.5f)), normal), [](std::size_t) { return true; });
  const glm::vec3 behind = shading_normals(scene, at(scene, down), down).mapped;
  CHECK(behind.z > 0);
  CHECK(glm::distance(behind, glm::vec3(-normal.x, -normal.y, normal.z)) < 0.01f);
}

TEST_CASE("The scale stretches the slope, and a flat map turns nothing", "[normal_map]") {
  const glm::vec3 down(0, 0, -1);
  Scene scene = mapped_plate(diffuse(glm::vec3(0.5f)), {0.2f, 0, 1});
  scene.materials[0].normal_scale = 2;
  CHECK(glm::distance(shading_normals(scene, at(scene, down), down).mapped,
                      glm::normalize(glm::vec3(0.4f, 0, 1))) < 0.02f);
  const Scene flat = mapped_plate(diffuse(glm::vec3(0.5f)), {0, 0, 1});
  CHECK(glm::distance(shading_normals(flat, at(flat, down), down).mapped, glm::vec3(0, 0, 1)) <
        0.008f);
}

TEST_CASE("Triangles whose texture has no area keep their normals", "[normal_map]") {
  const glm::vec3 down(0, 0, -1);
  Scene scene = mapped_plate(diffuse(glm::vec3(0.5f)), {0.5f, 0, 1});
  scene.corner_uv.assign(scene.triangle_count(), {});
  CHECK(shading_normals(scene, at(scene, down), down).mapped == glm::vec3(0, 0, 1));
}

TEST_CASE("Under a normal map a diffuse surface reflects light by the mapped cosine",
          "[normal_map]") {
  const glm::vec3 normal = glm::normalize(glm::vec3(0.3f, 0, 1)), down(0, 0, -1);
  const Scene scene = mapped_plate(diffuse(glm::vec3(0.5f)), normal);
  const OpaqueBsdf bsdf(scene, at(scene, down), down);
  for (const glm::vec3 light : {glm::vec3(0.4f, 0, 1), glm::vec3(-0.4f, 0.1f, 1)}) {
    const glm::vec3 to = glm::normalize(light);
    CHECK(bsdf.reflected(to).g ==
          Approx(0.5 / glm::pi<double>() * double{glm::dot(normal, to)}).epsilon(0.01));
  }
}

TEST_CASE("Under a normal map the eye sees no more light than there is, from whichever side",
          "[normal_map]") {
  const glm::vec3 normal(0.8f, 0, 1);
  for (const Material& material :
       {diffuse(glm::vec3(0.9f)), glossy(glm::vec3(0.9f), glm::vec3(0.04f), 0.3f),
        glossy(glm::vec3(0.0f), glm::vec3(1.0f), 0.3f)})
    for (const float tilt : {-4.0f, -1.0f, 0.0f, 1.0f, 4.0f}) {
      const Scene scene = mapped_plate(material, normal);
      const glm::vec3 direction = glm::normalize(glm::vec3(tilt, 0, -1));
      const SurfacePoint point = at(scene, direction);
      const OpaqueBsdf bsdf(scene, point, direction, PathStart::eye);
      double sum = 0;
      constexpr int samples = 40'000;
      for (int i = 0; i < samples; ++i) {
        const auto drawn = bsdf.sample(
            RandomStream(5, static_cast<std::uint64_t>(i), 0).block(Purpose::path_scattering, 0));
        if (!drawn) continue;
        REQUIRE(drawn->z > 0);
        const float density = bsdf.density(*drawn);
        if (density > 0) sum += double{bsdf.reflected(*drawn).g / density} / samples;
      }
      CAPTURE(tilt, material.roughness);
      CHECK(sum < 1.03);  // the fit to the coat's albedo, and noise
      CHECK(sum >= 0);
    }
}

TEST_CASE("Photons and rays from the eye see the same surface under a normal map", "[normal_map]") {
  const Scene scene =
      mapped_plate(glossy(glm::vec3(0.6f), glm::vec3(0.04f), 0.4f), {0.3f, 0.2f, 1});
  const glm::vec3 light = glm::normalize(glm::vec3(0.3f, 0.5f, 1)),
                  eye = glm::normalize(glm::vec3(-0.5f, 0.1f, 1));
  const OpaqueBsdf from_light(scene, at(scene, -light), -light, PathStart::light);
  const OpaqueBsdf from_eye(scene, at(scene, -eye), -eye, PathStart::eye);
  CHECK((from_light.reflected(eye) / eye.z).g == Approx((from_eye.reflected(light) / light.z).g));
}

}  // namespace photile::test
