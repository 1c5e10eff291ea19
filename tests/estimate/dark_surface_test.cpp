// Even light on the open part of a plate, none on the rest: what reads 1, and what stays dark. All
// readings are beside the closed form, 1 lm/m2 where light falls.
#include <catch2/catch.hpp>
#include <functional>
#include <memory>

#include "photile/surface_index.hpp"
#include "photon_sets.hpp"
#include "test_device.hpp"
#include "test_scenes.hpp"
#include "test_tunings.hpp"

namespace photile::test {
namespace {

using Where = std::function<bool(const glm::vec3&)>;

/// A plate of 1 x 1 m in the plane z = 0, and boxes on it.
Scene plate_under(const std::vector<std::array<glm::vec3, 2>>& boxes, int cells = 1) {
  SceneBuilder builder;
  const std::uint32_t white = builder.add(diffuse(0.5f));
  builder.grid({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, cells, white);
  for (const auto& [low, high] : boxes) builder.box(low, high, white, false);
  builder.add(point_light("lamp", {0.5f, 0.5f, 2}));
  return builder.build();
}

/// The sides of the plate's triangles that look up, by place.
class UpperSides {
 public:
  explicit UpperSides(const Scene& scene) : scene_(scene), at_(parts * parts) {
    for (std::uint32_t t = 0; t < scene.triangle_count(); ++t) {
      const auto c = scene.corners(t);
      if (c[0].z != 0 || c[1].z != 0 || c[2].z != 0) continue;
      const glm::ivec2 low = part(glm::min(c[0], glm::min(c[1], c[2])));
      const glm::ivec2 high = part(glm::max(c[0], glm::max(c[1], c[2])));
      for (int y = low.y; y <= high.y; ++y) {
        for (int x = low.x; x <= high.x; ++x) triangles(x, y).push_back(t);
      }
    }
  }

  std::uint32_t at(const glm::vec3& point) {
    for (const std::uint32_t t : triangles(part(point).x, part(point).y)) {
      const auto c = scene_.corners(t);
      const glm::vec3 n(0, 0, 1);
      int left = 0, right = 0;
      for (int i = 0; i < 3; ++i) {
        const float turn = glm::dot(n, glm::cross(c[(i + 1) % 3] - c[i], point - c[i]));
        left += turn >= 0, right += turn <= 0;
      }
      if (left == 3 || right == 3) {
        return oriented(t, face_normal(scene_, oriented(t, 0)).z > 0 ? 0 : 1);
      }
    }
    throw std::logic_error("no triangle of the plate there");
  }

 private:
  static constexpr int parts = 64;  ///< along each side of the plate
  static glm::ivec2 part(const glm::vec3& point) {
    return glm::min(glm::ivec2(glm::vec2(point) * static_cast<float>(parts)), parts - 1);
  }
  std::vector<std::uint32_t>& triangles(int x, int y) {
    return at_[static_cast<std::size_t>(y * parts + x)];
  }

  const Scene& scene_;
  std::vector<std::vector<std::uint32_t>> at_;
};

/// Photons of 1 lm/m2 on the part of the plate that is open, `density` to a square metre.
Photons even_light(const Scene& scene, const Where& open, int density, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<float> place(0.0f, 1.0f);
  UpperSides upper_sides(scene);
  Photons photons;
  for (int i = 0; i < density; ++i) {
    const glm::vec3 p(place(random), place(random), 0.0f);
    if (open(p)) add_photon(photons, scene, p, upper_sides.at(p), random);
  }
  photons.flux.assign(photons.size(), glm::vec3(1.0f / static_cast<float>(density)));
  return sort_by_oriented_face(std::move(photons), 2 * scene.triangle_count());
}

struct Means {
  double with_dark, without;
};

/// Mean irradiance at points of the plate, over sets of photons; with dark surface, and without.
///   density   photons to a square metre of open plate
Means means(const Scene& scene, const Where& open, const Where& seen, int neighbours = 200,
            int density = 20'000) {
  const double widest = 2 * std::sqrt(neighbours / (glm::pi<double>() * density));  // automatic
  std::array<double, 2> sum{};
  std::size_t count = 0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const Photons photons = even_light(scene, open, density, seed);
    const PhotonMaps maps(device(), scene, photons,
                          find_map_groups(scene, photons, MapMode::automatic, {widest, 60}),
                          {.radius = widest});
    std::mt19937_64 random(100 + seed);
    std::uniform_real_distribution<float> place(0.0f, 1.0f);
    UpperSides upper_sides(scene);
    PrimaryHits hits;
    while (hits.position.size() < 1000) {
      const glm::vec3 p(place(random), place(random), 0.0f);
      if (!seen(p)) continue;
      add_grey_hit(hits, p, upper_sides.at(p));
    }
    count += hits.position.size();
    SurfaceIndex whole = index_surface(scene, landed_on(scene, photons), widest, 60);
    for (const bool with_dark : {true, false}) {
      const auto surface = std::make_shared<const SurfaceIndex>(
          with_dark ? index_surface(scene, photons, widest, 60) : whole);
      EstimateParameters parameters{.neighbours = neighbours, .surface = surface};
      const LightTable estimates = Estimator(maps, scene, parameters).estimate(hits);
      for (const glm::vec3& irradiance : estimates.irradiance) {
        sum[with_dark ? 0 : 1] += irradiance.g;
      }
    }
  }
  const auto hits = static_cast<double>(count);
  return {sum[0] / hits, sum[1] / hits};
}

/// Distance from a square's outside to it, and 0 within.
float distance_from(const glm::vec3& p, const glm::vec2& low, const glm::vec2& high) {
  const glm::vec2 q(p);
  return glm::length(glm::max(glm::max(low - q, q - high), glm::vec2(0.0f)));
}

}  // namespace

TEST_CASE("a plate partly covered by a box reads 1 beside it") {
  const glm::vec2 low(0.3f), high(0.7f);
  const Scene scene = plate_under({{glm::vec3(low, 0.0f), glm::vec3(high, 0.3f)}});
  const auto outside = [&](const glm::vec3& p) { return distance_from(p, low, high) > 0; };
  const auto beside = [&](const glm::vec3& p) {
    const float distance = distance_from(p, low, high);
    return distance > 0 && distance < 0.02f;
  };
  // Within r = 113 mm of the hits nearly half of the disc lies under the box. Where the box's edge
  // crosses triangles of 12 to 24 photons, 15 mm high at most, they are taken for open: 15 x 226
  // mm^2 at most of a disc of 40,000 mm^2.
  const Means mean = means(scene, outside, beside, 8000, 200'000);
  CHECK(mean.without < 0.65);
  CHECK(mean.with_dark == Approx(1.0).margin(0.1));
}

TEST_CASE("a wall that goes on above a ceiling reads 1 below it, for any triangles") {
  const int cells = GENERATE(1, 4, 16);
  CAPTURE(cells);
  // The wall lies: what is beyond y = 0.625 is above the ceiling.
  const Scene scene = plate_under({}, cells);
  const auto below = [](const glm::vec3& p) { return p.y < 0.625f; };
  const auto near = [](const glm::vec3& p) { return p.y > 0.6f && p.y < 0.625f; };
  const Means mean = means(scene, below, near);
  CHECK(mean.with_dark == Approx(1.0).margin(0.1));
}

TEST_CASE("a shadow that is seen stays as dark as it was") {
  const auto lit = [](const glm::vec3& p) { return p.x < 0.5f; };
  const auto in_shadow = [](const glm::vec3& p) { return p.x > 0.53f; };
  for (const int cells : {1, 8}) {
    const Means mean = means(plate_under({}, cells), lit, in_shadow);
    CAPTURE(cells, mean.without);
    CHECK(mean.with_dark <= mean.without * 1.02);
  }
}

TEST_CASE("slits of 1 to 20 mm between boxes read no more than what falls into them") {
  for (const float slit : {0.001f, 0.005f, 0.02f}) {
    const float low = 0.5f - slit / 2, high = 0.5f + slit / 2;
    const Scene scene = plate_under({{glm::vec3(0, 0, 0), glm::vec3(low, 1, 0.1f)},
                                     {glm::vec3(high, 0, 0), glm::vec3(1, 1, 0.1f)}});
    const auto in_slit = [&](const glm::vec3& p) { return p.x > low && p.x < high; };
    const Means mean = means(scene, in_slit, in_slit, 200, 400'000);
    CAPTURE(slit, mean.without);
    CHECK(mean.with_dark >= mean.without * 0.99);
    CHECK(mean.with_dark < 1.1);
  }
}

TEST_CASE("a panel reads 1 above surface that does not count and has parts where others do") {
  // A floor ends in the dark: first with triangles on which photons are missing, then with two that
  // are too small for any to be expected. A tile that lies in the same place counts before them.
  SceneBuilder builder;
  const std::uint32_t white = builder.add(diffuse(0.5f));
  builder.grid({2.05f, 0.05f, 0}, {0.1f, 0, 0}, {0, 0.1f, 0}, 1, white);
  builder.grid({0, 0, 0}, {2, 0, 0}, {0, 1, 0}, 2, white);
  builder.grid({2, 0, 0}, {0.2f, 0, 0}, {0, 0.2f, 0}, 1, white);
  builder.grid({2, 0, 0.002f}, {0.2f, 0, 0}, {0, 0.2f, 0}, 1, white);
  builder.add(point_light("lamp", {0.5f, 0.5f, 2}));
  const Scene scene = builder.build();
  const auto upper_side_at = [&](const glm::vec3& p) {
    for (std::uint32_t t = 0; t < scene.triangle_count(); ++t) {
      const auto [a, b, c] = scene.corners(t);
      if (a.z != p.z) continue;
      const auto turn = [&](const glm::vec3& from, const glm::vec3& to) {
        return (to.x - from.x) * (p.y - from.y) - (to.y - from.y) * (p.x - from.x);
      };
      const float least = std::min({turn(a, b), turn(b, c), turn(c, a)});
      const float most = std::max({turn(a, b), turn(b, c), turn(c, a)});
      if (least >= 0 || most <= 0)
        return oriented(t, face_normal(scene, oriented(t, 0)).z > 0 ? 0 : 1);
    }
    throw std::logic_error("no triangle there");
  };
  // On the panel 1 lm/m2.
  constexpr int on_floor = 200, on_panel = 2000;
  constexpr double radius = 0.03;
  std::mt19937_64 random(1);
  std::uniform_real_distribution<float> place(0.0f, 1.0f);
  const auto point_of_panel = [&] {
    const float x = place(random), y = place(random);
    return glm::vec3(2 + 0.2f * x, 0.2f * y, 0.002f);
  };
  Photons photons;
  for (int i = 0; i < on_floor; ++i) {
    const float x = place(random), y = place(random);
    add_photon(photons, scene, {x, y, 0}, upper_side_at({x, y, 0}), random);
  }
  for (int i = 0; i < on_panel; ++i) {
    const glm::vec3 p = point_of_panel();
    add_photon(photons, scene, p, upper_side_at(p), random);
  }
  photons.flux.assign(photons.size(), glm::vec3(0.04f / on_panel));
  photons = sort_by_oriented_face(std::move(photons), 2 * scene.triangle_count());

  const auto surface =
      std::make_shared<const SurfaceIndex>(index_surface(scene, photons, radius, 60));
  const std::vector<std::uint8_t> lit = lit_components(*surface, landed_on(scene, photons));
  REQUIRE(std::any_of(
      surface->unlit_regions.begin(), surface->unlit_regions.end(),
      [&](const DarkPart& part) { return lit[surface->component[part.oriented_face]] == 0; }));
  PrimaryHits hits;
  for (int i = 0; i < 2000; ++i) {
    const glm::vec3 p = point_of_panel();
    add_grey_hit(hits, p, upper_side_at(p));
  }
  const PhotonMaps maps(device(), scene, photons,
                        find_map_groups(scene, photons, MapMode::automatic, {radius, 60}),
                        {.radius = radius});
  for (const EstimateTuning& tuning : tunings_of(device().info())) {
    EstimateParameters parameters{.neighbours = 50, .surface = surface};
    parameters.tuning = tuning;
    const LightTable estimates = Estimator(maps, scene, parameters).estimate(hits);
    double sum = 0;
    for (const glm::vec3& irradiance : estimates.irradiance) sum += irradiance.g;
    CAPTURE(name_of(tuning.strategy));
    CHECK(sum / static_cast<double>(hits.size()) == Approx(1.0).margin(0.03));
  }
}

TEST_CASE("even light on all of a surface leaves no part of it dark") {
  for (const int cells : {1, 7, 60}) {
    const Scene scene = plate_under({}, cells);
    const Photons photons = even_light(
        scene, [](const glm::vec3&) { return true; }, 100'000, 3);
    const SurfaceIndex surface = index_surface(scene, photons, 0.05, 60);
    CHECK(surface.unlit_regions.empty());
    CHECK(std::count(surface.dark.begin(), surface.dark.end(), 1) == 0);
  }
}

}  // namespace photile::test
