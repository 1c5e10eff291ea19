// EXR files of photile's own: layers, attributes and powers.
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numeric>

#include "flat_picture.hpp"
#include "photile/limits.hpp"
#include "picture_support.hpp"

namespace photile::test {
namespace {

using Catch::Contains;

/// 5 x 3 pixels: smaller than any block, with values that a float format may lose.
Image awkward_picture() {
  using Limits = std::numeric_limits<float>;
  // Not in the order of the file: the root comes last here.
  Image image = flat_picture(
      5, 3, 0, {"Combined_floor lamp.R", "Illuminance_floor lamp.Y", "B", "A", "G", "R"});
  for (std::vector<float>& plane : image.channels) {
    for (std::size_t i = 0; i < plane.size(); ++i) plane[i] = 0.1f * static_cast<float>(i) + 0.3f;
  }
  std::vector<float>& red = image.channels.back();
  red[0] = Limits::quiet_NaN();
  red[1] = Limits::infinity();
  red[2] = -Limits::infinity();
  red[3] = Limits::denorm_min();
  red[4] = -0.0f;
  red[5] = Limits::max();
  image.attributes["photile.scene"] = "a \"quoted\" name, ü";
  image.attributes["photile.units"] = "cd/m2";
  image.numbers["whiteLuminance"] = 1.0f;
  for (std::size_t i = 0; i < 16; ++i) {
    image.matrices["worldToCamera"][i] = static_cast<float>(i) + 0.5f;
    image.matrices["worldToNDC"][i] = -static_cast<float>(i);
  }
  return image;
}

std::string output_of(const std::string& command) {
  std::string output;
  FILE* pipe = ::popen(command.c_str(), "r");
  REQUIRE(pipe != nullptr);
  std::array<char, 4096> buffer;
  while (const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), pipe)) {
    output.append(buffer.data(), count);
  }
  REQUIRE(::pclose(pipe) == 0);
  return output;
}

TEST_CASE("an EXR keeps every float, name, string, number and matrix, bit for bit") {
  const TemporaryFolder folder;
  const Image written = awkward_picture();
  write_exr(folder / "a.exr", written);
  const Image read = read_image(folder / "a.exr");
  REQUIRE(read.width == 5);
  REQUIRE(read.height == 3);
  REQUIRE(read.channel_names.size() == written.channel_names.size());
  for (std::size_t i = 0; i < written.channel_names.size(); ++i) {
    const std::vector<float>* plane = read.find(written.channel_names[i]);
    INFO(written.channel_names[i]);
    REQUIRE(plane != nullptr);
    CHECK(same_bits(*plane, written.channels[i]));
  }
  for (const auto& [name, value] : written.attributes) CHECK(read.attributes.at(name) == value);
  CHECK(read.numbers.at("whiteLuminance") == 1.0f);
  CHECK(read.matrices == written.matrices);
}

TEST_CASE("a picture of more rows than one write takes keeps its pixels") {
  const TemporaryFolder folder;
  Image written = flat_picture(3, 201, 0, {"R"});
  std::iota(written.channels[0].begin(), written.channels[0].end(), 0.0f);
  write_exr(folder / "tall.exr", written);
  CHECK(same_bits(*read_image(folder / "tall.exr").find("R"), written.channels[0]));
}

TEST_CASE("reading an EXR and writing it again gives the same bytes") {
  const TemporaryFolder folder;
  write_exr(folder / "a.exr", awkward_picture());
  write_exr(folder / "b.exr", read_image(folder / "a.exr"));
  CHECK(bytes_of(folder / "a.exr") == bytes_of(folder / "b.exr"));
}

TEST_CASE("an EXR's header is what OpenEXR's standard attributes and OpenImageIO expect") {
  const TemporaryFolder folder;
  write_exr(folder / "a.exr", awkward_picture());
  const auto input = OIIO::ImageInput::open((folder / "a.exr").string());
  REQUIRE(input);
  const OIIO::ImageSpec& spec = input->spec();
  const std::vector<std::string> root(spec.channelnames.begin(), spec.channelnames.begin() + 4);
  CHECK(root == std::vector<std::string>{"R", "G", "B", "A"});
  CHECK(spec.format == OIIO::TypeDesc::FLOAT);
  CHECK(spec.get_string_attribute("compression") == "zip");
  CHECK(spec.get_string_attribute("colorInteropID") == "lin_rec709_scene");
  CHECK_FALSE(input->seek_subimage(1, 0));  // single part
  REQUIRE(input->seek_subimage(0, 0));

  const OIIO::ParamValue* chromaticities = spec.find_attribute("chromaticities");
  REQUIRE(chromaticities != nullptr);
  REQUIRE(chromaticities->type() == OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8));
  const std::array<float, 8> rec709{0.64f, 0.33f, 0.3f, 0.6f, 0.15f, 0.06f, 0.3127f, 0.329f};
  for (int i = 0; i < 8; ++i) {
    CHECK(chromaticities->get_float_indexed(i) == rec709[static_cast<std::size_t>(i)]);
  }
  CHECK(spec.find_attribute("worldToCamera", OIIO::TypeDesc::TypeMatrix) != nullptr);
  CHECK(spec.find_attribute("worldToNDC", OIIO::TypeDesc::TypeMatrix) != nullptr);
  const std::string bytes = bytes_of(folder / "a.exr");
  using namespace std::string_literals;
  CHECK(bytes.find("worldToCamera\0m44f\0"s) != std::string::npos);
  CHECK(bytes.find("worldToNDC\0m44f\0"s) != std::string::npos);
  CHECK(bytes.find("chromaticities\0chromaticities\0"s) != std::string::npos);
  CHECK(bytes.find("whiteLuminance\0float\0"s) != std::string::npos);
}

TEST_CASE("oiiotool lists the root and every layer of a mixed picture") {
  const TemporaryFolder folder;
  LightMix mix{{mixed("lamp", 10), mixed("ceiling light", 20)}};
  write_exr(folder / "a.exr", mix_layers(random_layers(4, 4, {"lamp", "ceiling light"}), mix));
  const std::string info = output_of("oiiotool --info -v '" + (folder / "a.exr").string() + "'");
  INFO(info);
  CHECK(info.find("channel list: R, G, B, A, ") != std::string::npos);
  for (const char* name :
       {"Combined_lamp.R, Combined_lamp.G, Combined_lamp.B",
        "Combined_ceiling light.R, Combined_ceiling light.G, Combined_ceiling light.B",
        "Illuminance_lamp.Y", "Illuminance_ceiling light.Y",
        "photile.lights: ", "photile.units: \"cd/m2\"", "photile.illuminance.units: \"lux\""}) {
    INFO(name);
    CHECK(info.find(name) != std::string::npos);
  }
}

/// combine_layers beside the sum of what mix_layers gives as layers.
void check_equal_to_sum(const LightLayers& layers, const LightMix& mix) {
  const Image mixed = mix_layers(layers, mix);
  const std::size_t pixels = mixed.pixels();
  std::vector<glm::vec3> picture(pixels, glm::vec3(7.0f));
  combine_layers(layers, mix, picture);
  for (int c = 0; c < 3; ++c) {
    std::vector<float> plane;
    // What is infinite is the largest float in layers.
    for (const glm::vec3& pixel : picture) {
      plane.push_back(std::min(pixel[c], std::numeric_limits<float>::max()));
    }
    std::vector<float> sum(pixels, 0.0f);
    for (const LightLayers::Layer& layer : layers.layers) {
      const std::vector<float>& part =
          *mixed.find("Combined_" + layer.light + "." + std::string(1, "RGB"[c]));
      for (std::size_t i = 0; i < pixels; ++i) sum[i] += part[i];
    }
    CHECK(same_bits(plane, sum));
  }
}

TEST_CASE("combined layers are the bits of the sum of mixed ones, at sizes around the blocks") {
  LightMix mix{{mixed("a", 812.5), mixed("b", 3.1), mixed("c", 47.0)}};
  mix.lights[1].tint = {2.0f, 1.0f, 0.5f};
  for (const int width : {1, 15, 16, 17, 1023, 1024, 1025, 5000}) {
    CAPTURE(width);
    check_equal_to_sum(random_layers(width, 3, {"c", "a", "b"}), mix);
  }
}

TEST_CASE("combined sparse layers are the bits of the sum of mixed ones") {
  const LightLayers layers = random_sparse_layers(37, 9, 11);
  REQUIRE(layers.sparse());
  LightMix mix;
  for (const LightLayers::Layer& layer : layers.layers) {
    mix.lights.push_back(mixed(layer.light, 1.5 * static_cast<double>(mix.lights.size())));
    mix.lights.back().tint = {2.0f, 1.0f, 0.5f};
  }
  check_equal_to_sum(layers, mix);
  mix.lights[3].power = 0;  // off
  check_equal_to_sum(layers, mix);
}

TEST_CASE("a combined light that is off adds nothing, even where its layer is infinite") {
  LightLayers layers = random_layers(40, 2, {"a", "b"});
  layers.layers[1].radiance[20] = glm::vec3(std::numeric_limits<float>::infinity());
  LightMix mix{{mixed("a", 2.0), mixed("b", 0.0)}};
  check_equal_to_sum(layers, mix);
  mix.lights[1] = mixed("b", 1.0);
  mix.lights[1].tint = {1.0f, 0.0f, 1.0f};
  check_equal_to_sum(layers, mix);
}

TEST_CASE("no layers combine to black") {
  LightLayers layers;
  layers.width = layers.height = 2;
  std::vector<glm::vec3> picture(4, glm::vec3(1.0f));
  combine_layers(layers, LightMix{}, picture);
  CHECK(picture == std::vector<glm::vec3>(4, glm::vec3(0.0f)));
}

TEST_CASE("combining refuses a picture of another size and a mix without the light") {
  const LightLayers layers = random_layers(3, 2, {"a"});
  LightMix mix{{mixed("a", 1.0)}};
  std::vector<glm::vec3> picture(5);
  CHECK_THROWS_AS(combine_layers(layers, mix, picture), UsageError);
  picture.resize(6);
  mix.lights = {mixed("b", 1.0)};
  CHECK_THROWS_AS(combine_layers(layers, mix, picture), UsageError);
}

/// Row vector times matrix, in double precision.
glm::dvec4 transform(const glm::dvec3& point, const std::array<float, 16>& matrix) {
  const double p[4] = {point.x, point.y, point.z, 1.0};
  glm::dvec4 result(0.0);
  for (int column = 0; column < 4; ++column) {
    for (int row = 0; row < 4; ++row) {
      result[column] += p[row] * matrix[static_cast<std::size_t>(4 * row + column)];
    }
  }
  return result;
}

/// A camera turned and moved, its axes computed here.
Camera oblique_camera() {
  Camera camera;
  camera.position = {1.0, 2.0, 3.0};
  camera.forward = glm::normalize(glm::dvec3(0.3, -0.4, -0.8));
  camera.right = glm::normalize(glm::cross(camera.forward, glm::dvec3(0.0, 1.0, 0.0)));
  camera.up = glm::cross(camera.right, camera.forward);
  camera.vertical_field_of_view = glm::radians(50.0);
  return camera;
}

TEST_CASE("worldToCamera puts right, up and depth on x, y and z, left-handed") {
  const Camera camera = oblique_camera();
  Image image;
  set_camera_attributes(image, camera, 640, 480);
  const glm::dvec3 point =
      camera.position + 2.0 * camera.right + 3.0 * camera.up + 5.0 * camera.forward;
  const glm::dvec4 seen = transform(point, image.matrices.at("worldToCamera"));
  CHECK(seen.x == Approx(2.0).epsilon(1e-5));
  CHECK(seen.y == Approx(3.0).epsilon(1e-5));
  CHECK(seen.z == Approx(5.0).epsilon(1e-5));
  CHECK(seen.w == Approx(1.0));
}

TEST_CASE("worldToNDC puts the picture's corners on the unit square, (0,0) upper left") {
  const Camera camera = oblique_camera();
  const double tan_y = std::tan(glm::radians(25.0)), tan_x = tan_y * 640.0 / 480.0;
  Image image;
  set_camera_attributes(image, camera, 640, 480);
  struct Corner {
    double right, up, x, y;
  };
  for (const Corner& corner : {Corner{-1, 1, 0, 0}, Corner{1, 1, 1, 0}, Corner{-1, -1, 0, 1},
                               Corner{1, -1, 1, 1}, Corner{0.5, 0, 0.75, 0.5}}) {
    const glm::dvec3 point =
        camera.position + 7.0 * (camera.forward + corner.right * tan_x * camera.right +
                                 corner.up * tan_y * camera.up);
    const glm::dvec4 ndc = transform(point, image.matrices.at("worldToNDC"));
    CHECK(ndc.x / ndc.w == Approx(corner.x).margin(1e-5));
    CHECK(ndc.y / ndc.w == Approx(corner.y).margin(1e-5));
    CHECK(ndc.z / ndc.w == Approx(1.0 / 7.0).epsilon(1e-4));
  }
}

// Powers of 1e-12 to 1e12 through mixing, the EXR file and relighting (docs/reference/limits.md).

const std::vector<std::string> light_names{"star", "lamp", "glow", "speck"};
const std::vector<double> powers{1e12, 1e3, 1e-3, 1e-12};

LightMix extreme_mix() {
  LightMix mix;
  for (std::size_t i = 0; i < light_names.size(); ++i)
    mix.lights.push_back(mixed(light_names[i], powers[i]));
  return mix;
}

/// A product is rounded twice (the power, the product), a sum of n lights n - 1 times more.
constexpr double layer_bound = 2.0 / (1 << 24);
constexpr double root_bound = layer_bound + 3.0 / (1 << 24);

/// Largest relative error of a layer, and of the root, against double precision.
struct Errors {
  double layer = 0, root = 0;
};

Errors errors_of(const Image& picture, const LightLayers& layers,
                 const std::vector<double>& expected_powers) {
  Errors errors;
  const std::vector<std::string> channels{"R", "G", "B"};
  for (std::size_t pixel = 0; pixel < layers.layers[0].radiance.size(); ++pixel) {
    for (int c = 0; c < 3; ++c) {
      const std::string& channel = channels[static_cast<std::size_t>(c)];
      double sum = 0;
      for (std::size_t i = 0; i < light_names.size(); ++i) {
        const double truth = expected_powers[i] * double{layers.layers[i].radiance[pixel][c]};
        const double found = (*picture.find("Combined_" + light_names[i] + "." + channel))[pixel];
        if (truth > 0) errors.layer = std::max(errors.layer, std::abs(found / truth - 1));
        sum += truth;
      }
      errors.root = std::max(errors.root, std::abs((*picture.find(channel))[pixel] / sum - 1));
    }
  }
  return errors;
}

TEST_CASE("extremes: powers of 1e-12 to 1e12 keep their digits in the file and in its sum") {
  const TemporaryFolder folder;
  const LightLayers layers = random_layers(9, 7, light_names);
  write_exr(folder / "a.exr", mix_layers(layers, extreme_mix()));
  const Errors errors = errors_of(read_image(folder / "a.exr"), layers, powers);
  CHECK(errors.layer <= layer_bound);
  CHECK(errors.root <= root_bound);
}

TEST_CASE("extremes: with the brightest light off, relighting leaves the others' digits") {
  const LightLayers layers = random_layers(9, 7, light_names);
  const Image relit = relight(mix_layers(layers, extreme_mix()), {LightChange::parse("star=off")});
  const Errors errors = errors_of(relit, layers, {0, 1e3, 1e-3, 1e-12});
  CHECK(errors.layer <= layer_bound);
  CHECK(errors.root <= root_bound);
}

TEST_CASE("extremes: from 1e-12 to 1e12 and back, relighting errs by a few roundings") {
  const LightLayers layers = random_layers(9, 7, light_names);
  const Image turned =
      relight(mix_layers(layers, extreme_mix()),
              {LightChange::parse("speck=1e12"), LightChange::parse("star=1e-12")});
  const Errors errors = errors_of(turned, layers, {1e-12, 1e3, 1e-3, 1e12});
  CHECK(errors.layer <= 2 * layer_bound);
  CHECK(errors.root <= 2 * root_bound);
}

TEST_CASE("extremes: the exposure of a picture does not depend on the unit of its radiance") {
  const LightLayers layers = random_layers(9, 7, {"lamp"});
  LightMix mix{{mixed("lamp", 1)}};
  const Image expected = tone_map(mix_layers(layers, mix), {});
  for (const double power : {1e-30, 1e-12, 1e12, 1e30}) {
    mix.lights[0].power = power;
    const Image shown = tone_map(mix_layers(layers, mix), {});
    double worst = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t i = 0; i < shown.channels[c].size(); ++i) {
        worst =
            std::max(worst, std::abs(double{shown.channels[c][i]} / expected.channels[c][i] - 1));
      }
    }
    CAPTURE(power);
    CHECK(worst <= 1e-6);
  }
}

// Numbers beyond those of floats, and what is no number, never reach a file, and are told.

constexpr float largest = std::numeric_limits<float>::max();
constexpr float infinite = std::numeric_limits<float>::infinity();

bool is_finite(const Image& image) {
  return std::all_of(image.channels.begin(), image.channels.end(), [](const auto& plane) {
    return std::all_of(plane.begin(), plane.end(), [](float v) { return std::isfinite(v); });
  });
}

/// A picture of 70 rows, so that it is read in several turns, with layers of one value each.
Image layered(const std::vector<std::pair<std::string, float>>& layers) {
  Image image;
  image.width = 3;
  image.height = 70;
  for (const auto& [light, value] : layers) {
    for (const char* component : {".R", ".G", ".B"}) {
      image.add("Combined_" + light + component).assign(image.pixels(), value);
    }
  }
  return image;
}

/// Relit as a file. The pixels are those of what was written.
struct Relit {
  Image image;
  std::vector<std::string> overflows;

  Relit(const Image& source, const std::vector<LightChange>& changes) {
    const TemporaryFolder folder;
    write_exr(folder / "in.exr", source);
    const auto picture = relit_picture(folder / "in.exr", changes);
    write_exr(folder / "out.exr", *picture);
    write_exr(folder / "again.exr", *picture);  // counts nothing twice
    overflows = picture->overflows();
    image = read_image(folder / "out.exr");
    CHECK(is_finite(image));
  }
};

TEST_CASE("layers near the largest float, turned up, are written as that and told") {
  const Relit relit(layered({{"lamp", 3e38f}, {"window", 2}}), {{"lamp", "x2"}});
  CHECK(relit.image.find("Combined_lamp.R")->front() == largest);
  CHECK(relit.image.find("Combined_window.G")->back() == 2);
  CHECK(relit.image.find("R")->back() == largest);
  REQUIRE(relit.overflows.size() == 1);
  CHECK_THAT(relit.overflows[0], Contains("light 'lamp'") && Contains("210 of 210 pixels") &&
                                     Contains("3.4e+38") && Contains("reduce the power"));
}

TEST_CASE("pixels of a layer that are no numbers are black, and the rest of the picture is kept") {
  Image source = layered({{"lamp", 1}, {"window", 2}});
  source.channels[1][5] = std::nanf("");
  source.channels[0][200] = -infinite;
  const Relit relit(source, {});
  CHECK((*relit.image.find("Combined_lamp.G"))[5] == 0);
  CHECK((*relit.image.find("Combined_lamp.R"))[200] == -largest);
  CHECK((*relit.image.find("G"))[5] == 2);
  CHECK((*relit.image.find("R"))[5] == 3);
  CHECK((*relit.image.find("R"))[4] == 3);
  REQUIRE(relit.overflows.size() == 1);
  CHECK_THAT(relit.overflows[0], Contains("light 'lamp'") && Contains("2 of 210 pixels"));
}

TEST_CASE("layers that only their sum carries beyond the largest float are told as a sum") {
  const Relit relit(layered({{"lamp", 3e38f}, {"window", 2e38f}}), {});
  CHECK(relit.image.find("R")->front() == largest);
  CHECK(relit.image.find("Combined_window.R")->front() == 2e38f);
  REQUIRE(relit.overflows.size() == 1);
  CHECK_THAT(relit.overflows[0], Contains("sum of the lights") && Contains("210 of 210"));
}

TEST_CASE("an alpha that is no number is none") {
  Image source = layered({{"lamp", 1}});
  source.add("A").assign(source.pixels(), std::nanf(""));
  const Relit relit(source, {});
  CHECK(relit.image.find("A")->front() == 0);
}

TEST_CASE("a rendered light of the greatest power stays finite in every channel, and is told") {
  LightMix mix{{mixed("sun", limits::max_light_power), mixed("lamp", 1)}};
  LightLayers layers = random_layers(9, 70, {"sun", "lamp"});
  for (float& value : layers.layers[0].illuminance) value = 1e12f;  // of a lamp of a micrometre
  const auto picture = mixed_picture(layers, mix);
  const Image image = to_image(*picture);
  CHECK(is_finite(image));
  CHECK(image.find("Illuminance_sun.Y")->front() == largest);
  REQUIRE(picture->overflows().size() == 1);
  CHECK_THAT(picture->overflows()[0], Contains("light 'sun'") && Contains("630 of 630"));
}

TEST_CASE("of a sound picture nothing is told") {
  LightMix mix{{mixed("a", 3), mixed("b", 5)}};
  const LightLayers layers = random_layers(9, 70, {"a", "b"});
  const auto picture = mixed_picture(layers, mix);
  CHECK(is_finite(to_image(*picture)));
  CHECK(picture->overflows().empty());
}

}  // namespace
}  // namespace photile::test
