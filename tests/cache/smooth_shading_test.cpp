// Smooth shading from nodes that gather, beside closed forms and paths.
#include <algorithm>
#include <catch2/catch.hpp>
#include <string>
#include <utility>

#include "cache/light_maps.hpp"
#include "light/light_at_points.hpp"
#include "photile/errors.hpp"
#include "photile/light_layers.hpp"
#include "photile/photons.hpp"
#include "photile/renderer.hpp"
#include "photile/scene.hpp"
#include "smooth_meshes.hpp"
#include "suns.hpp"
#include "test_device.hpp"

namespace photile::test {
namespace {

using std::numbers::pi;

constexpr double albedo = 0.7;
const SmoothMesh sphere = smooth_sphere({0.0, 0.0, 1.2}, 0.5);
const SmoothMesh cylinder = smooth_cylinder({0.0, 0.0, 0.6}, 0.3, 1.0, 16);

RenderParameters good() {
  RenderParameters parameters;
  set_quality(parameters, Quality::good);
  parameters.light_maps = LightMapMode::on;
  parameters.photons.emitted_photons = 200'000;
  parameters.seed = 3;
  return parameters;
}

/// The mesh in a room of 4 x 4 x 3 m with a panel under its ceiling and a small lamp on one side.
Scene in_room(const SmoothMesh& mesh, bool with_normals = true, int lamps = 2) {
  SceneBuilder builder;
  const std::uint32_t wall = builder.add(diffuse(0.6f));
  const std::uint32_t black = builder.add(diffuse(0.0f));
  builder.box({-2, -2, 0}, {2, 2, 3}, wall, true);
  mesh.add_to(builder, builder.add(diffuse(albedo)), with_normals);
  const std::uint32_t panel = builder.add(area_light("panel", 3000.0));
  builder.grid({-1.3f, -0.5f, 2.9f}, {0, 0.6f, 0}, {0.6f, 0, 0}, 1, black, panel);
  if (lamps > 1) {
    const std::uint32_t side = builder.add(area_light("side", 800.0));
    builder.grid({1.9f, 0.2f, 1.0f}, {0, 0, 0.3f}, {0, 0.3f, 0}, 1, black, side);
  }
  return builder.build();
}

std::vector<Sensor> sensors_of(const std::vector<SmoothMesh::TestPoint>& test_points) {
  std::vector<Sensor> sensors;
  for (const SmoothMesh::TestPoint& test_point : test_points) sensors.push_back(test_point.sensor);
  return sensors;
}

/// One test point of a mesh in so many.
std::vector<Sensor> some_of(const SmoothMesh& mesh, std::size_t step) {
  const std::vector<Sensor> all = sensors_of(mesh.test_points());
  std::vector<Sensor> some;
  for (std::size_t i = 0; i < all.size(); i += step) some.push_back(all[i]);
  return some;
}

LightLayers by_nodes(const Scene& scene, const std::vector<Sensor>& sensors) {
  return measure(scene, sensors, {&device(), 1}, good()).layers.dense();
}

/// Luminance of all lights at their powers, per sensor.
std::vector<double> radiance_of(const Scene& scene, const LightLayers& layers) {
  const std::vector<double> powers = light::layer_powers(scene);
  std::vector<double> radiance(layers.layers.front().radiance.size(), 0.0);
  for (std::size_t layer = 0; layer < powers.size(); ++layer) {
    for (std::size_t i = 0; i < radiance.size(); ++i) {
      radiance[i] += powers[layer] * luminance(glm::dvec3(layers.layers[layer].radiance[i]));
    }
  }
  return radiance;
}

double square(double x) { return x * x; }

/// Rms relative difference of nodes in one scene from paths in another, less the noise of these,
/// which two seeds tell.
double rms_beside_paths(const Scene& of_nodes, const Scene& scene,
                        const std::vector<Sensor>& sensors, int paths) {
  const std::vector<double> nodes = radiance_of(of_nodes, by_nodes(of_nodes, sensors));
  const auto traced = [&](std::uint64_t seed) {
    return radiance_of(scene, measure_by_paths(scene, sensors, paths, seed).layers.dense());
  };
  const std::vector<double> first = traced(1), second = traced(2);
  double difference = 0, noise = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const double mean = 0.5 * (first[i] + second[i]);
    difference += square(nodes[i] / mean - 1);
    noise += square(0.5 * (first[i] - second[i]) / mean);
  }
  return std::sqrt(std::max(0.0, difference - noise) / static_cast<double>(nodes.size()));
}

double rms_beside_paths(const Scene& scene, const std::vector<Sensor>& sensors, int paths) {
  return rms_beside_paths(scene, scene, sensors, paths);
}

}  // namespace

TEST_CASE(
    "Nodes show a sphere of facets in suns by the cosine to the interpolated normal, each sun and "
    "their sum") {
  // Half of the suns shine from the other side: what one light leaves dark takes nothing from
  // another. Of more than eight lights each light sample draws one, so that a layer is right on
  // average.
  const int suns = GENERATE(1, 2, 10);
  const bool are_drawn = suns > 8;
  SceneBuilder builder;
  sphere.add_to(builder, builder.add(diffuse(albedo)));
  std::vector<glm::dvec3> to_sun;
  std::vector<double> lux;
  for (int i = 0; i < suns; ++i) {
    const double side = i % 2 == 0 ? 1 : -1;
    to_sun.push_back(glm::normalize(glm::dvec3(0.4 * side + 0.01 * i, -0.5 * side, 0.7 * side)));
    lux.push_back(1000.0 / (1 + i));
    builder.add_distant(sun_along(glm::vec3(-to_sun.back()), 0, "sun " + std::to_string(i)),
                        lux.back());
  }
  const Scene scene = builder.build();
  REQUIRE(needs_of(scene).many_lights() == are_drawn);
  const std::vector<SmoothMesh::TestPoint> test_points = sphere.test_points();
  const LightLayers layers = by_nodes(scene, sensors_of(test_points));
  const std::vector<double> of_all = radiance_of(scene, layers),
                            powers = light::layer_powers(scene);
  REQUIRE(layers.layers.size() == to_sun.size());
  std::vector<double> lit(to_sun.size(), 0.0), ratios = lit;
  for (std::size_t i = 0; i < test_points.size(); ++i) {
    const auto cosine_to = [&](int sun) { return glm::dot(test_points[i].smooth, to_sun[sun]); };
    double sum = 0;
    bool is_at_a_terminator = false;  // of the facets around
    for (int sun = 0; sun < suns; ++sun) is_at_a_terminator |= std::abs(cosine_to(sun)) < 0.3;
    if (is_at_a_terminator) continue;
    for (int sun = 0; sun < suns; ++sun) {
      CAPTURE(suns, sun, cosine_to(sun), glm::dot(test_points[i].sensor.normal, to_sun[sun]));
      const double expected = albedo / pi * lux[sun] * std::max(0.0, cosine_to(sun));
      const double found = powers[sun] * luminance(glm::dvec3(layers.layers[sun].radiance[i]));
      if (expected == 0 || !are_drawn) CHECK(found == Approx(expected).epsilon(0.01).margin(1e-3));
      sum += expected;
      if (expected == 0) continue;
      ratios[sun] += found / expected;
      lit[sun] += 1;
    }
    CHECK(of_all[i] == Approx(sum).epsilon(are_drawn ? 0.02 : 0.01).margin(1e-3));
  }
  for (int sun = 0; sun < suns; ++sun) {
    CHECK(lit[sun] > 120);
    CHECK(ratios[sun] / lit[sun] == Approx(1.0).epsilon(0.01));
  }
}

TEST_CASE("Nodes show a smooth sphere and cylinder in a room as paths do") {
  CHECK(rms_beside_paths(in_room(sphere), some_of(sphere, 5), 4'000) < 0.02);
  CHECK(rms_beside_paths(in_room(cylinder), some_of(cylinder, 1), 6'000) < 0.02);
}

TEST_CASE("Nodes show a floor with a normal map as paths do") {
  Scene scene = in_room(sphere);
  constexpr std::array<std::uint8_t, 4> tilted{160, 110, 249, 255};  // by 16 degrees
  scene.textures.emplace_back("tilted", 1, 1, std::vector<std::array<std::uint8_t, 4>>{tilted});
  scene.corner_uv.assign(scene.triangle_count(),
                         {glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(0, 1)});
  const Scene flat = scene;
  scene.materials[0].normal_texture = 0;  // of the room
  std::vector<Sensor> sensors;
  for (const double x : {-1.3, -0.9, -0.4, 0.3, 0.8, 1.2}) {
    for (const double y : {-1.1, -0.5, 0.2, 0.7, 1.3}) sensors.push_back({{x, y, 0}, {0, 0, 1}});
  }
  // Nodes that take the floor for flat err by 13%. What is left is what a light linear in the
  // normal cannot tell.
  CHECK(rms_beside_paths(scene, sensors, 4'000) <
        rms_beside_paths(flat, scene, sensors, 4'000) / 3);
}

TEST_CASE("Many lights are shaded as smoothly") {
  const std::vector<Sensor> sensors = some_of(sphere, 5);
  SceneBuilder builder;
  const std::uint32_t wall = builder.add(diffuse(0.6f));
  const std::uint32_t black = builder.add(diffuse(0.0f));
  builder.box({-2, -2, 0}, {2, 2, 3}, wall, true);
  sphere.add_to(builder, builder.add(diffuse(albedo)));
  for (int i = 0; i < 10; ++i) {  // the panel of in_room in strips
    const std::uint32_t strip = builder.add(area_light("strip " + std::to_string(i), 300.0));
    builder.grid({-1.3f + 0.06f * static_cast<float>(i), -0.5f, 2.9f}, {0, 0.6f, 0}, {0.06f, 0, 0},
                 1, black, strip);
  }
  const Scene strips = builder.build();
  REQUIRE(needs_of(strips).many_lights());
  const RenderParameters parameters = good();
  const std::vector<double> many =
      radiance_of(strips, measure(strips, sensors, {&device(), 1}, parameters).layers.dense());
  const Scene panel = in_room(sphere, true, 1);
  const std::vector<double> one = radiance_of(panel, by_nodes(panel, sensors));
  double squares = 0;
  for (std::size_t i = 0; i < one.size(); ++i) squares += square(many[i] / one[i] - 1);
  CHECK(std::sqrt(squares / static_cast<double>(one.size())) < 0.03);  // the noise of both
}

/// Nodes that tell light by the normal.
class TurnedSource : public cache::NodeSource {
 public:
  cache::NodeValues value(const cache::NodeBatch& batch, const Progress&) override {
    cache::NodeValues values{LightTable(1, false), {}, {}};
    for (std::size_t node = 0; node < batch.nodes; ++node) {
      const glm::vec3& at = batch.points.position[node];
      values.light.irradiance.emplace_back(1.0f + at.x * at.x);
      values.light.by_normal.emplace_back(at, 1.0f);
      values.error.push_back(0.1f);
      values.distance.push_back(1.0f);
    }
    return values;
  }
};

TEST_CASE("Light by the normal is kept, taken in again and refused where it is no number") {
  const Scene scene = in_room(sphere, true, 1);
  const RayScene rays(scene);
  cache::LightMapParameters parameters;
  parameters.powers = {1.0};
  const auto hits_on_all = [&] {
    PrimaryHits hits;
    for (std::uint32_t t = 0; t < scene.triangle_count(); ++t) {
      const auto corners = scene.corners(t);
      hits.position.push_back((corners[0] + corners[1] + corners[2]) / 3.0f);
      hits.oriented_face.push_back(oriented(t, scene.front_side[t]));
    }
    return hits;
  };
  TurnedSource source;
  cache::LightMaps maps(rays, parameters, source);
  maps.fill(hits_on_all(), Progress::none());
  const LightMapContents whole = maps.contents();
  REQUIRE(whole.values.by_normal.size() == whole.nodes.size());
  cache::LightMaps same(rays, parameters, source);
  same.restore(whole);
  CHECK(same.values().by_normal == whole.values.by_normal);
  std::vector<std::uint8_t> keep(whole.nodes.size());
  for (std::size_t i = 0; i < keep.size(); ++i) keep[i] = i % 3 == 0 ? 1 : 0;
  const std::vector<std::uint32_t> former = same.forget(keep);
  for (std::size_t i = 0; i < former.size(); ++i) {
    REQUIRE(same.values().by_normal[i] == whole.values.by_normal[former[i]]);
  }
  const auto refused = [&](const auto& spoil) {
    LightMapContents contents = whole;
    spoil(contents.values.by_normal);
    cache::LightMaps other(rays, parameters, source);
    CHECK_THROWS_AS(other.restore(std::move(contents)), InputError);
  };
  refused([](auto& by_normal) { by_normal.pop_back(); });
  refused([](auto& by_normal) { by_normal.clear(); });
  refused([](auto& by_normal) { by_normal[7].w = std::nanf(""); });
}

TEST_CASE("Vertex normals change no lux, and layers follow the powers of lamps") {
  const std::vector<Sensor> sensors = some_of(sphere, 7);
  const Scene smooth = in_room(sphere), flat = in_room(sphere, false);
  REQUIRE(needs_of(smooth).smooth_shading);
  REQUIRE_FALSE(needs_of(flat).smooth_shading);
  const LightLayers with = by_nodes(smooth, sensors), without = by_nodes(flat, sensors);
  REQUIRE(with.layers.size() == 2);
  for (std::size_t layer = 0; layer < 2; ++layer) {
    CHECK(with.layers[layer].illuminance == without.layers[layer].illuminance);
    CHECK(with.layers[layer].radiance != without.layers[layer].radiance);
  }
  // Twice the power of a lamp, twice its part of the sum: layers are those at power 1, the filter's
  // weights at powers in one proportion the same.
  Scene bright = smooth;
  for (Light& light : bright.lights) light.power *= 2;
  const std::vector<double> once = radiance_of(smooth, with);
  const std::vector<double> twice = radiance_of(bright, by_nodes(bright, sensors));
  for (std::size_t i = 0; i < once.size(); ++i)
    CHECK(twice[i] == Approx(2 * once[i]).epsilon(1e-5));
}

}  // namespace photile::test
