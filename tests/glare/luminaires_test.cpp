// Luminaires as observers see them, and their ratings, against closed forms.
#include "glare/luminaires.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "glare/measure_glare.hpp"
#include "test_scenes.hpp"
#include "validation/analytic_cases.hpp"

namespace photile::test {
namespace {

using namespace glare;

/// At the origin, looking along y with z up.
const Observer eye{"eye", glm::dvec3(0), {0, 1, 0}, {0, 0, 1}};

/// A square of 2 h metres that faces the eye from `distance` metres, `above` the line of sight.
void add_panel(SceneBuilder& builder, double h, double distance, double above, double lumens,
               const std::string& name = "panel") {
  const auto black = builder.add(diffuse(0));
  const auto light = builder.add(area_light(name, lumens));
  builder.grid(glm::vec3(-h, distance, above - h), glm::vec3(2 * h, 0, 0), glm::vec3(0, 0, 2 * h),
               1, black, light);
}

/// Solid angle of a rectangle a x b seen from `distance` straight before its middle.
double solid_angle(double a, double b, double distance) {
  return 4 * std::asin(
                 a * b /
                 std::sqrt((a * a + 4 * distance * distance) * (b * b + 4 * distance * distance)));
}

LightMix mix_of(const Scene& scene) { return LightMix::of(scene, 683); }

TEST_CASE("a panel before the eye has its luminance, solid angle and illuminance") {
  SceneBuilder builder("panel");
  add_panel(builder, 0.5, 2, 0, 1000);
  const Scene scene = builder.build();
  const RayScene rays(scene);
  const auto seen = Luminaires(rays, 1024).seen_by(eye, mix_of(scene));
  REQUIRE(seen.size() == 1);
  CHECK(seen[0].name == "panel");
  CHECK(seen[0].luminance == Approx(1000 / glm::pi<double>()).epsilon(1e-4));  // 1 m2
  CHECK(seen[0].solid_angle == Approx(solid_angle(1, 1, 2)).epsilon(2e-3));
  CHECK(seen[0].projected_area == Approx(1).epsilon(0.07));
  const double factor = validation::rectangle_factor(eye.position, eye.forward, {-0.5, 2, -0.5},
                                                     {1, 0, 0}, {0, 0, 1});
  CHECK(seen[0].illuminance == Approx(1000 * factor).epsilon(5e-3));
  CHECK(seen[0].direction.y == Approx(1).epsilon(1e-3));
}

TEST_CASE("a screen hides its part of a panel, a pane of glass weakens it") {
  const bool glass = GENERATE(false, true);
  SceneBuilder builder("panel");
  add_panel(builder, 0.5, 2, 0, 1000);
  const auto screen = builder.add(glass ? test::glass(1.5f, true) : diffuse(0));
  builder.grid({0, 1, -1}, {1, 0, 0}, {0, 0, 2}, 1, screen);  // the right half
  const Scene scene = builder.build();
  const RayScene rays(scene);
  const auto seen = Luminaires(rays, 1024).seen_by(eye, mix_of(scene));
  REQUIRE(seen.size() == 1);
  const double whole = solid_angle(1, 1, 2);
  if (glass) {
    CHECK(seen[0].solid_angle == Approx(whole).epsilon(2e-3));
    CHECK(seen[0].luminance < 0.97 * 1000 / glm::pi<double>());
    CHECK(seen[0].luminance >
          0.94 * 1000 / glm::pi<double>());  // half of it through 4% at each of two sides
  } else {
    CHECK(seen[0].solid_angle == Approx(0.5 * whole).epsilon(0.02));
    CHECK(seen[0].luminance == Approx(1000 / glm::pi<double>()).epsilon(1e-4));
  }
}

TEST_CASE(
    "what lies behind the eye, shines away or is off is not seen; parts apart are luminaires") {
  SceneBuilder builder("panels");
  const auto black = builder.add(diffuse(0));
  const auto both = builder.add(area_light("both", 100));
  builder.grid({-2, 3, 0}, {1, 0, 0}, {0, 0, 1}, 1, black, both);
  builder.grid({1, 3, 0}, {1, 0, 0}, {0, 0, 1}, 1, black, both);
  const auto away = builder.add(area_light("away", 100));
  builder.grid({-2, 4, 3}, {0, 0, 1}, {1, 0, 0}, 1, black, away);
  const auto behind = builder.add(area_light("behind", 100));
  builder.grid({-1, -3, 0}, {0, 0, 1}, {1, 0, 0}, 1, black, behind);
  const Scene scene = builder.build();
  const RayScene rays(scene);
  LightMix mix = mix_of(scene);
  const Luminaires luminaires(rays, 64);
  const auto seen = luminaires.seen_by(eye, mix);
  REQUIRE(seen.size() == 2);
  CHECK(seen[0].name == "both 1");
  CHECK(seen[1].name == "both 2");
  CHECK(seen[0].luminance == Approx(50 / glm::pi<double>()).epsilon(1e-4));
  mix.lights[0].power = 0;
  CHECK(luminaires.seen_by(eye, mix).empty());
}

TEST_CASE("a photometric lamp is as bright as its intensity over its opening") {
  SceneBuilder builder("lamp");
  builder.grid({-5, -5, -2}, {10, 0, 0}, {0, 10, 0}, 1, builder.add(diffuse(0)));
  Light lamp = point_light("lamp", {0, 4, 3});
  lamp.direction = {0, 0, -1};
  builder.add(lamp);
  Scene scene = builder.build();
  IntensityDistribution even("even", {}, {0, 90}, {0, 360}, {500, 500, 500, 500});
  even.set_opening({.x = 1.2, .y = 0.3});
  scene.lights[0].distribution = 0;
  scene.lights[0].power = even.flux();
  scene.distributions.push_back(even);
  const RayScene rays(scene);
  const auto seen = Luminaires(rays, 64).seen_by(eye, mix_of(scene));
  REQUIRE(seen.size() == 1);
  const double area = 1.2 * 0.3 * 3 / 5;  // by the cosine at 3 m up and 4 m ahead
  CHECK(seen[0].luminance == Approx(500 / area).epsilon(1e-5));
  CHECK(seen[0].solid_angle == Approx(area / 25).epsilon(1e-5));
  CHECK(seen[0].illuminance == Approx(500.0 / 25 * 0.8).epsilon(1e-5));
}

/// An even lamp of 500 cd at (0, 4, 3) over a dark floor; a surface of `side` metres squared that
/// faces down, or a point.
Scene even_lamp(const LuminousOpening& opening, const glm::dvec3& aim, const glm::dvec3& x_axis,
                double side = 0) {
  SceneBuilder builder("lamp");
  const auto black = builder.add(diffuse(0));
  builder.grid({-5, -5, -2}, {10, 0, 0}, {0, 10, 0}, 1, black);
  if (side > 0) {
    const auto light = builder.add(area_light("lamp", 1));
    const auto h = static_cast<float>(side / 2);
    builder.grid({-h, 4 - h, 3}, {0, 2 * h, 0}, {2 * h, 0, 0}, 1, black, light);
  } else {
    builder.add(point_light("lamp", {0, 4, 3}));
  }
  Scene scene = builder.build();
  IntensityDistribution even("even", {}, {0, 180}, {0, 360}, {500, 500, 500, 500});
  even.set_opening(opening);
  scene.lights[0].direction = glm::vec3(aim);
  scene.lights[0].x_axis = glm::vec3(x_axis);
  scene.lights[0].two_sided = side > 0;
  scene.lights[0].distribution = 0;
  scene.lights[0].power = even.flux();
  scene.distributions.push_back(even);
  return scene;
}

VisibleLuminaire seen_of(const Scene& scene, const Observer& observer) {
  const RayScene rays(scene);
  const auto seen = Luminaires(rays, 256).seen_by(observer, mix_of(scene));
  REQUIRE(seen.size() == 1);
  return seen[0];
}

const Observer level{"level", {0, 0, 3}, {0, 1, 0}, {0, 0, 1}};

TEST_CASE("a tube that is turned and tilted shows its length and ends as they lie in the room") {
  constexpr double length = 1.2, d = 0.1;
  const LuminousOpening tube{.x = length,
                             .y = d,
                             .heights = {d, d, d, d},
                             .shape = LuminousOpening::Shape::cylinder_along_x};
  for (const glm::dvec3& along : {glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, 0.8, 0.6),
                                  glm::normalize(glm::dvec3(1, 2, -2))}) {
    const glm::dvec3 aim = glm::normalize(glm::cross(along, glm::dvec3(0.3, 0.1, 1)));
    const Scene scene = even_lamp(tube, aim, along);
    for (const Observer& observer : {eye, level}) {
      const glm::dvec3 way = glm::dvec3(0, 4, 3) - observer.position;
      const double end = std::abs(glm::dot(along, way)) / glm::length(way);
      const double area =
          length * d * std::sqrt(1 - end * end) + 0.25 * glm::pi<double>() * d * d * end;
      CAPTURE(along.x, along.y, along.z, observer.name);
      CHECK(seen_of(scene, observer).projected_area == Approx(area).epsilon(1e-5));
      CHECK(seen_of(scene, observer).luminance == Approx(500 / area).epsilon(1e-5));
    }
  }
}

TEST_CASE("a placed lamp has the opening of its file, also edge-on, unless its size is another") {
  constexpr double d = 0.3;
  const LuminousOpening globe{
      .x = d, .y = d, .heights = {d, d, d, d}, .shape = LuminousOpening::Shape::ellipsoid};
  const double disc = 0.25 * glm::pi<double>() * d * d;
  const Scene as_in_file = even_lamp(globe, {0, 0, -1}, {1, 0, 0}, std::sqrt(disc));
  for (const Observer& observer : {eye, level}) {
    CAPTURE(observer.name);
    CHECK(seen_of(as_in_file, observer).projected_area == Approx(disc).epsilon(1e-3));
    CHECK(seen_of(as_in_file, observer).luminance == Approx(500 / disc).epsilon(1e-3));
  }
  const Scene larger = even_lamp(globe, {0, 0, -1}, {1, 0, 0}, 0.5);
  CHECK(seen_of(larger, eye).projected_area == Approx(0.25 * 3 / 5).epsilon(0.01));
}

TEST_CASE("openings of photometric files count for the coverage of the ceiling") {
  const LuminousOpening panel{.x = 2, .y = 1};
  const Scene down = even_lamp(panel, {0, 0, -1}, {1, 0, 0});
  CHECK(Luminaires(RayScene(down), 1).large_area({0, 0, 1}) == Approx(2));
  const Scene upright = even_lamp(panel, {0, 1, 0}, {1, 0, 0});
  CHECK(Luminaires(RayScene(upright), 1).large_area({0, 0, 1}) == Approx(0).margin(1e-6));
}

TEST_CASE("a small lamp before an even background has UGR and DGP in closed form") {
  constexpr double background = 120;
  SceneBuilder builder("lamp before a sky");
  add_panel(builder, 0.1, 3, 1.2, 400);
  Scene scene = builder.build();
  add_environment(scene,
                  EnvironmentMap("sky", 2, 1, std::vector<glm::vec3>(2, glm::vec3(background))));
  GlareParameters parameters;
  parameters.measuring.by_paths = true;
  parameters.measuring.gathering.rays = 4096;
  parameters.measuring.repeats = 4;
  parameters.measuring.photons.film.samples_per_pixel = 4;
  parameters.picture_side = 256;
  const auto all = measure_glare(scene, std::span(&eye, 1), mix_of(scene), 1, {}, parameters);
  REQUIRE(all.size() == 1);
  const ObserverGlare& glare = all.front();
  const double luminance = 400 / (glm::pi<double>() * 0.04);
  const double distance2 = 9 + 1.44, cosine = 3 / std::sqrt(distance2);
  const double omega = 0.04 * cosine / distance2;
  const double p = position_index(eye, glm::normalize(glm::dvec3(0, 3, 1.2)));
  CHECK(glare.background.value == Approx(background).epsilon(0.01));
  REQUIRE(glare.ugr);
  CHECK(glare.ugr->value ==
        Approx(8 * std::log10(0.25 / background * luminance * luminance * omega / (p * p)))
            .margin(0.05));
  CHECK_FALSE(glare.ggr);
  const double at_eye = glm::pi<double>() * background + luminance * omega * cosine;
  CHECK(glare.illuminance.value == Approx(at_eye).epsilon(0.01));
  REQUIRE(glare.dgp);
  REQUIRE(glare.picture->sources.size() == 1);
  CHECK(glare.dgp->value == Approx(5.87e-5 * at_eye + 0.16 +
                                   0.0918 * std::log10(1 + luminance * luminance * omega /
                                                               (std::pow(at_eye, 1.87) * p * p)))
                                .epsilon(0.02));
  CHECK(glare.picture->illuminance == Approx(at_eye).epsilon(0.02));
}

constexpr double sky = 120;  ///< cd/m2

GlareParameters without_pictures() {
  GlareParameters parameters;
  parameters.by_pictures = false;
  return parameters;
}

/// Under an even sky, by paths.
ObserverGlare rated(SceneBuilder& builder, GlareParameters parameters) {
  Scene scene = builder.build();
  add_environment(scene, EnvironmentMap("sky", 2, 1, std::vector<glm::vec3>(2, glm::vec3(sky))));
  parameters.measuring.by_paths = true;
  parameters.measuring.gathering.rays = 4096;
  parameters.measuring.repeats = 2;
  parameters.measuring.photons.film.samples_per_pixel = 16;
  return measure_glare(scene, std::span(&eye, 1), mix_of(scene), 1, {}, parameters).front();
}

TEST_CASE("UGR by luminaires and by pictures is the same where the sources are the same") {
  SceneBuilder builder("two panels before a sky");
  const double lumens = 3000, luminance = lumens / (glm::pi<double>() * 0.36);
  const auto black = builder.add(diffuse(0));
  for (const float x : {-1.1f, 0.5f}) {
    const auto light = builder.add(area_light(x < 0 ? "left" : "right", lumens));
    builder.grid({x, 3, 0.7f}, {0.6f, 0, 0}, {0, 0, 0.6f}, 1, black, light);
  }
  double sum = 0, at_eye = 0;  // of both, by their places' luminance, solid angle and p
  constexpr int places = 40;
  for (int i = 0; i < places * places; ++i) {
    const glm::dvec3 way(0.5 + 0.6 * (i % places + 0.5) / places, 3,
                         0.7 + 0.6 * (i / places + 0.5) / places);
    const double d2 = glm::dot(way, way), cosine = 3 / std::sqrt(d2);
    const double omega = 0.36 / (places * places) * cosine / d2;
    const double p = position_index(eye, glm::normalize(way));
    sum += 2 * luminance * luminance * omega / (p * p);
    at_eye += 2 * luminance * omega * cosine;
  }
  const double behind = sky * (1 - at_eye / luminance / glm::pi<double>());  // panels hide some
  const double truth = 8 * std::log10(0.25 / behind * sum);

  GlareParameters parameters;
  parameters.by_pictures = true;
  parameters.picture_side = 512;
  parameters.search.threshold = 1000;
  const ObserverGlare seen = rated(builder, parameters);
  REQUIRE(seen.ugr);
  CHECK(seen.ugr->value == Approx(truth).margin(0.05));
  // Pixels at a panel's border are darker than it, or no part of it: always a little too low.
  const double by_picture = ugr(seen.picture->plain_sources(), seen.picture->background);
  CHECK(by_picture == Approx(truth).margin(0.2));

  // Panels below the threshold are no sources of the picture: their light is its background.
  parameters.search.threshold = 4000;
  const ObserverGlare blind = rated(builder, parameters);
  CHECK(blind.ugr->value == Approx(truth).margin(0.05));
  CHECK(blind.picture->sources.empty());
  CHECK(blind.picture->background == Approx(behind + at_eye / glm::pi<double>()).epsilon(0.02));
}

TEST_CASE("small openings of one intensity have one UGR, 200 I^2 / r^2") {
  const double lumens = 50, intensity = lumens / glm::pi<double>();
  const double truth = 8 * std::log10(0.25 / sky * 200 * intensity * intensity / 9);
  for (const double half : {0.03, 0.01}) {  // 0.0036 and 0.0004 m2
    CAPTURE(half);
    SceneBuilder builder("small lamp before a sky");
    add_panel(builder, half, 3, 0, lumens);
    CHECK(rated(builder, without_pictures()).ugr->value == Approx(truth).margin(0.1));
  }
}

TEST_CASE("an opening of more than 1.5 m2 has a GGR by its light and the sky's at the eye") {
  SceneBuilder builder("large panel before a sky");
  add_panel(builder, 0.75, 2, 0, 5000);  // 2.25 m2
  const ObserverGlare seen = rated(builder, without_pictures());
  const double factor = validation::rectangle_factor(eye.position, eye.forward, {-0.75, 2, -0.75},
                                                     {1.5, 0, 0}, {0, 0, 1.5});
  const double direct = 5000 / 2.25 * factor, indirect = glm::pi<double>() * sky * (1 - factor);
  REQUIRE(seen.ggr);
  CHECK(*seen.ggr - seen.ugr->value ==
        Approx(8 * std::log10(2.55 * (1 + direct / 220) / (1 + direct / indirect))).margin(0.05));
  // By what was measured itself, to the last digits.
  const double at_eye = seen.luminaires.front().illuminance;
  CHECK(*seen.ggr ==
        Approx(ggr(seen.ugr->value, at_eye, glm::pi<double>() * seen.background.value, 1))
            .margin(1e-6));
}

TEST_CASE("large are openings of more than 1.5 m2, by what of them faces down") {
  SceneBuilder builder("panels");
  const auto black = builder.add(diffuse(0));
  const auto panel = [&](const char* name, float x, const glm::vec3& u, const glm::vec3& v) {
    builder.grid({x, 3, 3}, u, v, 1, black, builder.add(area_light(name, 100)));
  };
  panel("large", -8, {0, 2, 0}, {1, 0, 0});
  panel("leaning", -4, {0, 2, 0}, {0.8f, 0, 0.6f});
  panel("small", 0, {0, 1, 0}, {1, 0, 0});
  panel("to the ceiling", 4, {2, 0, 0}, {0, 2, 0});
  const Scene scene = builder.build();
  const RayScene rays(scene);
  CHECK(Luminaires(rays, 64).large_area({0, 0, 1}) == Approx(2 + 2 * 0.8).epsilon(1e-5));
}

}  // namespace
}  // namespace photile::test
