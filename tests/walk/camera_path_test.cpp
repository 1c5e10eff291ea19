// Paths of a camera.
#include "reading/camera_path.hpp"

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "gltf/cameras.hpp"
#include "photile/defaults.hpp"
#include "photile/errors.hpp"
#include "render/pictures.hpp"
#include "temporary_folder.hpp"
#include "walk/frames.hpp"

namespace photile::test {
namespace {

using Catch::Contains;
using nlohmann::json;

// Keyframes of a camera.

reading::CameraMotion read(const std::string& text) {
  const TemporaryFolder folder;
  const auto file = folder.path / "path.json";
  std::ofstream(file) << text;
  Camera base;
  base.name = "eye";
  base.aspect_ratio = 1.5;
  return reading::read_camera_path(file, base);
}

void check_near(const glm::dvec3& a, const glm::dvec3& b, double tolerance = 1e-9) {
  INFO(a.x << " " << a.y << " " << a.z << " and " << b.x << " " << b.y << " " << b.z);
  CHECK(glm::length(a - b) < tolerance);
}

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

// Animations of glTF cameras, against values worked out by hand from the specification.

/// A glTF file with one camera "eye" under a node "dolly" at (0, 1, 0).
struct AnimatedFile {
  TemporaryFolder folder;
  std::vector<float> numbers{0};  // an empty buffer would be refused for itself
  json document{
      {"asset", {{"version", "2.0"}}},
      {"scenes", {{{"nodes", {0}}}}},
      {"nodes",
       {{{"name", "dolly"}, {"translation", {0, 1, 0}}, {"children", {1}}},
        {{"name", "eye"}, {"camera", 0}}}},
      {"cameras", {{{"type", "perspective"}, {"perspective", {{"yfov", 0.7}, {"znear", 0.1}}}}}},
      {"accessors", json::array()},
      {"bufferViews", json::array()},
      {"animations",
       {{{"name", "walk"}, {"channels", json::array()}, {"samplers", json::array()}}}}};

  int accessor(const std::vector<float>& values, const char* type, int components) {
    document["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", 4 * numbers.size()}, {"byteLength", 4 * values.size()}});
    numbers.insert(numbers.end(), values.begin(), values.end());
    const int index = static_cast<int>(document["accessors"].size());
    document["accessors"].push_back(
        {{"bufferView", index},
         {"componentType", 5126},
         {"count", values.size() / static_cast<std::size_t>(components)},
         {"type", type}});
    return index;
  }

  void animate(int node, const char* path, const char* interpolation,
               const std::vector<float>& times, const std::vector<float>& values) {
    const bool rotation = std::string(path) == "rotation";
    json& animation = document["animations"][0];
    const int input = accessor(times, "SCALAR", 1);
    const int output = accessor(values, rotation ? "VEC4" : "VEC3", rotation ? 4 : 3);
    animation["channels"].push_back(
        {{"sampler", animation["samplers"].size()}, {"target", {{"node", node}, {"path", path}}}});
    animation["samplers"].push_back(
        {{"input", input}, {"output", output}, {"interpolation", interpolation}});
  }

  reading::CameraMotion read(const std::string& animation = "",
                             const SceneLoadOptions& options = {}) {
    const std::string bytes(reinterpret_cast<const char*>(numbers.data()), 4 * numbers.size());
    std::ofstream(folder.path / "a.bin", std::ios::binary) << bytes;
    document["buffers"] = {{{"uri", "a.bin"}, {"byteLength", bytes.size()}}};
    std::ofstream(folder.path / "a.gltf") << document.dump();
    Camera camera;
    camera.name = "eye";
    return gltf::read_camera_animation(folder.path / "a.gltf", options, camera, animation);
  }
};

/// As floats are.
void check_close(const glm::dvec3& a, const glm::dvec3& b) { check_near(a, b, 1e-6); }

TEST_CASE("LINEAR translations go straight, in the space of the node above") {
  AnimatedFile file;
  file.animate(1, "translation", "LINEAR", {1, 3}, {0, 0, 0, 4, 2, 0});
  const auto motion = file.read();
  CHECK(motion.begin == 1);
  CHECK(motion.end == 3);
  check_close(motion.at(1).position, {0, 1, 0});
  check_close(motion.at(1.5).position, {1, 1.5, 0});
  check_close(motion.at(99).position, {4, 3, 0});
  check_close(motion.at(1.5).forward, {0, 0, -1});
}

TEST_CASE("an animation in centimetres moves its camera by metres") {
  AnimatedFile file;
  file.animate(1, "translation", "LINEAR", {1, 3}, {0, 0, 0, 400, 200, 0});
  SceneLoadOptions centimetres;
  centimetres.metres_per_unit = 0.01;
  const auto motion = file.read("", centimetres);
  check_close(motion.at(99).position, {4, 2.01, 0});
  check_close(motion.at(1.5).forward, {0, 0, -1});
}

TEST_CASE("STEP holds each value until the next key") {
  AnimatedFile file;
  file.animate(1, "translation", "STEP", {0, 1, 2}, {0, 0, 0, 1, 0, 0, 2, 0, 0});
  const auto motion = file.read();
  check_close(motion.at(0.99).position, {0, 1, 0});
  check_close(motion.at(1).position, {1, 1, 0});
  check_close(motion.at(2).position, {2, 1, 0});
}

TEST_CASE("CUBICSPLINE follows Hermite curves with its tangents times the seconds between keys") {
  AnimatedFile file;
  // in-tangent, value, out-tangent per key; two seconds apart.
  file.animate(1, "translation", "CUBICSPLINE", {0, 2, 4},
               {9, 9, 9, 0, 0, 0, 1, 0, 0, -1, 0, 0, 4, 0, 0, 0, 2, 0, 0, 0, 4, 6, 0, 2, 9, 9, 9});
  const auto motion = file.read();
  // At the middle: 1/2 p0 + 1/8 (2 x 1) + 1/2 p1 - 1/8 (2 x -1).
  check_close(motion.at(1).position, {2.5, 1, 0});
  check_close(motion.at(3).position, {5, 1.5, 0});
}

TEST_CASE("rotations turn about the node above as well, along the shortest arc") {
  AnimatedFile file;
  const auto half = [](double degrees) {
    return static_cast<float>(std::sin(degrees * M_PI / 360));
  };
  const auto whole = [](double degrees) {
    return static_cast<float>(std::cos(degrees * M_PI / 360));
  };
  // About y, 0 to -90 degrees: from -z to +x.
  file.animate(0, "rotation", "LINEAR", {0, 1}, {0, 0, 0, 1, 0, half(-90), 0, whole(-90)});
  const auto motion = file.read("walk");
  check_close(motion.at(1).forward, {1, 0, 0});
  check_close(motion.at(1.0 / 3).forward,
              {std::sin(glm::radians(30.0)), 0, -std::cos(glm::radians(30.0))});
}

TEST_CASE("files without such an animation, or with a broken one, are refused") {
  AnimatedFile file;
  SECTION("nothing moves") { CHECK_THROWS_WITH(file.read(), Contains("no animation")); }
  SECTION("another name") {
    file.animate(1, "translation", "LINEAR", {0, 1}, {0, 0, 0, 1, 0, 0});
    CHECK_THROWS_WITH(file.read("run"), Contains("'run'"));
  }
  SECTION("times that do not ascend") {
    file.animate(1, "translation", "LINEAR", {1, 1}, {0, 0, 0, 1, 0, 0});
    CHECK_THROWS_AS(file.read(), InputError);
  }
  SECTION("too few values") {
    file.animate(1, "translation", "CUBICSPLINE", {0, 1}, {0, 0, 0, 1, 0, 0});
    CHECK_THROWS_AS(file.read(), InputError);
  }
  SECTION("a sampler that is not there") {
    file.animate(1, "translation", "LINEAR", {0, 1}, {0, 0, 0, 1, 0, 0});
    file.document["animations"][0]["channels"][0]["sampler"] = 7;
    CHECK_THROWS_AS(file.read(), InputError);
  }
  SECTION("an accessor beyond its buffer") {
    file.animate(1, "translation", "LINEAR", {0, 1}, {0, 0, 0, 1, 0, 0});
    file.document["accessors"][1]["count"] = 1000;
    CHECK_THROWS_AS(file.read(), InputError);
  }
}

using walk::ContactSheet;
using walk::FrameNames;

// Names of numbered frames.

TEST_CASE("hashes and printf's numbers become frame numbers, as wide as they say at least") {
  const auto [pattern, frame, name] = GENERATE(table<std::string, int, std::string>({
      {"frame.####.exr", 7, "frame.0007.exr"},
      {"frame.####.exr", 123456, "frame.123456.exr"},
      {"#.exr", 12, "12.exr"},
      {"a%04d.exr", 7, "a0007.exr"},
      {"a%d.exr", 7, "a7.exr"},
      {"a%3d.exr", 7, "a  7.exr"},
      {"a%09d.exr", 7, "a000000007.exr"},
      {"a%%0d.exr", 7, "a%7.exr"},
      {"c#/b##.exr", 3, "c#/b03.exr"},
      {"out/walk.png", 3, "out/walk.0003.png"},
      {"walk", 3, "walk.0003"},
  }));
  CHECK(FrameNames(pattern).of(frame).string() == name);
}

TEST_CASE("a place of any width takes no more stack than another") {
  const std::string hashes(200'000, '#');
  CHECK(FrameNames(hashes + ".exr").of(7).string() == std::string(199'999, '0') + "7.exr");
}

TEST_CASE("a name with two places for the number, or a wrong one, is refused") {
  const std::string pattern =
      GENERATE("##-##.exr", "a%d#.exr", "####/frame.exr", "%s.exr", "%0", "%00d", "%12d");
  INFO(pattern);
  CHECK_THROWS_AS(FrameNames(pattern), UsageError);
}

// Ranges of frames as render farms write them.

TEST_CASE("a range of frames is one, all between two, or every so many of them") {
  const auto [text, numbers] = GENERATE(table<std::string, std::vector<int>>({
      {"7", {7}},
      {"0", {0}},
      {"3-6", {3, 4, 5, 6}},
      {"3-3", {3}},
      {"1-10x4", {1, 5, 9}},
  }));
  const auto range = walk::parse_frame_range(text);
  REQUIRE(range);
  std::vector<int> found;
  for (int number = 0; number < 20; ++number) {
    if (range->contains(number)) found.push_back(number);
  }
  CHECK(found == numbers);
}

TEST_CASE("what is no range of frames is none") {
  const std::string text =
      GENERATE("", "-", "-3", "3-", "6-3", "1-4x0", "1-4x", "1-4x-1", "a", "1 - 4", "1-4x2x2",
               "1.5", "99999999999", "1-99999999999", "+1");
  CAPTURE(text);
  CHECK_FALSE(walk::parse_frame_range(text));
}

// Frames on a contact sheet, each in its place.

constexpr int gap = 4;

/// Red on its left half and black on the right; green all over.
Image frame(int width, int height, float red, float green) {
  Image image;
  image.width = width;
  image.height = height;
  for (const char* channel : {"R", "G", "B"}) image.add(channel);
  for (std::size_t i = 0; i < image.pixels(); ++i) {
    const bool left = static_cast<int>(i) % width < width / 2;
    image.channels[0][i] = left ? red : 0;
    image.channels[1][i] = green;
  }
  return image;
}

float at(const Image& sheet, const char* channel, int x, int y) {
  return (*sheet.find(channel))[static_cast<std::size_t>(y * sheet.width + x)];
}

TEST_CASE("frames lie from left to right and from top to bottom, the rest of the sheet is grey") {
  constexpr int width = 6, height = 4;
  ContactSheet sheet(5, width, height);  // 3 columns, 2 rows
  for (int i = 0; i < 5; ++i) sheet.add(i, frame(width, height, 0.5f, 0.1f * float(i + 1)));
  const Image& image = sheet.image();
  CHECK(image.width == 3 * width + 4 * gap);
  CHECK(image.height == 2 * height + 3 * gap);
  for (int i = 0; i < 5; ++i) {
    INFO("frame " << i);
    const int left = gap + i % 3 * (width + gap), top = gap + i / 3 * (height + gap);
    CHECK(at(image, "G", left, top) == Approx(0.1 * (i + 1)));
    CHECK(at(image, "G", left + width - 1, top + height - 1) == Approx(0.1 * (i + 1)));
    CHECK(at(image, "R", left + 2, top) == 0.5f);
    CHECK(at(image, "R", left + 3, top) == 0.0f);
    CHECK(at(image, "G", left - 1, top) == at(image, "G", 0, 0));
  }
  const int sixth = gap + 2 * (width + gap);
  CHECK(at(image, "G", sixth, gap + height + gap) == at(image, "G", 0, 0));
}

TEST_CASE("of more frames than a sheet holds it shows as many as it holds, at even distances") {
  const auto [count, most] = GENERATE(table<int, int>({{3, 5}, {5, 5}, {6, 5}, {9, 5}, {1000, 7}}));
  CAPTURE(count, most);
  std::vector<int> shown;
  for (int frame = 0; frame < count; ++frame) {
    const int place = walk::place_on_sheet(frame, count, most);
    if (place < 0) continue;
    CHECK(place == static_cast<int>(shown.size()));
    shown.push_back(frame);
  }
  REQUIRE(shown.size() == static_cast<std::size_t>(std::min(count, most)));
  CHECK(shown.front() == 0);
  shown.push_back(count);
  const double even = std::max(1.0, double(count) / most);
  for (std::size_t i = 1; i < shown.size(); ++i) {
    CHECK(std::abs(shown[i] - shown[i - 1] - even) < 1);
  }
}

TEST_CASE("large frames are drawn small, as the means of their pixels") {
  constexpr int small = defaults::contact_sheet_width;
  ContactSheet sheet(1, 4 * small, 4 * 100);
  Image stripes = frame(4 * small, 4 * 100, 0, 0);
  for (std::size_t i = 0; i < stripes.pixels(); i += 2) stripes.channels[2][i] = 1;
  sheet.add(0, stripes);
  CHECK(sheet.image().width == small + 2 * gap);
  CHECK(sheet.image().height == 100 + 2 * gap);
  for (const int x : {0, 100, small - 1}) {
    CHECK(at(sheet.image(), "B", gap + x, gap + 50) == Approx(0.5));
  }
}

// Many pictures from one set of maps are those of one rendering each.

RenderParameters small() { return small_picture(20'000, 24, 16); }

TEST_CASE("each picture is the one that render gives, bit for bit, of several passes as well") {
  const Scene scene = furnished_room();
  RenderParameters parameters = small();
  parameters.passes = GENERATE(1, 3);
  std::span<Device> devices(&device(), 1);
  SceneRenderer renderer(scene, devices, parameters);
  for (const double x : {0.5, 2.0, 0.5}) {
    const Camera camera = Camera::look_at({x, 0.3, 1.5}, {2, 2, 0.5}, {0, 0, 1}, 1.0);
    const RenderResult kept = renderer.render(camera, parameters.film);
    const RenderResult once = render(scene, camera, devices, parameters);
    REQUIRE(kept.layers.layers.size() == 2);
    CHECK(same_bits(kept.layers, once.layers));
    CHECK(kept.used.radius == once.used.radius);
    CHECK(kept.stored_photons == once.stored_photons);
  }
}

TEST_CASE("light maps of several passes are refused") {
  const Scene scene = furnished_room();
  RenderParameters parameters = small();
  parameters.passes = 3;
  parameters.light_maps = LightMapMode::on;
  std::span<Device> devices(&device(), 1);
  CHECK_THROWS_WITH(SceneRenderer(scene, devices, parameters),
                    Catch::Contains("one photon pass") && Catch::Contains("there are 3"));
}

}  // namespace
}  // namespace photile::test
