// Uniform irradiance reads 1 on every surface that ends in the open, is thin, folds, or lies close
// to another. Photons land where light would, uniformly; each mean is over 16 sets of photons.
#include <catch2/catch.hpp>
#include <functional>

#include "photile/estimator.hpp"
#include "photile/neighbour_groups.hpp"
#include "photon_sets.hpp"
#include "statistical_tests.hpp"
#include "test_device.hpp"
#include "test_scenes.hpp"

namespace photile::test {
namespace {

using Chosen = std::function<bool(const Scene&, std::uint32_t oriented_face)>;

/// Uniform points on the oriented faces chosen, together 1 lm/m2.
Photons photons_on(const Scene& scene, const Chosen& chosen, std::size_t count,
                   std::uint64_t seed) {
  std::vector<std::uint32_t> sides;
  std::vector<double> areas;
  for (std::uint32_t s = 0; s < 2 * scene.triangle_count(); ++s) {
    if (!chosen(scene, s)) continue;
    sides.push_back(s);
    areas.push_back(triangle_area(scene, triangle_of(s)));
  }
  const double total = std::accumulate(areas.begin(), areas.end(), 0.0);
  std::discrete_distribution<std::size_t> pick(areas.begin(), areas.end());
  std::mt19937_64 random(seed);
  Photons photons;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t s = sides[pick(random)];
    add_photon(photons, scene, random_point(scene, triangle_of(s), random), s, random);
  }
  photons.flux.assign(count, glm::vec3(static_cast<float>(total / static_cast<double>(count))));
  return sort_by_oriented_face(std::move(photons), 2 * scene.triangle_count());
}

struct Reading {
  Scene scene;
  Chosen lit;   ///< where photons land
  Chosen seen;  ///< where hits are
  std::function<bool(const glm::vec3&)> where = [](const glm::vec3&) { return true; };
  std::size_t photons = 20'000;
  double radius = 0.06;
  AreaMode area = AreaMode::clipped;
};

/// What landed where hits are, lm/m2: near 1, with the noise of how many photons did.
double landed_on_seen(const Reading& reading, const Photons& photons) {
  double landed = 0, area = 0;
  for (std::uint32_t s = 0; s < 2 * reading.scene.triangle_count(); ++s) {
    if (!reading.seen(reading.scene, s)) continue;
    landed += (photons.first_of[s + 1] - photons.first_of[s]) * double{photons.flux[0].g};
    area += triangle_area(reading.scene, triangle_of(s));
  }
  return landed / area;
}

/// Mean irradiance over the hits, one for each of 16 sets of photons.
std::vector<double> readings(Reading reading) {
  std::vector<double> means;
  reading.scene.lights.assign(1, point_light("lamp", glm::vec3(0.0f)));
  for (std::uint64_t seed = 1; seed <= 16; ++seed) {
    const Photons photons = photons_on(reading.scene, reading.lit, reading.photons, seed);
    const Photons points = photons_on(reading.scene, reading.seen, 6000, 100 + seed);
    PrimaryHits hits;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (!reading.where(points.position[i])) continue;
      add_grey_hit(hits, points.position[i], points.oriented_face[i]);
    }
    REQUIRE(hits.position.size() > 100);
    const PhotonMaps maps(
        device(), reading.scene, photons,
        find_map_groups(reading.scene, photons, MapMode::automatic, {reading.radius, 60}),
        {.radius = reading.radius});
    EstimateParameters parameters;
    parameters.area = reading.area;
    const LightTable estimates = Estimator(maps, reading.scene, parameters).estimate(hits);
    double sum = 0;
    for (const glm::vec3& irradiance : estimates.irradiance) sum += irradiance.g;
    means.push_back(sum / static_cast<double>(hits.position.size()) /
                    landed_on_seen(reading, photons));
  }
  return means;
}

bool upwards(const Scene& scene, std::uint32_t s) { return face_normal(scene, s).z > 0.9; }

/// The sides of a convex body round the origin that look outwards.
bool outwards(const Scene& scene, std::uint32_t s) {
  const auto corners = scene.corners(triangle_of(s));
  return glm::dot(face_normal(scene, s), glm::dvec3(corners[0] + corners[1] + corners[2])) > 0;
}

bool top(const Scene& scene, std::uint32_t s) { return upwards(scene, s) && outwards(scene, s); }

Scene box(const glm::vec3& size, int cells) {
  SceneBuilder builder;
  builder.box(-0.5f * size, 0.5f * size, builder.add(diffuse(0.5f)), false, cells);
  return builder.build();
}

}  // namespace

TEST_CASE("a uniformly lit plate reads 1 over all of it, borders and corners, for any triangles",
          "[long]") {
  for (const int cells : {1, 40}) {
    const Scene scene = plate(diffuse(0.5f), 1.0f, cells);
    CAPTURE(cells);
    CHECK_VERDICT(mean_is(readings({scene, upwards, upwards}), 1.0, 0.01));
    const auto border = [](const glm::vec3& p) {
      return std::max(std::abs(p.x), std::abs(p.y)) > 0.48f;
    };
    CHECK_VERDICT(mean_is(readings({scene, upwards, upwards, border}), 1.0, 0.06));
  }
}

TEST_CASE("whole discs read too little at the border of a plate") {
  Reading reading{plate(diffuse(0.5f), 1.0f, 1), upwards, upwards};
  reading.where = [](const glm::vec3& p) { return std::abs(p.x) > 0.49f; };
  reading.area = AreaMode::disc;
  for (const double mean : readings(reading)) CHECK(mean < 0.75);
}

TEST_CASE("thin plates of 1 to 20 mm read 1 on their faces: their insides count for nothing") {
  for (const float thickness : {0.001f, 0.005f, 0.02f}) {
    CAPTURE(thickness);
    CHECK_VERDICT(mean_is(readings({box({1.0f, 0.8f, thickness}, 4), outwards, top}), 1.0, 0.01));
  }
}

TEST_CASE("a curved shell of 5 mm, its inner side dark, reads 1", "[long][slow]") {
  // A cylinder of radius 20 cm and a smaller one within; on the outer one 1 lm/m2.
  Scene scene = empty_scene();
  constexpr int segments = 160;
  for (const float radius : {0.2f, 0.195f}) {
    const auto at = [&](int i, float z) {
      const float angle = glm::two_pi<float>() * static_cast<float>(i % segments) / segments;
      return glm::vec3(radius * std::cos(angle), radius * std::sin(angle), z);
    };
    for (int i = 0; i < segments; ++i) {
      for (int j = -40; j < 40; ++j) {
        const float low = 0.01f * static_cast<float>(j), high = 0.01f * static_cast<float>(j + 1);
        add_triangle(scene, at(i, low), at(i + 1, low), at(i + 1, high));
        add_triangle(scene, at(i, low), at(i + 1, high), at(i, high));
      }
    }
  }
  const auto outer = [](const Scene& of, std::uint32_t s) {
    const glm::vec3 corner = of.corners(triangle_of(s))[0];
    return outwards(of, s) && glm::length(glm::vec2(corner)) > 0.198f;
  };
  // What lies within the radius r on a cylinder of radius R is larger than the disc by
  // (r / R)^2 / 16 at most: 0.3% for the radius of 4 cm here.
  CHECK_VERDICT(mean_is(readings({scene, outer, outer}), 1.0, 0.015));
}

TEST_CASE("tiles on a floor read 1, in their middle and at the border of the floor") {
  SceneBuilder builder;
  const std::uint32_t white = builder.add(diffuse(0.5f));
  builder.grid({0, 0, -0.001f}, {1, 0, 0}, {0, 1, 0}, 1, white);
  for (int i = 0; i < 10; ++i) {
    for (int j = 0; j < 10; ++j) {
      builder.grid({0.1f * static_cast<float>(i), 0.1f * static_cast<float>(j), 0.001f},
                   {0.097f, 0, 0}, {0, 0.097f, 0}, 1, white);
    }
  }
  builder.add(point_light("lamp", glm::vec3(0.0f)));
  const Scene scene = builder.build();
  // Photons fall from above: on tiles, and on the floor in the joints between them.
  std::vector<double> means;
  for (std::uint64_t seed = 1; seed <= 16; ++seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<float> place(0.0f, 1.0f);
    std::vector<std::array<std::uint32_t, 2>> tiles(100, {none, none});
    std::array<std::uint32_t, 2> floor{none, none};
    for (std::uint32_t s = 0; s < 2 * scene.triangle_count(); ++s) {
      if (!upwards(scene, s)) continue;
      const auto c = scene.corners(triangle_of(s));
      const glm::vec3 middle = (c[0] + c[1] + c[2]) / 3.0f;
      const int index = static_cast<int>(middle.x * 10) * 10 + static_cast<int>(middle.y * 10);
      auto& pair = c[0].z < 0 ? floor : tiles[static_cast<std::size_t>(index)];
      (pair[0] == none ? pair[0] : pair[1]) = s;
    }
    const auto lands = [&](const std::array<std::uint32_t, 2>& pair, const glm::vec3& p) {
      const auto c = scene.corners(triangle_of(pair[0]));
      bool inside = true;
      const glm::vec3 n(face_normal(scene, oriented(triangle_of(pair[0]), 0)));
      for (int i = 0; i < 3; ++i) {
        inside &= glm::dot(glm::cross(n, c[(i + 1) % 3] - c[i]), p - c[i]) >= 0;
      }
      return inside ? pair[0] : pair[1];
    };
    Photons photons;
    PrimaryHits hits;
    constexpr int count = 20'000;
    for (int i = 0; i < count + 4000; ++i) {
      const float x = place(random), y = place(random);
      const bool joint = std::fmod(x, 0.1f) > 0.097f || std::fmod(y, 0.1f) > 0.097f;
      const auto index =
          static_cast<std::size_t>(static_cast<int>(x * 10) * 10 + static_cast<int>(y * 10));
      const glm::vec3 p(x, y, joint ? -0.001f : 0.001f);
      const std::uint32_t s = lands(joint ? floor : tiles[index], p);
      if (i < count) {
        add_photon(photons, scene, p, s, random);
      } else if (!joint) {
        add_grey_hit(hits, p, s);
      }
    }
    photons.flux.assign(count, glm::vec3(1.0f / count));
    photons = sort_by_oriented_face(std::move(photons), 2 * scene.triangle_count());
    const PhotonMaps maps(device(), scene, photons, find_neighbour_groups(scene, {0.06, 60}),
                          {.radius = 0.06});
    const LightTable estimates = Estimator(maps, scene, {}).estimate(hits);
    double sum = 0;
    for (const glm::vec3& irradiance : estimates.irradiance) sum += irradiance.g;
    means.push_back(sum / static_cast<double>(hits.position.size()));
  }
  // Without the exposure of the floor below, and the bound by the whole disc, they read 0.5. Of the
  // floor 64 points say how much lies in the joints: 3% of its area at most.
  CHECK_VERDICT(mean_is(means, 1.0, 0.04));
}

TEST_CASE("layers that coincide count once") {
  Scene scene = empty_scene();
  for (int layer = 0; layer < 3; ++layer) {
    add_plate(scene, {-0.5f, -0.5f, 0}, {1, 0, 0}, {0, 1, 0}, 4);
  }
  // Photons land on any of the layers: together 3 lm/m2 where each has 1.
  CHECK_VERDICT(mean_is(readings({scene, upwards, upwards}), 3.0, 0.03));
}

TEST_CASE("overlapping layers of which one catches the light read what they catch") {
  Scene scene = scene_of_plates({{{-0.5f, -0.5f, 0}, {1, 0, 0}, {0, 1, 0}, 1},
                                 {{-0.4f, -0.5f, 0}, {0.8f, 0, 0}, {0, 1, 0}, 3}});
  const auto first = [](const Scene& of, std::uint32_t s) {
    return upwards(of, s) && triangle_of(s) < 2;
  };
  CHECK_VERDICT(mean_is(readings({scene, first, first}), 1.0, 0.01));
}

TEST_CASE("inconsistent winding changes no reading") {
  Scene scene = box({1.0f, 0.8f, 0.01f}, 5);
  for (std::size_t t = 0; t < scene.triangle_count(); t += 2) {
    std::swap(scene.triangles[t].y, scene.triangles[t].z);
  }
  CHECK_VERDICT(mean_is(readings({scene, outwards, top}), 1.0, 0.01));
}

TEST_CASE("a bright table top does not bleed into a dark floor below, nor the floor into it") {
  // 5 cm apart, with a radius of 6 cm: the floor has half the irradiance of the table.
  SceneBuilder builder;
  const std::uint32_t white = builder.add(diffuse(0.5f));
  builder.grid({-0.5f, -0.5f, 0}, {1, 0, 0}, {0, 1, 0}, 2, white);
  builder.grid({-0.2f, -0.2f, 0.05f}, {0.4f, 0, 0}, {0, 0.4f, 0}, 2, white);
  Reading reading{builder.build(), upwards, upwards};
  reading.seen = [](const Scene& of, std::uint32_t s) {
    return upwards(of, s) && of.corners(triangle_of(s))[0].z > 0.04f;
  };
  reading.where = [](const glm::vec3& p) {
    return std::max(std::abs(p.x), std::abs(p.y)) > 0.18f;  // the table's border
  };
  reading.lit = [](const Scene& of, std::uint32_t s) {
    return upwards(of, s) && of.corners(triangle_of(s))[0].z > 0.04f;
  };
  CHECK_VERDICT(mean_is(readings(reading), 1.0, 0.04));
}

TEST_CASE("a uniformly lit plate reads its irradiance away from borders for any triangulation",
          "[long][slow]") {
  // N photons of flux 1 on 1 m2: irradiance N. By the law of the estimate, (k - 1) / (pi r_k^2) has
  // mean N and a standard deviation of N / sqrt(k - 2) for each independent point.
  constexpr std::size_t count = 200'000;
  constexpr int k = 50;
  constexpr double radius = 0.03;
  // 3 x 0.03 from the border lie 0.82^2 m2, in which about 0.67 N / k = 2680 points are
  // independent. The mean of all hits then has a deviation of 1 / sqrt(48 x 2680) = 0.28%; the bar
  // of 1% is 3.6 deviations wide.
  for (const int cells : {1, 2, 7, 22, 70}) {
    Scene scene = scene_of_plates({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, cells}});
    Photons photons = uniform_photons(scene, count, 71, false);
    photons.flux.assign(count, glm::vec3(1.0f));
    const PhotonMaps maps(device(), scene, photons, find_neighbour_groups(scene, {radius, 60}),
                          {radius, 4});
    const PrimaryHits all = uniform_hits(scene, 40'000, 72, false);
    const LightTable estimates = Estimator(maps, scene, {k, 0}).estimate(all);
    double sum = 0;
    std::size_t inner = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const glm::vec3 p = all.position[i];
      const float border = std::min({p.x, p.y, 1 - p.x, 1 - p.y});
      if (border < 0.09f) continue;
      sum += estimates.irradiance[i].g;
      ++inner;
    }
    CAPTURE(cells, 2 * cells * cells, inner);
    REQUIRE(inner > 20'000);
    CHECK(sum / static_cast<double>(inner) / count == Approx(1.0).margin(0.01));
  }
}

}  // namespace photile::test
