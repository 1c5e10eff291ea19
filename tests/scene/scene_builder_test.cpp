// Scenes made from arrays: what is filled, and what is refused.
#include "photile/scene_builder.hpp"

#include <functional>
#include <limits>
#include <numbers>

#include "message_of.hpp"
#include "photile/photile.hpp"
#include "scene_invariants.hpp"
#include "test_device.hpp"
#include "test_scenes.hpp"

namespace photile::test {
namespace {

using Catch::Contains;
using std::numbers::pi;

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

/// A tetrahedron of 1 m, fronts outwards, as arrays.
struct Tetrahedron {
  std::vector<glm::vec3> vertices{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  std::vector<glm::uvec3> triangles{{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};

  MeshArrays arrays() const { return {.vertices = vertices, .triangles = triangles}; }
};

Texture grey_texture() { return {"grey", 1, 1, {{128, 128, 128, 255}}}; }

Material textured(std::uint32_t texture) {
  Material material = diffuse(0.5f);
  material.name = "paper";
  material.diffuse_texture = texture;
  return material;
}

}  // namespace

TEST_CASE("a mesh of arrays becomes a scene with every array filled") {
  SceneBuilder builder("tetrahedron");
  builder.add(diffuse(0.5f));
  const std::uint32_t red = builder.add(diffuse({0.5f, 0.1f, 0.1f}));
  const std::uint32_t lamp = builder.add(area_light("lamp", 100));
  const Tetrahedron shape;
  const std::vector<std::uint32_t> materials{0, red, 0, red}, lights{none, none, lamp, none};
  MeshArrays mesh = shape.arrays();
  mesh.materials = materials;
  mesh.lights = lights;
  const std::vector<std::uint32_t> numbers = builder.add(mesh);
  CHECK(numbers == std::vector<std::uint32_t>{0, 1, 2, 3});
  const Scene scene = builder.build();
  check_invariants(scene);
  CHECK(scene.vertices.size() == 4);
  CHECK(scene.triangle_material == materials);
  CHECK(scene.triangle_light == lights);
  CHECK(scene.lights[lamp].triangles == std::vector<std::uint32_t>{2});
  CHECK(scene.cameras.size() == 1);
  for (std::uint32_t t = 0; t < 4; ++t) {
    const glm::dvec3 outwards = face_normal(scene, oriented(t, scene.front_side[t]));
    CHECK(glm::dot(outwards, glm::dvec3(scene.corners(t)[0]) - glm::dvec3(0.2)) > 0);
  }
}

TEST_CASE("triangles without area and those upon others are left out, and have no number") {
  SceneBuilder builder;
  builder.add(diffuse(0.5f));
  Tetrahedron shape;
  shape.triangles = {{0, 1, 2}, {1, 1, 2}, {2, 1, 0}, {0, 1, 3}};
  CHECK(builder.add(shape.arrays()) == std::vector<std::uint32_t>{0, none, none, 1});
  const Scene scene = builder.build();
  CHECK(scene.report.degenerate_triangles == 1);
  CHECK(scene.report.duplicate_triangles == 1);
}

TEST_CASE("coordinates and normals follow the corners, and only those that materials need stay") {
  SceneBuilder builder;
  const std::uint32_t plain = builder.add(diffuse(0.5f));
  builder.triangle({5, 0, 0}, {6, 0, 0}, {5, 1, 0}, plain);
  const std::uint32_t paper = builder.add(textured(builder.add(grey_texture())));
  const Tetrahedron shape;
  std::vector<glm::vec2> uv;
  for (const glm::vec3& p : shape.vertices) uv.emplace_back(p.x + 2 * p.y, p.z);
  MeshArrays mesh = shape.arrays();
  mesh.uv = uv;
  mesh.normals = shape.vertices;
  mesh.material = paper;
  builder.add(mesh);
  const Scene scene = builder.build();
  REQUIRE(scene.corner_uv.size() == 5);
  CHECK(scene.corner_uv[0] == std::array<glm::vec2, 3>{});
  for (std::size_t t = 1; t < 5; ++t) {
    for (std::size_t c = 0; c < 3; ++c) {
      const glm::vec3 p = scene.corners(t)[c];
      CHECK(scene.corner_uv[t][c] == glm::vec2(p.x + 2 * p.y, p.z));
    }
  }
  CHECK(scene.corner_normal.size() == 5);  // they bend a matt surface
  CHECK(scene.corner_tangent.empty());
  CHECK(scene.corner_emission_uv.empty());
}

TEST_CASE("a triangle is the same whichever corner comes first, and its winding is its front") {
  std::vector<std::size_t> order{0, 1, 2};
  const std::array<glm::vec3, 3> corners{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
  do {
    SceneBuilder builder;
    const std::array given{corners[order[0]], corners[order[1]], corners[order[2]]};
    builder.triangle(given[0], given[1], given[2], builder.add(diffuse(0.5f)));
    const Scene scene = builder.build();
    CHECK(scene.corners(0) == std::array<glm::vec3, 3>{{{0, 0, 0}, {0, 1, 0}, {1, 0, 0}}});
    CHECK(face_normal(scene, oriented(0, scene.front_side[0])).z ==
          glm::cross(given[1] - given[0], given[2] - given[0]).z);
  } while (std::next_permutation(order.begin(), order.end()));
}

TEST_CASE("normals of the triangles stay for materials that ask for a frame, bent ones for all") {
  SceneBuilder builder;
  const std::vector<glm::vec3> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  std::vector<glm::vec3> normals(3, glm::vec3(0, 0, 2));
  const std::vector<glm::uvec3> triangle{{0, 1, 2}};
  const auto add_triangle = [&](SceneBuilder& to) {
    to.add({.vertices = corners,
            .triangles = triangle,
            .normals = normals,
            .material = to.add(diffuse(0.5f))});
  };
  add_triangle(builder);
  CHECK(builder.build().corner_normal.empty());
  builder.add(mirror(0.9f));
  CHECK(builder.build().corner_normal.size() == 1);
  normals[0] = {1, 0, 1};
  SceneBuilder bent;
  add_triangle(bent);
  CHECK(needs_of(bent.build()).smooth_shading);
}

TEST_CASE("a texture is opaque where no texel lets light through") {
  CHECK(Texture("paper", 2, 1, {{1, 2, 3, 255}, {0, 0, 0, 255}}).opaque());
  CHECK_FALSE(Texture("lace", 2, 1, {{1, 2, 3, 255}, {0, 0, 0, 254}}).opaque());
}

TEST_CASE("lights get the flux that the closed forms say") {
  SceneBuilder builder;
  const std::uint32_t white = builder.add(diffuse(0.5f));
  builder.box(glm::vec3(-1), glm::vec3(1), white, true);
  const double disc = glm::pi<double>() * 3;  // of the sphere through the corners, squared metres
  Light sun;
  sun.name = "sun";
  sun.direction = {0, -3, 0};
  sun.color = {2, 2, 2};
  const std::uint32_t parallel = builder.add_distant(sun, 1000);
  sun.angular_diameter = 1.5f;
  const std::uint32_t wide = builder.add_distant(sun, 1000);
  const std::uint32_t sky =
      builder.add_surroundings("sky", EnvironmentMap("even", 4, 2, std::vector(8, glm::vec3(2))));
  const Scene scene = builder.build();
  CHECK(scene.lights[parallel].power == Approx(1000 * disc));
  CHECK(scene.lights[parallel].direction == glm::vec3(0, -1, 0));
  CHECK(scene.lights[parallel].color == glm::vec3(1));
  // Radiance L over the disc: irradiance L pi sin^2, flux per area L 2 pi (1 - cos).
  const double half = 0.75;
  CHECK(scene.lights[wide].power ==
        Approx(1000 * disc * 2 * (1 - std::cos(half)) / std::pow(std::sin(half), 2)));
  CHECK(scene.lights[sky].power == Approx(2 * 4 * glm::pi<double>() * disc));
  CHECK(scene.lights[wide].name == "sun_2");
}

TEST_CASE("a textured area light emits its power, where its texture is bright") {
  SceneBuilder builder;
  const std::uint32_t black = builder.add(diffuse(0.0f));
  Light lamp = area_light("window", 50);
  lamp.emission_texture = builder.add(grey_texture());
  lamp.color = {1, 0, 0};
  const std::uint32_t light = builder.add(lamp);
  const Tetrahedron shape;
  const std::vector<glm::vec2> uv(4, glm::vec2(0.5f));
  MeshArrays mesh = shape.arrays();
  mesh.emission_uv = uv;
  mesh.light = light;
  mesh.material = black;
  builder.add(mesh);
  const Scene scene = builder.build();
  CHECK(scene.lights[light].power == 50);
  // pi A x radiance = 1 over the surface, of texels that are 0.2159 of white.
  const double area = 1.5 + std::sqrt(3) / 2;
  const double texel = std::pow((128 / 255.0 + 0.055) / 1.055, 2.4);
  CHECK(scene.lights[light].texel_radiance.r * 0.2126 * texel * std::numbers::pi * area ==
        Approx(1).epsilon(1e-5));
  CHECK(scene.lights[light].color.g == 0);
}

TEST_CASE("what is wrong with a mesh or a light is said in one line that names the scene") {
  SceneBuilder builder("kitchen");
  const std::uint32_t white = builder.add(diffuse(0.5f));
  const std::uint32_t paper = builder.add(textured(builder.add(grey_texture())));
  const std::uint32_t bulb = builder.add(point_light("bulb", {0, 0, 1}));
  Tetrahedron shape;
  const auto refusal = [&](const std::function<void(MeshArrays&)>& change) {
    MeshArrays mesh = shape.arrays();
    mesh.material = white;
    change(mesh);
    return message_of<InputError>([&] { builder.add(mesh); });
  };
  const std::vector<std::uint32_t> two{0, 0}, unknown{0, 0, 9, 0};
  const std::vector<glm::vec2> short_uv(3);
  const std::vector<glm::vec3> bad_normals{{0, 0, 1}, {0, nan, 0}, {0, 0, 1}, {0, 0, 1}};
  CHECK(refusal([&](auto& m) { m.materials = two; }) ==
        "kitchen: a mesh has 2 materials; it must have none or 4");
  CHECK_THAT(refusal([&](auto& m) { m.materials = unknown; }),
             Contains("kitchen: a triangle has material 9, and there are 2"));
  CHECK_THAT(refusal([&](auto& m) { m.uv = short_uv; }), Contains("3 uv; it must have none or 4"));
  CHECK_THAT(refusal([&](auto& m) { m.normals = bad_normals; }), Contains("normal of vertex 1"));
  CHECK_THAT(refusal([&](auto& m) { m.light = 7; }), Contains("light 7, and there are 1"));
  CHECK_THAT(refusal([&](auto& m) { m.light = bulb; }),
             Contains("'bulb', which is not an area light"));
  CHECK_THAT(refusal([&](auto& m) { m.material = paper; }),
             Contains("without uv") && Contains("'paper'"));
  shape.triangles[3].y = 4;
  CHECK(refusal([](auto&) {}) ==
        "kitchen: triangle 3 of a mesh has the corners 1, 4, 3 of 4 vertices");
  shape.triangles[3].y = 2;
  shape.vertices[2].z = nan;
  CHECK_THAT(refusal([](auto&) {}), Contains("kitchen: vertex 2 of a mesh lies at (0, 1, nan)"));
  shape.vertices[2].z = 1e13f;
  CHECK_THAT(refusal([](auto&) {}), Contains("vertex 2 of a mesh"));

  const auto refuse_light = [&](const std::function<void(Light&)>& change, const char* reason) {
    Light light = point_light("lamp", {0, 0, 0});
    change(light);
    CHECK_THROWS_WITH(builder.add(light), Contains("kitchen: light 'lamp' ") && Contains(reason));
  };
  refuse_light([](Light& l) { l.power = 0; }, "power 0; it must be above 0");
  refuse_light([](Light& l) { l.power = -5; }, "power -5");
  refuse_light([](Light& l) { l.power = std::numeric_limits<double>::quiet_NaN(); }, "power nan");
  refuse_light([](Light& l) { l.color = glm::vec3(0); }, "no colour");
  refuse_light([](Light& l) { l.color = {1, -1, 1}; }, "no colour");
  refuse_light([](Light& l) { l.direction = glm::vec3(0); }, "no direction");
  refuse_light([](Light& l) { l.distribution = 0; }, "distribution 0 of 0");
  refuse_light([](Light& l) { l.emission_texture = 0; }, "emission texture");
  refuse_light(
      [](Light& l) {
        l.kind = LightKind::spot;
        l.inner_cone_angle = 1;
        l.outer_cone_angle = 0.5f;
      },
      "cone angles");
}

TEST_CASE("a scene without triangles, or a lamp without any, is refused") {
  SceneBuilder builder("empty");
  CHECK_THROWS_WITH(builder.build(), "empty: no triangle has an area; add a mesh");
  const std::uint32_t white = builder.add(diffuse(0.5f));
  builder.box(glm::vec3(0), glm::vec3(1), white, true);
  builder.add(area_light("panel"));
  CHECK_THROWS_WITH(builder.build(), Contains("'panel' is an area light without triangles"));
}

TEST_CASE("a scene that was filled wrongly by hand is an error of every stage, and no crash") {
  const auto broken = [](const std::function<void(Scene&)>& change) {
    Scene scene = closed_box(diffuse(0.5f));
    change(scene);
    return scene;
  };
  const Scene whole = broken([](Scene&) {});
  const Photons photons = trace_photons(RayScene(whole), {.emitted_photons = 100}).photons;
  const NeighbourGroups groups = find_neighbour_groups(whole, {.radius = 0.1});
  const auto check_stages = [&](const Scene& scene, const char* reason) {
    INFO(reason);
    const auto refuses = [&](const auto& stage) {
      CHECK_THROWS_WITH(stage(), Contains("closed box: ") && Contains(reason));
      CHECK_THROWS_AS(stage(), InputError);
    };
    refuses([&] { check_scene(scene); });
    refuses([&] { RayScene rays(scene); });
    refuses([&] { find_neighbour_groups(scene, {.radius = 0.1}); });
    refuses([&] { find_patches(scene, 0.1, MapMode::patch); });
    refuses([&] { find_map_groups(scene, photons, MapMode::automatic, {.radius = 0.1}); });
    refuses([&] { index_surface(scene, std::vector<std::uint32_t>(24), 0.1, 60); });
    refuses([&] { PhotonMaps(device(), scene, photons, groups, {.radius = 0.1}); });
    refuses([&] { trace_paths(scene, Camera(), {.width = 2, .height = 2}); });
    refuses([&] { render(scene, Camera(), device(), {}); });
  };
  const auto stages_refuse = [&](const std::function<void(Scene&)>& change, const char* reason) {
    check_stages(broken(change), reason);
  };
  stages_refuse([](Scene& s) { s.front_side.clear(); }, "front_side has 0 elements for 12");
  stages_refuse([](Scene& s) { s.triangle_light.clear(); }, "triangle_light has 0 elements");
  stages_refuse([](Scene& s) { s.triangle_material.pop_back(); }, "triangle_material has 11");
  stages_refuse([](Scene& s) { s.corner_uv.resize(3); }, "corner_uv has 3");
  stages_refuse([](Scene& s) { s.triangles[4].z = 8; }, "of 8 vertices");
  stages_refuse([](Scene& s) { s.vertices[3].y = nan; }, "vertex 3 lies at");
  stages_refuse([](Scene& s) { s.triangle_material[5] = 1; }, "triangle 5 has material 1 of 1");
  stages_refuse([](Scene& s) { s.triangle_light[5] = 0; }, "light 0, which is not an area light");
  stages_refuse([](Scene& s) { s.materials[0].diffuse_texture = 0; }, "has texture 0 of 0");
  stages_refuse([](Scene& s) { s.materials[0].diffuse.g = nan; }, "reflectances lie in [0, 1]");
  for (const double power : {double{nan}, -1.0, 1e300}) {
    stages_refuse([power](Scene& s) { s.lights[0].power = power; }, "has the power");
  }
  stages_refuse([](Scene& s) { s.lights[0].distribution = 2; }, "has distribution 2 of 0");
  stages_refuse([](Scene& s) { s.lights[0].kind = LightKind::environment; }, "no environment");
  stages_refuse([](Scene& s) { s.instances.emplace_back(); }, "instance of mesh 0");
}

TEST_CASE("photons that do not fit the scene are an error of the maps, and no crash") {
  const Scene scene = closed_box(diffuse(0.5f));
  const NeighbourGroups groups = find_neighbour_groups(scene, {.radius = 0.1});
  const Photons whole = trace_photons(RayScene(scene), {.emitted_photons = 100}).photons;
  const auto refuse = [&](const std::function<void(Photons&)>& change, const char* reason) {
    Photons photons = whole;
    change(photons);
    CHECK_THROWS_WITH(PhotonMaps(device(), scene, photons, groups, {.radius = 0.1}),
                      Contains("photons of closed box: ") && Contains(reason));
  };
  refuse([](Photons& p) { p.flux.pop_back(); }, "different lengths");
  refuse([](Photons& p) { p.first_of.clear(); }, "order of their triangles");
  refuse([](Photons& p) { std::reverse(p.oriented_face.begin(), p.oriented_face.end()); },
         "order of their triangles");
  refuse([](Photons& p) { p.position[7].x = nan; }, "NaN or infinite");
  CHECK_THROWS_WITH(
      PhotonMaps(device(), plate(diffuse(0.5f), 1), Photons{}, groups, {.radius = 0.1}),
      Contains("plate"));
}

}  // namespace photile::test
