// Photons without a scene, against brute force in double precision.
#include "photile/photon_cloud.hpp"

#include <catch2/catch.hpp>
#include <glm/gtc/constants.hpp>
#include <limits>
#include <random>

#include "oracle/rounding.hpp"
#include "photile/errors.hpp"
#include "photile/neighbours.h"
#include "test_device.hpp"

namespace photile::test {
namespace {

using Catch::Contains;
using reference::tie;  // what single precision may order either way
using Points = std::vector<glm::vec3>;

/// Photons and the points that ask for them.
struct Cloud {
  Points position, normal, flux;
  std::vector<std::uint16_t> light;
  Points points, point_normals;

  CloudPhotons photons() const { return {position, normal, flux, light}; }
};

struct Neighbour {
  double squared_distance;
  std::uint32_t photon;
  auto operator<=>(const Neighbour&) const = default;
};

/// All photons within the radius of a point whose normals agree, nearest first.
std::vector<Neighbour> neighbours_of(const Cloud& cloud, std::size_t point, double radius,
                                     double angle_degrees) {
  std::vector<Neighbour> result;
  for (std::uint32_t i = 0; i < cloud.position.size(); ++i) {
    const glm::dvec3 offset = glm::dvec3(cloud.position[i]) - glm::dvec3(cloud.points[point]);
    const double squared = glm::dot(offset, offset);
    const bool agrees =
        cloud.normal.empty() ||
        normals_agree(glm::dvec3(cloud.normal[i]), glm::dvec3(cloud.point_normals[point]),
                      std::cos(glm::radians(angle_degrees)));
    if (squared <= radius * radius && agrees) result.push_back({squared, i});
  }
  std::sort(result.begin(), result.end());
  return result;
}

/// Points whose neighbours are not the k nearest, or not in the order of their distances.
std::size_t count_wrong(const Cloud& cloud, const CloudNeighbours& found, double radius,
                        double angle_degrees) {
  const auto k = static_cast<std::size_t>(found.k);
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const std::vector<Neighbour> within =
        neighbours_of(cloud, i, radius * (1 + tie), angle_degrees);
    const std::size_t most = std::min(k, within.size());
    const std::size_t least = std::min<std::size_t>(
        k, static_cast<std::size_t>(std::count_if(within.begin(), within.end(), [&](const auto& n) {
          return n.squared_distance <= radius * radius * (1 - tie);
        })));
    std::size_t count = 0;
    bool right = true;
    for (; count < k && found.photons[i * k + count] != none; ++count) {
      const std::uint32_t photon = found.photons[i * k + count];
      const auto it = std::find_if(within.begin(), within.end(),
                                   [&](const Neighbour& n) { return n.photon == photon; });
      const float squared = found.squared_distance[i * k + count];
      right &= it != within.end() && squared == static_cast<float>(it->squared_distance) &&
               it->squared_distance <= within[most - 1].squared_distance * (1 + tie);
      right &= count == 0 || squared >= found.squared_distance[i * k + count - 1];
    }
    for (std::size_t j = count; j < k; ++j) {
      right &= found.photons[i * k + j] == none && std::isinf(found.squared_distance[i * k + j]);
    }
    std::vector<std::uint32_t> row(
        found.photons.begin() + static_cast<std::ptrdiff_t>(i * k),
        found.photons.begin() + static_cast<std::ptrdiff_t>(i * k + count));
    std::sort(row.begin(), row.end());
    right &= std::adjacent_find(row.begin(), row.end()) == row.end();
    right &= count >= least && count <= most;
    wrong += !right;
  }
  return wrong;
}

/// Photons of a cell of the grids: as usual, and one cell for all.
constexpr std::array cells{defaults::photons_per_cell, 1e12f};

void check_neighbours(const Cloud& cloud, double radius, std::initializer_list<int> ks,
                      double angle_degrees = 60) {
  for (const float photons_per_cell : cells) {
    PhotonCloud maps(device(), cloud.photons(), {radius, angle_degrees, photons_per_cell});
    for (const int k : ks) {
      CAPTURE(photons_per_cell, k, radius, cloud.position.size());
      const CloudNeighbours found = maps.nearest(cloud.points, cloud.point_normals, k);
      REQUIRE(found.photons.size() == cloud.points.size() * static_cast<std::size_t>(k));
      CHECK(count_wrong(cloud, found, radius, angle_degrees) == 0);
    }
  }
  for (const double most : {radius, std::numeric_limits<double>::infinity()}) {
    for (const int k : ks) {
      if (cloud.position.empty()) continue;
      CAPTURE(k, most, cloud.position.size());
      const NeighbourSearch search{cloud.position,      cloud.points, k, most, cloud.normal,
                                   cloud.point_normals, angle_degrees};
      CHECK(count_wrong(cloud, find_neighbours(device(), search), most, angle_degrees) == 0);
    }
  }
}

glm::vec3 random_direction(std::mt19937_64& random) {
  std::normal_distribution<float> normal;
  const float x = normal(random), y = normal(random), z = normal(random);
  return glm::normalize(glm::vec3(x, y, z));
}

glm::vec3 random_place(std::mt19937_64& random, const glm::vec3& low, const glm::vec3& high) {
  std::uniform_real_distribution<float> uniform;
  const float x = uniform(random), y = uniform(random), z = uniform(random);
  return low + glm::vec3(x, y, z) * (high - low);
}

/// Photons on both sides of a sphere's surface, asked for on the surface and off it.
Cloud sphere(std::size_t photons, std::size_t points, const glm::vec3& centre, float radius) {
  std::mt19937_64 random(5);
  Cloud cloud;
  for (std::size_t i = 0; i < photons + points; ++i) {
    const glm::vec3 direction = random_direction(random);
    const bool is_photon = i < photons;
    const float off = is_photon || i % 2 == 0 ? 1.0f : 1.03f;
    (is_photon ? cloud.position : cloud.points).push_back(centre + off * radius * direction);
    (is_photon ? cloud.normal : cloud.point_normals).push_back(i % 3 == 0 ? -direction : direction);
  }
  return cloud;
}

/// Photons all through a box.
Cloud fog(std::size_t photons, std::size_t points, const glm::vec3& low, const glm::vec3& high) {
  std::mt19937_64 random(6);
  Cloud cloud;
  for (std::size_t i = 0; i < photons; ++i) {
    cloud.position.push_back(random_place(random, low, high));
  }
  const glm::vec3 border = 0.2f * (high - low);
  for (std::size_t i = 0; i < points; ++i) {
    cloud.points.push_back(random_place(random, low - border, high + border));
  }
  return cloud;
}

}  // namespace

TEST_CASE("every structure finds the nearest photons on both sides of a sphere, by normals") {
  const Cloud cloud = sphere(6000, 300, {1, -2, 3}, 0.8f);
  check_neighbours(cloud, 0.1, {1, 7, 50, 300});
  check_neighbours(cloud, 0.4, {20}, 0);
  check_neighbours(cloud, 0.4, {20}, 120);
  check_neighbours(cloud, 3.0, {20}, 180);
}

TEST_CASE("every structure finds the nearest photons in a volume, without normals") {
  check_neighbours(fog(5000, 300, {-1, -1, -1}, {1, 1, 1}), 0.15, {1, 9, 40});
  check_neighbours(fog(3000, 200, {-1, -1, -1}, {1, 1, 1}), 50, {16});
  check_neighbours(fog(3000, 200, {-100, 0, 0}, {100, 0.1f, 0.1f}), 0.3, {16});
}

TEST_CASE("photons in one point are all found, and none twice") {
  std::mt19937_64 random(7);
  Cloud cloud = fog(100, 50, {0, 0, 0}, {1, 1, 1});
  cloud.position.insert(cloud.position.end(), 3000, glm::vec3(0.5f));
  cloud.points.emplace_back(0.5f);
  check_neighbours(cloud, 0.3, {1, 50, 4000});
}

TEST_CASE("no photons, one photon, and fewer than k") {
  Cloud cloud = fog(0, 20, {0, 0, 0}, {1, 1, 1});
  check_neighbours(cloud, 0.5, {1, 8});
  PhotonCloud empty(device(), cloud.photons(), {.radius = 0.5});
  const std::vector<glm::vec3> dark = empty.irradiance(cloud.points, {}).irradiance;
  CHECK(dark == Points(20, glm::vec3(0)));
  CHECK(empty.nearest({}, {}, 3).photons.empty());
  cloud.position = {{0.5f, 0.5f, 0.5f}};
  check_neighbours(cloud, 0.5, {1, 8});
  cloud.position.emplace_back(0.4f, 0.4f, 0.4f);
  check_neighbours(cloud, 0.5, {1, 1000});
}

TEST_CASE("photons a thousand kilometres off are found as others are") {
  const glm::vec3 far(1e6f, -1e6f, 1e6f);
  check_neighbours(fog(2000, 200, far, far + 40.0f), 8, {1, 20});
  check_neighbours(sphere(2000, 200, far, 20), 5, {1, 20});
  Cloud both = fog(1000, 100, {-1, -1, -1}, {1, 1, 1});
  const Cloud other = fog(1000, 100, far, far + 4.0f);
  both.position.insert(both.position.end(), other.position.begin(), other.position.end());
  both.points.insert(both.points.end(), other.points.begin(), other.points.end());
  check_neighbours(both, 0.3, {10});
}

TEST_CASE("irradiance is the flux of the k - 1 nearest over the disc through the k-th, per light") {
  Cloud cloud = sphere(5000, 200, {0, 0, 0}, 1);
  std::mt19937_64 random(8);
  for (std::size_t i = 0; i < cloud.position.size(); ++i) {
    cloud.flux.push_back(random_place(random, glm::vec3(0), glm::vec3(1)));
    cloud.light.push_back(static_cast<std::uint16_t>(random() % 3));
  }
  constexpr double radius = 0.12;
  for (const float photons_per_cell : cells) {
    PhotonCloud maps(device(), cloud.photons(),
                     {.radius = radius, .photons_per_cell = photons_per_cell});
    for (const int k : {20, 400}) {
      CAPTURE(photons_per_cell, k);
      const LightTable found =
          maps.irradiance(cloud.points, cloud.point_normals, {.neighbours = k});
      REQUIRE(found.irradiance.size() == 3 * cloud.points.size());
      std::size_t wrong = 0;
      for (std::size_t i = 0; i < cloud.points.size(); ++i) {
        const std::vector<Neighbour> near = neighbours_of(cloud, i, radius, 60);
        const bool full = near.size() >= static_cast<std::size_t>(k);
        const std::size_t counted = full ? static_cast<std::size_t>(k) - 1 : near.size();
        const double squared = full ? near[counted].squared_distance : radius * radius;
        std::array<glm::dvec3, 3> expected{};
        for (std::size_t j = 0; j < counted; ++j) {
          const std::uint32_t photon = near[j].photon;
          expected[cloud.light[photon]] +=
              glm::dvec3(cloud.flux[photon]) / (glm::pi<double>() * squared);
        }
        for (std::size_t light = 0; light < 3; ++light) {
          const glm::dvec3 got(found.irradiance[3 * i + light]);
          wrong += glm::length(got - expected[light]) > 1e-5 * (1 + glm::length(expected[light]));
        }
      }
      CHECK(wrong == 0);
    }
  }
}

TEST_CASE("without flux the irradiance is the density of photons") {
  std::mt19937_64 random(9);
  Cloud cloud;
  for (int i = 0; i < 40'000; ++i) {
    cloud.position.push_back(random_place(random, {-1, -1, 0}, {1, 1, 0}));
  }
  cloud.points = {{0, 0, 0}};
  PhotonCloud maps(device(), cloud.photons(), {.radius = 0.5});
  // 4000 photons scatter by 1.6%.
  CHECK(maps.irradiance(cloud.points, {}, {.neighbours = 4000}).irradiance[0].g ==
        Approx(10'000).epsilon(0.08));
}

TEST_CASE("a device with little memory finds the same neighbours") {
  const Cloud cloud = fog(20'000, 200, {-1, -1, -1}, {1, 1, 0});
  PhotonCloud maps(device(), cloud.photons(), {.radius = 0.2});
  DeviceOptions options;
  options.memory_bytes = 400'000;
  Device small(options);
  PhotonCloud paged(small, cloud.photons(), {.radius = 0.2});
  CHECK(paged.statistics().pages > maps.statistics().pages);
  const CloudNeighbours all = maps.nearest(cloud.points, {}, 30);
  const CloudNeighbours parts = paged.nearest(cloud.points, {}, 30);
  CHECK(all.photons == parts.photons);
  CHECK(all.squared_distance == parts.squared_distance);
}

TEST_CASE("what is wrong with photons or points is said in one line") {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const Cloud whole = sphere(10, 5, {0, 0, 0}, 1);
  const auto refuse = [&](const auto& change, const char* reason) {
    Cloud cloud = whole;
    change(cloud);
    CHECK_THROWS_WITH(PhotonCloud(device(), cloud.photons(), {.radius = 0.1}), Contains(reason));
  };
  refuse([&](Cloud& c) { c.position[3].y = nan; }, "photon 3 lies at");
  refuse([&](Cloud& c) { c.position[4].x = 1e13f; }, "photon 4 lies at");
  refuse([&](Cloud& c) { c.normal[5] *= 2; }, "photon 5 has a normal of length 2");
  refuse([&](Cloud& c) { c.normal[5] *= 1.002f; }, "photon 5 has a normal of length 1.002");
  Cloud rounded = whole;
  rounded.normal[5] *= 1.0005f;  // as normals of half precision are
  CHECK_NOTHROW(PhotonCloud(device(), rounded.photons(), {.radius = 0.1}));
  refuse([&](Cloud& c) { c.normal[5].z = nan; }, "photon 5 has a normal of length nan");
  refuse([&](Cloud& c) { c.normal.pop_back(); }, "9 normals for 10 photons");
  refuse([&](Cloud& c) { c.light.resize(3); }, "3 lights for 10 photons");
  refuse([&](Cloud& c) { c.flux.resize(10, glm::vec3(nan)); }, "photon 0 has a flux");
  refuse([&](Cloud& c) { c.light.resize(10, 65'000); }, "light 65000");
  for (const double radius : {0.0, -1.0, double{nan}, std::numeric_limits<double>::infinity()}) {
    CHECK_THROWS_AS(PhotonCloud(device(), whole.photons(), {.radius = radius}), UsageError);
  }
  CHECK_THROWS_AS(PhotonCloud(device(), whole.photons(), {.radius = 1, .angle_degrees = -1}),
                  UsageError);
  PhotonCloud maps(device(), whole.photons(), {.radius = 0.1});
  CHECK_THROWS_WITH(maps.nearest(whole.points, {}, 3), Contains("0 normals for 5 points"));
  CHECK_THROWS_AS(maps.nearest(whole.points, whole.point_normals, 0), UsageError);
  CHECK_THROWS_AS(maps.nearest(whole.points, whole.point_normals, 3, 0.2), UsageError);
  Points bad = whole.points;
  bad[2].z = nan;
  CHECK_THROWS_WITH(maps.nearest(bad, whole.point_normals, 3), Contains("point 2 lies at"));
  Cloud flat = whole;
  flat.normal.clear();
  PhotonCloud plain(device(), flat.photons(), {.radius = 0.1});
  CHECK_THROWS_WITH(plain.nearest(flat.points, flat.point_normals, 3),
                    Contains("the photons have none"));
}

TEST_CASE("C gets the neighbours that C++ gets, and errors as a status and a line") {
  const Cloud cloud = fog(2000, 100, {-1, -1, -1}, {1, 1, 1});
  photile_device* opened = nullptr;
  CHECK(photile_open_device("no such device", &opened) == PHOTILE_DEVICE_ERROR);
  REQUIRE(photile_open_device(nullptr, &opened) == PHOTILE_OK);
  std::vector<std::uint32_t> indices(800);
  std::vector<float> distances(800);
  const auto find = [&](std::size_t count, int k, float most = INFINITY) {
    return photile_find_neighbours(opened, &cloud.position[0].x, count, &cloud.points[0].x, 100, k,
                                   most, indices.data(), distances.data());
  };
  REQUIRE(find(2000, 8) == PHOTILE_OK);
  const CloudNeighbours expected = find_neighbours(device(), {cloud.position, cloud.points, 8});
  CHECK(indices == expected.photons);
  CHECK(distances[799] == std::sqrt(expected.squared_distance[799]));
  REQUIRE(find(3, 8) == PHOTILE_OK);
  CHECK((indices[2] < 3 && indices[3] == 3 && std::isinf(distances[3])));
  CHECK(find(3, 0) == PHOTILE_BAD_INPUT);
  CHECK(find(3, 8, NAN) == PHOTILE_BAD_INPUT);
  CHECK(find(0, 8) == PHOTILE_BAD_INPUT);
  CHECK_THAT(photile_last_error(), Contains("no points"));
  photile_close_device(opened);
}

}  // namespace photile::test
