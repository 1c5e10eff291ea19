// Lights changed and mixed in a picture.
#include <OpenImageIO/imageio.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "photile/layered_picture.hpp"
#include "picture_support.hpp"

namespace photile::test {
namespace {

TEST_CASE("the root is the float sum of the layers in order, alpha one") {
  LightMix mix;
  mix.lights = {mixed("z", 812.5), mixed("a", 3.1), mixed("m", 47.0)};
  const Image picture = mix_layers(random_layers(7, 5, {"z", "a", "m"}), mix);
  for (const std::string channel : {"R", "G", "B"}) {
    std::vector<float> sum(35, 0.0f);
    for (const std::string light : {"z", "a", "m"}) {
      const std::vector<float>& layer = *picture.find("Combined_" + light + "." + channel);
      for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += layer[i];
    }
    CHECK(same_bits(*picture.find(channel), sum));
  }
  CHECK(*picture.find("A") == std::vector<float>(35, 1.0f));
  const std::vector<std::string> first(picture.channel_names.begin(),
                                       picture.channel_names.begin() + 4);
  CHECK(first == std::vector<std::string>{"R", "G", "B", "A"});
}

TEST_CASE("a layer is radiance x power x tint, and lux are illuminance x power") {
  const LightLayers layers = random_layers(3, 2, {"lamp"});
  LightMix mix;
  mix.lights = {mixed("lamp", 800.0)};
  mix.lights[0].tint = {2.0f, 1.0f, 0.5f};
  const Image picture = mix_layers(layers, mix);
  for (std::size_t i = 0; i < 6; ++i) {
    const glm::vec3 radiance = layers.layers[0].radiance[i];
    CHECK((*picture.find("Combined_lamp.R"))[i] == Approx(radiance.r * 1600.0).epsilon(1e-6));
    CHECK((*picture.find("Combined_lamp.G"))[i] == Approx(radiance.g * 800.0).epsilon(1e-6));
    CHECK((*picture.find("Combined_lamp.B"))[i] == Approx(radiance.b * 400.0).epsilon(1e-6));
    CHECK((*picture.find("Illuminance_lamp.Y"))[i] ==
          Approx(layers.layers[0].illuminance[i] * 800.0).epsilon(1e-6));
  }
  CHECK(picture.attributes.at("photile.units") == "cd/m2");
  CHECK(picture.attributes.at("photile.illuminance.units") == "lux");
  CHECK(picture.numbers.at("whiteLuminance") == 1.0f);
}

TEST_CASE("a scene in watts keeps W/(m2 sr) in its picture and gives lux by the efficacy") {
  const LightLayers layers = random_layers(3, 2, {"lamp"});
  LightMix mix;
  mix.lumen_per_watt = 179.0;
  mix.lights = {mixed("lamp", 12.0, PowerUnit::watt)};
  const Image picture = mix_layers(layers, mix);
  for (std::size_t i = 0; i < 6; ++i) {
    CHECK((*picture.find("R"))[i] == Approx(layers.layers[0].radiance[i].r * 12.0).epsilon(1e-6));
    CHECK((*picture.find("Illuminance_lamp.Y"))[i] ==
          Approx(layers.layers[0].illuminance[i] * 12.0 * 179.0).epsilon(1e-6));
  }
  CHECK(picture.attributes.at("photile.units") == "W/(m2 sr)");
  CHECK(picture.attributes.at("photile.illuminance.units") == "lux");
  CHECK(picture.attributes.at("photile.efficacy") == "179");
  CHECK(picture.numbers.at("whiteLuminance") == 179.0f);
}

TEST_CASE("photile.lights names every light with its power, unit, colour and tint") {
  LightMix mix;
  mix.lights = {mixed("b", 5.5), mixed("a \"x\" = ü", 0.0)};
  mix.lights[0].color = {1.5f, 0.75f, 2.0f};
  mix.lights[0].tint = {0.5f, 1.25f, 0.25f};
  const Image picture = mix_layers(random_layers(2, 2, {"b", "a \"x\" = ü"}), mix);
  const auto lights = nlohmann::json::parse(picture.attributes.at("photile.lights"));
  REQUIRE(lights.size() == 2);
  CHECK(lights[0]["name"] == "b");
  CHECK(lights[0]["power"] == 5.5);
  CHECK(lights[0]["unit"] == "lm");
  CHECK(lights[0]["color"] == nlohmann::json{1.5, 0.75, 2.0});
  CHECK(lights[0]["tint"] == nlohmann::json{0.5, 1.25, 0.25});
  CHECK(lights[1]["name"] == "a \"x\" = ü");
  CHECK(lights[1]["power"] == 0.0);
}

TEST_CASE("a mix is read back from an EXR, whatever order the file keeps channels in") {
  const TemporaryFolder folder;
  LightMix mix;
  mix.lumen_per_watt = 179.0;
  mix.lights = {mixed("z", 5.5, PowerUnit::watt), mixed("a", 0.1, PowerUnit::watt)};
  mix.lights[1].tint = {0.1f, 0.2f, 0.3f};
  mix.lights[1].color = {0.7f, 1.1f, 0.9f};
  write_exr(folder / "a.exr", mix_layers(random_layers(2, 2, {"z", "a"}), mix));
  const LightMix read = read_light_mix(read_image(folder / "a.exr"));
  CHECK(read.lumen_per_watt == 179.0);
  REQUIRE(read.lights.size() == 2);
  for (std::size_t i = 0; i < 2; ++i) {
    CHECK(read.lights[i].name == mix.lights[i].name);
    CHECK(read.lights[i].power == mix.lights[i].power);
    CHECK(read.lights[i].unit == mix.lights[i].unit);
    CHECK(read.lights[i].color == mix.lights[i].color);
    CHECK(read.lights[i].tint == mix.lights[i].tint);
  }
}

TEST_CASE("a scene's own mix has its lights' names, powers, unit and colours") {
  Scene scene;
  scene.unit = PowerUnit::watt;
  scene.lights.resize(2);
  scene.lights[0].name = "one";
  scene.lights[0].power = 3.0;
  scene.lights[1].name = "two";
  scene.lights[1].color = {2.0f, 0.5f, 1.0f};
  const LightMix mix = LightMix::of(scene, 683.0);
  REQUIRE(mix.lights.size() == 2);
  CHECK(mix.lights[0].name == "one");
  CHECK(mix.lights[0].power == 3.0);
  CHECK(mix.lights[0].unit == PowerUnit::watt);
  CHECK(mix.lights[1].color == glm::vec3(2.0f, 0.5f, 1.0f));
  CHECK(mix.lights[1].tint == glm::vec3(1.0f));
}

TEST_CASE("layers start black, one per light, in the scene's order") {
  Scene scene;
  scene.lights.resize(2);
  scene.lights[0].name = "one";
  scene.lights[1].name = "two";
  const LightLayers layers(4, 3, scene);
  REQUIRE(layers.layers.size() == 2);
  CHECK(layers.layers[1].light == "two");
  CHECK(layers.layers[1].radiance == std::vector<glm::vec3>(12, glm::vec3(0.0f)));
  CHECK(layers.layers[1].illuminance == std::vector<float>(12, 0.0f));
}

TEST_CASE("a light at power 0 is black even where its layer is not finite") {
  LightLayers layers = random_layers(2, 1, {"lamp"});
  layers.layers[0].radiance[0] = glm::vec3(std::numeric_limits<float>::quiet_NaN());
  LightMix mix;
  mix.lights = {mixed("lamp", 0.0)};
  CHECK((*mix_layers(layers, mix).find("R"))[0] == 0.0f);
}

TEST_CASE("a layer whose light the mix lacks is refused by name") {
  LightMix mix;
  mix.lights = {mixed("other", 1.0)};
  const std::string message =
      message_of<UsageError>([&] { mix_layers(random_layers(2, 2, {"lamp"}), mix); });
  CHECK(message.find("'lamp'") != std::string::npos);
}

LightMix two_lights() {
  LightMix mix;
  mix.lumen_per_watt = 200.0;
  mix.lights = {mixed("lamp", 800.0), mixed("heater", 50.0, PowerUnit::watt)};
  return mix;
}

LightMix after(const std::vector<std::string>& changes) {
  LightMix mix = two_lights();
  std::vector<LightChange> parsed;
  for (const std::string& text : changes) parsed.push_back(LightChange::parse(text));
  change_lights(mix, parsed);
  return mix;
}

TEST_CASE("a power without a unit is in the light's own") {
  CHECK(after({"lamp=1200"}).lights[0].power == 1200.0);
  CHECK(after({"heater=12.5"}).lights[1].power == 12.5);
  CHECK(after({"lamp=1e3"}).lights[0].power == 1000.0);
}

TEST_CASE("a power with a unit is converted by the efficacy") {
  CHECK(after({"lamp=1200lm"}).lights[0].power == 1200.0);
  CHECK(after({"lamp=10W"}).lights[0].power == 2000.0);
  CHECK(after({"heater=10W"}).lights[1].power == 10.0);
  CHECK(after({"heater=1000lm"}).lights[1].power == 5.0);
}

TEST_CASE("factors multiply, off is zero, and changes apply in order") {
  CHECK(after({"lamp=x0.5"}).lights[0].power == 400.0);
  CHECK(after({"lamp=50%"}).lights[0].power == 400.0);
  CHECK_THROWS_AS(after({"lamp=%"}), UsageError);
  CHECK(after({"lamp=off"}).lights[0].power == 0.0);
  CHECK(after({"lamp=0"}).lights[0].power == 0.0);
  CHECK(after({"lamp=x2", "lamp=x3"}).lights[0].power == 4800.0);
  CHECK(after({"lamp=x2", "lamp=100"}).lights[0].power == 100.0);
  CHECK(after({"lamp=off", "lamp=100"}).lights[0].power == 100.0);
  CHECK(after({"lamp=x2"}).lights[1].power == 50.0);
}

TEST_CASE("a colour becomes a tint of luminance 1 with the ratios of linear sRGB") {
  const MixedLight light = after({"lamp=#FF8000"}).lights[0];
  // IEC 61966-2-1: code 128 of 255 is 0.21586 linear, code 255 is 1.
  const double green = 0.2158605;
  const double y = 0.2126 + 0.7152 * green;
  CHECK(light.tint.r == Approx(1.0 / y).epsilon(1e-6));
  CHECK(light.tint.g == Approx(green / y).epsilon(1e-6));
  CHECK(light.tint.b == 0.0f);
  CHECK(light.power == 800.0);
  CHECK(after({"lamp=#ffffff"}).lights[0].tint == glm::vec3(1.0f));
  // Only hue and saturation count, and the last colour replaces the one before.
  CHECK(after({"lamp=#00FF00", "lamp=#808080"}).lights[0].tint.b == Approx(1.0).epsilon(1e-6));
}

TEST_CASE("a colour temperature replaces the light's own colour and keeps its power") {
  LightMix mix = two_lights();
  mix.lights[0].color = {1.4f, 0.9f, 0.8172f};
  change_lights(mix, {LightChange::parse("lamp=2700K")});
  const glm::dvec3 color = glm::dvec3(mix.lights[0].tint) * glm::dvec3(mix.lights[0].color);
  // Chromaticity (0.4599, 0.4106) of the black body, in Rec.709.
  CHECK(color.r / color.b == Approx(1.9353 / 0.1917).epsilon(0.02));
  CHECK(luminance(color) == Approx(1.0).epsilon(1e-6));
  CHECK(mix.lights[0].power == 800.0);
  mix.lights[0].color = {4.7036689f, 0.0f, 0.0f};
  CHECK_THROWS_AS(change_lights(mix, {LightChange::parse("lamp=2700K")}), UsageError);
  for (const char* text : {"lamp=K", "lamp=999K", "lamp=40001K", "lamp=x2K", "lamp=-5000K"}) {
    CHECK_THROWS_AS(after({text}), UsageError);
  }
}

TEST_CASE("a tint keeps the luminance of the light's own colour") {
  LightMix mix = two_lights();
  mix.lights[0].color = {2.0f, 0.7f, 1.0f};
  change_lights(mix, {LightChange::parse("lamp=#3060C0")});
  CHECK(luminance(glm::dvec3(mix.lights[0].tint) * glm::dvec3(mix.lights[0].color)) ==
        Approx(1.0).epsilon(1e-6));
}

TEST_CASE("an unknown light is refused with the list of those there are, and nothing changes") {
  LightMix mix = two_lights();
  const std::string message = message_of<UsageError>([&] {
    change_lights(mix, {LightChange::parse("lamp=5"), LightChange::parse("lmap=5")});
  });
  CHECK(message.find("'lmap'") != std::string::npos);
  CHECK(message.find("'lamp', 'heater'") != std::string::npos);
  CHECK(mix.lights[0].power == 800.0);
}

TEST_CASE("a malformed, negative or non-finite value is refused, naming light and value") {
  for (const std::string value :
       {"-1",       "-1lm",    "nan",     "inf",     "1e999", "12 lm", "12kW",
        "lm",       "W",       "5,5",     "x",       "x-1",   "xnan",  "#12345",
        "#1234567", "#GG0000", "#-12345", "#000000", "Off",   " 5",    "0x10"}) {
    LightMix mix = two_lights();
    const std::string message = message_of<UsageError>([&] {
      change_lights(mix, {LightChange{"lamp", value}});
    });
    INFO(message);
    CHECK(message.find("'lamp'") != std::string::npos);
    CHECK(message.find("'" + value + "'") != std::string::npos);
  }
}

TEST_CASE("factors that multiply beyond the largest number are refused") {
  CHECK_THROWS_AS(after({"lamp=x1e300", "lamp=x1e300"}), UsageError);
}

TEST_CASE("a colour that a light's own colour lacks altogether is refused") {
  LightMix mix = two_lights();
  mix.lights[0].color = {4.7f, 0.0f, 0.0f};
  CHECK_THROWS_AS(change_lights(mix, {LightChange::parse("lamp=#0000FF")}), UsageError);
}

TEST_CASE("a change is split at its last equals sign, and both sides must be there") {
  const LightChange change = LightChange::parse("desk = left=x2");
  CHECK(change.name == "desk = left");
  CHECK(change.value == "x2");
  for (const char* text : {"lamp", "=5", "lamp=", "=", ""}) {
    CHECK_THROWS_AS(LightChange::parse(text), UsageError);
  }
}

const std::vector<std::string> names{"window", "lamp", "sconce"};

LightMix mix_of(double window, double lamp, double sconce) {
  LightMix mix;
  mix.lights = {mixed("window", window), mixed("lamp", lamp), mixed("sconce", sconce)};
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
  CHECK_NOTHROW(relight(picture, parse({"lamp=x3"})));  // still off
  CHECK_NOTHROW(relight(picture, parse({"lamp=off"})));
}

TEST_CASE("a colour that an earlier tint took out of the picture cannot come back") {
  const Image red = relight(mix_layers(random_layers(3, 3, names), mix_of(1.0, 1.0, 1.0)),
                            parse({"lamp=#FF0000"}));
  CHECK_THROWS_AS(relight(red, parse({"lamp=#FFFFFF"})), UsageError);
  CHECK_NOTHROW(relight(red, parse({"lamp=x2"})));
}

TEST_CASE("a picture without light layers is an input error") {
  Image picture;
  picture.width = picture.height = 2;
  for (const char* name : {"R", "G", "B"}) picture.add(name);
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
  const std::string message =
      message_of<InputError>([&] { relight(read_image(folder / "two.exr"), {}); });
  CHECK(message.find("'Left'") != std::string::npos);
  CHECK(message.find("'Right'") != std::string::npos);
}

TEST_CASE("a layer without all of R, G and B is refused by name") {
  const TemporaryFolder folder;
  write_parts(folder / "half.exr", {{"", {"Combined_key.R", "Combined_key.G"}}});
  const std::string message =
      message_of<InputError>([&] { relight(read_image(folder / "half.exr"), {}); });
  CHECK(message.find("'key'") != std::string::npos);
  CHECK(message.find("channel B") != std::string::npos);
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

}  // namespace
}  // namespace photile::test
