// Where glass encloses a volume, and where it is a sheet.
#include <catch2/catch.hpp>

#include "scene/scene_queries.hpp"
#include "test_scenes.hpp"

namespace photile::test {
namespace {

constexpr std::uint32_t pane = 1;  // material of the glass

/// A room at some distance from the world's origin, and what `add` puts into it.
template <class Add>
std::uint32_t open_edges(bool thin, const Add& add) {
  SceneBuilder builder;
  builder.add(diffuse(glm::vec3(0.5f)));
  builder.add(glass(1.5f, thin));
  builder.add(point_light("lamp", {101, 1, 2.5f}));
  builder.box({99, -1, 0}, {104, 4, 3}, 0, true);
  add(builder);
  const auto open = scene::open_edges_of_glass(builder.build());
  CHECK(open[0] == 0);
  return open[pane];
}

}  // namespace

TEST_CASE("a box of glass has no open edge, whatever its number of quads") {
  const int cells = GENERATE(1, 3);
  CHECK(open_edges(false, [&](SceneBuilder& builder) {
          builder.box({100, 0, 1}, {101.3f, 1, 1.7f}, pane, false, cells);
        }) == 0);
}

TEST_CASE("a sheet of solid glass is open along its outline, and thin glass may be a sheet") {
  const auto sheet = [](SceneBuilder& builder) {
    builder.grid({100, 0, 1}, {1, 0, 0}, {0, 0.3f, 1}, 2, pane);
  };
  CHECK(open_edges(false, sheet) == 8);
  CHECK(open_edges(true, sheet) == 0);
}

TEST_CASE("a box of glass without a lid is open along its rim") {
  CHECK(open_edges(false, [](SceneBuilder& builder) {
          builder.grid({100, 0, 1}, {0, 1, 0}, {1, 0, 0}, 1, pane);
          builder.grid({100, 0, 1}, {1, 0, 0}, {0, 0, 1}, 1, pane);
          builder.grid({100, 1, 1}, {0, 0, 1}, {1, 0, 0}, 1, pane);
          builder.grid({100, 0, 1}, {0, 0, 1}, {0, 1, 0}, 1, pane);
          builder.grid({101, 0, 1}, {0, 1, 0}, {0, 0, 1}, 1, pane);
        }) == 4);
}

TEST_CASE("six quads that share neither corners nor their cuts are a closed box") {
  // Some 15 microns apart, and cut into 1 to 6 x 6 cells each, so that no corner meets another's.
  CHECK(open_edges(false, [](SceneBuilder& builder) {
          const float gap = 1.5e-5f;
          builder.grid({100, 0, 1 - gap}, {0, 1, 0}, {1, 0, 0}, 1, pane);
          builder.grid({100, 0, 2 + gap}, {1, 0, 0}, {0, 1, 0}, 2, pane);
          builder.grid({100, -gap, 1}, {1, 0, 0}, {0, 0, 1}, 3, pane);
          builder.grid({100, 1 + gap, 1}, {0, 0, 1}, {1, 0, 0}, 4, pane);
          builder.grid({100 - gap, 0, 1}, {0, 0, 1}, {0, 1, 0}, 5, pane);
          builder.grid({101 + gap, 0, 1}, {0, 1, 0}, {0, 0, 1}, 6, pane);
        }) == 0);
}

}  // namespace photile::test
