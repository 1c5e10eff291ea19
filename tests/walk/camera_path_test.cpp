// Keyframes of a camera.
#include "reading/camera_path.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <glm/gtc/constants.hpp>

#include "photile/errors.hpp"
#include "temporary_folder.hpp"

namespace photile::test {

using Catch::Contains;

namespace {

reading::CameraMotion read(const std::string& text) {
  const TemporaryFolder folder;
  const auto file = folder.path / "path.json";
  std::ofstream(file) << text;
  Camera base;
  base.name = "eye";
  base.aspect_ratio = 1.5;
  return reading::read_camera_path(file, base);
}

void check_near(const glm::dvec3& a, const glm::dvec3& b) {
  INFO(a.x << " " << a.y << " " << a.z << " and " << b.x << " " << b.y << " " << b.z);
  CHECK(glm::length(a - b) < 1e-9);
}

}  // namespace

TEST_CASE("a camera is where its keyframes say, and stays there before and after them") {
  const auto motion = read(R"([
      {"time": 1, "position": [0, 1, 0], "look_at": [0, 1, -5], "fov": 30},
      {"time": 2, "position": [2, 1, 0], "look_at": [2, 3, -2], "fov": 60},
      {"time": 4, "position": [2, 1, 4], "look_at": [0, 1, 4]}])");
  CHECK(motion.begin == 1);
  CHECK(motion.end == 4);
  const Camera second = motion.at(2);
  check_near(second.position, {2, 1, 0});
  check_near(second.forward, glm::normalize(glm::dvec3(0, 1, -1)));
  CHECK(glm::degrees(second.vertical_field_of_view) == Approx(60));
  CHECK(second.name == "eye");
  CHECK(second.aspect_ratio == 1.5);
  check_near(motion.at(0).position, {0, 1, 0});
  check_near(motion.at(9).position, {2, 1, 4});
  CHECK(glm::degrees(motion.at(1.5).vertical_field_of_view) == Approx(45));
  CHECK(glm::degrees(motion.at(9).vertical_field_of_view) == Approx(40));  // the base's
}

TEST_CASE("smooth paths have the velocity of Catmull and Rom at keyframes, and rest at the ends") {
  const std::vector<double> times{0, 1, 3};
  const std::vector<glm::dvec3> values{{0, 0, 0}, {1, 2, 0}, {6, 2, 3}};
  constexpr double h = 1e-6;
  const auto velocity = [&](double t) {
    return (reading::smooth(times, values, t + h) - reading::smooth(times, values, t - h)) /
           (2 * h);
  };
  CHECK(glm::length(velocity(1) - glm::dvec3(2, 2.0 / 3, 1)) < 1e-4);
  CHECK(glm::length(velocity(2 * h)) < 1e-4);
  CHECK(glm::length(velocity(3 - 2 * h)) < 1e-4);
  check_near(reading::linear(times, values, 2), {3.5, 2, 1.5});
}

TEST_CASE("a target that stays is looked at all the way") {
  const auto motion = read(R"([{"time": 0, "position": [3, 0, 0], "look_at": [0, 0, 0]},
                               {"time": 1, "position": [0, 0, 5], "look_at": [0, 0, 0]}])");
  for (const double time : {0.1, 0.4, 0.9}) {
    const Camera camera = motion.at(time);
    check_near(camera.forward, glm::normalize(-camera.position));
  }
}

TEST_CASE("directions turn along the shortest arc at even speed") {
  const auto motion = read(R"({"interpolation": "linear", "keyframes": [
      {"time": 0, "position": [0, 0, 0], "direction": [0, 0, -1]},
      {"time": 1, "position": [4, 0, 0], "direction": [1, 0, 0]}]})");
  const Camera third = motion.at(1.0 / 3);
  const double angle = glm::radians(30.0);
  check_near(third.forward, {std::sin(angle), 0, -std::cos(angle)});
  check_near(third.up, {0, 1, 0});
  check_near(third.position, {4.0 / 3, 0, 0});
}

TEST_CASE("what is no path is refused by file, keyframe and key") {
  const auto [text, expected] = GENERATE(table<std::string, std::string>({
      {"[", "no JSON"},
      {"[]", "no keyframes"},
      {"{}", "no keyframes"},
      {"[1]", "keyframe 1"},
      {R"([{"position": [0,0,0], "look_at": [0,0,1]}])", "'time'"},
      {R"([{"time": 0, "position": [0,0], "look_at": [0,0,1]}])", "'position'"},
      {R"([{"time": 0, "position": [0,0,0]}])", "look_at"},
      {R"([{"time": 0, "position": [0,0,0], "look_at": [0,0,1], "direction": [0,0,1]}])",
       "look_at"},
      {R"([{"time": 0, "position": [0,0,0], "look_at": [0,0,0]}])", "own position"},
      {R"([{"time": 0, "position": [0,0,0], "look_at": [0,0,1], "fov": 180}])", "'fov'"},
      {R"([{"time": 0, "position": [0,0,0], "look_at": [0,0,1], "roll": 1}])", "'roll'"},
      {R"([{"time": 0, "position": [0,0,0], "look_at": [0,0,1], "up": [0,0,0]}])", "'up'"},
      {R"({"interpolation": "cubic", "keyframes": [{"time": 0, "position": [0,0,0],
           "look_at": [0,0,1]}]})",
       "'interpolation'"},
  }));
  INFO(text);
  CHECK_THROWS_AS(read(text), InputError);
  CHECK_THROWS_WITH(read(text), Contains("path.json") && Contains(expected));
  CHECK_THROWS_WITH(read(R"([{"time": 1, "position": [0,0,0], "look_at": [0,0,1]},
                             {"time": 1, "position": [0,0,0], "look_at": [0,0,1]}])"),
                    Contains("keyframe 2") && Contains("'time'"));
}

}  // namespace photile::test
