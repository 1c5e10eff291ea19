#include <OpenImageIO/imageio.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <limits>

#include "picture_support.hpp"

namespace photile::test {
namespace {

/// 5 x 3 pixels: smaller than any block, with values that a float format may lose.
Image awkward_picture() {
  using Limits = std::numeric_limits<float>;
  Image image;
  image.width = 5;
  image.height = 3;
  // Not in the order of the file: the root comes last here.
  for (const char* name :
       {"Combined_floor lamp.R", "Illuminance_floor lamp.Y", "B", "A", "G", "R"}) {
    std::vector<float>& plane = image.add(name);
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

}  // namespace

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
  Image written;
  written.width = 3;
  written.height = 201;
  std::vector<float>& plane = written.add("R");
  for (std::size_t i = 0; i < plane.size(); ++i) plane[i] = static_cast<float>(i);
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
  LightMix mix;
  mix.lights = {mixed("lamp", 10), mixed("ceiling light", 20)};
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

}  // namespace photile::test
