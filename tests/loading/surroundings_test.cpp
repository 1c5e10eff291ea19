// What surrounds a scene.
#include "loading/surroundings.hpp"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <glm/glm.hpp>
#include <limits>
#include <numbers>
#include <random>

#include "flat_picture.hpp"
#include "pictures/textures.hpp"
#include "textured_square.hpp"
#include "trace/distant_light.hpp"

namespace photile::test {
namespace {

using Catch::Contains;
using pictures::CubeMap;
using std::numbers::pi;

// Environments, suns and skies against closed forms, and pictures that are none.

/// Illuminance of a surface that faces `normal` under all of the map: the midpoint rule over each
/// texel.
double illuminance(const EnvironmentMap& map, const glm::dvec3& normal) {
  double sum = 0;
  for (int row = 0; row < map.height(); ++row) {
    for (int column = 0; column < map.width(); ++column) {
      for (int part = 0; part < 64; ++part) {  // a texel may be as wide as the sky
        const double cosine =
            glm::dot(normal, map.direction_at(column + (part + 0.5) / 64, row, 0.5));
        sum +=
            luminance(map.texel(column, row)) * map.solid_angle(row) * std::max(0.0, cosine) / 64;
      }
    }
  }
  return sum;
}

/// A map whose texels say where they are: red their column, green their row.
EnvironmentMap numbered(double rotation = 0) {
  std::vector<glm::vec3> texels;
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 8; ++column) texels.emplace_back(column, row, 1);
  }
  return {"numbered", 8, 4, texels, rotation};
}

const std::string dark_square = unit_square + "usemtl wall\nf 1 2 3 4\n",
                  dark_wall = "newmtl wall\nKd 0.5 0.5 0.5\n";

Scene load_under(const SceneLoadOptions& options) {
  nlohmann::json document = square_document();
  document["materials"][0]["emissiveFactor"] = {0, 0, 0};
  return load_gltf(document, options);
}

TEST_CASE("an environment has the radiance that its file says, at each place and in its unit") {
  const SceneFolderOnDisk folder;
  const auto hdr = [&](const std::string& lines, const std::string& format = "rgbe") {
    std::string text = "#?RADIANCE\n" + lines + "FORMAT=32-bit_rle_" + format + "\n\n-Y 2 +X 4\n";
    for (int i = 0; i < 8; ++i) text += "\xC8\xC8\xC8\x87";  // 200 / 256 x 2^7 = 100
    return folder.write("e.hdr", text);
  };
  const auto lux = [&](const std::filesystem::path& file, bool watts = false) {
    SceneLoadOptions options;
    options.environment.file = file;
    const Scene scene = watts ? load_obj(dark_square, dark_wall, options) : load_under(options);
    return illuminance(scene.environments.at(0), {0, 1, 0});
  };
  CHECK(lux(hdr("")) == Approx(100 * pi).epsilon(1e-2));
  const double all = lux(hdr(""));
  CHECK(lux(hdr("EXPOSURE=2\nEXPOSURE=5\n")) == Approx(all / 10));
  CHECK(lux(hdr("COLORCORR= 2 2 2\n")) == Approx(all / 2));
  CHECK(lux(hdr("", "xyze")) == Approx(all));
  // XYZ is in cd/m2 (ra_xyze divides by its 179 lm/W), RGB in what the scene has.
  CHECK(lux(hdr(""), true) == Approx(all));
  CHECK(lux(hdr("", "xyze"), true) == Approx(all / SceneLoadOptions().lumen_per_watt));
  CHECK_THROWS_WITH(lux(hdr("VIEW= -vth -vp 0 0 0\n")), Contains("e.hdr") && Contains("-vth"));
  Image picture = flat_picture(4, 2, 0.5f);
  picture.numbers["whiteLuminance"] = 200;
  write_exr(folder.path / "e.exr", picture);
  CHECK(lux(folder.path / "e.exr") == Approx(all));
}

TEST_CASE("the middle of a map lies towards -z, its right half towards +x, its top towards +y",
          "[environment]") {
  const EnvironmentMap map = numbered();
  CHECK(map.radiance({0.01f, 0.1f, -1}) == glm::vec3(4, 1, 1));
  CHECK(map.radiance({-0.01f, -0.1f, -1}) == glm::vec3(3, 2, 1));
  CHECK(map.radiance({1, 0.1f, -0.01f}) == glm::vec3(5, 1, 1));
  CHECK(map.radiance({1, 0.1f, 0.01f}) == glm::vec3(6, 1, 1));
  CHECK(map.radiance({0.01f, 0.1f, 1}) == glm::vec3(7, 1, 1));
  CHECK(map.radiance({-0.01f, 0.1f, 1}) == glm::vec3(0, 1, 1));
  CHECK(map.radiance({0.01f, 1, -0.01f}).g == 0);
  CHECK(map.radiance({0.01f, -1, -0.01f}).g == 3);
  // A quarter turn clockwise from above takes the middle from north to east.
  CHECK(numbered(90).radiance({1, 0.1f, 0.01f}) == glm::vec3(4, 1, 1));
  for (const double rotation : {0.0, 77.0, -200.0}) {
    const EnvironmentMap turned = numbered(rotation);
    for (int row = 0; row < 4; ++row) {
      for (int column = 0; column < 8; ++column) {
        CHECK(turned.radiance(glm::vec3(turned.direction_at(column + 0.3, row, 0.7))) ==
              glm::vec3(column, row, 1));
      }
    }
  }
}

TEST_CASE("texels of a map cover the sphere", "[environment]") {
  const EnvironmentMap even("even", 5, 7, std::vector<glm::vec3>(35, glm::vec3(2.0f)));
  CHECK(even.integral().g == Approx(8 * pi));
}

TEST_CASE("an even environment of L gives the flux 4 pi L times the disc", "[environment]") {
  const SceneFolderOnDisk folder;
  SceneLoadOptions options;
  for (const char* name : {"sky.exr", "sky.hdr"}) {
    options.environment.file =
        write_picture(folder.path / name, 4, 2, 3, std::vector<float>(24, 0.5f));
    options.environment.scale = 20;
    const Scene scene = load_under(options);
    REQUIRE(scene.lights.size() == 1);
    CHECK(scene.lights[0].name == "environment");
    CHECK(scene.lights[0].kind == LightKind::environment);
    CHECK(scene.lights[0].power == Approx(4 * pi * 10 * pi * 0.5));  // radius sqrt(2) / 2
  }
}

TEST_CASE("a picture that is no environment is refused by name", "[environment]") {
  const SceneFolderOnDisk folder;
  const auto error_of = [&](const std::string& file) {
    SceneLoadOptions options;
    options.environment.file = file;
    return input_error_of([&] { load_under(options); });
  };
  CHECK_THAT(
      error_of(write_picture(folder.path / "low.png", 2, 2, 3, std::vector<std::uint8_t>(12, 127))),
      Contains("low.png") && Contains("floating-point"));
  CHECK_THAT(error_of(write_picture(folder.path / "black.exr", 2, 2, 3, std::vector<float>(12, 0))),
             Contains("is black"));
  for (const float bad :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), -0.25f}) {
    std::vector<float> pixels(2 * 3 * 3, 1.0f);
    pixels[4] = pixels[16] = bad;  // texels (1, 0) and (2, 1)
    CHECK_THAT(error_of(write_picture(folder.path / "bad.exr", 3, 2, 3, pixels)),
               Contains("bad.exr") && Contains("2 of 6 texels are NaN, infinite or negative") &&
                   Contains("column 1, row 0"));
  }
}

TEST_CASE("a sun gives its lux to a surface that faces it, whatever its size", "[sun]") {
  for (const double diameter : {0.0, 0.533, 60.0}) {
    SceneLoadOptions options;
    options.sun = Sun{90, 30, 1000, diameter};
    options.ground = 0;
    const Scene scene = load_under(options);
    REQUIRE(scene.lights.size() == 1);
    const Light& sun = scene.lights[0];
    CHECK(sun.name == "sun");
    CHECK(glm::distance(-sun.direction, glm::vec3(std::sqrt(0.75f), 0.5f, 0)) < 1e-6f);
    // E = L pi sin^2, and the flux is L times the solid angle times the disc.
    const double half = diameter * pi / 360;
    const double over = diameter > 0 ? 2 * (1 - std::cos(half)) / std::pow(std::sin(half), 2) : 1;
    CHECK(sun.power == Approx(1000 * over * pi * 0.5));
    CHECK(sun.has_size() == (diameter > 0));
  }
}

TEST_CASE("skies give their lux to the ground") {
  const glm::dvec3 to_sun = loading::direction_to(Sun{200, 35, 1});
  for (const SkyKind kind : {SkyKind::uniform, SkyKind::overcast, SkyKind::clear}) {
    const EnvironmentMap sky = loading::sky_map(kind, 12'000, to_sun);
    CHECK(illuminance(sky, {0, 1, 0}) == Approx(12'000).epsilon(1e-4));
    CHECK(illuminance(sky, {0, -1, 0}) == 0);
  }
}

TEST_CASE("luminances of uniform and overcast skies follow their closed forms") {
  const EnvironmentMap uniform = loading::sky_map(SkyKind::uniform, 1000, {});
  CHECK(uniform.radiance({0.6f, 0.8f, 0}).g == Approx(1000 / pi));
  const EnvironmentMap overcast = loading::sky_map(SkyKind::overcast, 10'000, {});
  const double zenith = 9 * 10'000 / (7 * pi);
  CHECK(overcast.radiance({0.001f, 1, 0}).g == Approx(zenith).epsilon(1e-3));
  CHECK(overcast.radiance({0.8f, 0.6f, 0}).g == Approx(zenith * 2.2 / 3).epsilon(5e-3));
  CHECK(overcast.radiance({0, 0.001f, 1}).g == Approx(zenith / 3).epsilon(2e-2));
  // On a wall: E = Lz (pi/2 + 4/3... ) by integrating L cos over the half of the sky it sees.
  CHECK(illuminance(overcast, {1, 0, 0}) == Approx(zenith / 3 * (pi / 2 + 4.0 / 3)).epsilon(1e-3));
}

TEST_CASE("a clear sky is brightest at its sun and darkest about 90 degrees from it") {
  const glm::dvec3 to_sun = loading::direction_to(Sun{0, 45, 1});
  const EnvironmentMap sky = loading::sky_map(SkyKind::clear, 10'000, to_sun);
  const auto relative = [&](const glm::dvec3& direction) {
    // ISO 15469, type 12, as the standard writes it: zenith angle and angle from the sun.
    const double zenith = std::acos(direction.y), from_sun = std::acos(glm::dot(direction, to_sun));
    return (1 - std::exp(-0.32 / std::cos(zenith))) *
           (1 + 10 * (std::exp(-3 * from_sun) - std::exp(-1.5 * pi)) +
            0.45 * std::pow(std::cos(from_sun), 2));
  };
  const double factor = double{sky.radiance({0.001f, 1, 0}).g} / relative({0, 1, 0});
  for (const glm::dvec3& direction :
       {glm::normalize(glm::dvec3(0, 1, -0.9)), glm::normalize(glm::dvec3(1, 1, 0.5)),
        glm::normalize(glm::dvec3(0.2, 0.3, 1))}) {
    CHECK(sky.radiance(glm::vec3(direction)).g ==
          Approx(factor * relative(direction)).epsilon(0.03));
  }
}

TEST_CASE("a clear sky needs a sun above the horizon") {
  SceneLoadOptions options;
  options.sky = Sky{SkyKind::clear, 10'000};
  options.sun = Sun{0, 5, 1000};
  const Scene scene = load_under(options);
  REQUIRE(scene.lights.size() == 3);
  CHECK(scene.lights[1].name == "sky");
  CHECK(scene.lights[1].power > 0);
}

TEST_CASE("a sky or a sun lights ground that reflects a fifth, unless another is given") {
  const auto ground_under = [](const SceneLoadOptions& options) {
    const Scene scene = load_under(options);
    if (scene.lights.back().name != "ground") return 0.0;
    const trace::DistantLights beyond(scene);
    const std::size_t last = scene.lights.size() - 1;
    return scene.lights[last].power * double{beyond[last].radiance({0, -1, 0}).g};
  };
  SceneLoadOptions options;
  CHECK(!loading::ground_reflectance(options));
  options.sky = Sky{SkyKind::overcast, 10'000};
  CHECK(ground_under(options) == Approx(0.2 * 10'000 / pi));  // a matt plane: E rho / pi
  CHECK(loading::ground_reflectance(options) == 0.2);
  options.sky.reset();
  options.sun = Sun{0, 30, 20'000};
  CHECK(ground_under(options) == Approx(0.2 * 20'000 * 0.5 / pi));
  options.ground = 0;
  CHECK(ground_under(options) == 0);
  CHECK_THAT(loading::sky_facts(options).front().second, Contains("reflectance 0 below"));
  // At night nothing lights it, which is no error unless another ground was asked for.
  options.ground = 0.2;
  options.sun = Sun{0, -30, 20'000};
  CHECK(ground_under(options) == 0);
  // Patches have 1 cd/m2 until an hour is chosen, which is scaled to a ground of 0.2.
  options.sun.reset();
  options.sky = Sky{SkyKind::patches, 0, 0, 0, 145};
  for (const double reflectance : {0.2, 0.5, 0.0}) {
    options.ground = reflectance;
    CHECK(ground_under(options) == Approx(reflectance / 0.2));
  }
}

TEST_CASE("ground below the horizon sends back its share of the light of sky and sun") {
  SceneLoadOptions options;
  options.ground = 0.3;
  options.sky = Sky{SkyKind::overcast, 10'000};
  options.sun = Sun{0, 30, 20'000};  // as much on the ground
  const Scene scene = load_under(options);
  REQUIRE(scene.lights.size() == 3);
  REQUIRE(scene.lights[2].name == "ground");
  const auto radiance_towards = [&](const glm::vec3& direction) {
    const trace::DistantLights beyond(scene);
    return scene.lights[2].power * double{beyond[2].radiance(direction).g};
  };
  CHECK(radiance_towards({0, -1, 0}) == Approx(0.3 * 20'000 / pi));
  CHECK(radiance_towards({0.8f, -0.01f, 0.6f}) == Approx(0.3 * 20'000 / pi));
  CHECK(radiance_towards({0, 1, 0}) == 0);
  CHECK(radiance_towards({0.8f, 0.01f, 0.6f}) == 0);
}

TEST_CASE("lux become watts in an OBJ scene, by the luminous efficacy") {
  SceneLoadOptions options;
  options.sun = Sun{0, 90, 683, 0};
  options.lumen_per_watt = 179;
  options.ground = 0;
  const Scene scene = load_obj(dark_square, dark_wall, options);
  REQUIRE(scene.lights.size() == 1);
  CHECK(scene.lights[0].power == Approx(683.0 / 179 * pi * 0.5));
}

// Cube maps against OpenGL's table of their faces, flipped as EXT_lights_image_based asks, and
// against integrals in closed form.

/// OpenGL 4.6, table 8.19: the direction of a place of a face, s and t from 0 to 1, t from the
/// first row of texels on.
glm::dvec3 opengl_direction(std::size_t face, double s, double t) {
  const double sc = 2 * s - 1, tc = 2 * t - 1;
  const std::array<glm::dvec3, 6> directions{
      {{1, -tc, -sc}, {-1, -tc, sc}, {sc, 1, tc}, {sc, -1, -tc}, {sc, -tc, 1}, {-sc, -tc, -1}}};
  return glm::normalize(directions[face]);
}

/// Direction of the middle of a texel: "each saved image must be flipped about its vertical axis".
glm::dvec3 texel_direction(std::size_t face, int column, int row, int side) {
  return opengl_direction(face, 1 - (column + 0.5) / side, (row + 0.5) / side);
}

/// A cube whose texels hold `radiance` of their directions.
pictures::CubeMap cube_of(int side, const std::function<glm::vec3(const glm::dvec3&)>& radiance) {
  pictures::CubeMap cube;
  for (std::size_t face = 0; face < 6; ++face) {
    cube[face].width = cube[face].height = side;
    for (int row = 0; row < side; ++row) {
      for (int column = 0; column < side; ++column) {
        cube[face].texels.push_back(radiance(texel_direction(face, column, row, side)));
      }
    }
  }
  return cube;
}

TEST_CASE("each texel of a cube map lies where OpenGL has it, flipped") {
  constexpr int side = 5;
  int number = 0;
  const CubeMap cube = cube_of(side, [&](const glm::dvec3&) { return glm::vec3(number++); });
  number = 0;
  for (std::size_t face = 0; face < 6; ++face) {
    for (int row = 0; row < side; ++row) {
      for (int column = 0; column < side; ++column) {
        CAPTURE(face, row, column);
        const glm::dvec3 direction = texel_direction(face, column, row, side);
        CHECK(pictures::radiance_towards(cube, direction) == glm::vec3(number++));
      }
    }
  }
}

TEST_CASE("edges and corners of the cube belong to a face that meets there") {
  const CubeMap cube = cube_of(4, [](const glm::dvec3& d) { return glm::vec3(d); });
  for (const glm::dvec3 direction :
       {glm::dvec3(1, 1, 1), glm::dvec3(-1, 1, -1), glm::dvec3(1, -1, 0), glm::dvec3(0, 1, -1)}) {
    const glm::dvec3 unit = glm::normalize(direction);
    CHECK(glm::distance(glm::dvec3(pictures::radiance_towards(cube, unit)), unit) < 0.5);
  }
}

/// A light from above and from the side, without symmetry.
glm::vec3 uneven(const glm::dvec3& d) {
  return glm::vec3(1 + 0.5 * d.x + 0.25 * d.y, 2 + d.y * d.y, 1 + 0.9 * d.z);
}

TEST_CASE("the equirectangular map of a cube has its radiance and its integral") {
  const CubeMap cube = cube_of(64, uneven);
  const EnvironmentMap map = pictures::environment_of(cube, glm::dquat(1.0, 0.0, 0.0, 0.0), "cube");
  CHECK(map.name() == "cube");
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 200; ++i) {
    const glm::dvec3 d = glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
    // A texel of either map spans 1.4 degrees.
    CHECK(glm::distance(map.radiance(glm::vec3(d)), uneven(d)) < 0.1f);
  }
  // Odd powers vanish, and the mean of y^2 over the sphere is a third.
  CHECK(map.integral().r == Approx(4 * pi).epsilon(1e-3));
  CHECK(map.integral().g == Approx(4 * pi * (2 + 1.0 / 3)).epsilon(1e-3));
  CHECK(map.integral().b == Approx(4 * pi).epsilon(1e-3));
}

TEST_CASE("a rotation turns the surroundings, by any axis") {
  const CubeMap cube = cube_of(64, uneven);
  const glm::dquat rotation = glm::angleAxis(1.1, glm::normalize(glm::dvec3(0.3, -0.5, 0.8)));
  const EnvironmentMap map = pictures::environment_of(cube, rotation, "turned");
  for (const glm::dvec3 d : {glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1),
                             glm::normalize(glm::dvec3(1, -2, 3))}) {
    CHECK(glm::distance(map.radiance(glm::vec3(rotation * d)), uneven(d)) < 0.1f);
  }
}

TEST_CASE("a patch of sky keeps its flux wherever it is turned") {
  // A cap of 20 degrees around +z.
  const CubeMap cube = cube_of(128, [](const glm::dvec3& d) {
    return glm::vec3(d.z > std::cos(20 * pi / 180) ? 100.0f : 0.0f);
  });
  const double expected = 100 * 2 * pi * (1 - std::cos(20 * pi / 180));
  for (const double angle : {0.0, 0.4, pi / 2, 2.0}) {
    const glm::dquat rotation = glm::angleAxis(angle, glm::dvec3(1, 0, 0));  // over a pole
    CHECK(pictures::environment_of(cube, rotation, "cap").integral().g ==
          Approx(expected).epsilon(0.01));
  }
}

}  // namespace
}  // namespace photile::test
