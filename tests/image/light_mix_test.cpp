// Pictures mixed of the layers of their lights, and what their attributes say of the mix.
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <tuple>

#include "picture_support.hpp"

namespace photile::test {

TEST_CASE("the root is the float sum of the layers in order, alpha one") {
  LightMix mix{{mixed("z", 812.5), mixed("a", 3.1), mixed("m", 47.0)}};
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
  LightMix mix{{mixed("lamp", 800.0)}};
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
  LightMix mix{{mixed("b", 5.5), mixed("a \"x\" = ü", 0.0)}};
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

TEST_CASE("a luminaire with a photometric file has lumens in a scene of watts, others watts") {
  constexpr double efficacy = 179;
  Scene scene;
  scene.unit = PowerUnit::watt;
  scene.distributions.push_back({"even", {}, {0, 180}, {0, 360}, {100, 100, 100, 100}});
  scene.lights.resize(2);
  scene.lights[0].name = "fire";
  scene.lights[0].power = 3;
  scene.lights[1].name = "lamp";
  scene.lights[1].power = 10;  // W, as all powers of the scene
  scene.lights[1].distribution = 0;
  LightMix mix = LightMix::of(scene, efficacy);
  CHECK(mix.lights[0].unit == PowerUnit::watt);
  CHECK(mix.lights[0].power == 3);
  CHECK(mix.lights[1].unit == PowerUnit::lumen);
  CHECK(mix.lights[1].power == Approx(10 * efficacy));
  CHECK(mix.unit() == PowerUnit::lumen);

  // A layer of 1 W (lm) is W/(m2 sr) for each watt and cd/m2 for each lumen.
  const LightLayers layers = random_layers(3, 2, {"fire", "lamp"});
  const Image picture = mix_layers(layers, mix);
  for (std::size_t i = 0; i < 6; ++i) {
    const float fire = layers.layers[0].radiance[i].g, lamp = layers.layers[1].radiance[i].g;
    CHECK((*picture.find("G"))[i] == Approx(efficacy * (3 * fire + 10 * lamp)).epsilon(1e-6));
    for (const auto& [name, layer, watts] : {std::tuple("fire", 0, 3.0), {"lamp", 1, 10.0}}) {
      CHECK((*picture.find(fmt::format("Illuminance_{}.Y", name)))[i] ==
            Approx(efficacy * watts * layers.layers[layer].illuminance[i]).epsilon(1e-6));
    }
  }
  CHECK(picture.attributes.at("photile.units") == "cd/m2");
  CHECK(picture.numbers.at("whiteLuminance") == 1.0f);
  std::vector<glm::vec3> root(6);
  combine_layers(light_layers(picture), read_light_mix(picture), root);
  for (std::size_t i = 0; i < 6; ++i)
    CHECK(root[i].g == Approx((*picture.find("G"))[i]).epsilon(1e-6));

  // Numbers without a unit are of the light's own.
  const Image changed = relight(picture, {{"lamp", "500"}, {"fire", "1"}});
  const auto lights = nlohmann::json::parse(changed.attributes.at("photile.lights"));
  CHECK(lights[0]["unit"] == "W");
  CHECK(lights[0]["power"] == 1);
  CHECK(lights[1]["unit"] == "lm");
  CHECK(lights[1]["power"] == 500);
  for (std::size_t i = 0; i < 6; ++i) {
    const float fire = layers.layers[0].radiance[i].r, lamp = layers.layers[1].radiance[i].r;
    CHECK((*changed.find("R"))[i] == Approx(efficacy * fire + 500 * lamp).epsilon(1e-5));
  }

  // Without the lamp's layer what is left is in cd/m2 still.
  Image left;
  static_cast<PictureHeader&>(left) = picture;
  left.channel_names.clear();
  for (const std::string channel :
       {"R", "G", "B", "A", "Combined_fire.R", "Combined_fire.G", "Combined_fire.B"}) {
    left.add(channel) = *picture.find(channel);
  }
  CHECK(relight(left, {}).attributes.at("photile.units") == "cd/m2");
  CHECK(read_light_mix(left).lights[0].unit == PowerUnit::lumen);
  CHECK(read_light_mix(left).lights[0].power == Approx(3 * efficacy));
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
  LightMix mix{{mixed("lamp", 0.0)}};
  CHECK((*mix_layers(layers, mix).find("R"))[0] == 0.0f);
}

TEST_CASE("a layer whose light the mix lacks is refused by name") {
  LightMix mix{{mixed("other", 1.0)}};
  const std::string message =
      message_of<UsageError>([&] { mix_layers(random_layers(2, 2, {"lamp"}), mix); });
  CHECK(message.find("'lamp'") != std::string::npos);
}

// Changes of lights: powers, colours and tints.

namespace {

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

}  // namespace

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
  CHECK(after({"lamp=off"}).lights[0].power == 0.0);
  CHECK(after({"lamp=0"}).lights[0].power == 0.0);
  CHECK(after({"lamp=x2", "lamp=x3"}).lights[0].power == 4800.0);
  CHECK(after({"lamp=x2", "lamp=100"}).lights[0].power == 100.0);
  CHECK(after({"lamp=off", "lamp=100"}).lights[0].power == 100.0);
  CHECK(after({"lamp=x2"}).lights[1].power == 50.0);
}

TEST_CASE("a glob changes all lights that it matches, a name only its own") {
  const LightMix all = after({"*=x2"});
  CHECK(all.lights[0].power == 1600.0);
  CHECK(all.lights[1].power == 100.0);
  const LightMix some = after({"h*r=off"});
  CHECK(some.lights[0].power == 800.0);
  CHECK(some.lights[1].power == 0.0);
  LightMix starred = two_lights();
  starred.lights[1].name = "l*";
  change_lights(starred, {LightChange::parse("l*=off")});
  CHECK(starred.lights[0].power == 800.0);
  CHECK(starred.lights[1].power == 0.0);
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

TEST_CASE("a colour that a light's own colour lacks altogether is refused") {
  LightMix mix = two_lights();
  mix.lights[0].color = {4.7f, 0.0f, 0.0f};
  CHECK_THROWS_AS(change_lights(mix, {LightChange::parse("lamp=#0000FF")}), UsageError);
}

TEST_CASE("a change is split at its last equals sign") {
  const LightChange change = LightChange::parse("desk = left=x2");
  CHECK(change.name == "desk = left");
  CHECK(change.value == "x2");
}

}  // namespace photile::test
