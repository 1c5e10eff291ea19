// Photons that are aimed at mirrors carry the flux that falls on them, against closed forms.
#include <catch2/catch.hpp>
#include <numbers>
#include <random>

#include "photile/photons.hpp"
#include "photile/ray_scene.hpp"
#include "photile/statistics.hpp"
#include "statistical_tests.hpp"
#include "suns.hpp"
#include "trace/emission_sampling.hpp"
#include "trace/sampling.hpp"
#include "trace/targets.hpp"
#include "validation/analytic_cases.hpp"

namespace photile::test {
namespace {

using std::numbers::pi;

constexpr float mirror_half_side = 0.3f;  ///< of mirrors, metres

/// A box of 2 m around the origin, black by default, with mirrors that reflect all light: two
/// beside each other that face -x, at a distance of 0.9 m, and one that faces +y at 0.7 m, whose
/// bounding spheres look through each other from most places.
SceneBuilder box_of_mirrors(float reflectance = 0.0f) {
  SceneBuilder builder;
  const std::uint32_t walls = builder.add(diffuse(reflectance));
  builder.box(glm::vec3(-1.0f), glm::vec3(1.0f), walls, true, 2);
  const std::uint32_t glass = builder.add(mirror(1.0f));
  for (const float z : {-0.65f, 0.05f}) {
    builder.grid({0.9f, -mirror_half_side, z}, {0, 0, 2 * mirror_half_side},
                 {0, 2 * mirror_half_side, 0}, 1, glass);
  }
  builder.grid({-mirror_half_side, -0.7f, -mirror_half_side}, {0, 0, 2 * mirror_half_side},
               {2 * mirror_half_side, 0, 0}, 1, glass);
  return builder;
}

/// Solid angle of a rectangle at a distance d from the origin, whose sides run from a to b and from
/// c to e along two axes: that of each corner's rectangle, added and taken away.
double solid_angle(double d, double a, double b, double c, double e) {
  const auto corner = [d](double x, double y) {
    return std::atan2(x * y, d * std::sqrt(d * d + x * x + y * y));
  };
  return corner(b, e) - corner(a, e) - corner(b, c) + corner(a, c);
}

/// Of all three mirrors, from the origin.
double solid_angle_of_mirrors() {
  return solid_angle(0.9, -0.3, 0.3, -0.65, -0.05) + solid_angle(0.9, -0.3, 0.3, 0.05, 0.65) +
         solid_angle(0.7, -0.3, 0.3, -0.3, 0.3);
}

/// Luminous flux of the caustics of 16 seeds, where the lamp emits 1.
std::vector<double> flux_of_caustics(const Scene& scene, std::uint64_t paths) {
  const RayScene rays(scene);
  return of_seeds([&](std::uint64_t seed) {
    const Photons caustics =
        trace_photons(rays, {.emitted_photons = paths, .seed = seed, .keep_caustics = true})
            .caustics;
    double sum = 0;
    for (const glm::vec3& flux : caustics.flux) sum += luminance(glm::dvec3(flux));
    return sum;
  });
}

}  // namespace

TEST_CASE("Caustics of a bare bulb carry the flux within the solid angle of the mirrors") {
  // What walls scatter is no caustic.
  SceneBuilder builder = box_of_mirrors(GENERATE(0.0f, 0.5f));
  builder.add(point_light("bulb", glm::vec3(0.0f)));
  const double truth = solid_angle_of_mirrors() / (4 * pi);
  CHECK_VERDICT(mean_is(flux_of_caustics(builder.build(), 5000), truth, 0.01 * truth));
}

TEST_CASE("Caustics of a spot light carry the flux that its cone sends to the mirrors") {
  SceneBuilder builder = box_of_mirrors();
  // 52 degrees: farther than the corners at 0.9 m, not those at 0.7 m.
  const Light spot = spot_light("spot", glm::vec3(0.0f), {1, 0, 0}, 0.9f, 0.95f);
  builder.add(spot);
  const double candela = 1 / (2 * pi * trace::SpotFalloff(spot).integral());
  const double truth = candela * 2 * solid_angle(0.9, -0.3, 0.3, 0.05, 0.65);
  CHECK_VERDICT(mean_is(flux_of_caustics(builder.build(), 5000), truth, 0.01 * truth));
}

TEST_CASE("Caustics of a lamp with an area carry the flux that falls on the mirrors") {
  const bool two_sided = GENERATE(false, true);
  SceneBuilder builder = box_of_mirrors();
  const std::uint32_t black = builder.add(diffuse(0.0f));
  builder.grid({-0.5f, 0, -0.25f}, {1.0f, 0, 0}, {0, 0, 0.5f}, 3, black,
               builder.add(area_light("lamp", 1, two_sided)));  // its front looks down
  // The lamp hides no mirror from itself; light that one mirror sends to another counts once.
  const auto on = [&](const glm::dvec3& corner, const glm::dvec3& u, const glm::dvec3& v,
                      const glm::dvec3& normal) {
    constexpr int cells = 60;
    double sum = 0;
    for (int i = 0; i < cells * cells; ++i) {
      const glm::dvec3 point =
          corner + (i % cells + 0.5) / cells * u + (i / cells + 0.5) / cells * v;
      sum += validation::rectangle_factor(point, normal, {-0.5, 0, -0.25}, {1, 0, 0}, {0, 0, 0.5});
    }
    return sum * glm::length(u) * glm::length(v) / (cells * cells * 0.5);
  };
  const double below = on({-0.3, -0.7, -0.3}, {0.6, 0, 0}, {0, 0, 0.6}, {0, 1, 0});
  double beside = 0;  // of mirrors that face -x, what lies below the lamp's plane
  for (const double z : {-0.65, 0.05}) {
    beside += on({0.9, -0.3, z}, {0, 0.3, 0}, {0, 0, 0.6}, {-1, 0, 0});
  }
  // Of two sides each emits half; above its plane the two halves of a mirror are alike.
  const double truth = two_sided ? below / 2 + beside : below + beside;
  CAPTURE(two_sided, below, beside);
  CHECK_VERDICT(mean_is(flux_of_caustics(builder.build(), 60'000), truth, 0.02 * truth));
}

TEST_CASE("Caustics of a sun carry the flux that crosses the mirror") {
  const float diameter = GENERATE(0.0f, 0.01f);
  SceneBuilder builder;
  builder.grid({-4, -2, 0}, {8, 0, 0}, {0, 4, 0}, 1, builder.add(diffuse(0.0f)));
  builder.grid({0, -0.5f, 0.1f}, {0, 0, 1}, {0, 1, 0}, 1, builder.add(mirror(1.0f)));
  const Light sun = sun_along(glm::normalize(glm::vec3(1, 0, -1)), diameter);
  builder.add_distant(sun, 1.0);
  const Scene scene = builder.build();
  const double radius = bounding_sphere(scene).radius;
  const double truth = std::cos(pi / 4) / (pi * radius * radius);
  CHECK_VERDICT(mean_is(flux_of_caustics(scene, 5000), truth, 0.01 * truth));
}

TEST_CASE("Photons of a caustic lie more evenly than by chance") {
  SceneBuilder builder;
  builder.grid({-4, -4, 0}, {8, 0, 0}, {0, 8, 0}, 1, builder.add(diffuse(0.0f)));
  builder.grid({-0.5f, -0.5f, 2}, {0, 1, 0}, {1, 0, 0}, 1, builder.add(mirror(1.0f)));
  builder.add(point_light("bulb", {0, 0, 1}));
  const Scene scene = builder.build();
  const RayScene rays(scene);
  double mean = 0, squares = 0;
  constexpr int seeds = 64;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    const Photons caustics =
        trace_photons(rays, {.emitted_photons = 4000, .seed = seed, .keep_caustics = true})
            .caustics;
    double count = 0;  // in a disc of 0.3 m
    for (const glm::vec3& p : caustics.position) count += std::hypot(p.x - 0.4f, p.y - 0.3f) < 0.3f;
    mean += count / seeds;
    squares += count * count / seeds;
  }
  REQUIRE(mean > 100);
  CHECK(squares - mean * mean < 0.3 * mean);  // by chance it is the mean, within a third
}

TEST_CASE("Aims: directions have the densities that are told, over all that targets show") {
  // Two spheres that overlap, one that the point is within, one below the horizon.
  const glm::vec3 up(0.0f, 0.0f, 1.0f);
  const trace::Targets targets({{{0.5, 0, 2}, 0.5, 3.0},
                                {{0.9, 0.2, 2}, 0.6, 1.0},
                                {{0, 0.1, 0}, 0.4, 0.2},
                                {{0, 0, -3}, 1.0, 5.0}});
  for (const glm::vec3* normal : {&up, static_cast<const glm::vec3*>(nullptr)}) {
    const trace::Aim aim(targets, glm::dvec3(0.0), normal);
    REQUIRE(aim.possible());
    constexpr int count = 50'000;
    std::mt19937 random(5);
    std::uniform_real_distribution<double> uniform;
    // Of a function of the direction, by the aim and by directions to all sides.
    const auto of = [](const glm::vec3& d) { return 1 + d.x + 0.5 * d.y * d.y; };
    double aimed = 0, aimed_squares = 0, everywhere = 0, squares = 0, all = 0;
    for (int i = 0; i < count; ++i) {
      const auto [direction, density] = aim.sample({uniform(random), uniform(random)});
      CHECK(density == Approx(aim.density(direction)).epsilon(1e-3));
      aimed += of(direction) / count;
      aimed_squares += of(direction) * of(direction) / count;
      const glm::vec3 other = trace::sample_sphere(static_cast<float>(uniform(random)),
                                                   static_cast<float>(uniform(random)));
      const double weight = 4 * pi * aim.density(other);
      all += weight / count;
      everywhere += weight * of(other) / count;
      squares += weight * weight * of(other) * of(other) / count;
    }
    const double error =
        std::sqrt((aimed_squares - aimed * aimed + squares - everywhere * everywhere) / count);
    CHECK(aimed == Approx(everywhere).margin(4 * error));
    CHECK(all == Approx(1).margin(4 * std::sqrt(squares / count)));
  }
  CHECK_FALSE(
      trace::Aim(trace::Targets({{{0, 0, -3}, 1.0, 5.0}}), glm::dvec3(0.0), &up).possible());
}

TEST_CASE("Scenes without mirrors and glass have no targets and no caustics") {
  const Scene scene = closed_box(diffuse(0.5f));
  CHECK(trace::specular_targets(scene).empty());
  const PhotonTracerResult traced =
      trace_photons(RayScene(scene), {.emitted_photons = 1000, .keep_caustics = true});
  CHECK(traced.caustics.size() == 0);
  CHECK(traced.caustics.first_of.size() == 2 * scene.triangle_count() + 1);
}

}  // namespace photile::test
