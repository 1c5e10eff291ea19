// Clicked points against closed forms, and what is kept of them.
#include <catch2/catch.hpp>
#include <chrono>
#include <glm/gtc/constants.hpp>
#include <thread>

#include "photile/defaults.hpp"
#include "test_scenes.hpp"
#include "view/light_board.hpp"
#include "view/point_worker.hpp"

namespace photile::test {
namespace {

using namespace photile::view;

/// A black floor at z = 0 under two lamps without size.
Scene floor() {
  SceneBuilder builder("floor");
  builder.grid({-5, -5, 0}, {10, 0, 0}, {0, 10, 0}, 1, builder.add(diffuse(glm::vec3(0))));
  builder.add(point_light("near", {0, 0, 2}, 100));
  builder.add(point_light("far", {3, 0, 4}, 400));
  return builder.build();
}

/// The points once all have so many repeats.
std::vector<ClickedPoint> wait_for(const PointWorker& worker, std::size_t repeats) {
  for (int i = 0; i < 6000; ++i) {
    const auto points = worker.points();
    const bool done = std::all_of(points.begin(), points.end(), [&](const ClickedPoint& point) {
      return point.repeats.size() >= repeats;
    });
    if (done) return points;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  throw std::runtime_error("the points are not read");
}

}  // namespace

TEST_CASE("a clicked point reads I cos / d^2 of each lamp at its power") {
  const auto held = std::make_shared<const Scene>(floor());
  const Scene& scene = *held;
  PointWorker worker(held);
  CHECK(worker.add({0, 0, 0}, {0, 0, 1}) == 1);
  CHECK(worker.add({3, 0, 0}, {0, 0, 1}) == 2);
  // All of them: after a few, chance decides by how much they differ.
  const auto points = wait_for(worker, defaults::clicked_repeats);
  LightMix mix = LightMix::of(scene, 683);
  const auto truth = [](double lumens, double height, double aside) {
    const double d2 = height * height + aside * aside;
    return lumens / (4 * glm::pi<double>()) * height / (d2 * std::sqrt(d2));
  };
  const auto first = points[0].lux(mix, 1);
  REQUIRE(first.size() == 3);
  CHECK(first[0].value == Approx(truth(100, 2, 0)).epsilon(1e-3));
  CHECK(first[1].value == Approx(truth(400, 4, 3)).epsilon(1e-3));
  CHECK(first[2].value == Approx(first[0].value + first[1].value));
  // Layers that are pooled are read together.
  const LayerMixdown one{{"both"}, {0, 0}, {1, 1}};
  const auto pooled = points[0].lux(mix, 1, &one);
  REQUIRE(pooled.size() == 2);
  CHECK(pooled[0].value == Approx(truth(100, 2, 0) + truth(400, 4, 3)).epsilon(1e-3));
  // A slider needs no new rays, and a maintenance factor is one.
  mix.lights[0].power = 50;
  mix.lights[1].power = 0;
  CHECK(points[1].lux(mix, 0.8).back().value == Approx(0.8 * truth(50, 2, 3)).epsilon(1e-3));
}

TEST_CASE("points are measured anew when the scene is another") {
  Scene scene = floor();
  PointWorker worker(std::make_shared<const Scene>(scene));
  worker.add({0, 0, 0}, {0, 0, 1});
  wait_for(worker, 2);
  scene.lights.resize(1);
  const auto edited = std::make_shared<const Scene>(scene);
  worker.use(edited);
  const auto points = wait_for(worker, 2);
  CHECK(points[0].number == 1);
  const auto lux = points[0].lux(LightMix::of(*edited, 683), 1);
  REQUIRE(lux.size() == 2);
  CHECK(lux[0].value == Approx(100 / (4 * glm::pi<double>()) / 4).epsilon(1e-3));
}

TEST_CASE("points are removed by their numbers, which stay") {
  PointWorker worker(std::make_shared<const Scene>(floor()));
  worker.add({0, 0, 0}, {0, 0, 1});
  worker.add({1, 0, 0}, {0, 0, 1});
  worker.remove(1);
  CHECK(worker.add({2, 0, 0}, {0, 0, 1}) == 3);
  const auto points = worker.points();
  REQUIRE(points.size() == 2);
  CHECK(points[0].number == 2);
  CHECK(points[1].number == 3);
}

TEST_CASE("points are kept as lines for measure, and as a table") {
  const auto held = std::make_shared<const Scene>(floor());
  const Scene& scene = *held;
  PointWorker worker(held);
  worker.add({0, 0, 0}, {0, 0, 1});
  const auto points = wait_for(worker, 2);
  CHECK(points_text(points) == "0 0 0 0 0 1\n");
  const LayerMixdown as_they_are = LightBoard(LightMix::of(scene, 683)).mixdown();
  const std::string csv = points_csv(points, LightMix::of(scene, 683), as_they_are, 1);
  CHECK_THAT(csv, Catch::Contains("point,x,y,z,dx,dy,dz,lux,standard_error,lux near") &&
                      Catch::Contains("\n1,0,0,0,0,0,1,"));
  const ClickedPoint unread{7, {1, 2, 3}, {0, 0, 1}};
  CHECK_THAT(points_csv({unread}, LightMix::of(scene, 683), as_they_are, 1),
             Catch::Contains("7,1,2,3,0,0,1,,,,,,\n"));
}

}  // namespace photile::test
