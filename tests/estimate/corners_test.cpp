// The area that an estimate divides by, at corners, on edges and at T-junctions of real meshes:
// there stored irradiance is looked up, and there rounding decides which side of an edge a point is
// on.
#include <catch2/catch.hpp>
#include <filesystem>

#include "oracle/clipped_area.hpp"
#include "photile/estimator.hpp"
#include "photile/neighbour_groups.hpp"
#include "photon_sets.hpp"
#include "shared_scenes.hpp"
#include "source_folder.hpp"
#include "test_device.hpp"

using namespace photile;

namespace {

constexpr int k = 50;

/// Metres from the place, towards the middle of the triangle. The last millimetre to a corner.
constexpr std::array steps = {0.0, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3};

/// A point of a triangle, approached from within.
struct Place {
  glm::vec3 position;
  std::uint32_t sided_triangle;
  const char* kind;
};

/// Every surface alike: diffuse, and no light has a layer of its own.
Scene plain(Scene scene) {
  for (Material& material : scene.materials) material = Material{};
  scene.lights.resize(1);
  scene.lights[0].kind = LightKind::point;
  scene.lights[0].triangles.clear();
  for (std::uint32_t& light : scene.triangle_light) light = none;
  return scene;
}

bool lies_on_edge(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b) {
  const double length = glm::distance(a, b);
  const double along = glm::dot(p - a, b - a) / length;
  if (!(along > 0.02 * length && along < 0.98 * length)) return false;
  return glm::length(p - a - (b - a) * (along / length)) < 1e-6 * (length + glm::length(p));
}

/// Corners, middles of edges and, where another triangle's corner lies on an edge, T-junctions.
std::vector<Place> places_of(const Scene& scene, std::size_t triangles, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<Place> places;
  for (std::size_t i = 0; i < triangles; ++i) {
    const auto t = static_cast<std::uint32_t>(
        triangles < scene.triangle_count() ? random() % scene.triangle_count() : i);
    if (t >= scene.triangle_count() || !(triangle_area(scene, t) > 0)) continue;
    const auto corners = scene.corners(t);
    const std::uint32_t own = sided(t, static_cast<std::uint32_t>(random() & 1));
    for (int c = 0; c < 3; ++c) {
      const glm::vec3 a = corners[c], b = corners[(c + 1) % 3];
      places.push_back({a, own, "corner"});
      places.push_back({0.5f * (a + b), own, "edge"});
      const glm::vec3 low = glm::min(a, b) - 1e-4f, high = glm::max(a, b) + 1e-4f;
      int found = 0;
      for (const glm::vec3& vertex : scene.vertices) {
        if (glm::any(glm::lessThan(vertex, low)) || glm::any(glm::greaterThan(vertex, high)) ||
            !lies_on_edge(vertex, a, b)) {
          continue;
        }
        places.push_back({vertex, own, "T-junction"});
        if (++found == 2) break;
      }
    }
  }
  return places;
}

class Shares {
 public:
  Shares(Scene scene, std::size_t photons)
      : scene_(plain(std::move(scene))),
        photons_(test::uniform_photons(scene_, photons, 161)),
        radius_(automatic_radius(photons_, k)) {
    photons_.flux.assign(photons_.size(), glm::vec3(1.0f));
    surface_ = std::make_shared<const SurfaceIndex>(
        index_surface(scene_, landed_on(scene_, photons_), radius_, 60));
    const NeighbourGroups groups =
        find_map_groups(scene_, photons_, MapMode::automatic, {radius_, 60});
    maps_.emplace(test::device(), scene_, photons_, groups, PhotonMapParameters{.radius = radius_});
    oracle_.emplace(scene_, photons_, *surface_, 60);
  }

  const Scene& scene() const { return scene_; }

  /// What the clipped area is of the whole disc; NaN where no photon lies in the slab, or one on
  /// its border. And the disc's radius.
  struct Share {
    double share, radius;
  };
  std::vector<Share> of(const PrimaryHits& hits) const {
    EstimateParameters parameters;
    parameters.neighbours = k;
    parameters.surface = surface_;
    Estimator estimator(*maps_, scene_, parameters);
    const Estimates estimates = estimator.estimate(hits);
    const NeighbourLists lists = estimator.nearest(hits);
    std::vector<Share> shares;
    for (std::size_t i = 0; i < hits.size(); ++i) {
      const double squared = lists.squared_radius[i];
      const double radius = std::sqrt(squared);
      const int counted = in_slab(hits, i, lists, radius);
      const double density = estimates.irradiance[i].g;
      const double area = counted / density;
      shares.push_back({counted > 0 ? area / (glm::pi<double>() * squared) : std::nan(""), radius});
    }
    return shares;
  }

  double expected(const Place& place, const glm::vec3& position, double radius) const {
    return oracle_->area(position, place.sided_triangle, radius) /
           (glm::pi<double>() * radius * radius);
  }

 private:
  /// Photons that count; 0 where rounding may tell.
  int in_slab(const PrimaryHits& hits, std::size_t i, const NeighbourLists& lists,
              double radius) const {
    const glm::dvec3 normal = sided_normal(scene_, hits.sided_triangle[i]);
    int counted = 0;
    double farthest = 0;
    bool farthest_counted = false;
    for (int n = 0; n < k; ++n) {
      const std::uint32_t photon = lists.photons[i * k + static_cast<std::size_t>(n)];
      if (photon == none) return 0;
      const glm::dvec3 offset =
          glm::dvec3(photons_.position[photon]) - glm::dvec3(hits.position[i]);
      const double height =
          std::abs(glm::dot(offset, normal)) / (radius * reference::ClippedArea::slab);
      if (std::abs(height - 1) < 1e-3) return 0;
      counted += height < 1;
      if (glm::length(offset) > farthest) {
        farthest = glm::length(offset);
        farthest_counted = height < 1;
      }
    }
    return counted - farthest_counted;  // the k-th sets the radius alone
  }

  Scene scene_;
  Photons photons_;
  double radius_;
  std::shared_ptr<const SurfaceIndex> surface_;
  std::optional<PhotonMaps> maps_;
  std::optional<reference::ClippedArea> oracle_;
};

void check_shares(Scene scene, std::size_t photons, std::size_t triangles,
                  std::size_t oracle_every) {
  const Shares shares(std::move(scene), photons);
  const std::vector<Place> places = places_of(shares.scene(), triangles, 162);
  PrimaryHits hits;
  for (const Place& place : places) {
    const auto corners = shares.scene().corners(triangle_of(place.sided_triangle));
    const glm::dvec3 middle =
        (glm::dvec3(corners[0]) + glm::dvec3(corners[1]) + glm::dvec3(corners[2])) / 3.0;
    const glm::dvec3 way = middle - glm::dvec3(place.position);
    for (const double step : steps) {
      const double part = std::min(step / glm::length(way), 1.0);
      hits.position.emplace_back(glm::dvec3(place.position) + way * part);
      hits.sided_triangle.push_back(place.sided_triangle);
      hits.diffuse_albedo.emplace_back(0.5f);
    }
  }
  hits.pixel.resize(hits.size());
  const auto all = shares.of(hits);
  std::size_t wrong = 0, compared = 0, counted = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Place& place = places[i / steps.size()];
    const auto& [share, radius] = all[i];
    if (std::isnan(share)) continue;
    ++counted;
    const double step = steps[i % steps.size()];
    const glm::vec3 p = hits.position[i];
    CAPTURE(place.kind, triangle_of(place.sided_triangle), p.x, p.y, p.z, step, radius, share);
    // Sharper corners than of 9 degrees are rare, and then they are the oracle's.
    const bool usual = share > 1 / 40.0 && share < 1.001;
    const double size = std::abs(p.x) + std::abs(p.y) + std::abs(p.z);
    const double rounding = 2e-3 + 4e-6 * size / radius;
    if (!usual || i % oracle_every == 0) {
      const double expected = shares.expected(place, p, radius);
      ++compared;
      const bool right = std::abs(share - expected) <= rounding;
      wrong += !right;
      if (wrong <= 20) CHECK(share == Approx(expected).margin(rounding));
    }
    const auto& [at_place, radius_there] = all[i / steps.size() * steps.size()];
    if (std::isnan(at_place)) continue;
    const bool steady = std::abs(share - at_place) <= rounding + 4 * step / radius;
    wrong += !steady;
    if (wrong <= 20) CHECK(share == Approx(at_place).margin(rounding + 4 * step / radius));
  }
  CAPTURE(places.size(), compared);
  CHECK(wrong == 0);
  CHECK(counted > all.size() / 4);
}

}  // namespace

TEST_CASE("areas at corners, edges and T-junctions of the bundled rooms are the oracle's") {
  const char* file = GENERATE("cornell-box/cornell-box.obj", "living-room/living-room.gltf");
  CAPTURE(file);
  check_shares(load_scene(test::source_folder() / "scenes" / file), 20'000, 40, 40);
}

TEST_CASE("areas at corners, edges and T-junctions of every bundled scene are the oracle's",
          "[slow]") {
  const char* file = GENERATE(
      "cornell-box/cornell-box-specular.gltf", "gallery/coloured-lamps.gltf",
      "gallery/downlights.gltf", "gallery/glass-sphere.gltf", "gallery/glossy-floor.gltf",
      "gallery/metal-ring.gltf", "gallery/sun-and-sky.gltf", "living-room/living-room.gltf");
  CAPTURE(file);
  check_shares(load_scene(test::source_folder() / "scenes" / file), 60'000, 400, 50);
}

TEST_CASE("areas at corners, edges and T-junctions of every shared scene are the oracle's",
          "[slow]") {
  if (!std::filesystem::exists(test::shared_scenes_folder() / "odd")) {
    WARN("skipped: no shared scenes");
    return;
  }
  for (const test::SharedScene& scene : test::shared_scenes) {
    if (!scene.refusal.empty()) continue;
    CAPTURE(scene.file);
    Scene loaded = test::load_shared_scene(scene);
    const bool interior = loaded.triangle_count() > 50'000;
    check_shares(std::move(loaded), interior ? 400'000 : 10'000, interior ? 1500 : 60,
                 interior ? 400 : 20);
  }
}
