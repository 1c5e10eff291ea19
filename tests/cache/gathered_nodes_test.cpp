// Light maps whose nodes gather light: closed forms, and on what they depend.
#define TBB_PREVIEW_GLOBAL_CONTROL 1
#include "cache/gathered_nodes.hpp"

#include <tbb/global_control.h>

#include <array>
#include <catch2/catch.hpp>
#include <cmath>

#include "cache/node_sources.hpp"
#include "gathering.hpp"
#include "light/light_at_points.hpp"
#include "validation/analytic_cases.hpp"

namespace photile::test {
namespace {

/// Light maps of a scene, and what values them.
struct GatheredMaps {
  GatheredMaps(GatheringScene& scene, const cache::GatheredNodesParameters& rays,
               double spacing = 0.16)
      : gather(scene.gather({})),
        parameters(parameters_of(scene, spacing)),
        nodes(gather, scene.estimators.layer_powers(), rays),
        maps(scene.rays, parameters, nodes) {}

  static cache::LightMapParameters parameters_of(GatheringScene& scene, double spacing) {
    cache::LightMapParameters parameters;
    parameters.spacing = spacing;
    parameters.levels = 3;
    const std::span<const double> powers = scene.estimators.layer_powers();
    parameters.powers.assign(powers.begin(), powers.end());
    return parameters;
  }

  void fill(const PrimaryHits& hits) { maps.fill(hits, Progress::none()); }

  /// Illuminance of all lights at a hit.
  double lux(const PrimaryHits& hits, std::size_t hit) const {
    cache::BilinearWeights bilinear;
    REQUIRE(maps.find(hits.oriented_face[hit], hits.position[hit], bilinear));
    double sum = 0;
    for (std::size_t i = 0; i < bilinear.node.size(); ++i) {
      maps.values().for_each(bilinear.node[i], [&](std::size_t layer, std::size_t value) {
        sum += double{bilinear.weight[i]} * parameters.powers[layer] *
               luminance(glm::dvec3(maps.values().irradiance[value]));
      });
    }
    return sum;
  }

  std::vector<double> all_lux(const PrimaryHits& hits) const {
    std::vector<double> result;
    for (std::size_t i = 0; i < hits.size(); ++i) result.push_back(lux(hits, i));
    return result;
  }

  cache::IrradianceGather gather;
  cache::LightMapParameters parameters;
  cache::GatheredNodes nodes;
  cache::LightMaps maps;
};

constexpr cache::GatheredNodesParameters few_rays{{32, 32}, {16, 16}};

/// The hits of one half of the room, and of the other.
std::array<PrimaryHits, 2> halves(const PrimaryHits& hits) {
  std::array<PrimaryHits, 2> parts;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    add_hit(parts[hits.position[i].x < 2.0f ? 0 : 1], hits.position[i], hits.oriented_face[i]);
  }
  return parts;
}

/// Relative root mean square of the differences from a formula, and their mean.
template <class Truth>
std::array<double, 2> errors_of(const GatheredMaps& maps, const PrimaryHits& hits,
                                const Truth& truth) {
  double squares = 0, sum = 0;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const double relative = maps.lux(hits, i) / truth(hits.position[i]) - 1;
    squares += relative * relative;
    sum += relative;
  }
  const auto count = static_cast<double>(hits.size());
  return {std::sqrt(squares / count), sum / count};
}

}  // namespace

TEST_CASE("gathered nodes: a furnace is the same all over, corners and edges among it") {
  constexpr double albedo = 0.5;
  const Scene box = furnace(diffuse(albedo));
  GatheringScene gathering(box, looked_up(200'000));
  GatheredMaps maps(gathering, few_rays);
  const PrimaryHits inside = hits_where(points_on(box, 12), fronts_of(box));
  maps.fill(inside);
  const double truth = 1.0 / 6 / (1 - albedo);  // 1 lm over 6 m2, and each bounce returns half
  const auto [rms, mean] = errors_of(maps, inside, [&](const glm::vec3&) { return truth; });
  CAPTURE(rms, mean);
  CHECK(rms < 0.05);
  CHECK(std::abs(mean) < 0.02);
}

TEST_CASE("gathered nodes: no light passes a wall that stands on one floor") {
  SceneBuilder builder;
  const std::uint32_t black = builder.add(diffuse(0.0f));
  builder.grid({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 2, black);
  builder.grid({0.1f, -3, 0}, {0, 6, 0}, {0, 0, 3}, 1, black);
  // Long, so that few samples are not sure of its light.
  builder.grid({0.2f, -3, 1}, {0, 6, 0}, {0.1f, 0, 0}, 1, black, builder.add(area_light("lamp")));
  GatheringScene rooms(builder.build(), looked_up(20'000));
  GatheredMaps maps(rooms, {{16, 16}, {8, 8}});
  const PrimaryHits floor = hits_where(points_on(rooms.scene, 14), fronts_of(rooms.scene, 8));
  maps.fill(floor);
  double behind = 0, before = 0;
  for (std::size_t i = 0; i < floor.size(); ++i) {
    if (floor.position[i].x > 0.3f) before = std::max(before, maps.lux(floor, i));
    // Not in the cells that the wall crosses.
    if (floor.position[i].x < -0.1f) behind = std::max(behind, maps.lux(floor, i));
  }
  CHECK(before > 0.01);
  CHECK(behind == 0);
}

TEST_CASE("gathered nodes: direct light is that of form factors, closer than rays alone tell it") {
  SceneBuilder builder;
  builder.grid({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 2, builder.add(diffuse(0.5f)));
  builder.grid({0.5f, -0.5f, 1}, {0, 1, 0}, {1, 0, 0}, 1, builder.add(diffuse(0.0f)),
               builder.add(area_light("lamp")));
  GatheringScene plain(builder.build(), looked_up(20'000));
  const PrimaryHits floor = hits_where(points_on(plain.scene, 14), fronts_of(plain.scene, 8));
  const auto truth = [](const glm::vec3& position) {
    return validation::rectangle_factor(glm::dvec3(position), {0, 0, 1}, {0.5, -0.5, 1}, {1, 0, 0},
                                        {0, 1, 0});
  };
  GatheredMaps maps(plain, few_rays, 0.04);
  maps.fill(floor);
  const auto [rms, mean] = errors_of(maps, floor, truth);
  const LightTable raw =
      plain.gather({.rays = 32, .light_samples = 32}).gather(floor, numbers(floor.size()));
  double squares = 0, stated = 0;
  for (std::size_t i = 0; i < floor.size(); ++i) {
    const double light = truth(floor.position[i]), count = static_cast<double>(floor.size());
    squares += std::pow(luminance(glm::dvec3(raw.irradiance[i])) / light - 1, 2) / count;
    stated += std::pow(raw.error(i) / light, 2) / count;
  }
  CAPTURE(rms, mean, std::sqrt(squares));
  CHECK(std::sqrt(squares / stated) == Approx(1).margin(0.2));
  CHECK(std::sqrt(stated) < 0.05);
  CHECK(rms < 0.75 * std::sqrt(squares));  // points that are in doubt look again, filter or not
  CHECK(rms < 0.02);
  CHECK(std::abs(mean) < 0.01);
}

TEST_CASE("gathered nodes: the filter of finer nodes leaves the mean of what few rays find") {
  // A lit plate above a floor, which one ray of eight meets: a node that few rays of its own
  // brought light to states a small error, and must not be believed more than one that many did.
  SceneBuilder builder;
  builder.grid({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 1, builder.add(diffuse(0.0f)));
  builder.grid({-0.5f, -0.5f, 1}, {0, 1, 0}, {1, 0, 0}, 1, builder.add(diffuse(0.8f)));
  builder.add(spot_light("lamp", {0, 0, 0.2f}, {0, 0, 1}, 0.1f, 0.5f));
  GatheringScene scene(builder.build(), looked_up(200'000));
  constexpr int side = 40;
  constexpr cache::NodeRays few{32, 32};
  cache::NodeBatch batch;
  batch.points = trace::sensor_hits(scene.rays,
                                    sensors_on({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, {0, 0, 1}, side));
  batch.nodes = batch.points.size();
  batch.number = numbers(batch.nodes);
  batch.coarse.assign(batch.nodes, 0);
  for (int node = 0; node < side * side; ++node) {
    for (int y = node / side - 1; y <= node / side + 1; ++y)
      for (int x = node % side - 1; x <= node % side + 1; ++x) {
        const int other = y * side + x;
        if (x < 0 || x >= side || y < 0 || y >= side || other == node) continue;
        batch.neighbours.items.push_back(static_cast<std::uint32_t>(other));
      }
    batch.neighbours.first.push_back(static_cast<std::uint32_t>(batch.neighbours.items.size()));
  }
  const auto sum_of = [](const LightTable& light) {
    return std::accumulate(light.irradiance.begin(), light.irradiance.end(), 0.0,
                           [](double sum, const glm::vec3& each) { return sum + each.g; });
  };
  cache::IrradianceGather gather = scene.gather({});
  const cache::GatheredParts raw =
      gather.gather(batch.points, batch.number, few.rays, few.light_samples);
  cache::GatheredNodes nodes(gather, scene.estimators.layer_powers(), {few, few});
  const double filtered = sum_of(nodes.value(batch, Progress::none()).light);
  const double found = sum_of(raw.indirect) + sum_of(raw.direct);
  CAPTURE(filtered / found);
  CHECK(found > 0);
  CHECK(filtered / found == Approx(1).margin(0.005));
}

TEST_CASE("gathered nodes: a wall is dark below the horizon of a bright lamp beside it") {
  SceneBuilder builder;
  const std::uint32_t black = builder.add(diffuse(0.0f));
  builder.grid({-0.6f, 0, -0.6f}, {1.2f, 0, 0}, {0, 0, 1.2f}, 1, black);  // its front to y < 0
  // A lamp that shines upwards, 2 mm from the wall; and a faint one far away.
  const glm::dvec3 corner{-0.11, -0.102, 0}, far{-0.5, -3, -0.5};
  builder.grid(glm::vec3(corner), {0.22f, 0, 0}, {0, 0.1f, 0}, 1, black,
               builder.add(area_light("sconce", 1)));
  builder.grid(glm::vec3(far), {0, 0, 1}, {1, 0, 0}, 1, black,
               builder.add(area_light("window", 1)));
  GatheringScene plain(builder.build(), looked_up(20'000));
  const auto by_window = [&](const glm::vec3& position) {
    return validation::rectangle_factor(glm::dvec3(position), {0, -1, 0}, far, {1, 0, 0},
                                        {0, 0, 1});
  };
  const PrimaryHits below =
      hits_where(points_on(plain.scene, 60), [&](const glm::vec3& at, std::uint32_t face) {
        return triangle_of(face) < 2 && at.z < -0.015f && at.z > -0.2f &&
               face_normal(plain.scene, face).y < 0 && std::abs(at.x) < 0.3f;
      });
  REQUIRE(below.size() > 100);
  GatheredMaps maps(plain, few_rays, 0.04);
  maps.fill(below);
  const auto [rms, mean] = errors_of(maps, below, by_window);
  CAPTURE(rms, mean);
  CHECK(rms < 0.1);
  CHECK(std::abs(mean) < 0.02);
}

TEST_CASE("gathered nodes: the same bits whatever was looked at before, on any number of threads") {
  GatheringScene room(furnished_room(2), looked_up(50'000));
  const PrimaryHits hits = points_on(room.scene, 5);
  const auto [here, there] = halves(hits);
  GatheredMaps at_once(room, few_rays);
  at_once.fill(hits);
  const std::vector<double> expected = at_once.all_lux(hits);
  for (const std::size_t threads : {1u, 2u}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    GatheredMaps forwards(room, few_rays), backwards(room, few_rays);
    forwards.fill(here);
    forwards.fill(there);
    backwards.fill(there);
    backwards.fill(here);
    CHECK(forwards.all_lux(hits) == expected);
    CHECK(backwards.all_lux(hits) == expected);
  }
}

TEST_CASE("gathered nodes: those found after others were saved or forgotten are the same bits") {
  GatheringScene room(furnished_room(2), looked_up(50'000));
  const PrimaryHits hits = points_on(room.scene, 5);
  const auto [here, there] = halves(hits);
  GatheredMaps at_once(room, few_rays), first(room, few_rays), second(room, few_rays);
  at_once.fill(hits);
  const std::vector<double> expected = at_once.all_lux(hits);
  first.fill(here);
  SECTION("taken in by other light maps, whose source knows none of them") {
    second.maps.restore(first.maps.contents());
    second.fill(there);
    CHECK(second.all_lux(hits) == expected);
    first.fill(there);  // the nodes may have another order
    const auto errors_of = [](const GatheredMaps& maps) {
      std::vector<float> errors = maps.maps.contents().error;
      std::sort(errors.begin(), errors.end());
      return errors;
    };
    CHECK((errors_of(second) == errors_of(first)));
  }
  SECTION("forgotten by the source alone") {
    CHECK(first.nodes.bytes() > second.nodes.bytes());
    first.nodes.forget();
    CHECK(first.nodes.bytes() == second.nodes.bytes());  // which has valued none
    first.fill(there);
    CHECK(first.all_lux(hits) == expected);
  }
  SECTION("forgotten by both") {
    std::vector<std::uint8_t> keep(first.maps.statistics().nodes, 0);
    for (std::size_t node = 0; node < keep.size(); node += 3) keep[node] = 1;
    first.maps.forget(keep);
    first.nodes.forget();
    first.fill(hits);
    CHECK(first.all_lux(hits) == expected);
  }
}

TEST_CASE("gathered nodes: many lights, each in its layer, are what their group is") {
  Scene scene = furnished_room();
  add_lamps(scene, 12);
  RenderParameters parameters = looked_up(50'000);
  parameters.radius = 0.3;
  const PrimaryHits hits = points_on(scene, 3);
  GatheringScene alone(scene, parameters);
  GatheredMaps layers(alone, few_rays);
  layers.fill(hits);
  for (Light& light : scene.lights) light.group = "all";
  GatheringScene grouped(scene, parameters);
  GatheredMaps together(grouped, few_rays);
  together.fill(hits);
  // Each layer is averaged by its own noise: what is left of it differs, the light does not.
  const LightTable many_rays =
      grouped.gather({.rays = 400, .light_samples = 400}).gather(hits, numbers(hits.size()));
  const auto errors = [&](const std::vector<double>& lux) {
    double sum = 0, truth = 0, squares = 0;
    for (std::size_t i = 0; i < hits.size(); ++i) {
      const double light = many_rays.total(i, grouped.estimators.layer_powers()).luminance;
      sum += lux[i];
      truth += light;
      squares += std::pow(lux[i] - light, 2);
    }
    const auto count = static_cast<double>(hits.size());
    return std::array{sum / truth, std::sqrt(squares * count) / truth};
  };
  const auto [mean_of_layers, rms_of_layers] = errors(layers.all_lux(hits));
  const auto [mean_of_group, rms_of_group] = errors(together.all_lux(hits));
  CAPTURE(mean_of_layers, rms_of_layers, mean_of_group, rms_of_group);
  CHECK(mean_of_layers == Approx(1).margin(0.01));
  CHECK(mean_of_group == Approx(1).margin(0.01));
  CHECK(rms_of_layers < 1.2 * rms_of_group);
}

TEST_CASE("gathered nodes: rays that go on from those before are those of both at once") {
  Scene box = closed_box(diffuse(0.5f));
  box.lights = {area_light("lamp")};
  box.triangle_light[0] = 0;
  box.lights[0].triangles = {0};
  GatheringScene lit(box, looked_up(50'000));
  const PrimaryHits hits = hits_where(points_on(box, 6), fronts_of(box));
  const auto points_of = [&](int rays, cache::GatheredPoints former) {
    cache::IrradianceGather gather = lit.gather({});
    const cache::LightMapParameters parameters = GatheredMaps::parameters_of(lit, 0.32);
    cache::GatheredNodes nodes(gather, lit.estimators.layer_powers(), {{rays, rays}, {rays, rays}},
                               std::move(former));
    cache::LightMaps maps(lit.rays, parameters, nodes);
    maps.fill(hits, Progress::none(), 1);
    return nodes.take_points();
  };
  const cache::GatheredPoints before = points_of(32, {});
  const cache::GatheredPoints both = points_of(96, before);
  const cache::GatheredPoints at_once = points_of(96, {});
  REQUIRE(before.row_of.size() > 100);
  REQUIRE(both.row_of.size() == before.row_of.size());
  const auto lux = [](const LightTable& light, std::uint32_t row) {
    return double{light.irradiance[row].x};
  };
  double squares = 0;
  for (const auto& [number, row] : both.row_of) {
    CHECK(both.rays[row].rays == 96);
    const std::uint32_t same = at_once.row_of.at(number);
    // In a room of matt surfaces directions are all that is random of rays.
    const double found = lux(both.light.indirect, row);
    CHECK(found == Approx(lux(at_once.light.indirect, same)).epsilon(1e-4));
    CHECK(both.light.distance[row] == Approx(at_once.light.distance[same]).epsilon(1e-3));
    squares += std::pow(lux(before.light.indirect, before.row_of.at(number)) / found - 1, 2);
  }
  CHECK(squares / static_cast<double>(both.row_of.size()) > 1e-4);  // fewer rays tell it less well
}

TEST_CASE("gathered nodes: rays go by the room that a scene has for nodes, and by what shines") {
  Scene room = closed_box(diffuse(0.5f));  // a cube of 6 m2
  room.lights = {point_light("lamp", {0.5f, 0.5f, 0.5f})};
  const auto rays_at = [&](double spacing) {
    const cache::GatheredNodesParameters rays = cache::rays_of_nodes(room, 64, spacing);
    return std::array<int, 4>{rays.coarse.rays, rays.coarse.light_samples, rays.fine.rays,
                              rays.fine.light_samples};
  };
  CHECK(rays_at(0.008) == std::array{64, 128, 24, 48});  // 93,750 nodes
  CHECK(rays_at(0) == std::array{64, 128, 24, 48});
  CHECK(rays_at(std::sqrt(6.0 / 40'000)) == std::array{128, 256, 32, 64});
  CHECK(rays_at(0.1) == std::array{256, 512, 64, 128});
  add_environment(room, EnvironmentMap("sky", 1, 1, {glm::vec3(1.0f)}));
  CHECK(rays_at(0.008) == std::array{256, 128, 64, 128});
  CHECK(rays_at(0.1) == std::array{256, 512, 64, 512});
}

}  // namespace photile::test
