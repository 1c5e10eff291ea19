// Colours of light by temperature, against published chromaticities.
#include <catch2/catch.hpp>
#include <tuple>

#include "scene/light_emission.hpp"
#include "scene_files.hpp"

namespace photile::test {

using Catch::Contains;
using scene::chromaticity_of_temperature;
using scene::color_of_temperature;

TEST_CASE("chromaticities are those that are published") {
  // CIE standard illuminants A, D55, D65 and D75; the Planckian locus of Wyszecki and Stiles.
  for (const auto& [kelvin, x, y] :
       {std::tuple{2855.5, 0.44758, 0.40745}, std::tuple{5503.0, 0.33243, 0.34744},
        std::tuple{6504.0, 0.31272, 0.32903}, std::tuple{7504.0, 0.29903, 0.31488},
        std::tuple{2000.0, 0.52669, 0.41331}, std::tuple{3000.0, 0.43693, 0.40407},
        std::tuple{4000.0, 0.38045, 0.37675}}) {
    const glm::dvec2 found = chromaticity_of_temperature(kelvin);
    CAPTURE(kelvin);
    CHECK(found.x == Approx(x).margin(4e-4));
    CHECK(found.y == Approx(y).margin(4e-4));
  }
}

TEST_CASE("6504 K is white, 2700 K is warm, and luminances are 1") {
  const glm::dvec3 white = color_of_temperature(6504);
  CHECK(white.r == Approx(1).margin(0.005));
  CHECK(white.g == Approx(1).margin(0.005));
  CHECK(white.b == Approx(1).margin(0.005));
  double before = 1e9;
  for (double kelvin = 1000; kelvin <= 40'000; kelvin *= 1.05) {
    const glm::dvec3 color = color_of_temperature(kelvin);
    CHECK(luminance(color) == Approx(1));
    CHECK(color.b >= 0);
    CHECK(color.r < before);  // bluer and bluer
    before = color.r;
  }
}

TEST_CASE("photile_kelvin and the option of the library colour a light and keep its flux") {
  nlohmann::json document = square_document();
  document["nodes"][0]["extras"]["photile_kelvin"] = 2700;
  const Scene warm = load_gltf(document);
  const Scene plain = load_gltf(square_document());
  CHECK(glm::distance(warm.lights.at(0).color, glm::vec3(color_of_temperature(2700))) < 1e-6f);
  CHECK(warm.lights[0].power == plain.lights.at(0).power);
  SceneLoadOptions options;
  options.temperatures.push_back(LightTemperature::parse("panel=4000K"));
  const Scene changed = load_gltf(document, options);
  CHECK(glm::distance(changed.lights.at(0).color, glm::vec3(color_of_temperature(4000))) < 1e-6f);

  options.temperatures = {LightTemperature::parse("lamp=4000")};
  CHECK_THROWS_WITH(load_gltf(document, options), Catch::Contains("there is 'panel'"));
  document["nodes"][0]["extras"]["photile_kelvin"] = 5;
  CHECK(warns(load_gltf(document), {"'panel'", "photile_kelvin"}));
}

TEST_CASE("texts of temperatures are checked") {
  CHECK(LightTemperature::parse("a=b=2700K").light == "a=b");
  CHECK(LightTemperature::parse("lamp=2700").kelvin == 2700);
  for (const char* text : {"", "lamp", "lamp=", "=2700", "lamp=warm", "lamp=999", "lamp=40001",
                           "lamp=2700KK", "lamp=nan"}) {
    CAPTURE(text);
    CHECK_THROWS_AS(LightTemperature::parse(text), UsageError);
  }
}

}  // namespace photile::test
