// Scattering at opaque surfaces against integrals of the BSDF.
#include <catch2/catch.hpp>

#include "photile/device/bsdf.h"
#include "statistical_tests.hpp"
#include "test_scenes.hpp"
#include "trace/opaque_bsdf.hpp"
#include "trace/scatter.hpp"

namespace photile::test {

using namespace photile::trace;

namespace {

SurfacePoint top_of_plate(const Scene& scene) {
  return surface_hit(scene, {0, 0.3f, 0.3f}, glm::vec3(0, 0, -1));
}

/// Mean over `samples` scattered photons of weight x g(direction).
template <class G>
double mean_weight(const Scene& scene, const glm::vec3& direction, std::uint64_t seed, int samples,
                   G&& g) {
  const SurfacePoint point = top_of_plate(scene);
  double sum = 0;
  for (int i = 0; i < samples; ++i) {
    const auto scattered = scatter_opaque(
        scene, point, direction, RandomStream(seed, i, 0).block(Purpose::photon_scattering, 1));
    if (scattered) sum += scattered->weight.g * g(scattered->direction);
  }
  return sum / samples;
}

/// Integral of f cos(o) g(o) over directions o, by the midpoint rule in (cos^2, phi).
template <class G>
double integral(const Material& material, const glm::dvec3& to_light, const glm::dvec3& normal,
                G&& g) {
  constexpr int rings = 800, sectors = 800;
  PhotileAlbedoFit fit;
  photile_albedo_fit(material.roughness, &fit);
  float f0_weight = 0, f90_weight = 0;
  photile_lobe_albedo(&fit, static_cast<float>(glm::dot(normal, to_light)), &f0_weight,
                      &f90_weight);
  const scene::Reflectance surface{material.diffuse, material.specular, material.f90,
                                   material.roughness};
  double sum = 0;
  for (int i = 0; i < rings; ++i)
    for (int j = 0; j < sectors; ++j) {
      const double cosine = std::sqrt((i + 0.5) / rings), sine = std::sqrt(1 - cosine * cosine);
      const double phi = 2 * M_PI * (j + 0.5) / sectors;
      const glm::dvec3 o(sine * std::cos(phi), sine * std::sin(phi), cosine);
      const glm::dvec3 h = glm::normalize(to_light + o);
      const float lobe = photile_ggx_lobe(
          static_cast<float>(glm::dot(normal, to_light)), static_cast<float>(glm::dot(normal, o)),
          static_cast<float>(glm::dot(normal, h)), material.roughness);
      const trace::DiffusePart part =
          trace::diffuse_part(surface, static_cast<float>(glm::dot(normal, o)));
      const float diffuse = photile_diffuse(part[0].g, part[1].g, part[2].g, f0_weight, f90_weight);
      sum += photile_opaque_bsdf(diffuse, material.specular.g, material.f90,
                                 photile_schlick(static_cast<float>(glm::dot(to_light, h))), lobe) *
             g(glm::vec3(o));
    }
  return sum * M_PI / (rings * sectors);
}

template <class G>
void check_against_integral(const Scene& scene, const glm::vec3& direction,
                            const glm::dvec3& normal, double delta, G&& g) {
  std::vector<double> means;
  for (std::uint64_t seed = 1; seed <= 16; ++seed)
    means.push_back(mean_weight(scene, direction, seed, 20'000, g));
  const double truth = integral(scene.materials[0], glm::dvec3(-direction), normal, g);
  CHECK_VERDICT(mean_is(means, truth, delta));
}

}  // namespace

TEST_CASE("A Lambertian surface scatters by the cosine law with its albedo as weight") {
  const Scene scene = plate(diffuse({0.2f, 0.5f, 0.8f}), 2);
  const SurfacePoint point = top_of_plate(scene);
  constexpr int samples = 100'000;
  std::vector<double> counts(20, 0.0);
  for (int i = 0; i < samples; ++i) {
    const auto scattered =
        scatter_opaque(scene, point, glm::normalize(glm::vec3(1, 0, -1)),
                       RandomStream(5, i, 0).block(Purpose::photon_scattering, 1));
    REQUIRE(scattered);
    REQUIRE(scattered->weight == glm::vec3(0.2f, 0.5f, 0.8f));
    const double z = scattered->direction.z;
    ++counts[std::min<std::size_t>(static_cast<std::size_t>(20 * z * z), 19)];
  }
  CHECK_VERDICT(counts_agree(counts, std::vector<double>(20, samples / 20.0)));
}

TEST_CASE("A glossy surface scatters as much as the integral of its BSDF, to each side alike") {
  for (const Material& material : {glossy(glm::vec3(0.5f), glm::vec3(0.04f), 0.2f),
                                   glossy(glm::vec3(0), glm::vec3(0.8f), 0.1f),
                                   glossy(glm::vec3(0.3f), glm::vec3(0.5f), 0.7f)})
    for (const float tilt : {0.0f, 1.0f, 3.0f}) {
      const Scene scene = plate(material, 2);
      const glm::vec3 direction = glm::normalize(glm::vec3(tilt, 0, -1));
      CAPTURE(tilt, material.roughness);
      const glm::dvec3 up(0, 0, 1);
      check_against_integral(scene, direction, up, 0.01, [](const glm::vec3&) { return 1.0; });
      check_against_integral(scene, direction, up, 0.015,
                             [](const glm::vec3& o) { return o.x > 0.3f ? 1.0 : 0.0; });
      check_against_integral(scene, direction, up, 0.015,
                             [](const glm::vec3& o) { return double{o.z} * o.z; });
    }
}

TEST_CASE("A tilted shading normal turns the lobe and leaves the cosine to the geometric normal") {
  Scene scene = plate(glossy(glm::vec3(0.4f), glm::vec3(0.3f), 0.3f), 2);
  const glm::vec3 tilted = glm::normalize(glm::vec3(0.3f, 0.1f, 1.0f));
  scene.corner_normal.assign(scene.triangle_count(), {tilted, tilted, tilted});
  const glm::vec3 direction = glm::normalize(glm::vec3(0.5f, 0, -1));
  check_against_integral(scene, direction, glm::dvec3(tilted), 0.015,
                         [](const glm::vec3&) { return 1.0; });
  check_against_integral(scene, direction, glm::dvec3(tilted), 0.015,
                         [](const glm::vec3& o) { return o.x > 0 ? 1.0 : 0.0; });
}

TEST_CASE("No photon is scattered into the surface, not even by a steep shading normal") {
  Scene scene = plate(glossy(glm::vec3(0.4f), glm::vec3(0.9f), 0.4f), 2);
  const glm::vec3 steep = glm::normalize(glm::vec3(1.0f, 0.0f, 0.3f));
  scene.corner_normal.assign(scene.triangle_count(), {steep, steep, steep});
  const SurfacePoint point = top_of_plate(scene);
  int scattered_photons = 0;
  for (int i = 0; i < 20'000; ++i) {
    const auto scattered =
        scatter_opaque(scene, point, glm::normalize(glm::vec3(-1, 0.2f, -0.2f)),
                       RandomStream(9, i, 0).block(Purpose::photon_scattering, 1));
    if (!scattered) continue;
    ++scattered_photons;
    REQUIRE(scattered->direction.z > 0);
    REQUIRE(std::isfinite(scattered->weight.r));
    REQUIRE(scattered->weight.r >= 0);
  }
  CHECK(scattered_photons > 1000);
}

TEST_CASE("The diffuse albedo is the material's colour times the texture at the hit") {
  Scene scene = plate(diffuse({0.5f, 1.0f, 1.0f}), 2);
  // Two texels, black and white, side by side; a lookup at a texel's centre returns it unmixed.
  scene.textures.emplace_back(
      "half", 2, 1, std::vector<std::array<std::uint8_t, 4>>{{0, 0, 0, 255}, {255, 255, 255, 255}});
  scene.materials[0].diffuse_texture = 0;
  scene.corner_uv.assign(scene.triangle_count(),
                         {glm::vec2(0.25f, 0.5f), glm::vec2(0.75f, 0.5f), glm::vec2(0.25f, 0.5f)});
  const glm::vec3 down(0, 0, -1);
  CHECK(glm::length(reflectance(scene, surface_hit(scene, {0, 0.0f, 0.0f}, down)).albedo) < 1e-6f);
  CHECK(glm::distance(reflectance(scene, surface_hit(scene, {0, 1.0f, 0.0f}, down)).albedo,
                      glm::vec3(0.5f, 1.0f, 1.0f)) < 1e-6f);
}

}  // namespace photile::test
