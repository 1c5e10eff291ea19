// White furnaces: inside walls that all glow alike, every material has a simple answer.

#include "validation/analytic_case.hpp"
#include "validation/form_factors.hpp"
#include "validation/room.hpp"

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
                           std::vector<Reading> readings, double photon_share) {
  return {name, source, furnace.build(), std::move(readings), photon_share};
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

}  // namespace photile::validation
