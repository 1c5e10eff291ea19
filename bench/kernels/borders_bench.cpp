// What borders do to a density: a wall corner and a table top 5 cm above a floor, read along lines
// away from the border by whole discs and by clipped ones, beside the closed form. Everything is
// black, so all light is direct: illuminance is I cos / d^2 where the lamp is seen, else 0.
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "photile/sensors.hpp"
#include "support/bench_record.hpp"
#include "validation/analytic_cases.hpp"

namespace {

using namespace photile;
using namespace photile::bench;
using validation::Room;

constexpr double power = 4000 * glm::pi<double>();  ///< lumens: 1000 cd
constexpr double radius = 0.06;                     ///< metres, of the search

/// A line of sensors at the same distance from the border.
struct Line {
  const char* place;
  double distance;  ///< metres from the border
  std::vector<Sensor> sensors;
  double expected;  ///< mean lux
};

double illuminance(const glm::dvec3& lamp, const Sensor& sensor) {
  const glm::dvec3 to_light = lamp - sensor.position;
  const double squared = glm::dot(to_light, to_light);
  return 1000 * glm::dot(to_light, sensor.normal) / (squared * std::sqrt(squared));
}

/// Sensors at corner + distance x away, over 1 m along `along`.
Line line(const char* place, double distance, const glm::dvec3& start, const glm::dvec3& away,
          const glm::dvec3& along, const glm::dvec3& normal, const glm::dvec3& lamp, bool lit) {
  constexpr int count = 200;
  Line made{place, distance, {}, 0};
  for (int i = 0; i < count; ++i) {
    made.sensors.push_back({start + distance * away + ((i + 0.5) / count) * along, normal});
    if (lit) made.expected += illuminance(lamp, made.sensors.back()) / count;
  }
  return made;
}

struct Subject {
  Scene scene;
  std::vector<Line> lines;
};

const glm::dvec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);

Subject wall_corner() {
  const glm::dvec3 lamp(1, 1, 1);
  Room room("wall corner");
  const std::uint32_t black = room.add_material(validation::diffuse(0));
  room.add({{0, 0, 0}, 2.0 * x, 2.0 * y}, black);
  room.add({{0, 0, 0}, 2.0 * y, 2.0 * z}, black);
  room.light(room.add_light(LightKind::point)).position = lamp;
  Subject subject{room.build(power), {}};
  for (const double d : {0.002, 0.01, 0.03, 0.1}) {
    subject.lines.push_back(line("floor, from the wall", d, {0, 0.5, 0}, x, y, z, lamp, true));
  }
  return subject;
}

/// The lamp hangs above the table's middle: its shadow reaches 1.5 cm beyond the table.
Subject table_top() {
  const glm::dvec3 lamp(0, 0, 1.05);
  Room room("table top");
  const std::uint32_t black = room.add_material(validation::diffuse(0));
  room.add({{-2, -2, 0}, 4.0 * x, 4.0 * y}, black);
  room.add({{-0.3, -0.6, 0.05}, 0.6 * x, 1.2 * y}, black);
  room.add({{-0.3, -0.6, 0.04}, 1.2 * y, 0.6 * x}, black);
  room.light(room.add_light(LightKind::point)).position = lamp;
  Subject subject{room.build(power), {}};
  const glm::dvec3 edge(0.3, -0.5, 0.05), below(0.3, -0.5, 0);
  for (const double d : {0.002, 0.01, 0.03, 0.1}) {
    subject.lines.push_back(line("table, from its edge", d, edge, -x, y, z, lamp, true));
  }
  for (const double d : {0.002, 0.01}) {
    subject.lines.push_back(
        line("floor in the shadow, beside the table", d, below, x, y, z, lamp, false));
  }
  for (const double d : {0.018, 0.03, 0.1}) {
    subject.lines.push_back(
        line("floor in the light, from the table", d, below, x, y, z, lamp, true));
  }
  return subject;
}

/// Mean lux along the line.
double reading(const Subject& subject, const Line& line, AreaMode area, std::uint64_t photons,
               Device& device) {
  RenderParameters parameters;
  parameters.photons.emitted_photons = photons;
  parameters.radius = radius;
  parameters.area = area;
  const RenderResult result = measure(subject.scene, line.sensors, {&device, 1}, parameters);
  double sum = 0;
  for (const float value : result.layers.layers[0].illuminance) sum += value;
  return power * sum / static_cast<double>(line.sensors.size());
}

bool run(BenchOptions& options) {
  const std::uint64_t photons = options.quick ? 50'000 : 2'000'000;
  BenchRecord record("borders", options);
  Device device({.selector = options.device});
  record.set_device(device.info());
  record.set("photons", photons);
  record.set("k", defaults::neighbours);
  record.set("radius", radius);
  for (const Subject& subject : {wall_corner(), table_top()}) {
    for (const Line& line : subject.lines) {
      record.add({{"scene", subject.scene.source.string()},
                  {"place", line.place},
                  {"millimetres", 1e3 * line.distance},
                  {"expected", line.expected},
                  {"disc", reading(subject, line, AreaMode::disc, photons, device)},
                  {"clipped", reading(subject, line, AreaMode::clipped, photons, device)}});
    }
  }
  record.write();
  return true;
}

}  // namespace

int main(int argument_count, char** arguments) {
  BenchOptions options;
  CLI::App command("Readings near borders beside closed forms", "borders");
  add_options(command, options, Repeating::no);
  return run_bench(command, argument_count, arguments, [&] { return run(options); });
}
