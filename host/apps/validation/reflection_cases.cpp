// White furnaces: inside walls that all glow alike, every material has a simple answer.
#include <fmt/format.h>

#include <cmath>

#include "validation/analytic_cases.hpp"

namespace photile::validation {

namespace {

constexpr double wall_luminance = 100;  // of the walls' own light, cd/m2
const glm::dvec3 size(2, 1, 1.5);

/// A closed box whose walls glow and reflect.
struct Furnace {
  explicit Furnace(const std::string& name, float reflectance)
      : room(name), walls(box_walls(size)) {
    const std::uint32_t wall = room.add_material(diffuse(reflectance));
    const std::uint32_t lamp = room.add_light(LightKind::area);
    for (const Rectangle& rectangle : walls) room.add(rectangle, wall, lamp);
  }
  Scene build() {
    double area = 0;
    for (const Rectangle& wall : walls) area += wall.area();
    return room.build(pi * wall_luminance * area);
  }

  Room room;
  std::vector<Rectangle> walls;
};

AnalyticCase with_readings(const std::string& name, const std::string& source, Furnace& furnace,
                           std::vector<Reading> readings, double photon_fraction) {
  return {name, source, furnace.build(), std::move(readings), photon_fraction};
}

AnalyticCase empty_furnace() {
  constexpr float reflectance = 0.8f;
  Furnace furnace("furnace", reflectance);
  return with_readings("furnace, diffuse walls, rho = 0.8", "pi L / (1 - rho) everywhere", furnace,
                       {{"mean over all walls", grid_of_sensors(furnace.walls, 12),
                         pi * wall_luminance / (1 - double{reflectance})}},
                       0.02);
}

/// A ball that loses no light changes nothing.
AnalyticCase furnace_with_ball(const std::string& name, const Material& look) {
  constexpr float reflectance = 0.5f;
  Furnace furnace("furnace with a ball", reflectance);
  furnace.room.add_ball({0.9, 0.5, 0.7}, 0.35, 12, furnace.room.add_material(look));
  return with_readings("furnace with " + name, "pi L / (1 - rho), as without it", furnace,
                       {{"mean over all walls", grid_of_sensors(furnace.walls, 12),
                         pi * wall_luminance / (1 - double{reflectance})}},
                       0.02);
}

AnalyticCase furnace_with_plate() {
  constexpr float albedo = 0.3f, f0 = 0.5f, alpha = 0.4f;
  Material look = diffuse(albedo);
  look.specular = glm::vec3(f0);
  look.roughness = alpha;
  Furnace furnace("furnace with a plate", 0);
  const Rectangle plate{{0.7, 0.2, 0.7}, {0.6, 0, 0}, {0, 0.6, 0}};
  furnace.room.add(plate, furnace.room.add_material(look));
  const std::vector<Sensor> sensors = grid_of_sensors({plate}, 15);
  return with_readings(
      "furnace with a glossy plate", "pi L; L x integral of the BSDF, seen along the normal",
      furnace,
      {{"illuminance of the plate", sensors, pi * wall_luminance},
       {"luminance of the plate", sensors, wall_luminance * glossy_reflectance(albedo, f0, alpha),
        Quantity::luminance}},
      0.5);
}

Material mirror() {
  Material material;
  material.interaction = Interaction::mirror;
  material.specular = glm::vec3(1);
  return material;
}

Material glass(bool thin) {
  Material material;
  material.interaction = Interaction::glass;
  material.thin = thin;
  return material;
}

}  // namespace

void add_furnace_cases(std::vector<AnalyticCase>& cases) {
  cases.push_back(empty_furnace());
  cases.push_back(furnace_with_ball("a mirror ball", mirror()));
  cases.push_back(furnace_with_ball("a glass ball", glass(false)));
  cases.push_back(furnace_with_ball("a ball of thin glass", glass(true)));
  cases.push_back(furnace_with_plate());
}

std::vector<AnalyticCase> analytic_cases() {
  std::vector<AnalyticCase> cases;
  add_direct_cases(cases);
  add_reflection_cases(cases);
  add_furnace_cases(cases);
  return cases;
}

// Light that diffuse surfaces reflect.

namespace {

constexpr double floor_illuminance = 1000;  // lux
constexpr double floor_reflectance = 0.8;
constexpr double side = 4;  // of the floor, metres

/// Parallel light falls on a floor of 4 x 4 m, along a black wall in x = 0 that sees the floor.
class LitFloor {
 public:
  explicit LitFloor(const std::string& name) : room(name), black(room.add_material(diffuse(0))) {
    room.add({{0, 0, 0}, {side, 0, 0}, {0, side, 0}},
             room.add_material(diffuse(static_cast<float>(floor_reflectance))));
    room.add({{0, 0, 0}, {0, side, 0}, {0, 0, 3}}, black);
    // In the planes of the wall and of what stands parallel to it, so that nothing is shadowed.
    room.light(room.add_light(LightKind::directional)).direction = {0, 0.8f, -0.6f};
  }

  /// The scene, its light scaled to the floor's illuminance.
  Scene build() {
    Scene scene = room.build(1);
    const double disc = pi * std::pow(bounding_sphere(scene).radius, 2);
    scene.lights[0].power = floor_illuminance / 0.6 * disc;
    return scene;
  }

  Room room;
  std::uint32_t black;
};

/// Illuminance from the part of the floor between two values of x.
double from_strip(const Sensor& sensor, double begin, double end) {
  return floor_illuminance * floor_reflectance *
         rectangle_factor(sensor.position, sensor.normal, {begin, 0, 0}, {end - begin, 0, 0},
                          {0, side, 0});
}

/// Sensors across the room, in lines along y: one through `at`, and others beside it on the wall or
/// on the ceiling.
template <class F>
Reading across(const std::string& place, const glm::dvec3& at, const glm::dvec3& normal,
               const F& illuminance) {
  Reading reading{place, {}, 0};
  constexpr int count = 35;
  const glm::dvec3 beside = glm::cross(normal, glm::dvec3(0, 1, 0));
  for (const double off : {-0.4, -0.2, 0.0, 0.2, 0.4}) {
    for (int i = 0; i < count; ++i) {
      reading.sensors.push_back({at + glm::dvec3(0, 0.3 + 0.1 * i, 0) + off * beside, normal});
    }
  }
  for (const Sensor& sensor : reading.sensors) {
    reading.expected += illuminance(sensor) / static_cast<double>(reading.sensors.size());
  }
  return reading;
}

AnalyticCase reflection() {
  constexpr double height = 3.2;
  LitFloor scene("lit floor");
  scene.room.add({{0, 0, height}, {0, side, 0}, {side, 0, 0}}, scene.black);  // faces down
  const auto whole = [](const Sensor& sensor) { return from_strip(sensor, 0, side); };
  AnalyticCase result{"diffuse reflection",
                      "after CIE 171:2006, 5.6: rho E x form factor of the floor",
                      scene.build(),
                      {}};
  for (const double z : {0.6, 1.4, 2.2}) {
    result.readings.push_back(
        across(fmt::format("wall, {} m high", z), {0, 0, z}, {1, 0, 0}, whole));
  }
  for (const double x : {1.0, 2.0, 3.0}) {
    result.readings.push_back(
        across(fmt::format("ceiling, {} m from the wall", x), {x, 0, height}, {0, 0, -1}, whole));
  }
  result.photon_fraction = 2;  // a small part of the light is reflected here
  result.direct_rays = 1;
  return result;
}

AnalyticCase obstructed_reflection() {
  constexpr double screen = 2, screen_height = 1;
  LitFloor scene("lit floor behind a screen");
  scene.room.add({{screen, 0, 0}, {0, side, 0}, {0, 0, screen_height}}, scene.black);
  AnalyticCase result{
      "diffuse reflection with an obstruction",
      "after CIE 171:2006, 5.7: form factors of the floor before and behind a screen",
      scene.build(),
      {}};
  for (const double z : {0.6, 1.4, 2.2}) {
    result.readings.push_back(
        across(fmt::format("wall, {} m high", z), {0, 0, z}, {1, 0, 0}, [](const Sensor& sensor) {
          double light = from_strip(sensor, 0, screen);
          // Lines over the top of the screen meet the floor again behind it.
          const double above = sensor.position.z - screen_height;
          const double beyond = above > 0 ? screen * sensor.position.z / above : side;
          if (beyond < side) light += from_strip(sensor, beyond, side);
          return light;
        }));
  }
  result.photon_fraction = 2;
  result.direct_rays = 1;
  return result;
}

/// The mean illuminance of a closed room of one reflectance: flux / (area (1 - rho)), since what
/// is emitted is what is absorbed.
AnalyticCase closed_room(float reflectance) {
  constexpr double flux = 10'000, edge = 4;
  Room room("closed room");
  const std::uint32_t wall = room.add_material(diffuse(reflectance));
  const std::vector<Rectangle> walls = box_walls(glm::dvec3(edge));
  for (const Rectangle& rectangle : walls) room.add(rectangle, wall);
  room.light(room.add_light(LightKind::point)).position = glm::vec3(edge / 2);
  AnalyticCase result{fmt::format("interreflection, rho = {}", reflectance),
                      "after CIE 171:2006, 5.8: flux / (area (1 - rho))",
                      room.build(flux),
                      {{"mean over all walls", grid_of_sensors(walls, 6),
                        flux / (6 * edge * edge * (1 - double{reflectance}))}}};
  result.photon_fraction = 0.03;
  result.neighbour_fraction = 0.05;
  return result;
}

/// Points spread evenly over a scene's front sides: where a sequence of golden ratios (Roberts,
/// "The unreasonable effectiveness of quasirandom sequences", 2018) falls on the summed areas.
std::vector<Sensor> spread_sensors(const Scene& scene, int count) {
  std::vector<double> area_up_to{0};
  for (std::uint32_t t = 0; t < scene.triangle_count(); ++t) {
    area_up_to.push_back(area_up_to.back() + triangle_area(scene, t));
  }
  std::vector<Sensor> sensors;
  std::uint32_t triangle = 0;
  for (int i = 0; i < count; ++i) {
    const double target = (i + 0.5) / count * area_up_to.back();
    while (area_up_to[triangle + 1] < target) ++triangle;
    double u = std::fmod(0.5 + 0.7548776662466927 * i, 1.0);
    double v = std::fmod(0.5 + 0.5698402909980532 * i, 1.0);
    if (u + v > 1) u = 1 - u, v = 1 - v;
    const auto [a, b, c] = scene.corners(triangle);
    sensors.push_back({glm::dvec3(a) + u * glm::dvec3(b - a) + v * glm::dvec3(c - a),
                       face_normal(scene, oriented(triangle, scene.front_side[triangle]))});
  }
  return sensors;
}

AnalyticCase integrating_sphere() {
  constexpr double flux = 1000;
  constexpr float reflectance = 0.9f;
  Room room("integrating sphere");
  room.add_ball(glm::dvec3(0), 0.5, 24, room.add_material(diffuse(reflectance)), true);
  room.add_light(LightKind::point);
  AnalyticCase result{"integrating sphere, rho = 0.9",
                      "flux / (area (1 - rho)), area of the facets",
                      room.build(flux),
                      {}};
  double area = 0;
  for (std::uint32_t t = 0; t < result.scene.triangle_count(); ++t) {
    area += triangle_area(result.scene, t);
  }
  result.readings.push_back({"mean over the wall", spread_sensors(result.scene, 2000),
                             flux / (area * (1 - double{reflectance}))});
  result.photon_fraction = 0.04;
  result.neighbour_fraction = 0.05;
  return result;
}

}  // namespace

void add_reflection_cases(std::vector<AnalyticCase>& cases) {
  cases.push_back(reflection());
  cases.push_back(obstructed_reflection());
  cases.push_back(closed_room(0.5f));
  cases.push_back(closed_room(0.8f));
  cases.push_back(integrating_sphere());
}

}  // namespace photile::validation
