// The scenes under scenes/ hold what scenes/README.md says.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <random>

#include "photile/load_scene.hpp"
#include "photile/scene.hpp"
#include "source_folder.hpp"
#include "test_scenes.hpp"

namespace photile::test {
namespace {

const std::filesystem::path folder = source_folder() / "scenes";
const std::filesystem::path cornell_obj = folder / "cornell-box/cornell-box.obj";
const std::filesystem::path cornell_gltf = folder / "cornell-box/cornell-box.gltf";
const std::filesystem::path cornell_specular = folder / "cornell-box/cornell-box-specular.gltf";
const std::filesystem::path living_room = folder / "living-room/living-room.gltf";

const Light& light_named(const Scene& scene, const std::string& name) {
  const auto found = std::find_if(scene.lights.begin(), scene.lights.end(),
                                  [&](const Light& light) { return light.name == name; });
  INFO(name);
  REQUIRE(found != scene.lights.end());
  return *found;
}

/// Distance along a ray to a triangle (Moeller and Trumbore 1997), both sides.
std::optional<double> distance_to(const Scene& scene, std::uint32_t triangle,
                                  const glm::dvec3& origin, const glm::dvec3& direction) {
  const auto corners = scene.corners(triangle);
  const glm::dvec3 a(corners[0]), u = glm::dvec3(corners[1]) - a, v = glm::dvec3(corners[2]) - a;
  const glm::dvec3 p = glm::cross(direction, v);
  const double determinant = glm::dot(u, p);
  if (std::abs(determinant) < 1e-14) return {};
  const glm::dvec3 s = origin - a, q = glm::cross(s, u);
  const double b1 = glm::dot(s, p) / determinant, b2 = glm::dot(direction, q) / determinant;
  const double t = glm::dot(v, q) / determinant;
  if (b1 < 0 || b2 < 0 || b1 + b2 > 1 || t <= 1e-9) return {};
  return t;
}

struct Seen {
  int rays = 0, escaped = 0, backs = 0;
};

/// What rays in random directions from a point meet first.
Seen look_around(const Scene& scene, const glm::dvec3& origin, int rays) {
  std::mt19937 engine(11);
  std::normal_distribution<double> gauss;
  Seen seen{rays};
  for (int ray = 0; ray < rays; ++ray) {
    const double x = gauss(engine), y = gauss(engine), z = gauss(engine);
    const glm::dvec3 direction = glm::normalize(glm::dvec3(x, y, z));
    double nearest = std::numeric_limits<double>::infinity();
    std::uint32_t hit = none;
    for (std::uint32_t triangle = 0; triangle < scene.triangle_count(); ++triangle) {
      const std::optional<double> t = distance_to(scene, triangle, origin, direction);
      if (t && *t < nearest) {
        nearest = *t;
        hit = triangle;
      }
    }
    if (hit == none) {
      ++seen.escaped;
    } else if (glm::dot(front_normal(scene, hit), direction) > 0) {
      ++seen.backs;
    }
  }
  return seen;
}

}  // namespace

TEST_CASE("bundled scenes load without a warning or a dropped triangle") {
  const auto gallery = [](const char* name) { return folder / "gallery" / name; };
  for (const auto& file :
       {cornell_obj, cornell_gltf, cornell_specular, living_room, gallery("glass-sphere.gltf"),
        gallery("metal-ring.gltf"), gallery("glossy-floor.gltf"), gallery("downlights.gltf"),
        gallery("coloured-lamps.gltf")}) {
    const Scene scene = load_scene(file);
    INFO(file.filename().string());
    for (const std::string& warning : scene.report.warnings) {
      INFO(warning);
      CHECK(false);
    }
    CHECK(scene.report.degenerate_triangles == 0);
    CHECK(scene.report.non_finite_triangles == 0);
    CHECK(scene.report.duplicate_triangles == 0);
  }
}

TEST_CASE("the Cornell box has its published size, its lamp 130 mm x 105 mm and 1000 lm") {
  for (const auto& file : {cornell_obj, cornell_gltf, cornell_specular}) {
    const Scene scene = load_scene(file);
    glm::vec3 low(1e9f), high(-1e9f);
    for (const glm::vec3& vertex : scene.vertices) {
      low = glm::min(low, vertex);
      high = glm::max(high, vertex);
    }
    CHECK(glm::length(low) < 1e-6f);
    CHECK(glm::length(high - glm::vec3(0.556f, 0.5488f, 0.5592f)) < 1e-6f);
    REQUIRE(scene.lights.size() == 1);
    const Light& lamp = light_named(scene, "lamp");
    const double lumen = scene.unit == PowerUnit::watt ? lamp.power * 683.0 : lamp.power;
    CHECK(lumen == Approx(1000.0).epsilon(1e-4));
    CHECK_FALSE(lamp.two_sided);
    double area = 0.0;
    for (const std::uint32_t triangle : lamp.triangles) {
      area += triangle_area(scene, triangle);
      CHECK(front_normal(scene, triangle).y == Approx(-1.0));
    }
    CHECK(area == Approx(0.130 * 0.105).epsilon(1e-5));
  }
  CHECK(load_scene(cornell_obj).unit == PowerUnit::watt);
  CHECK(load_scene(cornell_gltf).unit == PowerUnit::lumen);
}

TEST_CASE("the Cornell box's camera is the published one") {
  const Camera camera = load_scene(cornell_gltf).cameras.at(0);
  CHECK(glm::length(camera.position - glm::dvec3(0.278, 0.273, -0.8)) < 1e-6);
  CHECK(glm::length(camera.forward - glm::dvec3(0.0, 0.0, 1.0)) < 1e-6);
  CHECK(std::tan(camera.vertical_field_of_view / 2) == Approx(0.5 * 25.0 / 35.0).epsilon(1e-5));
  CHECK(camera.aspect_ratio == Approx(1.0));
}

TEST_CASE("the Cornell box is the same triangles as OBJ and as glTF") {
  const auto sorted_corners = [](const Scene& scene) {
    std::vector<std::array<float, 9>> triangles;
    for (std::size_t i = 0; i < scene.triangle_count(); ++i) {
      const auto c = scene.corners(i);
      triangles.push_back({c[0].x, c[0].y, c[0].z, c[1].x, c[1].y, c[1].z, c[2].x, c[2].y, c[2].z});
    }
    std::sort(triangles.begin(), triangles.end());
    return triangles;
  };
  const auto obj = sorted_corners(load_scene(cornell_obj));
  CHECK(obj.size() == 38);
  CHECK(obj == sorted_corners(load_scene(cornell_gltf)));
}

TEST_CASE("the specular Cornell box has one glass and one mirror") {
  const Scene scene = load_scene(cornell_specular);
  std::map<Interaction, std::size_t> triangles;
  for (const std::uint32_t material : scene.triangle_material) {
    ++triangles[scene.materials[material].interaction];
  }
  CHECK(triangles[Interaction::mirror] == 10);
  CHECK(triangles[Interaction::glass] > 1000);
}

TEST_CASE("the living room has the lamps, lumens and directions that its description gives") {
  const Scene scene = load_scene(living_room);
  struct Lamp {
    const char* name;
    double lumen;
    glm::dvec3 front;  ///< of all its triangles; zero for a bulb
  };
  const Lamp lamps[] = {{"daylight", 1200, {0, 0, 1}},    {"ceiling_panel", 1600, {0, -1, 0}},
                        {"floor_lamp", 1050, {0, 0, 0}},  {"sconce_left", 400, {0, 1, 0}},
                        {"sconce_right", 400, {0, 1, 0}}, {"desk_lamp", 470, {0, -1, 0}}};
  CHECK(scene.unit == PowerUnit::lumen);
  CHECK(scene.lights.size() == std::size(lamps) + 1);
  for (const Lamp& lamp : lamps) {
    const Light& light = light_named(scene, lamp.name);
    CHECK(light.power == Approx(lamp.lumen).epsilon(1e-4));
    CHECK_FALSE(light.two_sided);
    REQUIRE_FALSE(light.triangles.empty());
    for (const std::uint32_t triangle : light.triangles) {
      if (lamp.front == glm::dvec3(0.0)) continue;
      CHECK(glm::dot(front_normal(scene, triangle), lamp.front) == Approx(1.0));
    }
  }
  const Light& spot = light_named(scene, "picture_spot");
  CHECK(spot.kind == LightKind::spot);
  CHECK(spot.direction.x < -0.7f);  // towards the west wall
  CHECK(scene.cameras.size() == 2);
}

TEST_CASE("the living room has plausible albedos, textures, a mirror, glass and glossy things") {
  const Scene scene = load_scene(living_room);
  CHECK(scene.triangle_count() > 30'000);
  CHECK(scene.triangle_count() < 150'000);
  std::map<std::string, int> kinds;
  for (const std::uint32_t index : scene.triangle_material) {
    const Material& material = scene.materials[index];
    if (material.interaction == Interaction::mirror) ++kinds["mirror"];
    if (material.interaction == Interaction::glass) ++kinds["glass"];
    if (material.glossy()) ++kinds["glossy"];
    if (material.normal_texture != none) ++kinds["bumpy"];
    if (material.diffuse_texture != none) ++kinds["textured"];
  }
  for (const char* kind : {"mirror", "glass", "glossy", "bumpy", "textured"}) {
    INFO(kind);
    CHECK(kinds[kind] > 0);
  }
  for (const Material& material : scene.materials) {
    if (material.interaction != Interaction::opaque || material.glossy()) continue;
    for (float v = 0.0f; v < 1.0f; v += 0.05f) {
      for (float u = 0.0f; u < 1.0f; u += 0.05f) {
        glm::vec3 albedo = material.diffuse;
        if (material.diffuse_texture != none) {
          albedo *= scene.textures[material.diffuse_texture].sample({u, v});
        }
        CHECK(std::max({albedo.r, albedo.g, albedo.b}) <= 0.85f);
      }
    }
  }
}

TEST_CASE("from inside the living room nothing is open and every surface shows its front") {
  const Scene scene = load_scene(living_room);
  for (const glm::dvec3& origin : {glm::dvec3(3.0, 1.9, 3.0), glm::dvec3(2.9, 0.3, 3.4)}) {
    const Seen seen = look_around(scene, origin, 1'500);
    CHECK(seen.escaped == 0);
    CHECK(seen.backs == 0);
  }
}

TEST_CASE("from inside the Cornell box every surface shows its front") {
  for (const auto& file : {cornell_gltf, cornell_specular}) {
    const Seen seen = look_around(load_scene(file), {0.28, 0.42, 0.1}, 1'500);
    CHECK(seen.backs == 0);
    CHECK(seen.escaped > 0);  // the side towards the camera is open
    CHECK(seen.escaped < 700);
  }
}

TEST_CASE("the bundled scenes stay small") {
  std::uintmax_t bytes = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file() && entry.path().extension() != ".pyc") bytes += entry.file_size();
  }
  CHECK(bytes < 8'000'000);
}

}  // namespace photile::test
