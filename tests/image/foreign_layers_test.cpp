// Layers as other programs write them; the files are made with OpenImageIO alone.
#include <OpenImageIO/imageio.h>

#include "photile/layered_picture.hpp"
#include "picture_support.hpp"

namespace photile::test {
namespace {

constexpr int columns = 4, rows = 3, pixels = columns * rows;

struct Part {
  std::string name;
  std::vector<std::string> channels;
  enum { text, number } take = text;  ///< type of an attribute
};

/// The value that channel c of the file holds at a pixel; c counts over all parts.
float value_at(int channel, int pixel) { return static_cast<float>(100 * channel + pixel); }

void write_parts(const std::filesystem::path& file, const std::vector<Part>& parts) {
  std::vector<OIIO::ImageSpec> specs;
  for (const Part& part : parts) {
    OIIO::ImageSpec spec(columns, rows, static_cast<int>(part.channels.size()),
                         OIIO::TypeDesc::FLOAT);
    spec.channelnames = part.channels;
    if (!part.name.empty()) spec.attribute("oiio:subimagename", part.name);
    part.take == Part::text ? spec.attribute("take", "first") : spec.attribute("take", 2.0f);
    specs.push_back(spec);
  }
  const auto output = OIIO::ImageOutput::create(file.string());
  REQUIRE(output->open(file.string(), static_cast<int>(specs.size()), specs.data()));
  int first = 0;
  for (std::size_t part = 0; part < parts.size(); ++part) {
    if (part > 0) {
      REQUIRE(output->open(file.string(), specs[part], OIIO::ImageOutput::AppendSubimage));
    }
    const int channels = static_cast<int>(parts[part].channels.size());
    std::vector<float> values;
    for (int pixel = 0; pixel < pixels; ++pixel) {
      for (int channel = 0; channel < channels; ++channel) {
        values.push_back(value_at(first + channel, pixel));
      }
    }
    REQUIRE(output->write_image(OIIO::TypeDesc::FLOAT, values.data()));
    first += channels;
  }
  REQUIRE(output->close());
}

std::vector<std::string> rgb(const std::string& layer) {
  return {layer + ".R", layer + ".G", layer + ".B"};
}

std::vector<std::string> join(std::vector<std::string> a, const std::vector<std::string>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// Two lights in file channels `first` and `second` on; key doubled, window off and on.
void check_relight(const std::filesystem::path& file, int key, int window) {
  const Image picture = read_image(file);
  const LightMix mix = read_light_mix(picture);
  REQUIRE(mix.lights.size() == 2);
  CHECK(mix.lights[0].power == 1.0);
  CHECK(mix.lights[1].power == 1.0);
  const Image relit = relight(picture, {{"key", "x2"}, {"window", "x1"}});
  const char* components[] = {"R", "G", "B"};
  for (int c = 0; c < 3; ++c) {
    const std::vector<float>& root = *relit.find(components[c]);
    const std::vector<float>& layer = *relit.find(std::string("Combined_key.") + components[c]);
    for (int pixel = 0; pixel < pixels; ++pixel) {
      const std::size_t i = static_cast<std::size_t>(pixel);
      CHECK(layer[i] == 2.0f * value_at(key + c, pixel));
      CHECK(root[i] == 2.0f * value_at(key + c, pixel) + value_at(window + c, pixel));
    }
  }
  for (const char* power : {"5", "5lm", "5W"}) {
    const std::string message = message_of<UsageError>([&] { relight(picture, {{"key", power}}); });
    CHECK(message.find("'key'") != std::string::npos);
    CHECK_THROWS_AS(relight(relit, {{"key", power}}), UsageError);  // still unknown
  }
  CHECK_NOTHROW(relight(picture, {{"key", "#FF8000"}, {"window", "off"}}));
}

}  // namespace

TEST_CASE("Blender 5's one part per pass is read as the layers it means") {
  const TemporaryFolder folder;
  write_parts(folder / "blender5.exr",
              {{"ViewLayer.Combined", join(rgb("ViewLayer.Combined"), {"ViewLayer.Combined.A"})},
               {"ViewLayer.Combined_key", rgb("ViewLayer.Combined_key")},
               {"ViewLayer.Combined_window", rgb("ViewLayer.Combined_window")}});
  const Image picture = read_image(folder / "blender5.exr");
  CHECK(picture.channel_names.size() == 10);
  CHECK(picture.find("ViewLayer.Combined_key.G") != nullptr);
  check_relight(folder / "blender5.exr", 4, 7);
}

TEST_CASE("Blender 4's passes in one part are read as layers") {
  const TemporaryFolder folder;
  write_parts(folder / "blender4.exr",
              {{"", join(join(rgb("ViewLayer.Combined"), rgb("ViewLayer.Combined_key")),
                         rgb("ViewLayer.Combined_window"))}});
  check_relight(folder / "blender4.exr", 3, 6);
}

TEST_CASE("Arnold's RGBA_<group> layers with alpha are read as layers") {
  const TemporaryFolder folder;
  write_parts(folder / "arnold.exr",
              {{"", join(join({"R", "G", "B", "A"}, join(rgb("RGBA_key"), {"RGBA_key.A"})),
                         join(rgb("RGBA_window"), {"RGBA_window.A"}))}});
  check_relight(folder / "arnold.exr", 4, 8);
  const Image relit = relight(read_image(folder / "arnold.exr"), {});
  CHECK((*relit.find("A"))[2] == value_at(3, 2));  // the root's own alpha
}

TEST_CASE("layers of two view layers are refused, naming both") {
  const TemporaryFolder folder;
  write_parts(folder / "two.exr",
              {{"", join(rgb("Left.Combined_key"), rgb("Right.Combined_key"))}});
  CHECK_THAT(message_of<InputError>([&] { relight(read_image(folder / "two.exr"), {}); }),
             Catch::Contains("'Left'") && Catch::Contains("'Right'"));
}

TEST_CASE("a layer without all of R, G and B is refused by name") {
  const TemporaryFolder folder;
  write_parts(folder / "half.exr", {{"", {"Combined_key.R", "Combined_key.G"}}});
  CHECK_THAT(message_of<InputError>([&] { relight(read_image(folder / "half.exr"), {}); }),
             Catch::Contains("'key'") && Catch::Contains("channel B"));
}

TEST_CASE("channels that only resemble layers are not taken for lights") {
  for (const char* name : {"Combined_.R", "Combined.R", "RGBA_.R", "RGBA.R", "XCombined_a.R", ".R",
                           "Combined_a", "Combined_a.RG", "..R", "."}) {
    Image picture;
    picture.width = picture.height = 1;
    picture.add(name);
    INFO(name);
    CHECK_THROWS_AS(relight(picture, {}), InputError);
  }
}

TEST_CASE("a light group with blanks and non-ASCII letters keeps its name") {
  const TemporaryFolder folder;
  write_parts(folder / "a.exr", {{"", rgb("ViewLayer.Combined_Küche 1")}});
  CHECK(read_light_mix(read_image(folder / "a.exr")).lights.at(0).name == "Küche 1");
}

TEST_CASE(
    "of an attribute of two types in two parts the first counts, and the picture is written") {
  const TemporaryFolder folder;
  write_parts(folder / "a.exr",
              {{"", rgb("Combined_key")}, {"b", rgb("Combined_b"), Part::number}});
  const PictureHeader read = read_header(folder / "a.exr");
  CHECK(read.attributes.at("take") == "first");
  CHECK(!read.numbers.contains("take"));
  write_exr(folder / "b.exr", *relit_picture(folder / "a.exr", {}));
  CHECK(read_header(folder / "b.exr").attributes.at("take") == "first");
}

TEST_CASE("parts that share channel names are told apart by their part's name") {
  const TemporaryFolder folder;
  write_parts(folder / "stereo.exr", {{"left", {"R", "G", "B"}}, {"right", {"R", "G", "B"}}});
  const Image picture = read_image(folder / "stereo.exr");
  REQUIRE(picture.find("R") != nullptr);
  REQUIRE(picture.find("right.R") != nullptr);
  CHECK((*picture.find("R"))[1] == value_at(0, 1));
  CHECK((*picture.find("right.R"))[1] == value_at(3, 1));
}

}  // namespace photile::test
