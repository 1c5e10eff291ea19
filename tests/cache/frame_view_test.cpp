// Light between nodes while others are lacking: without steps, spots and squares.
#include "cache/frame_view.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <optional>

#include "cache/node_sources.hpp"

namespace photile::test {
namespace {

constexpr int points_per_side = 400;
constexpr float floor_side = 4.0f;

/// Cells of all sizes have corners that differ.
float rising_light(const glm::vec3& p, std::uint32_t) { return std::exp(2 * p.x + p.y); }

/// A square floor, and a number for the surroundings of each node.
class FloorSource : public FormulaSource {
 public:
  using FormulaSource::FormulaSource;
  cache::NodeValues value(const cache::NodeBatch& batch, const Progress& progress) override {
    cache::NodeValues values = FormulaSource::value(batch, progress);
    for (std::size_t node = 0; node < batch.nodes; ++node) {
      values.error.push_back(0);
      values.distance.push_back(surroundings(batch.points.position[node]));
    }
    return values;
  }
  std::function<float(const glm::vec3&)> surroundings = [](const glm::vec3&) { return 10.0f; };
};

struct Floor {
  explicit Floor(FormulaSource::Formula light, int levels = 4)
      : scene(with_one_lamp(floor_scene())),
        rays(scene),
        source(std::move(light)),
        maps(rays, quiet_parameters(0.5, levels), source) {}

  static Scene floor_scene() {
    Scene scene = plate(diffuse(0.5f), floor_side);
    for (glm::vec3& position : scene.vertices)
      position += glm::vec3(0.5f * floor_side, 0.5f * floor_side, 0);
    return scene;
  }

  /// Fills what is needed where x lies in [from, to].
  void fill(float from, float to, int levels) {
    PrimaryHits hits;
    for_points([&](float x, float y) {
      if (x >= from && x <= to) add_hit(hits, {x, y, 0}, oriented(0, 0));
    });
    maps.fill(hits, Progress::none(), levels);
  }

  template <class Visit>
  void for_points(const Visit& visit) const {
    for (int i = 0; i < points_per_side; ++i) {
      for (int j = 0; j < points_per_side; j += 10) {
        const float x = floor_side * (static_cast<float>(i) + 0.5f) / points_per_side;
        const float y = floor_side * (static_cast<float>(j) + 0.27f) / points_per_side;
        visit(x, y);
      }
    }
  }

  float own(float x, float y) const {
    cache::BilinearWeights bilinear;
    maps.find(oriented(0, 0), {x, y, 0}, bilinear);
    const auto part = [&](std::size_t i) {
      return bilinear.weight[i] * maps.values().irradiance[bilinear.node[i]].x;
    };
    return (part(0) + part(1)) + (part(2) + part(3));
  }
  std::optional<glm::vec3> read(float x, float y) const {
    bool lacks = false, softened = false;
    return view.irradiance(oriented(0, 0), {x, y, 0}, 0, lacks, softened);
  }
  float shown(float x, float y) const {
    const auto light = read(x, y);
    REQUIRE(light);
    return light->x;
  }
  void mix(bool soft = false) { view.mix(std::vector{glm::vec3(1.0f)}, soft); }
  /// Shows all of the floor, and softens it from the next mix on where it lacks nodes. Returns
  /// whether that makes a difference.
  bool soften() {
    mix();
    view.end_picture();  // that of all points that were read before
    for_points([&](float x, float y) { read(x, y); });
    view.end_picture();
    view.show_complete();
    return view.soften();
  }

  /// The largest difference, relative to the light, between points so close that smooth light has
  /// none.
  float largest_step(float (Floor::*light)(float, float) const) const {
    constexpr float apart = 1e-4f;
    float largest = 0;
    for_points([&](float x, float y) {
      // Borders of cells of all sizes lie at multiples of the smallest.
      const float border = std::round(x / 0.0625f) * 0.0625f;
      if (border < apart || border > floor_side - apart) return;
      const float before = (this->*light)(border - 0.5f * apart, y);
      const float after = (this->*light)(border + 0.5f * apart, y);
      largest = std::max(largest, std::abs(after - before) / before);
    });
    return largest;
  }

  const Scene scene;
  const RayScene rays;
  FloorSource source;
  cache::LightMaps maps;
  cache::FrameView view{scene, maps};
};

}  // namespace

TEST_CASE("Between cells that have their nodes and cells that lack them there is no step") {
  Floor floor(rising_light);
  floor.fill(0, floor_side, 1);
  REQUIRE(floor.soften());
  floor.fill(0, 1.7f, 2);  // in part, to levels of several kinds
  floor.fill(0, 1.2f, 8);
  floor.mix();
  CHECK(floor.largest_step(&Floor::own) > 0.03f);
  CHECK(floor.largest_step(&Floor::shown) < 0.001f);  // it rises by two a metre

  floor.fill(0, floor_side, 8);
  REQUIRE(floor.soften());
  floor.mix();
  floor.for_points([&](float x, float y) { REQUIRE(floor.shown(x, y) == floor.own(x, y)); });
}

TEST_CASE("Soft light has no step at cells that are larger because their corners agree") {
  // A ridge between nodes of the coarsest level, that ends at a border of cells.
  Floor floor([](const glm::vec3& p, std::uint32_t) {
    const float across = std::max(0.0f, 1 - 8 * std::abs(p.y - 2.25f));
    return 1 + across * std::clamp(4 * (2.25f - p.x), 0.0f, 1.0f) + (p.x < 1.6f ? 4 * p.y : 2.0f);
  });
  floor.fill(0, floor_side, 8);
  floor.soften();
  REQUIRE(floor.view.lacking() == 0);
  floor.mix(true);
  CHECK(floor.largest_step(&Floor::own) > 0.1f);
  CHECK(floor.largest_step(&Floor::shown) < 0.02f);
}

TEST_CASE("Nodes that are shut in count for little around them while others are lacking") {
  const float middle = GENERATE(2.0f, 2.25f);  // of one node, or of a cell with all its corners
  const auto is_shut_in = [&](const glm::vec3& p) {
    return glm::length(p - glm::vec3(middle, middle, 0)) < 0.4f;
  };
  Floor floor([&](const glm::vec3& p, std::uint32_t) { return is_shut_in(p) ? 0.0f : 1.0f; });
  floor.source.surroundings = [&](const glm::vec3& p) { return is_shut_in(p) ? 0.005f : 10.0f; };
  floor.fill(0, floor_side, 1);
  REQUIRE(floor.soften());
  floor.mix();
  CHECK(floor.own(2.2f, 2.2f) < 0.7f);
  CHECK(floor.shown(2.2f, 2.2f) > 0.8f);
}

TEST_CASE("A node that is far brighter than all around it is dimmed while others are lacking") {
  Floor floor([](const glm::vec3& p, std::uint32_t) {
    return glm::length(p - glm::vec3(2, 2, 0)) < 0.1f ? 100.0f : 1.0f;
  });
  floor.fill(0, floor_side, 1);
  REQUIRE(floor.soften());
  floor.mix();
  std::vector<float> shown;
  for (std::uint32_t node = 0; node < floor.maps.statistics().nodes; ++node) {
    const glm::vec3& at = floor.maps.point(node).position;
    shown.push_back(floor.shown(at.x, at.y));
  }
  const auto [least, most] = std::minmax_element(shown.begin(), shown.end());
  CHECK(*least == Approx(1.0f));
  CHECK(*most == Approx(3.0f).epsilon(0.01));  // nodes may be moved by millimetres
}

}  // namespace photile::test
