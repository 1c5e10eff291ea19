// Boxes near a box, against a look at each.
#include "geometry/box_tree.hpp"

#include <catch2/catch.hpp>
#include <set>
#include <vector>

#include "meshes.hpp"

namespace photile::test {
namespace {

std::vector<geometry::Box> random_boxes(std::size_t count, test::Uniform& uniform) {
  std::vector<geometry::Box> boxes(count);
  for (geometry::Box& box : boxes) {
    const glm::vec3 corner(uniform.point(0, 1));
    box.extend(corner);
    box.extend(corner + glm::vec3(uniform.point(0, 0.1)));
  }
  return boxes;
}

}  // namespace

TEST_CASE("a tree visits every box within the distance, each once") {
  const std::size_t count = GENERATE(1u, 2u, 5u, 100u, 20'000u);  // the last is built in parallel
  test::Uniform uniform(count);
  std::vector<geometry::Box> boxes = random_boxes(count, uniform);
  if (count == 100) boxes.assign(count, boxes.front());  // all in one place
  const geometry::BoxTree tree(boxes);
  for (const geometry::Box& query : random_boxes(50, uniform)) {
    constexpr float limit = 0.01f;
    std::vector<int> visits(count, 0);
    tree.visit_within(query, limit, [&](std::uint32_t box) {
      ++visits[box];
      return false;
    });
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const bool near = geometry::squared_distance(boxes[i], query) <= limit;
      if (visits[i] > 1 || (near && visits[i] == 0)) ++wrong;
    }
    CHECK(wrong == 0);
  }
}

TEST_CASE("a tree visits the boxes that overlap one, each once, and no others") {
  const std::size_t count = GENERATE(0u, 1u, 5u, 20'000u);
  test::Uniform uniform(count);
  const std::vector<geometry::Box> boxes = random_boxes(count, uniform);
  const geometry::BoxTree tree(boxes);
  std::vector<geometry::Box> queries = random_boxes(50, uniform);
  if (count > 0) queries.push_back(boxes.front());
  std::size_t wrong = 0, met = 0;
  for (const geometry::Box& query : queries) {
    std::vector<int> visits(count, 0);
    tree.visit_overlapping(boxes, query, [&](std::uint32_t box) { ++visits[box]; });
    for (std::size_t i = 0; i < count; ++i) {
      bool apart = false;
      for (int axis = 0; axis < 3; ++axis) {
        apart = apart || boxes[i].upper[axis] < query.lower[axis] ||
                query.upper[axis] < boxes[i].lower[axis];
      }
      if (visits[i] != (apart ? 0 : 1)) ++wrong;
      if (!apart) ++met;
    }
  }
  CHECK(wrong == 0);
  CHECK((met > 0) == (count > 0));
}

TEST_CASE("a tree without boxes visits none, and a visit that returns true is the last") {
  int visits = 0;
  const auto stop = [&](std::uint32_t) { return ++visits > 0; };
  geometry::Box everywhere;
  everywhere.extend(glm::vec3(-1e6f));
  everywhere.extend(glm::vec3(1e6f));
  geometry::BoxTree(std::vector<geometry::Box>{}).visit_within(everywhere, 1, stop);
  CHECK(visits == 0);
  test::Uniform uniform(1);
  geometry::BoxTree(random_boxes(30, uniform)).visit_within(everywhere, 1, stop);
  CHECK(visits == 1);
}

}  // namespace photile::test
