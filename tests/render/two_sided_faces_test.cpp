// Faces in one place that look away from each other: two rooms beside each other, each with its
// own side of what divides them. Every surface of a room emits what it does not reflect of an even
// light, so that the light is even: a closed form that any wrong side of the partition breaks.
#include <catch2/catch.hpp>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <vector>

#include "photile/renderer.hpp"
#include "photile/sensors.hpp"
#include "test_device.hpp"
#include "test_scenes.hpp"
#include "trace/ray_query.hpp"

namespace photile::test {
namespace {

constexpr double pi = glm::pi<double>();
/// Illuminance of all surfaces of the rooms, lux.
constexpr double west_lux = 100, east_lux = 1000;

/// How the two sides of the partition lie in its plane.
enum class Partition {
  equal,      ///< the same triangles
  diagonals,  ///< quads that are cut along different diagonals
  panel       ///< the east room has a smaller panel on the west room's wall
};

/// Two cubes of 2 m beside each other, at x < 0 and x > 0, turned and moved.
class Rooms {
 public:
  explicit Rooms(bool turned) : turned_(turned) {}

  glm::vec3 at(const glm::dvec3& p) const {
    if (!turned_) return glm::vec3(p);
    const glm::dmat4 turn = glm::rotate(glm::dmat4(1.0), 0.7, glm::dvec3(0.48, 0.6, 0.64));
    return glm::vec3(glm::dvec3(turn * glm::dvec4(p, 1.0)) + glm::dvec3(0.3, -0.2, 0.7));
  }
  glm::dvec3 towards(const glm::dvec3& direction) const {
    return glm::normalize(glm::dvec3(at(direction)) - glm::dvec3(at(glm::dvec3(0.0))));
  }

  /// A quad that emits what an even light lacks. Its front has the corners counter-clockwise.
  void quad(SceneBuilder& builder, const std::array<glm::dvec3, 4>& p, float reflectance,
            double lux, bool other_diagonal = false) const {
    const std::uint32_t material = builder.add(diffuse(reflectance));
    const double area = glm::length(glm::cross(p[1] - p[0], p[3] - p[0]));
    std::uint32_t light = none;
    if (reflectance < 1) light = builder.add(area_light("side", (1 - reflectance) * lux * area));
    const int first = other_diagonal ? 1 : 0;
    builder.quad(at(p[first]), at(p[first + 1]), at(p[(first + 2) % 4]), at(p[(first + 3) % 4]),
                 material, light);
  }

  /// All but the side at x = 0; `sign`: of x.
  void shell(SceneBuilder& builder, double sign, float reflectance, double lux) const {
    const double x = 2 * sign;
    const auto face = [&](std::array<glm::dvec3, 4> p) {
      if (sign < 0) std::swap(p[1], p[3]);
      quad(builder, p, reflectance, lux);
    };
    face({{{0, 0, 0}, {x, 0, 0}, {x, 2, 0}, {0, 2, 0}}});
    face({{{0, 0, 2}, {0, 2, 2}, {x, 2, 2}, {x, 0, 2}}});
    face({{{0, 0, 0}, {0, 0, 2}, {x, 0, 2}, {x, 0, 0}}});
    face({{{0, 2, 0}, {x, 2, 0}, {x, 2, 2}, {0, 2, 2}}});
    face({{{x, 0, 0}, {x, 0, 2}, {x, 2, 2}, {x, 2, 0}}});
  }

  /// The side of the west room, which looks to it.
  void west_side(SceneBuilder& builder, Partition partition) const {
    // Around the panel the east room sees the back of this wall, which does not emit.
    const float reflectance = partition == Partition::panel ? 1.0f : 0.85f;
    quad(builder, {{{0, 0, 0}, {0, 0, 2}, {0, 2, 2}, {0, 2, 0}}}, reflectance, west_lux);
  }
  void east_side(SceneBuilder& builder, Partition partition) const {
    if (partition != Partition::panel) {
      quad(builder, {{{0, 0, 0}, {0, 2, 0}, {0, 2, 2}, {0, 0, 2}}}, 0.05f, east_lux,
           partition == Partition::diagonals);
      return;
    }
    quad(builder, {{{0, 0.3, 0.4}, {0, 1.5, 0.4}, {0, 1.5, 1.7}, {0, 0.3, 1.7}}}, 0.05f, east_lux);
  }

  Scene scene(Partition partition, bool east_first) const {
    SceneBuilder builder("two rooms");
    if (east_first) east_side(builder, partition);
    west_side(builder, partition);
    if (!east_first) east_side(builder, partition);
    shell(builder, -1, 0.5f, west_lux);
    shell(builder, 1, 0.6f, east_lux);
    return builder.build();
  }

 private:
  bool turned_;
};

std::vector<double> lux_of(const Scene& scene, const LightLayers& layers) {
  const LightLayers dense = layers.dense();
  std::vector<double> lux(dense.layers.at(0).illuminance.size(), 0.0);
  for (std::size_t light = 0; light < dense.layers.size(); ++light) {
    for (std::size_t i = 0; i < lux.size(); ++i) {
      lux[i] += scene.lights[light].power * double{dense.layers[light].illuminance[i]};
    }
  }
  return lux;
}

/// In each room: towards the partition, away from it, along it, and on the partition itself.
std::vector<Sensor> sensors_in(const Rooms& rooms) {
  std::vector<Sensor> sensors;
  for (const double sign : {-1.0, 1.0}) {
    const glm::dvec3 middle(rooms.at({sign * 0.6, 0.9, 1.1})), on_it(rooms.at({0, 0.9, 1.1}));
    sensors.push_back({middle, rooms.towards({-sign, 0, 0})});
    sensors.push_back({middle, rooms.towards({sign, 0, 0})});
    sensors.push_back({middle, rooms.towards({0, 0, 1})});
    sensors.push_back({on_it, rooms.towards({sign, 0, 0})});
  }
  return sensors;
}

void check_rooms(const std::vector<double>& lux, double tolerance) {
  REQUIRE(lux.size() == 8);
  for (std::size_t i = 0; i < lux.size(); ++i) {
    CAPTURE(i);
    CHECK(lux[i] == Approx(i < 4 ? west_lux : east_lux).epsilon(tolerance));
  }
}

RenderParameters few_photons(LightMapMode mode) {
  RenderParameters parameters;
  parameters.photons.emitted_photons = 100'000;
  parameters.light_maps = mode;
  return parameters;
}

}  // namespace

TEST_CASE("each room has its own side of what divides it from the next by paths") {
  const auto partition = GENERATE(Partition::equal, Partition::diagonals, Partition::panel);
  const bool turned = GENERATE(false, true), east_first = GENERATE(false, true);
  CAPTURE(static_cast<int>(partition), turned, east_first);
  const Rooms rooms(turned);
  const Scene scene = rooms.scene(partition, east_first);
  const auto layers = gather_by_paths(scene, sensors_in(rooms), {.rays = 4096}, 1).layers;
  check_rooms(lux_of(scene, layers), 0.05);
}

/// Whether sensors in both rooms read by photons what is right.
void check_by_photons(Partition partition, bool turned, bool east_first, LightMapMode mode) {
  CAPTURE(static_cast<int>(partition), turned, east_first, name_of(mode));
  const Rooms rooms(turned);
  const Scene scene = rooms.scene(partition, east_first);
  const auto layers =
      gather(scene, sensors_in(rooms), {.rays = 1024}, std::span(&device(), 1), few_photons(mode))
          .layers;
  check_rooms(lux_of(scene, layers), 0.05);
}

TEST_CASE("each room has its own side of what divides it from the next by photons") {
  check_by_photons(Partition::equal, false, true, LightMapMode::off);
  check_by_photons(Partition::diagonals, true, false, LightMapMode::on);
  check_by_photons(Partition::panel, true, true, LightMapMode::on);
}

TEST_CASE("each room has its own side of any partition by photons", "[slow]") {
  check_by_photons(GENERATE(Partition::equal, Partition::diagonals, Partition::panel),
                   GENERATE(false, true), GENERATE(false, true),
                   GENERATE(LightMapMode::off, LightMapMode::on));
}

TEST_CASE("pictures show the side of the room that the camera is in") {
  const auto partition = GENERATE(Partition::equal, Partition::diagonals, Partition::panel);
  const auto mode = partition == Partition::panel ? LightMapMode::off : LightMapMode::on;
  CAPTURE(static_cast<int>(partition), name_of(mode));
  const Rooms rooms(true);
  const Scene scene = rooms.scene(partition, false);
  for (const double sign : {-1.0, 1.0}) {
    RenderParameters parameters = few_photons(mode);
    parameters.film.width = parameters.film.height = 16;
    const glm::dvec3 eye(rooms.at({sign * 1.7, 1, 1})), middle(rooms.at({0, 1, 1}));
    const Camera camera = Camera::look_at(eye, middle, rooms.towards({0, 0, 1}), 1.0);
    const auto layers = render(scene, camera, device(), parameters).layers.dense();
    double radiance = 0;
    for (std::size_t light = 0; light < layers.layers.size(); ++light) {
      for (const glm::vec3& value : layers.layers[light].radiance) {
        radiance += scene.lights[light].power * luminance(glm::dvec3(value)) / 256;
      }
    }
    CHECK(pi * radiance == Approx(sign < 0 ? west_lux : east_lux).epsilon(0.04));
  }
}

TEST_CASE("a panel on the back of a wall hides that back where it lies, to a rounding") {
  const bool turned = GENERATE(false, true), east_first = GENERATE(false, true);
  CAPTURE(turned, east_first);
  const Rooms rooms(turned);
  const Scene scene = rooms.scene(Partition::panel, east_first);
  const RayScene rays(scene);
  const trace::FlushDenormals flush_denormals;
  const auto albedo_seen = [&](const glm::dvec3& from, const glm::dvec3& to) {
    const glm::vec3 origin = rooms.at(from), direction = glm::normalize(rooms.at(to) - origin);
    const auto hit = trace::intersect(rays, origin, direction);
    REQUIRE(hit);
    const trace::SurfacePoint point = trace::surface_hit(scene, *hit, direction);
    CHECK(glm::dot(point.normal, direction) < 0);
    return trace::material_of(scene, point).diffuse.x;
  };
  for (int i = 0; i < 100; ++i) {
    const double y = 0.01 + 0.0198 * i, z = std::fmod(0.013 + 0.61803398875 * i, 1.98) + 0.01;
    const bool on_panel = y > 0.3 && y < 1.5 && z > 0.4 && z < 1.7;
    CAPTURE(y, z);
    CHECK(albedo_seen({1, 1, 1}, {0, y, z}) == (on_panel ? 0.05f : 1.0f));
    CHECK(albedo_seen({-1, 1, 1}, {0, y, z}) == 1.0f);
  }
}

TEST_CASE("the parts of a face that others hide, and those where it counts, are the whole face") {
  const Rooms rooms(GENERATE(false, true));
  const Scene scene = rooms.scene(Partition::panel, true);
  const scene::CoincidentFaces coincident(scene);
  const auto area_of = [](const std::vector<scene::CoincidentFaces::Part>& parts) {
    double area = 0;
    for (const auto& [a, b, c] : parts) {
      area += 0.5 * glm::length(glm::cross(glm::dvec3(b - a), glm::dvec3(c - a)));
    }
    return area;
  };
  double hidden = 0;
  for (std::uint32_t s = 0; s < 2 * scene.triangle_count(); ++s) {
    const auto parts = coincident.parts_of(scene, s);
    CHECK(area_of(parts.counted) + area_of(parts.hidden) ==
          Approx(triangle_area(scene, triangle_of(s))).epsilon(1e-5));
    hidden += area_of(parts.hidden);
  }
  // The wall's back behind the panel, and the panel's before the wall.
  CHECK(hidden == Approx(2 * 1.2 * 1.3).epsilon(1e-5));
}

TEST_CASE("behind a cutout lies the other side, from either room") {
  SceneBuilder builder;
  Material mesh = diffuse(0.3f);
  mesh.opacity = 0.0f;
  const std::uint32_t holes = builder.add(mesh), wall = builder.add(diffuse(0.7f));
  builder.quad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, holes);
  builder.quad({0, 0, 0}, {0, 1, 0}, {1, 1, 0}, {1, 0, 0}, wall);
  builder.add(point_light("lamp", {0.5f, 0.5f, 1.0f}));
  const Scene scene = builder.build();
  REQUIRE(scene.triangle_count() == 4);
  const RayScene rays(scene);
  const trace::FlushDenormals flush_denormals;
  for (const float from : {-1.0f, 1.0f}) {
    trace::RayOrigin origin(glm::vec3(0.3f, 0.4f, from));
    std::uint32_t cutouts = 0;
    const auto met = trace::next_surface(rays, origin, {0, 0, -from}, trace::RandomStream(1, 2, 3),
                                         trace::Purpose::eye_cutouts, cutouts);
    REQUIRE(met);
    CHECK(trace::material_of(scene, *met).diffuse.x == 0.7f);
    CHECK(met->normal.z == from);
    CHECK(trace::transmittance(rays, glm::vec3(0.3f, 0.4f, from), {0.3f, 0.4f, -from}) ==
          glm::vec3(0.0f));
  }
}

}  // namespace photile::test
