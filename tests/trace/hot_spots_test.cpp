// Surface close to lights without size: which photons are not those of maps, how rays go there, and
// on which side lights lie that are in a surface.
#include "trace/hot_spots.hpp"

#include <catch2/catch.hpp>

#include "lamp_below_ceiling.hpp"
#include "photile/photons.hpp"
#include "trace/photon_tracer.hpp"
#include "trace/random_stream.hpp"
#include "trace/ray_query.hpp"
#include "trace/sampling.hpp"

namespace photile::test {

TEST_CASE("hot spots: lights in the middle of a room have none") {
  CHECK(trace::hot_spots_of(RayScene(furnished_room())).empty());
}

TEST_CASE("hot spots: photons straight from the light are left out as far as its spot reaches") {
  constexpr double below = 0.01;
  SceneBuilder builder = ceiling_and_floor();
  builder.add(point_light("lamp", {0, 0, ceiling_height - static_cast<float>(below)}));
  const Scene scene = builder.build();
  const RayScene rays(scene);
  const auto flux_on_ceiling = [&](bool all) {
    const PhotonTracerParameters parameters{.emitted_photons = 200'000};
    const Photons photons = (all ? trace_photons(rays, parameters)
                                 : trace::trace_photons_beside_hot_spots(rays, parameters))
                                .photons;
    double flux = 0;
    for (std::size_t i = 0; i < photons.size(); ++i) {
      if (photons.position[i].z > 1) flux += luminance(glm::dvec3(photons.flux[i]));
    }
    return flux;
  };
  const trace::HotSpots& spots = trace::hot_spots_of(rays);
  double reach = 0, beyond = 3;
  while (beyond - reach > 1e-6) {
    const double middle = 0.5 * (reach + beyond);
    const glm::vec3 there(middle, 0, scene.lights[0].position.z);
    (spots.holds(0, there) ? reach : beyond) = middle;
  }
  REQUIRE(reach > 0.1);
  REQUIRE(reach < 0.5);
  // Within a distance R lie the directions whose cosine is at least below / R.
  CHECK(flux_on_ceiling(true) - flux_on_ceiling(false) ==
        Approx(0.5 * (1 - below / reach)).epsilon(0.01));
}

TEST_CASE("hot spots: rays that are aimed there have the density that they say") {
  SceneBuilder builder = ceiling_and_floor();
  builder.add(point_light("lamp", {0, 0, ceiling_height - 0.1f}));
  builder.add(spot_light("spot", {0.5f, 0, ceiling_height - 0.08f}, {0, 0.6f, 0.8f}, 0.2f, 0.6f));
  const Scene scene = builder.build();
  const RayScene rays(scene);
  const trace::FlushDenormals flush_denormals;
  const glm::vec3 from(0.3f, 0.2f, 2.0f), up(0, 0, 1);
  const trace::HotSpotAim aim(trace::hot_spots_of(rays), from, &up);
  REQUIRE(aim.fraction() > 0);
  constexpr std::uint32_t count = 1 << 16;
  // Within four cones around the ceiling above: as many targets as the integral of the density.
  for (const double widest : {0.2, 0.4, 0.7, 1.5}) {
    double aimed = 0, integral = 0;
    const double cap = 1 - std::cos(widest);
    for (std::uint32_t i = 0; i < count; ++i) {
      const glm::dvec2 u = trace::sobol_point(i, trace::RandomBlock({1, 2, 3, 4}));
      if (const auto target = aim.sample(u)) {
        aimed += target->direction.z > std::cos(widest) ? 1.0 / count : 0.0;
      }
      const glm::vec3 direction =
          trace::direction_at(static_cast<float>(1 - cap * u.x), static_cast<float>(u.y));
      const auto hit = trace::intersect(rays, from, direction);
      if (!hit) continue;
      const trace::SurfacePoint met = trace::surface_hit(scene, *hit, direction);
      // weight_beside is (1 - f) / ((1 - f) + f density) beside rays of density 1.
      const double f = aim.fraction(), weight = aim.weight_beside(1.0, met);
      integral += (1 - f) * (1 / weight - 1) / f * 2 * glm::pi<double>() * cap / count;
    }
    CAPTURE(widest);
    CHECK(aimed == Approx(integral).epsilon(0.01));
  }
}

TEST_CASE("a light in a surface lies on the side to which it shines, or below, or within") {
  const auto moved = [](const Light& light) {
    SceneBuilder builder("room");
    builder.box({0, 0, 0}, {4, 3, 4}, builder.add(diffuse(0.5f)), true);
    builder.grid({0, 1.5f, 0}, {4, 0, 0}, {0, 0, 4}, 1, 0);  // a storey
    builder.add(light);
    return builder.build().lights[0].position - light.position;
  };
  const float most = 1e-4f;
  const auto is_along = [&](const glm::vec3& way, const glm::vec3& normal) {
    const float along = glm::dot(way, normal);
    return along > 1e-5f && along < most && glm::length(way - along * normal) < 1e-6f;
  };
  const glm::vec3 on_ceiling(2, 3, 2), on_floor(1, 0, 1), on_storey(2, 1.5f, 1), on_wall(0, 1, 2);
  CHECK(is_along(moved(spot_light("down", on_ceiling, {0, -1, 0}, 0.3f, 0.6f)), {0, -1, 0}));
  CHECK(is_along(moved(spot_light("up", on_storey, {0, 1, 0}, 0.3f, 0.6f)), {0, 1, 0}));
  CHECK(is_along(moved(spot_light("down", on_storey, {0, -1, 0}, 0.3f, 0.6f)), {0, -1, 0}));
  CHECK(is_along(moved(point_light("both ways", on_ceiling)), {0, -1, 0}));
  CHECK(is_along(moved(point_light("both ways", on_storey)), {0, -1, 0}));
  CHECK(is_along(moved(point_light("both ways", on_floor)), {0, 1, 0}));
  CHECK(is_along(moved(point_light("both ways", on_wall)), {1, 0, 0}));
  CHECK(moved(point_light("in the room", {2, 2.999f, 2})) == glm::vec3(0.0f));
}

}  // namespace photile::test
