// Distances to the m-th nearest photon, against all distances sorted.
#include <algorithm>
#include <catch2/catch.hpp>
#include <vector>

#include "groups/automatic_radius.hpp"
#include "meshes.hpp"

namespace photile::test {
namespace {

/// Sheets, a dense lump, points that coincide, and one far away.
std::vector<glm::vec3> uneven_positions(std::size_t count) {
  test::Uniform uniform(count);
  std::vector<glm::vec3> positions;
  for (std::size_t i = 0; i < count; ++i) {
    const glm::vec3 point(uniform.point(0, 4));
    positions.push_back(i % 4 == 0   ? glm::vec3(point.x, point.y, 0)
                        : i % 4 == 1 ? glm::vec3(0, point.y, point.z)
                        : i % 4 == 2 ? glm::vec3(1) + 1e-3f * point
                                     : glm::vec3(2, 3, 0));
  }
  positions.back() = glm::vec3(1e4f);
  return positions;
}

}  // namespace

TEST_CASE("the m-th nearest photon is that of all distances sorted") {
  const std::size_t count = GENERATE(2u, 31u, 1000u, 20'000u);
  const std::vector<glm::vec3> positions = uneven_positions(count);
  const groups::PhotonBlocks blocks(positions, count);
  REQUIRE(blocks.size() == count);
  std::vector<float> scratch;
  for (std::size_t i = 0; i < count; i += std::max<std::size_t>(1, count / 50)) {
    std::vector<double> squared;
    for (const glm::vec3& position : positions) {
      const glm::dvec3 offset = glm::dvec3(position) - glm::dvec3(positions[i]);
      squared.push_back(glm::dot(offset, offset));
    }
    std::sort(squared.begin(), squared.end());
    for (const std::size_t m : {std::size_t{1}, count / 20, count / 2, count - 1}) {
      CAPTURE(count, i, m);
      CHECK(blocks.squared_distance(i, m, scratch) == Approx(squared[m]).epsilon(1e-5));
    }
  }
}

TEST_CASE("of more positions than wanted those in equal steps are taken") {
  std::vector<glm::vec3> positions;
  for (int i = 0; i < 100; ++i) positions.emplace_back(i, 0, 0);
  const groups::PhotonBlocks blocks(positions, 10);  // 5, 15, ... 95
  CHECK(blocks.size() == 10);
  std::vector<float> scratch;
  CHECK(blocks.squared_distance(0, 1, scratch) == 100);
  CHECK(blocks.squared_distance(9, 9, scratch) == 8100);
}

}  // namespace photile::test
