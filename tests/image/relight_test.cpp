// Pictures relit from their layers.
#include <OpenImageIO/imageio.h>

#include "flat_picture.hpp"
#include "image/white.hpp"
#include "picture_support.hpp"

namespace photile::test {
namespace {

using Catch::Contains;

const std::vector<std::string> names{"window", "lamp", "sconce"};

LightMix mix_of(double window, double lamp, double sconce) {
  LightMix mix{{mixed("window", window), mixed("lamp", lamp), mixed("sconce", sconce)}};
  return mix;
}

std::vector<LightChange> parse(const std::vector<std::string>& texts) {
  std::vector<LightChange> changes;
  for (const std::string& text : texts) changes.push_back(LightChange::parse(text));
  return changes;
}

/// Every channel equal within a few float roundings: one of the layer, one of the ratio, and the
/// sum.
void check_equal(const Image& relit, const Image& rendered) {
  REQUIRE(relit.channel_names.size() == rendered.channel_names.size());
  for (std::size_t i = 0; i < rendered.channel_names.size(); ++i) {
    const std::vector<float>* plane = relit.find(rendered.channel_names[i]);
    INFO(rendered.channel_names[i]);
    REQUIRE(plane != nullptr);
    double worst = 0.0;
    for (std::size_t pixel = 0; pixel < plane->size(); ++pixel) {
      const double expected = rendered.channels[i][pixel];
      worst = std::max(worst, std::abs((*plane)[pixel] - expected) / std::max(expected, 1e-30));
    }
    CHECK(worst <= 4 * 1.2e-7);
  }
}

TEST_CASE("relighting a picture equals mixing its layers with the new powers") {
  const TemporaryFolder folder;
  const LightLayers layers = random_layers(9, 7, names);
  write_exr(folder / "a.exr", mix_layers(layers, mix_of(5000.0, 806.0, 33.3)));
  const Image relit =
      relight(read_image(folder / "a.exr"), parse({"lamp=1521", "sconce=x0.3", "window=off"}));
  check_equal(relit, mix_layers(layers, mix_of(0.0, 1521.0, 33.3 * 0.3)));
}

TEST_CASE("relighting with a colour equals mixing with that colour") {
  const LightLayers layers = random_layers(9, 7, names);
  LightMix mix = mix_of(1.0, 2.0, 3.0);
  mix.lights[1].color = {1.8f, 0.8f, 0.6f};
  const std::vector<LightChange> changes = parse({"lamp=#40A0FF", "lamp=7"});
  const Image relit = relight(mix_layers(layers, mix), changes);
  change_lights(mix, changes);
  check_equal(relit, mix_layers(layers, mix));
}

TEST_CASE("a picture without a white of its own is given that of its lights before they change") {
  const LightLayers layers = random_layers(9, 7, names);
  LightMix mix = mix_of(5, 2, 0);
  const auto of_luminance_1 = [](const glm::dvec3& color) {
    return glm::vec3(color / luminance(color));
  };
  mix.lights[0].color = of_luminance_1({0.8, 1.0, 1.4});
  mix.lights[1].color = of_luminance_1({1.8, 0.8, 0.3});
  double sums[2]{};
  for (std::size_t light = 0; light < 2; ++light) {
    for (const float lux : layers.layers[light].illuminance) {
      sums[light] += mix.lights[light].power * double{lux};
    }
  }
  const glm::dvec3 light =
      sums[0] * glm::dvec3(mix.lights[0].color) + sums[1] * glm::dvec3(mix.lights[1].color);
  const Image before = mix_layers(layers, mix);
  REQUIRE_FALSE(image::kept_white(before));
  for (const char* change : {"lamp=6500K", "window=off", "window=x2"}) {
    const auto white = image::kept_white(relight(before, parse({change})));
    REQUIRE(white);
    for (int channel = 0; channel < 3; ++channel) {
      CHECK(double{(*white)[static_cast<std::size_t>(channel)]} ==
            Approx(light[channel] / luminance(light)).epsilon(1e-5));
    }
  }
}

TEST_CASE("a white that is kept stays, and a damaged one is refused with what it is") {
  Image picture = mix_layers(random_layers(9, 7, names), mix_of(5, 2, 1));
  const image::White white{1.5f, 0.9f, 0.1f};
  image::keep_white(picture, white);
  CHECK(image::kept_white(relight(picture, parse({"lamp=2700K"}))) == white);
  for (const char* damaged : {"", "1 1", "1 0 1", "1 nan 1", "white"}) {
    picture.attributes["photile.white"] = damaged;
    CHECK_THROWS_WITH(relight(picture, {}),
                      Contains("photile.white") && Contains("three numbers above 0"));
  }
}

TEST_CASE("a relit picture relights again as the first one would") {
  const LightLayers layers = random_layers(5, 5, names);
  const Image once =
      relight(mix_layers(layers, mix_of(10.0, 20.0, 30.0)), parse({"lamp=35", "sconce=#FFD8A0"}));
  const Image twice = relight(once, parse({"lamp=50", "sconce=#FFFFFF", "window=11"}));
  check_equal(twice, mix_layers(layers, mix_of(11.0, 50.0, 30.0)));
}

TEST_CASE("relighting without changes keeps every bit and the attributes") {
  Image picture = mix_layers(random_layers(5, 5, names), mix_of(10.0, 20.0, 0.0));
  picture.attributes["photile.scene"] = "room.gltf";
  picture.matrices["worldToCamera"] = {1, 2, 3};
  const Image relit = relight(picture, {});
  CHECK(relit.channel_names == picture.channel_names);
  for (std::size_t i = 0; i < picture.channels.size(); ++i) {
    CHECK(same_bits(relit.channels[i], picture.channels[i]));
  }
  CHECK(relit.attributes == picture.attributes);
  CHECK(relit.matrices == picture.matrices);
  CHECK(relit.numbers == picture.numbers);
}

TEST_CASE("attributes that another program gave another type are replaced by photile's own") {
  const TemporaryFolder folder;
  Image picture = mix_layers(random_layers(3, 3, names), mix_of(10.0, 20.0, 0.0));
  picture.numbers.erase("whiteLuminance");
  picture.attributes["whiteLuminance"] = "bright";
  picture.attributes.erase("photile.units");
  picture.numbers["photile.units"] = 3;
  picture.attributes.erase("photile.illuminance.units");
  picture.matrices["photile.illuminance.units"] = {};
  write_exr(folder / "foreign.exr", picture);
  write_exr(folder / "relit.exr", *relit_picture(folder / "foreign.exr", parse({"lamp=x2"})));
  const PictureHeader relit = read_header(folder / "relit.exr");
  CHECK(relit.numbers.at("whiteLuminance") == 1.0f);
  CHECK(relit.attributes.at("photile.units") == "cd/m2");
  CHECK(relit.attributes.at("photile.illuminance.units") == "lux");
}

TEST_CASE("turning up a light that is off in the picture is refused by name") {
  const Image picture = mix_layers(random_layers(3, 3, names), mix_of(10.0, 0.0, 1.0));
  const std::string message = message_of<UsageError>([&] { relight(picture, parse({"lamp=5"})); });
  CHECK(message.find("'lamp'") != std::string::npos);
  const Image dark = mix_layers(random_layers(3, 3, names), mix_of(0.0, 1.0, 1.0));
  CHECK_THROWS_AS(relit_mix(dark, parse({"window=5"})), UsageError);
  CHECK_NOTHROW(relight(picture, parse({"lamp=x3"})));  // still off
  CHECK_NOTHROW(relight(picture, parse({"lamp=off"})));
}

TEST_CASE("the layers of a picture are those that it was mixed from, by the unit of power") {
  const LightLayers layers = random_layers(3, 2, names);
  LightMix mix = mix_of(10.0, 0.0, 0.5);
  mix.lights[2].tint = {0.5f, 1.25f, 0.25f};
  const LightLayers read = light_layers(mix_layers(layers, mix));
  for (std::size_t l = 0; l < names.size(); ++l) {
    const float lit = l == 1 ? 0.0f : 1.0f;  // nothing is known of what is off
    for (std::size_t i = 0; i < 6; ++i) {
      for (int c = 0; c < 3; ++c) {
        CHECK(read.layers[l].radiance[i][c] == Approx(lit * layers.layers[l].radiance[i][c]));
      }
      CHECK(read.layers[l].illuminance[i] == Approx(lit * layers.layers[l].illuminance[i]));
    }
  }
}

TEST_CASE("a colour that an earlier tint took out of the picture cannot come back") {
  const Image red = relight(mix_layers(random_layers(3, 3, names), mix_of(1.0, 1.0, 1.0)),
                            parse({"lamp=#FF0000"}));
  CHECK_THROWS_AS(relight(red, parse({"lamp=#FFFFFF"})), UsageError);
  CHECK_NOTHROW(relight(red, parse({"lamp=x2"})));
}

TEST_CASE("a picture without light layers is an input error") {
  const Image picture = flat_picture(2, 2);
  CHECK_THROWS_AS(relight(picture, {}), InputError);
  CHECK_THROWS_AS(read_light_mix(picture), InputError);
}

TEST_CASE(
    "a light that the records lack takes part with power 1, and a record without layer is left") {
  Image picture = mix_layers(random_layers(3, 3, names), mix_of(10.0, 20.0, 30.0));
  picture.attributes["photile.lights"] =
      R"([{"name":"sconce","power":30,"unit":"lm"},{"name":"gone","power":1,"unit":"lm"}])";
  const LightMix mix = read_light_mix(picture);
  REQUIRE(mix.lights.size() == 3);
  CHECK(mix.lights[0].name == "sconce");
  CHECK(mix.lights[0].power == 30.0);
  CHECK(mix.lights[1].power == 1.0);
  CHECK_THROWS_AS(relight(picture, parse({"gone=off"})), UsageError);
}

TEST_CASE("damaged records are an input error that names the attribute") {
  for (const char* records :
       {"", "{", "5", "[5]", "[{}]", R"([{"name":5}])", R"([{"name":"lamp","power":-1}])",
        R"([{"name":"lamp","power":"many"}])", R"([{"name":"lamp","unit":"bananas"}])",
        R"([{"name":"lamp","tint":[1,2]}])", R"([{"name":"lamp","color":[1,2,-3]}])",
        R"([{"name":"lamp","power":1e999}])"}) {
    Image picture = mix_layers(random_layers(2, 2, names), mix_of(1.0, 1.0, 1.0));
    picture.attributes["photile.lights"] = records;
    INFO(records);
    const std::string message = message_of<InputError>([&] { relight(picture, {}); });
    CHECK(message.find("photile.lights") != std::string::npos);
  }
  for (const char* efficacy : {"", "none", "-5", "0", "inf", "683x"}) {
    Image picture = mix_layers(random_layers(2, 2, names), mix_of(1.0, 1.0, 1.0));
    picture.attributes["photile.efficacy"] = efficacy;
    CHECK_THROWS_AS(relight(picture, {}), InputError);
  }
}

TEST_CASE("records nested 100,000 deep are refused without a crash") {
  Image picture = mix_layers(random_layers(2, 2, names), mix_of(1.0, 1.0, 1.0));
  picture.attributes["photile.lights"] = std::string(100'000, '[');
  CHECK_THROWS_AS(relight(picture, {}), InputError);
  picture.attributes["photile.lights"] = std::string(100'000, '[') + std::string(100'000, ']');
  CHECK_THROWS_AS(relight(picture, {}), InputError);
}

// Layers as other programs write them; the files are made with OpenImageIO alone.

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
             Contains("'Left'") && Contains("'Right'"));
}

TEST_CASE("a layer without all of R, G and B is refused by name") {
  const TemporaryFolder folder;
  write_parts(folder / "half.exr", {{"", {"Combined_key.R", "Combined_key.G"}}});
  CHECK_THAT(message_of<InputError>([&] { relight(read_image(folder / "half.exr"), {}); }),
             Contains("'key'") && Contains("channel B"));
}

TEST_CASE("channels that only resemble layers are not taken for lights") {
  for (const char* name : {"Combined_.R", "Combined.R", "RGBA_.R", "RGBA.R", "XCombined_a.R", ".R",
                           "Combined_a", "Combined_a.RG", "..R", "."}) {
    INFO(name);
    CHECK_THROWS_AS(relight(flat_picture(1, 1, 0, {name}), {}), InputError);
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

}  // namespace
}  // namespace photile::test
