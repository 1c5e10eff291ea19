// What the angle of neighbour groups does: the larger, the less a curved surface darkens at the
// edges of its regions, and the more light bleeds around the edges between surfaces. Graglia et al.
// 2012 take 60 degrees without a figure.
//
// Photons lie evenly on lit surfaces, one watt a square metre, so that the truth is 1 there and 0
// on unlit ones.
#include <fmt/format.h>

#include <cmath>
#include <glm/gtc/constants.hpp>
#include <numeric>
#include <random>

#include "photile/estimator.hpp"
#include "photile/scene_builder.hpp"
#include "support/bench_record.hpp"
#include "support/workload.hpp"

namespace {

using namespace photile;
using namespace photile::bench;

/// A flat rectangle, seen from where its normal points.
struct Region {
  glm::vec3 origin, u, v;
  bool lit;
  bool asked;  ///< hits lie here
};

struct Shape {
  std::string name;
  std::vector<Region> regions;
  /// Hits lie within the radius of the edge along v, where u = 0.
  bool near_edge;
};

/// Plane faces in a ring around z, 0.2 m wide each.
Shape prism(int sides) {
  Shape shape{fmt::format("prism of {} sides", sides), {}, false};
  const float side = 0.2f, step = glm::two_pi<float>() / static_cast<float>(sides);
  const float radius = 0.5f * side / std::sin(0.5f * step);
  const auto corner = [&](int i) {
    const float angle = step * static_cast<float>(i);
    return glm::vec3(radius * std::cos(angle), radius * std::sin(angle), 0);
  };
  for (int i = 0; i < sides; ++i) {
    shape.regions.push_back({corner(i), corner(i + 1) - corner(i), {0, 0, 1}, true, true});
  }
  return shape;
}

/// Two plates that share an edge, whose normals differ by an angle; asked are points near the edge
/// on the lit plate or on the unlit one.
Shape wedge(double degrees, bool lit) {
  const double angle = glm::radians(degrees);
  const glm::vec3 away(-std::cos(angle), 0, -std::sin(angle));
  // Normals: cross(u, v) of each plate points up and outwards.
  const Region first{{0, 1, 0}, {1, 0, 0}, {0, 1, 0}, true, lit};
  const Region second{{0, 2, 0}, away, {0, -1, 0}, false, !lit};
  return {fmt::format("edge of {:.0f} degrees, {} side", degrees, lit ? "lit" : "unlit"),
          {first, second},
          true};
}

glm::vec3 normal_of(const Region& region) { return glm::normalize(glm::cross(region.u, region.v)); }

class Subject {
 public:
  explicit Subject(const Shape& shape) : shape_(shape) {
    SceneBuilder builder(shape.name);
    builder.add(lamp_at({0, 0, 5}));
    const std::uint32_t white = builder.add(white_material());
    for (const Region& f : shape.regions) {
      builder.quad(f.origin, f.origin + f.u, f.origin + f.u + f.v, f.origin + f.v, white);
    }
    scene_ = std::move(builder).build();
  }

  const Scene& scene() const { return scene_; }

  Photons photons(double per_square_metre) const {
    std::mt19937 random(1);
    Photons photons;
    for (std::size_t i = 0; i < shape_.regions.size(); ++i) {
      const Region& region = shape_.regions[i];
      if (!region.lit) continue;
      const double area = glm::length(glm::cross(region.u, region.v));
      const auto count = static_cast<std::size_t>(area * per_square_metre);
      for (std::size_t n = 0; n < count; ++n) {
        add_point(i, 1.0f, random, photons.position, photons.oriented_face);
        photons.flux.emplace_back(static_cast<float>(area / static_cast<double>(count)));
      }
    }
    photons.emitted_per_light = {photons.size()};
    return sort_by_oriented_face(std::move(photons), 2 * scene_.triangle_count());
  }

  /// `reach`: largest distance from the edge, where hits are near one.
  PrimaryHits hits(std::size_t count, double reach) const {
    std::mt19937 random(2);
    PrimaryHits hits;
    std::vector<std::size_t> asked;
    for (std::size_t i = 0; i < shape_.regions.size(); ++i) {
      if (shape_.regions[i].asked) asked.push_back(i);
    }
    for (std::size_t n = 0; n < count; ++n) {
      add_point(asked[n % asked.size()], shape_.near_edge ? static_cast<float>(reach) : 1.0f,
                random, hits.position, hits.oriented_face);
      hits.pixel.push_back(static_cast<std::uint32_t>(n));
    }
    hits.throughput.assign(count, glm::vec3(1.0f));
    hits.diffuse_albedo.assign(count, glm::vec3(0.5f));
    return hits;
  }

  /// Whether hits lie on lit surfaces.
  bool lit() const {
    return std::any_of(shape_.regions.begin(), shape_.regions.end(),
                       [](const Region& f) { return f.lit && f.asked; });
  }

 private:
  /// A point of a region, up to `most_u` of the way along u, and the side that its normal is on.
  void add_point(std::size_t region, float most_u, std::mt19937& random,
                 std::vector<glm::vec3>& positions, std::vector<std::uint32_t>& sides) const {
    std::uniform_real_distribution<float> uniform(0, 1);
    const Region& f = shape_.regions[region];
    const float u = most_u * uniform(random);
    // Ends of the edges are left out: there the surface ends.
    const float v =
        shape_.near_edge && most_u < 1 ? 0.2f + 0.6f * uniform(random) : uniform(random);
    positions.push_back(f.origin + u * f.u + v * f.v);
    // A quad's triangles are those below its diagonal and above it.
    const auto triangle = static_cast<std::uint32_t>(2 * region + (v <= u ? 0 : 1));
    const std::uint32_t front = oriented(triangle, 0);
    const bool faces = glm::dot(face_normal(scene_, front), glm::dvec3(normal_of(f))) > 0;
    sides.push_back(faces ? front : oriented(triangle, 1));
  }

  const Shape& shape_;
  Scene scene_;
};

double mean_irradiance(const PhotonMaps& maps, const Subject& subject, const PrimaryHits& hits,
                       AreaMode area) {
  Estimator estimator(maps, subject.scene(), {.area = area});
  double sum = 0;
  for (const glm::vec3& value : estimator.estimate(hits).irradiance) sum += value.x;
  return sum / static_cast<double>(hits.size());
}

bool run(const BenchOptions& options) {
  const double per_square_metre = options.quick ? 5'000 : 100'000;
  const std::size_t hit_count = options.quick ? 500 : 20'000;
  BenchRecord record("angle", options);
  Device device({.selector = options.device});
  record.set_device(device.info());
  record.set("k", defaults::neighbours);
  record.set("photons per square metre", per_square_metre);
  std::vector<Shape> shapes{prism(6), prism(12), prism(24), prism(48)};
  for (const double degrees : {15.0, 30.0, 45.0, 60.0, 75.0, 90.0}) {
    shapes.push_back(wedge(degrees, false));
  }
  shapes.push_back(wedge(90, true));  // the lit side is the same at every edge
  for (const Shape& shape : shapes) {
    const Subject subject(shape);
    const Photons photons = subject.photons(per_square_metre);
    const double radius = automatic_radius(photons, defaults::neighbours);
    const PrimaryHits hits = subject.hits(hit_count, radius);
    for (int angle = 0; angle <= 90; angle += options.quick ? 30 : 5) {
      // Plane faces that meet at just the angle belong together: not left to rounding.
      const double degrees = std::min(angle + 0.01, 90.0);
      const NeighbourGroups groups =
          find_map_groups(subject.scene(), photons, MapMode::automatic, {radius, degrees});
      const PhotonMaps maps(device, subject.scene(), photons, groups, {.radius = radius});
      record.add({{"shape", shape.name},
                  {"angle", angle},
                  {"expected", subject.lit() ? 1.0 : 0.0},
                  {"disc", mean_irradiance(maps, subject, hits, AreaMode::disc)},
                  {"clipped", mean_irradiance(maps, subject, hits, AreaMode::clipped)},
                  {"references per photon", static_cast<double>(maps.statistics().references) /
                                                static_cast<double>(photons.size())}});
    }
  }
  record.write();
  return true;
}

}  // namespace

int main(int argument_count, char** arguments) {
  BenchOptions options;
  CLI::App command("Darkening and bleeding against the angle of the groups", "angle");
  add_options(command, options, Repeating::no);
  return run_bench(command, argument_count, arguments, [&] { return run(options); });
}
