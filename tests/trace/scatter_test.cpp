// Scattering at surfaces.
#include "trace/scatter.hpp"

#include <array>
#include <catch2/catch.hpp>

#include "photile/device/bsdf.h"
#include "statistical_tests.hpp"
#include "test_scenes.hpp"
#include "trace/eye_path.hpp"
#include "trace/light_sampler.hpp"
#include "trace/opaque_bsdf.hpp"
#include "trace/surface.hpp"

namespace photile::test {
namespace {

using namespace trace;

// Scattering at opaque surfaces against integrals of the BSDF.

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
  const std::vector<double> means =
      of_seeds([&](std::uint64_t seed) { return mean_weight(scene, direction, seed, 20'000, g); });
  const double truth = integral(scene.materials[0], glm::dvec3(-direction), normal, g);
  CHECK_VERDICT(mean_is(means, truth, delta));
}

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
  for (const Material& material :
       {glossy(0.5f, 0.04f, 0.2f), glossy(0, 0.8f, 0.1f), glossy(0.3f, 0.5f, 0.7f)})
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
  Scene scene = plate(glossy(0.4f, 0.3f, 0.3f), 2);
  const glm::vec3 tilted = glm::normalize(glm::vec3(0.3f, 0.1f, 1.0f));
  scene.corner_normal.assign(scene.triangle_count(), {tilted, tilted, tilted});
  const glm::vec3 direction = glm::normalize(glm::vec3(0.5f, 0, -1));
  check_against_integral(scene, direction, glm::dvec3(tilted), 0.015,
                         [](const glm::vec3&) { return 1.0; });
  check_against_integral(scene, direction, glm::dvec3(tilted), 0.015,
                         [](const glm::vec3& o) { return o.x > 0 ? 1.0 : 0.0; });
}

TEST_CASE("No photon is scattered into the surface, not even by a steep shading normal") {
  Scene scene = plate(glossy(0.4f, 0.9f, 0.4f), 2);
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

// Mirrors and glass against Snell's and Fresnel's laws.

/// Ray direction in the plane y = 0 at `angle` from straight down.
glm::vec3 downwards(double angle) {
  return {static_cast<float>(std::sin(angle)), 0.0f, static_cast<float>(-std::cos(angle))};
}

glm::vec3 upwards(double angle) {
  const glm::vec3 v = downwards(angle);
  return {v.x, v.y, -v.z};
}

Scattered scatter(const Scene& scene, const glm::vec3& direction, float choice) {
  return scatter_specular(scene, surface_hit(scene, {0, 0.2f, 0.5f}, direction), direction, choice);
}

constexpr float never_reflect = 0.9999999f;

/// Share of choices that reflect, over 100,000 evenly spaced ones.
double reflected_fraction(const Scene& scene, const glm::vec3& direction) {
  int reflected = 0;
  for (int i = 0; i < 100'000; ++i) {
    const Scattered scattered = scatter(scene, direction, (static_cast<float>(i) + 0.5f) / 1e5f);
    reflected += scattered.direction.z * direction.z < 0;
  }
  return reflected / 1e5;
}

TEST_CASE("A mirror sends a ray out at the angle it came in, from both sides, and tints it") {
  const glm::vec3 tint(0.9f, 0.8f, 0.7f);
  const Scene scene = plate(mirror(tint), 2);
  for (const double angle : {0.0, 0.3, 1.2, 1.57}) {
    const Scattered above = scatter(scene, downwards(angle), 0.5f);
    CHECK(glm::distance(above.direction, upwards(angle)) < 1e-6f);
    CHECK(above.weight == tint);
    CHECK(glm::distance(scatter(scene, upwards(angle), 0.5f).direction, downwards(angle)) < 1e-6f);
  }
}

TEST_CASE("Glass of index 1.5 reflects 4% at normal incidence, entering and leaving") {
  const Scene scene = plate(glass(1.5f), 2);
  CHECK(reflected_fraction(scene, downwards(0)) == Approx(0.04).margin(2e-5));
  CHECK(reflected_fraction(scene, upwards(0)) == Approx(0.04).margin(2e-5));
}

TEST_CASE(
    "Glass reflects what Fresnel's equations say in double, total beyond the critical angle") {
  const Scene scene = plate(glass(1.5f), 2);
  for (const double angle : {0.3, 0.8, 1.3}) {
    const double sin_t = std::sin(angle) / 1.5, t = std::asin(sin_t);
    const double s = std::sin(angle - t) / std::sin(angle + t);
    const double p = std::tan(angle - t) / std::tan(angle + t);
    const double reflectance = 0.5 * (s * s + p * p);
    CHECK(reflected_fraction(scene, downwards(angle)) == Approx(reflectance).margin(3e-5));
    // Along the same path backwards the reflectance is the same.
    CHECK(reflected_fraction(scene, upwards(t)) == Approx(reflectance).margin(3e-5));
  }
  CHECK(reflected_fraction(scene, upwards(std::asin(1 / 1.5) + 1e-3)) == 1.0);
  CHECK(reflected_fraction(scene, upwards(1.5)) == 1.0);
  CHECK(fresnel_dielectric(0.0f, 1 / 1.5f) == Approx(1));
}

TEST_CASE(
    "Glass bends a ray by Snell's law, and what enters at an angle leaves a slab at that angle") {
  const Scene scene = plate(glass(1.5f), 2);
  for (const double angle : {0.0, 0.3, 0.8, 1.3}) {
    const double inside = std::asin(std::sin(angle) / 1.5);
    CHECK(glm::distance(scatter(scene, downwards(angle), never_reflect).direction,
                        downwards(inside)) < 1e-6f);
    CHECK(glm::distance(scatter(scene, upwards(inside), never_reflect).direction, upwards(angle)) <
          2e-6f);
  }
}

TEST_CASE("Glass whose front is below is entered from below") {
  Scene scene = plate(glass(1.5f), 2);
  for (auto& front : scene.front_side) front ^= 1;
  const double inside = std::asin(std::sin(0.8) / 1.5);
  CHECK(glm::distance(scatter(scene, upwards(0.8), never_reflect).direction, upwards(inside)) <
        1e-6f);
}

TEST_CASE("Thin glass does not bend rays and reflects as a pane with two faces, from both sides") {
  const Scene scene = plate(glass(1.5f, true), 2);
  for (const double angle : {0.0, 0.8}) {
    CHECK(scatter(scene, downwards(angle), never_reflect).direction == downwards(angle));
    CHECK(scatter(scene, upwards(angle), never_reflect).direction == upwards(angle));
  }
  // The series F + (1-F)^2 F (1 + F^2 + F^4 + ...), summed term by term.
  const double f = 0.04;
  double reflectance = f;
  for (double term = (1 - f) * (1 - f) * f; term > 1e-12; term *= f * f) reflectance += term;
  CHECK(reflected_fraction(scene, downwards(0)) == Approx(reflectance).margin(2e-5));
  CHECK(reflected_fraction(scene, upwards(0)) == Approx(reflectance).margin(2e-5));
}

TEST_CASE("Glass tints what passes and not what it reflects") {
  Material green = glass(1.5f);
  green.transmission = {0.2f, 0.9f, 0.3f};
  const Scene scene = plate(green, 2);
  CHECK(scatter(scene, downwards(0.3), never_reflect).weight == green.transmission);
  CHECK(scatter(scene, downwards(0.3), 0.0f).weight == glm::vec3(1.0f));
}

TEST_CASE("A steep shading normal sends no ray to the wrong side of a mirror or of glass") {
  for (const Material& material : {mirror(1.0f), glass(1.5f)}) {
    Scene scene = plate(material, 2);
    const glm::vec3 steep = glm::normalize(glm::vec3(-1.0f, 0.0f, 0.2f));
    scene.corner_normal.assign(scene.triangle_count(), {steep, steep, steep});
    for (const double angle : {0.1, 0.8, 1.4}) {
      CHECK(scatter(scene, downwards(angle), 0.0f).direction.z > 0);
      if (material.interaction == Interaction::glass)
        CHECK(scatter(scene, downwards(angle), never_reflect).direction.z < 0);
    }
  }
}

TEST_CASE("Radiance loses the squared index on the way into the eye, and gets it back beyond") {
  const Scene solid = plate(glass(1.5f), 2);
  const double inside = std::asin(std::sin(0.8) / 1.5);
  const Scattered in = scatter(solid, downwards(0.8), never_reflect);
  const Scattered out = scatter(solid, upwards(inside), never_reflect);
  CHECK(in.radiance_factor == Approx(1 / 2.25));
  CHECK(out.radiance_factor == Approx(2.25));
  CHECK(static_cast<float>(in.radiance_factor * out.radiance_factor) == 1.0f);
  CHECK(scatter(solid, downwards(0.8), 0.0f).radiance_factor == 1);
  CHECK(scatter(solid, upwards(1.2), never_reflect).radiance_factor == 1);  // total reflection
  CHECK(scatter(plate(glass(1.5f, true), 2), downwards(0.8), never_reflect).radiance_factor == 1);
  CHECK(scatter(plate(mirror(1.0f), 2), downwards(0.8), 0.5f).radiance_factor == 1);
}

// Paths along lobes, surface by surface.

TEST_CASE("lobe paths: what one surface scatters says nothing of what another does") {
  SceneBuilder builder;
  const std::uint32_t metal = builder.add(glossy(0.0f, 0.95f, 0.02f));
  builder.grid({-50, -50, 0}, {100, 0, 0}, {0, 100, 0}, 1, metal);
  builder.grid({-50, -50, 1}, {0, 100, 0}, {100, 0, 0}, 1, metal);
  builder.add(point_light("bulb", {3, 2, 0.5f}));
  const Scene scene = builder.build();
  const RayScene rays(scene);
  const LightSampler lamps(scene);
  const LobeRays lobes{rays, lamps};
  constexpr int surfaces = 5, paths = 2000;
  const PrimaryHitParameters film{.max_specular_depth = surfaces};
  const EyeSetup setup{.rays = &impl_of(rays), .parameters = &film, .lobes = &lobes};
  // Which way each surface turns a path that met the first one at a right angle: the signs of the
  // changes of its slopes along x and y.
  std::vector<std::array<int, 2 * surfaces>> turns;
  for (std::uint64_t pixel = 0; pixel < paths; ++pixel) {
    const RandomStream numbers(1, pixel, 0);
    EyeRecord seen, reflected;
    const auto end = follow_eye_ray(setup, {glm::vec3(0, 0, 0.5f), {0, 0, -1}, glm::vec3(1.0f), 0},
                                    numbers, seen);
    REQUIRE(end);
    follow_lobes(setup, *end, {numbers, 0, pixel, 0}, reflected);
    if (reflected.hits.size() < surfaces) continue;
    glm::dvec3 from(end->point.position);
    glm::dvec2 slope(0.0);
    auto& turn = turns.emplace_back();
    for (int i = 0; i < surfaces; ++i) {
      const glm::dvec3 to(reflected.hits[static_cast<std::size_t>(i)].position);
      const glm::dvec2 next = glm::dvec2(to - from) / std::abs(to.z - from.z);
      turn[2 * i] = next.x > slope.x ? 1 : -1;
      turn[2 * i + 1] = next.y > slope.y ? 1 : -1;
      slope = next;
      from = to;
    }
  }
  REQUIRE(turns.size() > 0.9 * paths);
  for (int i = 0; i < 2 * surfaces; ++i) {
    for (int j = 0; j < i - i % 2; ++j) {
      int sum = 0;
      for (const auto& turn : turns) sum += turn[i] * turn[j];
      CAPTURE(i, j);
      // Scatters by the root of the number of paths.
      CHECK(std::abs(sum) < 5 * std::sqrt(turns.size()));
    }
  }
}

// Normal maps: which way they turn, and that surfaces under them reflect no more than they get.

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

/// Normals as they are seen from above.
ShadingNormals normals_of(const Scene& scene) {
  return shading_normals(scene, top_of_plate(scene), {0, 0, -1});
}

TEST_CASE("Red turns the normal towards u, green towards -v") {
  const glm::vec3 down(0, 0, -1);
  for (const glm::vec3 normal :
       {glm::vec3(0.3f, 0, 1), glm::vec3(0, 0.3f, 1), glm::vec3(-0.2f, 0.4f, 1)}) {
    const Scene scene = mapped_plate(diffuse(0.5f), normal);
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
  const glm::vec3 tilted = glm::normalize(glm::vec3(0.3f, 0.1f, 1.0f));
  for (std::size_t missing = 0; missing < 3; ++missing) {
    Scene scene = plate(diffuse(0.5f), 2);
    scene.corner_normal.assign(scene.triangle_count(), {tilted, tilted, tilted});
    CHECK(normals_of(scene).smooth != glm::vec3(0, 0, 1));
    for (auto& corner : scene.corner_normal) corner[missing] = glm::vec3(0.0f);
    CHECK(normals_of(scene).smooth == glm::vec3(0, 0, 1));
  }
}

TEST_CASE("The winding and the mirroring of coordinates do not turn the map") {
  const glm::vec3 normal = glm::normalize(glm::vec3(0.3f, 0.2f, 1));
  Scene scene = mapped_plate(diffuse(0.5f), normal);
  for (auto& uv : scene.corner_uv)
    for (glm::vec2& corner : uv) corner.x = -corner.x;  // red is now along -x
  CHECK(glm::distance(normals_of(scene).mapped, glm::vec3(-normal.x, normal.y, normal.z)) < 0.01f);
  // The other side is the front: from above the plate is seen from behind, where bumps are dents.
  scene = rewound(mapped_plate(diffuse(0.5f), normal), [](std::size_t) { return true; });
  const glm::vec3 behind = normals_of(scene).mapped;
  CHECK(behind.z > 0);
  CHECK(glm::distance(behind, glm::vec3(-normal.x, -normal.y, normal.z)) < 0.01f);
}

TEST_CASE("The scale stretches the slope, and a flat map turns nothing") {
  Scene scene = mapped_plate(diffuse(0.5f), {0.2f, 0, 1});
  scene.materials[0].normal_scale = 2;
  CHECK(glm::distance(normals_of(scene).mapped, glm::normalize(glm::vec3(0.4f, 0, 1))) < 0.02f);
  const Scene flat = mapped_plate(diffuse(0.5f), {0, 0, 1});
  CHECK(glm::distance(normals_of(flat).mapped, glm::vec3(0, 0, 1)) < 0.008f);
}

TEST_CASE("Triangles whose texture has no area keep their normals") {
  Scene scene = mapped_plate(diffuse(0.5f), {0.5f, 0, 1});
  scene.corner_uv.assign(scene.triangle_count(), {});
  CHECK(normals_of(scene).mapped == glm::vec3(0, 0, 1));
}

TEST_CASE("Under a normal map a diffuse surface reflects light by the mapped cosine") {
  const glm::vec3 normal = glm::normalize(glm::vec3(0.3f, 0, 1)), down(0, 0, -1);
  const Scene scene = mapped_plate(diffuse(0.5f), normal);
  const OpaqueBsdf bsdf(scene, at(scene, down), down);
  for (const glm::vec3 light : {glm::vec3(0.4f, 0, 1), glm::vec3(-0.4f, 0.1f, 1)}) {
    const glm::vec3 to = glm::normalize(light);
    CHECK(bsdf.reflected(to).g ==
          Approx(0.5 / glm::pi<double>() * double{glm::dot(normal, to)}).epsilon(0.01));
  }
}

TEST_CASE("Under a normal map the eye sees no more light than there is, from whichever side") {
  const glm::vec3 normal(0.8f, 0, 1);
  for (const Material& material :
       {diffuse(0.9f), glossy(0.9f, 0.04f, 0.3f), glossy(0.0f, 1.0f, 0.3f)})
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

TEST_CASE("Photons and rays from the eye see the same surface under a normal map") {
  const Scene scene = mapped_plate(glossy(0.6f, 0.04f, 0.4f), {0.3f, 0.2f, 1});
  const glm::vec3 light = glm::normalize(glm::vec3(0.3f, 0.5f, 1)),
                  eye = glm::normalize(glm::vec3(-0.5f, 0.1f, 1));
  const OpaqueBsdf from_light(scene, at(scene, -light), -light, PathStart::light);
  const OpaqueBsdf from_eye(scene, at(scene, -eye), -eye, PathStart::eye);
  CHECK((from_light.reflected(eye) / eye.z).g == Approx((from_eye.reflected(light) / light.z).g));
}

}  // namespace
}  // namespace photile::test
