// Direct light.
#include <cmath>

#include "validation/analytic_cases.hpp"

namespace photile::validation {
namespace {

const glm::dvec3 up(0, 0, 1);

/// A black floor of 4 x 4 m around the origin, in z = 0.
const Rectangle floor_plan{{-2, -2, 0}, {4, 0, 0}, {0, 4, 0}};

/// Points in a square about a point of the floor, or on three circles about the origin whose mean
/// radius is `distance`: far enough from one another to share few photons.
std::vector<Sensor> places_at(double distance) {
  constexpr int side = 7, circles = 3, on_circle = 25;
  constexpr double apart = 0.2;
  std::vector<Sensor> sensors;
  for (int i = 0; distance == 0 && i < side * side; ++i) {
    sensors.push_back({apart * glm::dvec3(i % side - side / 2, i / side - side / 2, 0), up});
  }
  for (int i = 0; distance > 0 && i < circles * on_circle; ++i) {
    const double angle = 2 * pi * i / on_circle;
    const double radius = distance + apart * (i / on_circle - circles / 2);
    sensors.push_back({radius * glm::dvec3(std::cos(angle), std::sin(angle), 0), up});
  }
  return sensors;
}

std::string metres_off(double distance) {
  return distance == 0 ? "below the lamp"
                       : std::to_string(distance).substr(0, 3) + " m from below it";
}

/// The mean of `illuminance(position)` over sensors.
template <class F>
double mean_over(const std::vector<Sensor>& sensors, const F& illuminance) {
  double sum = 0;
  for (const Sensor& sensor : sensors) sum += illuminance(sensor.position);
  return sum / static_cast<double>(sensors.size());
}

template <class F>
std::vector<Reading> readings_on_floor(const F& illuminance) {
  std::vector<Reading> readings;
  for (const double distance : {0.0, 0.5, 1.0, 1.5}) {
    const std::vector<Sensor> sensors = places_at(distance);
    readings.push_back({metres_off(distance), sensors, mean_over(sensors, illuminance)});
  }
  return readings;
}

AnalyticCase point_light() {
  constexpr double height = 3, intensity = 1000;
  Room room("point light");
  room.add(floor_plan, room.add_material(diffuse(0)));
  room.light(room.add_light(LightKind::point)).position = {0, 0, height};
  return {"point light over a surface", "after CIE 171:2006, 5.2: I cos / d^2",
          room.build(4 * pi * intensity), readings_on_floor([&](const glm::dvec3& point) {
            return intensity * height / std::pow(glm::length(point - height * up), 3);
          })};
}

AnalyticCase spot_light() {
  constexpr double height = 3, flux = 3000, inner = 0.45, outer = 0.8;
  const double cos_inner = std::cos(inner), cos_outer = std::cos(outer);
  Room room("spot light");
  room.add(floor_plan, room.add_material(diffuse(0)));
  Light& spot = room.light(room.add_light(LightKind::spot));
  spot.position = {0, 0, height};
  spot.direction = {0, 0, -1};
  spot.inner_cone_angle = static_cast<float>(inner);
  spot.outer_cone_angle = static_cast<float>(outer);
  // The square falloff of KHR_lights_punctual over the cosine holds a third of a full cone's flux.
  const double intensity = flux / (2 * pi * (1 - cos_inner + (cos_inner - cos_outer) / 3));
  AnalyticCase result{"spot light over a surface", "KHR_lights_punctual: I falloff cos / d^2",
                      room.build(flux), readings_on_floor([&](const glm::dvec3& point) {
                        const double distance = glm::length(point - height * up);
                        const double cosine = height / distance;
                        const double share =
                            glm::clamp((cosine - cos_outer) / (cos_inner - cos_outer), 0.0, 1.0);
                        return intensity * share * share * cosine / (distance * distance);
                      })};
  result.photon_fraction = 0.25;
  return result;
}

AnalyticCase area_light() {
  constexpr double flux = 3000;
  const Rectangle lamp{{-0.5, -0.5, 3}, {0, 1, 0}, {1, 0, 0}};  // faces down
  Room room("area light");
  const std::uint32_t black = room.add_material(diffuse(0));
  room.add(floor_plan, black);
  room.add(lamp, black, room.add_light(LightKind::area));
  return {"area light over a surface",
          "after CIE 171:2006, 5.3: pi L x form factor of the lamp's outline", room.build(flux),
          readings_on_floor([&](const glm::dvec3& point) {
            return flux / lamp.area() * rectangle_factor(point, up, lamp.corner, lamp.u, lamp.v);
          })};
}

/// A lamp of one rectangle, the mean over another.
AnalyticCase rectangles(const std::string& name, const std::string& source, const Rectangle& lamp,
                        const Rectangle& receiver, double factor) {
  constexpr double flux = 1000;
  Room room(name);
  const std::uint32_t black = room.add_material(diffuse(0));
  room.add(receiver, black);
  room.add(lamp, black, room.add_light(LightKind::area));
  AnalyticCase result{name, source, room.build(flux), {}};
  result.readings.push_back(
      {"mean over the other", grid_of_sensors({receiver}, 16), flux * factor / receiver.area()});
  result.photon_fraction = 0.03;
  result.neighbour_fraction = 0.05;
  return result;
}

AnalyticCase flux_in_black_box() {
  constexpr double flux = 1000;
  const glm::dvec3 size(4, 3, 2.5);
  Room room("black box");
  const std::uint32_t black = room.add_material(diffuse(0));
  room.light(room.add_light(LightKind::point)).position = {1.6, 1.7, 1.2};
  const std::vector<Rectangle> walls = box_walls(size);
  for (const Rectangle& wall : walls) room.add(wall, black);
  const double area = 2 * (size.x * size.y + size.y * size.z + size.z * size.x);
  AnalyticCase result{"luminous flux in a black box",
                      "after CIE 171:2006, 5.4: all that is emitted arrives",
                      room.build(flux),
                      {{"mean over all walls", grid_of_sensors(walls, 8), flux / area}}};
  result.photon_fraction = 0.03;
  result.neighbour_fraction = 0.05;
  return result;
}

}  // namespace

void add_direct_cases(std::vector<AnalyticCase>& cases) {
  cases.push_back(point_light());
  cases.push_back(spot_light());
  cases.push_back(area_light());
  cases.push_back(rectangles("opposed rectangles", "Howell's catalog, C-11",
                             {{0, 0, 1.5}, {0, 1, 0}, {2, 0, 0}}, {{0, 0, 0}, {2, 0, 0}, {0, 1, 0}},
                             opposed_rectangles_factor(2, 1, 1.5)));
  cases.push_back(rectangles("perpendicular rectangles", "Howell's catalog, C-14",
                             {{0, 0, 0}, {0, 2, 0}, {0, 0, 1}}, {{0, 0, 0}, {1.5, 0, 0}, {0, 2, 0}},
                             perpendicular_rectangles_factor(1, 1.5, 2)));
  cases.push_back(flux_in_black_box());
}

}  // namespace photile::validation
