// Quick frames from light maps: what they show while nodes are lacking, and once none is.
#include "render/frame_renderer.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <limits>

#include "cache/charts.hpp"
#include "cache/node_sources.hpp"
#include "trace/ray_query.hpp"
#include "trace/surface.hpp"

namespace photile::test {
namespace {

constexpr double all = std::numeric_limits<double>::infinity();
constexpr int frame_width = 96, frame_height = 64;

float waves(const glm::vec3& p, std::uint32_t) {
  return 2.0f + std::sin(9 * p.x) * std::cos(7 * p.y) + std::sin(5 * p.z);
}

/// A room whose light is a formula, and frames of it.
struct DrawnRoom {
  explicit DrawnRoom(FormulaSource::Formula light = waves)
      : scene(with_one_lamp(furnished_room(2))),
        rays(scene),
        source(std::move(light)),
        maps(rays, quiet_parameters(), source),
        frames(rays, maps) {}

  std::vector<glm::vec3> draw(const Camera& camera, double seconds, float power = 1.0f,
                              int samples = 1, cache::FrameView* coarser = nullptr) {
    std::vector<glm::vec3> picture(std::size_t{frame_width} * frame_height);
    const std::vector<glm::vec3> powers{glm::vec3(power)};
    drawn = frames.draw(camera, {frame_width, frame_height, samples}, powers, seconds, picture,
                        Progress::none(), coarser);
    return picture;
  }

  const Scene scene;
  const RayScene rays;
  FormulaSource source;
  cache::LightMaps maps;
  FrameRenderer frames;
  DrawnFrame drawn;
};

Camera in_the_room(double x) { return Camera::look_at({x, 0.3, 1.5}, {2, 2, 0.5}, {0, 0, 1}, 1.0); }

/// The chart in each pixel; none along borders between them, and where nothing is seen.
std::vector<std::uint32_t> charts_seen(const DrawnRoom& room, const Camera& camera) {
  const auto chart_at = [&](double x, double y) {
    const glm::vec3 direction(camera.direction(x, y, frame_width, frame_height));
    const auto hit = trace::intersect(room.rays, glm::vec3(camera.position), direction);
    if (!hit) return none;
    const std::uint32_t side = trace::surface_hit(room.scene, *hit, direction).side;
    return room.maps.charts().chart_of()[oriented(hit->triangle, side)];
  };
  std::vector<std::uint32_t> charts;
  for (int y = 0; y < frame_height; ++y) {
    for (int x = 0; x < frame_width; ++x) {
      const std::uint32_t chart = chart_at(x, y);  // at the corners of the pixel
      const bool inside = chart == chart_at(x + 1, y) && chart == chart_at(x, y + 1) &&
                          chart == chart_at(x + 1, y + 1);
      charts.push_back(inside ? chart : none);
    }
  }
  return charts;
}

bool same_pixels(const std::vector<glm::vec3>& a, const std::vector<glm::vec3>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof a[0]) == 0;
}

/// The same light at all nodes.
auto constant(float light) {
  return [light](const glm::vec3&, std::uint32_t) { return light; };
}

}  // namespace

TEST_CASE("Frames that value a few nodes at a time come to the bits of one that values all") {
  DrawnRoom at_once, step_by_step;
  const auto expected = at_once.draw(in_the_room(0.5), all);
  CHECK(at_once.drawn.lacking == 0);
  std::vector<glm::vec3> picture;
  int frames = 0;
  std::size_t lacking = std::numeric_limits<std::size_t>::max();
  do {
    picture = step_by_step.draw(in_the_room(0.5), 1e-3);
    ++frames;
    REQUIRE(frames < 100'000);
    lacking = step_by_step.drawn.lacking;
  } while (lacking > 0);
  CHECK(frames > 2);
  CHECK(same_pixels(picture, expected));
  CHECK(step_by_step.maps.statistics().nodes == at_once.maps.statistics().nodes);
}

TEST_CASE("A frame without time values nothing, and one with a little what takes most of it") {
  std::vector<glm::vec3> asked;
  DrawnRoom room([&](const glm::vec3& p, std::uint32_t) {
    asked.push_back(p);
    return 1.0f;
  });
  // Nearly all of it shows the floor, and a corner of it a block.
  const Camera camera = Camera::look_at({2.0, 2.0, 1.0}, {2.05, 2.0, 0}, {0, 0, 1}, 0.8);
  room.draw(camera, 0);
  CHECK(asked.empty());
  CHECK(room.drawn.lacking > 0);
  CHECK(room.drawn.empty == room.drawn.lacking);
  CHECK(room.drawn.fill_seconds == 0);
  room.draw(camera, 1e-7);
  const auto first = asked;
  REQUIRE_FALSE(first.empty());
  room.draw(camera, all);
  CHECK(first.size() < asked.size() / 10);
  for (const glm::vec3& p : first) CHECK(p.z == 0.0f);
}

TEST_CASE("Surface whose finer nodes are lacking shows coarser ones, and none is black") {
  DrawnRoom room;
  int with_nodes = 0;
  for (int frame = 0; frame < 20; ++frame) {
    const auto picture = room.draw(in_the_room(0.5), 1e-4);
    if (room.maps.statistics().nodes == 0) continue;
    ++with_nodes;
    for (const glm::vec3& pixel : picture) REQUIRE(pixel.x + pixel.y + pixel.z > 0);
  }
  CHECK(with_nodes >= 15);
}

TEST_CASE("Where there is no node yet, other light maps are shown, which are filled before") {
  DrawnRoom coarse(constant(1.0f)), fine(constant(2.0f));
  const Camera camera = in_the_room(0.5);
  const auto of_coarse = coarse.draw(camera, all);
  const auto without_own = fine.draw(camera, 0, 1.0f, 1, &coarse.frames.view());
  for (std::size_t i = 0; i < of_coarse.size(); ++i) {
    REQUIRE(without_own[i].x == Approx(of_coarse[i].x));
  }
  CHECK(fine.drawn.lacking > 0);
  CHECK(fine.drawn.empty == 0);
  CHECK(fine.drawn.lacking_fraction == 1);
  fine.draw(camera, 1e-7, 1.0f, 1, &coarse.frames.view());  // a few nodes
  CHECK(fine.drawn.lacking_fraction > 0);
  CHECK(fine.drawn.lacking_fraction < 1);
  const auto of_fine = fine.draw(camera, all, 1.0f, 1, &coarse.frames.view());
  CHECK(fine.drawn.lacking == 0);
  CHECK(fine.drawn.lacking_fraction == 0);
  CHECK(same_pixels(of_fine, fine.draw(camera, all)));

  DrawnRoom empty(constant(1.0f)), waiting(constant(2.0f));
  waiting.draw(camera, 1e-7, 1.0f, 1, &empty.frames.view());
  CHECK(waiting.drawn.unlit_fraction > 0.5);
  CHECK(waiting.maps.statistics().nodes == 0);
  CHECK(empty.maps.statistics().nodes > 0);
}

TEST_CASE("Pictures of one frame get better until nothing is lacking, chart by chart") {
  DrawnRoom coarse(constant(1.0f)), fine(constant(2.0f));
  const Camera camera = in_the_room(0.5);
  const auto of_coarse = coarse.draw(camera, all);
  const std::vector<glm::vec3> powers{glm::vec3(1.0f)};
  std::vector<glm::vec3> picture(std::size_t{frame_width} * frame_height);
  const std::vector<std::uint32_t> chart_in = charts_seen(fine, camera);
  std::vector<double> lacking;
  std::size_t changing = 0;  // pictures that show both
  const auto show = [&](const DrawnFrame& drawn) {
    lacking.push_back(drawn.lacking_fraction);
    std::vector<float> light_of_chart(fine.maps.charts().size(), 0.0f);
    std::size_t of_fine = 0;
    for (std::size_t pixel = 0; pixel < picture.size(); ++pixel) {
      const float light = picture[pixel].x / of_coarse[pixel].x;
      const bool is_one_of_both = light == Approx(1.0f) || light == Approx(2.0f);
      REQUIRE(is_one_of_both);
      of_fine += light > 1.5f ? 1 : 0;
      if (chart_in[pixel] == none) continue;
      float& of_chart = light_of_chart[chart_in[pixel]];
      if (of_chart != 0.0f) REQUIRE(light == Approx(of_chart));
      of_chart = light;
    }
    changing += of_fine > 0 && of_fine < picture.size() ? 1 : 0;
    return 1e-4;
  };
  const DrawnFrame last =
      fine.frames.draw(camera, {frame_width, frame_height, 1}, powers, FrameFilling(0, {}, show),
                       picture, Progress::none(), &coarse.frames.view());
  CHECK(last.lacking == 0);
  CHECK(changing > 0);
  REQUIRE(lacking.size() > 2);
  CHECK(lacking.front() == 1);
  CHECK(std::is_sorted(lacking.rbegin(), lacking.rend()));
  CHECK(same_pixels(picture, fine.draw(camera, all)));
}

TEST_CASE("A frame that nobody waits for any longer values no more nodes") {
  DrawnRoom room;
  std::vector<glm::vec3> picture(std::size_t{frame_width} * frame_height);
  const std::vector<glm::vec3> powers{glm::vec3(1.0f)};
  const auto nodes = [&] { return room.maps.statistics().nodes; };
  const DrawnFrame drawn =
      room.frames.draw(in_the_room(0.5), {frame_width, frame_height, 1}, powers,
                       FrameFilling(1e6, [&] { return nodes() > 0; }), picture, Progress::none());
  CHECK(drawn.lacking > 0);
  CHECK(nodes() > 0);
  CHECK(nodes() < drawn.lacking / 4);
}

TEST_CASE("A camera that stands still, or comes back, sees the same bits") {
  DrawnRoom room;
  const auto first = room.draw(in_the_room(0.5), all);
  CHECK(same_pixels(room.draw(in_the_room(0.5), all), first));
  room.draw(in_the_room(1.5), all, 0.3f);
  CHECK(same_pixels(room.draw(in_the_room(0.5), all), first));
}

TEST_CASE("Several rays a pixel smooth edges, and leave smooth light as it is") {
  DrawnRoom room;
  const auto one = room.draw(in_the_room(0.5), all);
  const auto nine = room.draw(in_the_room(0.5), all, 1.0f, 9);
  std::size_t near = 0;
  double sum_of_one = 0, sum_of_nine = 0;
  for (std::size_t i = 0; i < one.size(); ++i) {
    near += std::abs(nine[i].x - one[i].x) < 0.05f * one[i].x ? 1 : 0;
    sum_of_one += double{one[i].x}, sum_of_nine += double{nine[i].x};
  }
  CHECK(near > one.size() * 8 / 10);
  CHECK(near < one.size());
  CHECK(sum_of_nine == Approx(sum_of_one).epsilon(0.01));
}

TEST_CASE("Cells that were seen least recently are forgotten, and come back to the same bits") {
  DrawnRoom free, bounded;
  const Camera behind = Camera::look_at({0.5, 0.3, 1.5}, {0.4, 0.1, 2.5}, {0, 0, 1}, 0.5);
  const auto first = free.draw(in_the_room(0.5), all);
  const cache::LightMapStatistics one_view = free.maps.statistics();
  const auto second = free.draw(behind, all);
  const std::uint64_t both = free.maps.statistics().nodes;
  REQUIRE(both > one_view.nodes);

  bounded.frames.view().bound(one_view.value_bytes + one_view.index_bytes - 1);
  for (int turn = 0; turn < 3; ++turn) {
    CHECK(same_pixels(bounded.draw(in_the_room(0.5), all), first));
    CHECK(same_pixels(bounded.draw(behind, all), second));
    CHECK(same_pixels(bounded.draw(behind, all, 2.0f), free.draw(behind, all, 2.0f)));
    free.draw(behind, all);
    CHECK(bounded.maps.statistics().nodes < both);
  }
}

TEST_CASE("Walking changes no light of a wall between frames") {
  DrawnRoom room;
  const PrimaryHits points = points_on(room.scene, 6);
  std::vector<float> before;
  for (int frame = 0; frame < 4; ++frame) {
    room.draw(in_the_room(0.5 + 0.1 * frame), all);
    const std::vector<float> now = read_all(room.maps, points);
    for (std::size_t i = 0; i < now.size() && frame > 0; ++i) {
      if (before[i] >= 0) REQUIRE(now[i] == before[i]);  // what was seen stays as it is
    }
    before = now;
  }
}

}  // namespace photile::test
