// Nodes under things that stand on a floor: what is read beside these.
#include <catch2/catch.hpp>
#include <cmath>

#include "cache/node_sources.hpp"
#include "trace/ray_query.hpp"

namespace photile::test {
namespace {

constexpr float between_from = 0.5015f, between_to = 0.5035f;  ///< metres, along x

/// Two boxes on a floor of 1 m, with a slot between them that no node of 5 mm lies in.
Scene boxes_on_floor() {
  SceneBuilder builder;
  const std::uint32_t white = builder.add(diffuse(0.5f));
  builder.grid({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 2, white);
  builder.box({0.313f, 0.313f, 0.0f}, {between_from, 0.687f, 0.2f}, white, false);
  builder.box({between_to, 0.313f, 0.0f}, {0.687f, 0.687f, 0.2f}, white, false);
  return with_one_lamp(std::move(builder).build());
}

/// 10 lx where the sky is seen, and none under the boxes.
float open_floor(const glm::vec3& p, std::uint32_t) {
  const bool beside = p.x < 0.313f || p.x > 0.687f || p.y < 0.313f || p.y > 0.687f;
  const bool between = p.x > between_from && p.x < between_to;
  return beside || between ? 10.0f : 0.0f;
}

/// Two plates that lie 2 mm above the floor, 8 mm apart: in the slits below them it is dark.
Scene plates_above_floor() {
  SceneBuilder builder;
  const std::uint32_t white = builder.add(diffuse(0.5f));
  builder.grid({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 2, white);
  builder.box({0.2f, 0.2f, 0.002f}, {0.4963f, 0.8f, 0.02f}, white, true);
  builder.box({0.5043f, 0.2f, 0.002f}, {0.8f, 0.8f, 0.02f}, white, true);
  return with_one_lamp(std::move(builder).build());
}

/// 10 lx in the gap between the plates and beside them; knows how near these are.
class PlateSource : public cache::NodeSource {
 public:
  cache::NodeValues value(const cache::NodeBatch& batch, const Progress&) override {
    cache::NodeValues values{LightTable(1, false), {}, {}};
    for (const glm::vec3& p : batch.points.position) {
      const bool open =
          p.y < 0.2f || p.y > 0.8f || p.x < 0.2f || p.x > 0.8f || (p.x > 0.4963f && p.x < 0.5043f);
      values.light.irradiance.emplace_back(open ? 10.0f : 0.0f);
      values.error.push_back(0.0f);
      values.distance.push_back(open ? 1.0f : 0.003f);
    }
    return values;
  }
};

/// Floor triangles come first; the side that looks up.
std::uint32_t floor_under(const Scene& scene, const glm::vec3& p) {
  for (std::uint32_t t = 0; t < 8; ++t) {
    const auto corners = scene.corners(t);
    const glm::vec3 a = corners[0], b = corners[1], c = corners[2];
    const auto left = [&](const glm::vec3& from, const glm::vec3& to) {
      return glm::cross(to - from, p - from).z * glm::cross(b - a, c - a).z >= 0.0f;
    };
    if (left(a, b) && left(b, c) && left(c, a)) {
      return oriented(t, face_normal(scene, oriented(t, 0)).z > 0 ? 0 : 1);
    }
  }
  return none;
}

/// A scene on whose floor nodes are valued by a source, and what they tell of points there.
struct FloorNodes {
  FloorNodes(Scene things_on_floor, cache::NodeSource& source)
      : scene(std::move(things_on_floor)), rays(scene), maps(rays, quiet_parameters(), source) {}

  void add(float x, float y) { add_hit(hits, {x, y, 0}, floor_under(scene, {x, y, 0})); }
  cache::BilinearWeights around(std::size_t hit) const {
    cache::BilinearWeights bilinear;
    REQUIRE(maps.find(hits.oriented_face[hit], hits.position[hit], bilinear));
    return bilinear;
  }
  bool keep_visible(std::size_t hit, cache::BilinearWeights& bilinear) const {
    return maps.keep_visible(hits.oriented_face[hit], hits.position[hit], bilinear);
  }
  /// The nodes that the point sees give 10 lx.
  void check_bright(std::size_t hit) const {
    CAPTURE(hits.position[hit].x, hits.position[hit].y);
    cache::BilinearWeights bilinear = around(hit);
    REQUIRE(keep_visible(hit, bilinear));
    float light = 0, weight = 0;
    for (std::size_t corner = 0; corner < 4; ++corner) {
      light += bilinear.weight[corner] * maps.values().irradiance[bilinear.node[corner]].x;
      weight += bilinear.weight[corner];
    }
    CHECK(weight == Approx(1).epsilon(1e-5));
    CHECK(light == Approx(10).epsilon(1e-5));
  }

  const trace::FlushDenormals flush_denormals;
  const Scene scene;
  const RayScene rays;
  cache::LightMaps maps;
  PrimaryHits hits;
};

}  // namespace

TEST_CASE("light beside a box on the floor is that of the floor, not of what it stands on") {
  FormulaSource source(open_floor);
  FloorNodes floor(boxes_on_floor(), source);
  for (const float away : {0.0005f, 0.001f, 0.002f, 0.004f, 0.006f, 0.01f}) {
    for (float y = 0.32f; y < 0.68f; y += 0.0171f) {
      for (const float x : {0.313f - away, 0.687f + away}) floor.add(x, y);
    }
  }
  floor.maps.fill(floor.hits, Progress::none());
  std::size_t dark = 0;
  for (std::size_t i = 0; i < floor.hits.size(); ++i) {
    const float unseen = read(floor.maps, floor.hits.position[i], floor.hits.oriented_face[i]);
    if (unseen < 9.0f) ++dark;
    floor.check_bright(i);
  }
  CHECK(dark > floor.hits.size() / 4);  // where visibility is left out
}

TEST_CASE("a place in a slot sees none of the nodes under its sides") {
  FormulaSource source(open_floor);
  FloorNodes floor(boxes_on_floor(), source);
  for (float y = 0.35f; y < 0.65f; y += 0.0171f) floor.add(0.5f * (between_from + between_to), y);
  floor.maps.fill(floor.hits, Progress::none());
  for (std::size_t i = 0; i < floor.hits.size(); ++i) {
    cache::BilinearWeights bilinear = floor.around(i);
    const cache::BilinearWeights before = bilinear;
    CHECK_FALSE(floor.keep_visible(i, bilinear));
    CHECK(bilinear.weight == before.weight);
  }
}

TEST_CASE(
    "a gap between plates is as bright as its own nodes, not as those in the slits below them") {
  PlateSource source;
  FloorNodes floor(plates_above_floor(), source);
  for (float y = 0.35f; y < 0.65f; y += 0.0171f) {
    for (const float x : {0.4985f, 0.4995f, 0.5005f, 0.5015f}) floor.add(x, y);
  }
  floor.maps.fill(floor.hits, Progress::none());
  for (std::size_t i = 0; i < floor.hits.size(); ++i) floor.check_bright(i);
}

TEST_CASE("all nodes of open floor and of a bowl are seen") {
  const trace::FlushDenormals flush_denormals;
  // A strip that turns by 15 degrees over 20 cm, hollow above and vaulted below.
  SceneBuilder builder;
  const std::uint32_t white = builder.add(diffuse(0.5f));
  constexpr int steps = 30;
  const auto place = [](int i) {
    const double angle = glm::radians(15.0) * (static_cast<double>(i) / steps - 0.5);
    const double radius = 0.2 / glm::radians(15.0);
    return glm::vec3(radius * std::sin(angle), 0, radius * (1 - std::cos(angle)));
  };
  const glm::vec3 across(0, 0.2f, 0);
  for (int i = 0; i < steps; ++i) {
    builder.quad(place(i), place(i + 1), place(i + 1) + across, place(i) + across, white);
  }
  const Scene scene = with_one_lamp(std::move(builder).build());
  const RayScene rays(scene);
  // Uneven everywhere, so that all nodes are looked at.
  FormulaSource source([](const glm::vec3& p, std::uint32_t) { return std::exp(200 * p.y); });
  cache::LightMaps maps(rays, quiet_parameters(), source);
  const PrimaryHits hits = points_on(scene, 8);
  maps.fill(hits, Progress::none());
  for (std::size_t i = 0; i < hits.size(); ++i) {
    cache::BilinearWeights bilinear;
    REQUIRE(maps.find(hits.oriented_face[i], hits.position[i], bilinear));
    const cache::BilinearWeights before = bilinear;
    REQUIRE(maps.uneven(bilinear));
    REQUIRE(maps.keep_visible(hits.oriented_face[i], hits.position[i], bilinear));
    for (std::size_t corner = 0; corner < 4; ++corner) {
      CHECK(bilinear.weight[corner] == Approx(before.weight[corner]).epsilon(1e-5));
    }
  }
}

}  // namespace photile::test
