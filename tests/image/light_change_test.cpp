// Changes of lights: powers, colours and tints.
#include "picture_support.hpp"

namespace photile::test {
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
