// Clicked points against closed forms.
#include <catch2/catch.hpp>
#include <chrono>
#include <glm/gtc/constants.hpp>
#include <thread>

#include "photile/defaults.hpp"
#include "test_scenes.hpp"
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

/// The mean of the repeats of a light at a power.
double lux(const ClickedPoint& point, std::size_t light, double lumens) {
  double sum = 0;
  for (const auto& repeat : point.repeats) sum += luminance(glm::dvec3(repeat[light]));
  return lumens * sum / static_cast<double>(point.repeats.size());
}

}  // namespace

TEST_CASE("a clicked point reads I cos / d^2 of each lamp at its power") {
  PointWorker worker(std::make_shared<const Scene>(floor()));
  CHECK(worker.add({0, 0, 0}, {0, 0, 1}) == 1);
  CHECK(worker.add({3, 0, 0}, {0, 0, 1}) == 2);
  // All of them: after a few, chance decides by how much they differ.
  const auto points = wait_for(worker, defaults::clicked_repeats);
  const auto truth = [](double lumens, double height, double aside) {
    const double d2 = height * height + aside * aside;
    return lumens / (4 * glm::pi<double>()) * height / (d2 * std::sqrt(d2));
  };
  CHECK(lux(points[0], 0, 100) == Approx(truth(100, 2, 0)).epsilon(1e-3));
  CHECK(lux(points[0], 1, 400) == Approx(truth(400, 4, 3)).epsilon(1e-3));
  CHECK(lux(points[1], 0, 50) == Approx(truth(50, 2, 3)).epsilon(1e-3));
}

TEST_CASE("points are measured anew when the scene is another") {
  Scene scene = floor();
  PointWorker worker(std::make_shared<const Scene>(scene));
  worker.add({0, 0, 0}, {0, 0, 1});
  wait_for(worker, 2);
  scene.lights.resize(1);
  worker.use(std::make_shared<const Scene>(scene));
  const auto points = wait_for(worker, 2);
  CHECK(points[0].number == 1);
  REQUIRE(points[0].repeats[0].size() == 1);
  CHECK(lux(points[0], 0, 100) == Approx(100 / (4 * glm::pi<double>()) / 4).epsilon(1e-3));
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

}  // namespace photile::test
