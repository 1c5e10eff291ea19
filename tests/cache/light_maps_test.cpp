// Light maps filled from formulas: what is read between nodes, and on what it depends.
#include "cache/light_maps.hpp"

#include <tbb/global_control.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <map>

#include "cache/node_sources.hpp"
#include "photile/errors.hpp"

namespace photile::test {
namespace {

/// A shadow border along x = 0.4137 that is 2 mm wide: within a cell of every level.
float shadow(const glm::vec3& p, std::uint32_t) {
  return 1.0f + 9.0f * glm::clamp((p.x - 0.4137f) / 0.002f, 0.0f, 1.0f);
}

}  // namespace

TEST_CASE("Light maps give back uniform light") {
  const Scene room = with_one_lamp(furnished_room(3));
  const RayScene rays(room);
  FormulaSource source([](const glm::vec3&, std::uint32_t) { return 3.25f; });
  cache::LightMaps maps(rays, quiet_parameters(), source);
  const PrimaryHits hits = points_on(room, 9);
  maps.fill(hits, Progress::none());
  for (const float value : read_all(maps, hits)) REQUIRE(value == Approx(3.25).epsilon(1e-6));
  CHECK(source.asked == maps.statistics().nodes);
}

TEST_CASE("Light maps give back light that varies linearly over a wall") {
  const Scene room = closed_box(diffuse(0.5f), 3);
  const RayScene rays(room);
  const auto light = [](const glm::vec3& p, std::uint32_t) { return 5.0f + p.x - 2 * p.y + p.z; };
  FormulaSource source(light);
  cache::LightMaps maps(rays, quiet_parameters(), source);
  const PrimaryHits hits = points_on(room, 12);
  maps.fill(hits, Progress::none());
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const double expected = light(hits.position[i], 0);
    // Nodes lie a little within their triangles.
    REQUIRE(read(maps, hits.position[i], hits.oriented_face[i]) ==
            Approx(expected).margin(std::sqrt(6.0) * 4 * defaults::node_inset * 0.04 / 8));
  }
}

TEST_CASE("Between nodes curved light is off by an eighth of its second difference") {
  const Scene floor = with_one_lamp(plate(diffuse(0.5f), 1.0f, 2));
  const RayScene rays(floor);
  // Second derivatives at most 36 each: so far is a chord of 4 cm from its arc, twice.
  const auto light = [](const glm::vec3& p, std::uint32_t) {
    return 20.0f + std::sin(6 * p.x) + std::cos(6 * p.y);
  };
  FormulaSource source(light);
  cache::LightMaps maps(rays, quiet_parameters(), source);
  const PrimaryHits hits = points_on(floor, 40);
  maps.fill(hits, Progress::none());
  const double bound = 2 * 36 * 0.04 * 0.04 / 8;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    REQUIRE(std::abs(read(maps, hits.position[i], hits.oriented_face[i]) -
                     light(hits.position[i], 0)) <= bound + 1e-4);
  }
}

TEST_CASE("Cells are split where light varies, down to the finest level") {
  const Scene floor = with_one_lamp(plate(diffuse(0.5f), 2.0f));
  const RayScene rays(floor);
  FormulaSource source(shadow);
  cache::LightMaps maps(rays, quiet_parameters(), source);
  const PrimaryHits hits = points_on(floor, 200);
  maps.fill(hits, Progress::none());
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const float x = hits.position[i].x;
    const float value = read(maps, hits.position[i], hits.oriented_face[i]);
    if (x < 0.4099f) REQUIRE(value == Approx(1.0).epsilon(1e-5));
    if (x > 0.4201f) REQUIRE(value == Approx(10.0).epsilon(1e-5));
    REQUIRE(value >= 1.0f - 1e-5f);
    REQUIRE(value <= 10.0f + 1e-4f);
  }
  // Both sides: 51^2 coarse nodes, and along 2 m of border columns of 2, 1 and 0.5 cm.
  const std::uint64_t nodes = maps.statistics().nodes / 2;
  CHECK(nodes > 51 * 51);
  CHECK(nodes < 51 * 51 + 4 * (101 + 201 + 401));
}

TEST_CASE("What is read does not depend on what was looked at before, or on threads") {
  const Scene room = with_one_lamp(furnished_room(2));
  const RayScene rays(room);
  const auto light = [](const glm::vec3& p, std::uint32_t s) {
    return 1.0f + std::abs(std::sin(11 * p.x) + std::sin(9 * p.y) * std::cos(13 * p.z)) +
           static_cast<float>(s % 2);
  };
  const PrimaryHits hits = points_on(room, 11);
  FormulaSource source(light);
  cache::LightMaps at_once(rays, quiet_parameters(), source);
  at_once.fill(hits, Progress::none());
  const std::vector<float> expected = read_all(at_once, hits);
  CHECK(*std::min_element(expected.begin(), expected.end()) >= 1.0f);

  // One hit after another, from the last on, by one thread.
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  cache::LightMaps one_by_one(rays, quiet_parameters(), source);
  for (std::size_t i = hits.size(); i-- > 0;) {
    PrimaryHits single;
    add_hit(single, hits.position[i], hits.oriented_face[i]);
    one_by_one.fill(single, Progress::none());
  }
  CHECK(read_all(one_by_one, hits) == expected);
  CHECK(one_by_one.statistics().nodes == at_once.statistics().nodes);
}

TEST_CASE("Neither side of a plate, nor a plate 1 mm below, leaks") {
  SceneBuilder builder;
  const std::uint32_t white = builder.add(diffuse(0.5f));
  builder.grid({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 2, white);
  builder.grid({0, 0, 0.001f}, {1, 0, 0}, {0, 1, 0}, 3, white);
  builder.grid({0.3f, 0.3f, 0.001f}, {0.2f, 0, 0}, {0, 0.2f, 0}, 1, white);  // coincident
  builder.add(point_light("lamp", {0, 0, 1}));
  const Scene scene = builder.build();
  const RayScene rays(scene);
  // A number of its own for each side of each plate.
  const auto light = [&](const glm::vec3&, std::uint32_t s) {
    const std::uint32_t t = triangle_of(s);
    const std::uint32_t plate = t < 8 ? 0 : t < 8 + 18 ? 1 : 2;
    const bool up = face_normal(scene, s).z > 0;
    return std::exp2(static_cast<float>(2 * plate + (up ? 1 : 0)));
  };
  FormulaSource source(light);
  cache::LightMaps maps(rays, quiet_parameters(), source);
  const PrimaryHits hits = points_on(scene, 7);
  maps.fill(hits, Progress::none());
  // Of faces in one place one counts.
  const scene::CoincidentFaces coincident(scene);
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const std::uint32_t counting =
        coincident.at(scene, hits.oriented_face[i], glm::dvec3(hits.position[i]));
    REQUIRE(read(maps, hits.position[i], hits.oriented_face[i]) ==
            Approx(light({}, counting)).epsilon(1e-6));
  }
}

TEST_CASE("A failing source leaves light maps as they were") {
  const Scene floor = with_one_lamp(plate(diffuse(0.5f), 1.0f));
  const RayScene rays(floor);
  const PrimaryHits hits = points_on(floor, 10);
  bool gone = true;
  FormulaSource source([&](const glm::vec3& p, std::uint32_t face) {
    if (gone) throw DeviceError("gone");
    return shadow(p, face);
  });
  cache::LightMaps maps(rays, quiet_parameters(), source);
  CHECK_THROWS_AS(maps.fill(hits, Progress::none()), DeviceError);
  CHECK(maps.statistics().nodes == 0);
  gone = false;
  maps.fill(hits, Progress::none());
  cache::LightMaps untroubled(rays, quiet_parameters(), source);
  untroubled.fill(hits, Progress::none());
  CHECK(read_all(maps, hits) == read_all(untroubled, hits));
}

TEST_CASE("Light maps are taken in whole, and filled on as if they had never been away") {
  const Scene floor = with_one_lamp(plate(diffuse(0.5f), 1.0f));
  const RayScene rays(floor);
  const PrimaryHits hits = points_on(floor, 60);
  PrimaryHits some;
  for (std::size_t i = 0; i < hits.size(); i += 7) {
    if (hits.position[i].x < 0.5f) add_hit(some, hits.position[i], hits.oriented_face[i]);
  }
  FormulaSource source(shadow);
  cache::LightMaps before(rays, quiet_parameters(), source);
  before.fill(some, Progress::none());
  cache::LightMaps after(rays, quiet_parameters(), source);
  after.restore(before.contents());
  CHECK(after.statistics().nodes == before.statistics().nodes);
  CHECK(after.statistics().cells == before.statistics().cells);
  CHECK(read_all(after, hits) == read_all(before, hits));
  const std::size_t asked = source.asked;
  after.fill(some, Progress::none());
  CHECK(source.asked == asked);
  after.fill(hits, Progress::none());
  cache::LightMaps fresh(rays, quiet_parameters(), source);
  fresh.fill(hits, Progress::none());
  CHECK(read_all(after, hits) == read_all(fresh, hits));
  CHECK(after.statistics().nodes == fresh.statistics().nodes);
}

TEST_CASE("What is forgotten is valued again to the same bits, and the rest stays") {
  const Scene floor = with_one_lamp(plate(diffuse(0.5f), 1.0f));
  const RayScene rays(floor);
  const PrimaryHits hits = points_on(floor, 60);
  FormulaSource source(shadow);
  cache::LightMaps maps(rays, quiet_parameters(), source);
  maps.fill(hits, Progress::none());
  const std::vector<float> before = read_all(maps, hits);
  const std::uint64_t nodes = maps.statistics().nodes;
  std::vector<std::uint8_t> keep(nodes, 0);
  for (std::size_t node = 0; node < nodes; node += 5) keep[node] = 1;
  const std::vector<std::uint32_t> former = maps.forget(keep);
  CHECK(former.size() == maps.statistics().nodes);
  CHECK(former.size() < nodes);
  CHECK(std::is_sorted(former.begin(), former.end()));
  std::size_t still_there = 0;
  const std::vector<float> between = read_all(maps, hits);
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if (between[i] < 0) continue;
    ++still_there;
    REQUIRE(between[i] == before[i]);
  }
  CHECK(still_there > 0);
  CHECK(still_there < hits.size());
  maps.fill(hits, Progress::none());
  CHECK(read_all(maps, hits) == before);
  CHECK(maps.statistics().nodes == nodes);
}

TEST_CASE("Contents that do not fit the scene are refused") {
  const Scene floor = with_one_lamp(plate(diffuse(0.5f), 1.0f));
  const RayScene rays(floor);
  FormulaSource source(shadow);
  cache::LightMaps maps(rays, quiet_parameters(), source);
  maps.fill(points_on(floor, 30), Progress::none());
  const LightMapContents whole = maps.contents();
  const auto refused = [&](const std::function<void(LightMapContents&)>& spoil) {
    LightMapContents contents = whole;
    spoil(contents);
    cache::LightMaps other(rays, quiet_parameters(), source);
    CHECK_THROWS_AS(other.restore(std::move(contents)), InputError);
  };
  refused([](auto& c) { c.nodes.pop_back(); });
  refused([](auto& c) { c.nodes[3] = c.nodes[4]; });
  refused([](auto& c) { c.nodes[5].x += 1; });
  refused([](auto& c) { c.values.irradiance.pop_back(); });
  refused([](auto& c) { c.values.irradiance[9].y = std::nanf(""); });
  refused([](auto& c) { c.values.first.push_back(0); });
  refused([](auto& c) { c.values.by_normal.resize(c.values.irradiance.size()); });  // not smooth
  refused([](auto& c) { c.tiles[0].chart = 99; });
  refused([](auto& c) { c.tiles[0].level = 4; });
  refused([](auto& c) { c.tiles[0].x = 4; });
  refused([](auto& c) { c.tiles[0].x = 1 << 20; });
  refused([](auto& c) { c.tiles[0].known = 0, c.tiles[0].split = 1; });
  refused([](auto& c) { c.tiles.push_back(c.tiles[0]); });
  refused([](auto& c) {  // children without their tile
    c.tiles.erase(std::find_if(c.tiles.begin(), c.tiles.end(),
                               [](const auto& tile) { return tile.split != 0; }));
  });
}

TEST_CASE("Light maps refuse what makes no lattice") {
  FormulaSource source(shadow);
  const Scene floor = with_one_lamp(plate(diffuse(0.5f), 1.0f));
  const RayScene rays(floor);
  for (const double spacing : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    CHECK_THROWS_AS(cache::LightMaps(rays, quiet_parameters(spacing), source), UsageError);
  }
  for (const int levels : {0, 13}) {
    CHECK_THROWS_AS(cache::LightMaps(rays, quiet_parameters(0.04, levels), source), UsageError);
  }
}

TEST_CASE(
    "hits read from the coarsest nodes alone have the same light whoever looked closer before") {
  SceneBuilder builder;
  builder.grid({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1, builder.add(diffuse(0.5f)));
  const Scene scene = with_one_lamp(std::move(builder).build());
  const RayScene rays(scene);
  const PrimaryHits hits = points_on(scene, 20);
  const auto light = [](const glm::vec3& p, std::uint32_t) { return p.x > 0.41f ? 10.0f : 0.0f; };
  FormulaSource fresh(light), refined(light);
  cache::LightMaps coarse(rays, quiet_parameters(), fresh), fine(rays, quiet_parameters(), refined);
  coarse.fill(hits, Progress::none(), cache::LightMaps::all_rounds, 1);
  fine.fill(hits, Progress::none());
  CHECK(fresh.asked < refined.asked);
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const auto read_coarse = [&](const cache::LightMaps& maps) {
      cache::BilinearWeights bilinear;
      REQUIRE(maps.find(hits.oriented_face[i], hits.position[i], bilinear, 1));
      float sum = 0;
      for (std::size_t corner = 0; corner < 4; ++corner) {
        sum += bilinear.weight[corner] * maps.values().irradiance[bilinear.node[corner]].x;
      }
      return sum;
    };
    CHECK(read_coarse(coarse) == read_coarse(fine));
  }
}

/// Keeps the positions of the points that it is asked for, by their numbers.
class NumberedPoints : public FormulaSource {
 public:
  NumberedPoints() : FormulaSource([](const glm::vec3&, std::uint32_t) { return 1.0f; }) {}

  cache::NodeValues value(const cache::NodeBatch& batch, const Progress& progress) override {
    for (std::size_t i = 0; i < batch.nodes; ++i) {
      position.insert({batch.number[i], batch.points.position[i]});
      coarse += batch.coarse[i];
    }
    return FormulaSource::value(batch, progress);
  }

  std::map<std::uint64_t, glm::vec3> position;
  std::size_t coarse = 0;
};

TEST_CASE("light maps: points keep their numbers where coarse levels are skipped") {
  SceneBuilder builder;
  builder.grid({0, 0, 0}, {1, 0, 0}, {0, 0.7f, 0}, 1, builder.add(diffuse(0.5f)));
  const Scene scene = with_one_lamp(builder.build());
  const RayScene rays(scene);
  const PrimaryHits hits = points_on(scene, 40);
  const auto filled = [&](int levels, int skipped) {
    cache::LightMapParameters parameters = quiet_parameters(0.1, levels);
    parameters.skipped_levels = skipped;
    NumberedPoints source;
    cache::LightMaps maps(rays, parameters, source);
    maps.fill(hits, Progress::none());
    return source;
  };
  const NumberedPoints plain = filled(3, 0), finer = filled(4, 1), finest = filled(5, 2);
  CHECK(plain.coarse == plain.position.size());
  CHECK(finer.coarse == finer.position.size());
  CHECK(finer.position.size() > 3 * plain.position.size());
  CHECK(finest.position.size() > 3 * finer.position.size());
  for (const auto& [coarser, closer] : {std::pair(&plain, &finer), std::pair(&finer, &finest)}) {
    for (const auto& [number, position] : coarser->position) {
      CAPTURE(number, position.x, position.y);
      REQUIRE(closer->position.contains(number));
      CHECK(glm::distance(closer->position.at(number), position) < 0.1f / 4 / 16);
    }
  }
}

}  // namespace photile::test
