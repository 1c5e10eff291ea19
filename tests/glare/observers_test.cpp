// Eyes and their directions.
#include <catch2/catch.hpp>

#include "glare/measure_glare.hpp"

namespace photile::test {

using namespace photile::glare;

TEST_CASE("a grid has its directions along the axes of the plan, clockwise from ahead") {
  measuring::SensorGrid grid{"point", {{{1, 1.2, 2}, {0, 1, 0}}, {{2, 1.2, 2}, {0, 1, 0}}}, {}};
  const auto all = observers_on(grid, measuring::PlanAxes(), 4);
  REQUIRE(all.size() == 8);
  CHECK(all[0].name == "point 1, 0 degrees");
  CHECK(all[7].name == "point 2, 270 degrees");
  const glm::dvec3 directions[]{{0, 0, -1}, {1, 0, 0}, {0, 0, 1}, {-1, 0, 0}};
  for (std::size_t i = 0; i < 4; ++i) {
    CHECK(glm::distance(all[i].forward, directions[i]) < 1e-12);
    CHECK(glm::distance(all[i].up, glm::dvec3(0, 1, 0)) < 1e-12);
  }
  CHECK(all[4].position.x == 2);
}

TEST_CASE("eyes that look up or down have an up of their own, at a right angle") {
  for (const glm::dvec3& towards :
       {glm::dvec3(0, 1, 0), glm::dvec3(0, -1, 0), glm::dvec3(0, 1, -1)}) {
    const Observer observer = Observer::looking("eye", {0, 0, 0}, 3.0 * towards, {0, 1, 0});
    CHECK(glm::length(observer.forward) == Approx(1));
    CHECK(glm::length(observer.up) == Approx(1));
    CHECK(glm::dot(observer.forward, observer.up) == Approx(0).margin(1e-12));
  }
}

}  // namespace photile::test
