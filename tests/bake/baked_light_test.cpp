// Light maps as textures: what a bilinear lookup gives at points of the surface, and how rectangles
// lie on a picture.
#include "bake/baked_light.hpp"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <set>

#include "cache/node_sources.hpp"
#include "photile/errors.hpp"

namespace photile::test {
namespace {

float gentle(const glm::vec3& p, std::uint32_t s) {
  const float brighter = side_of(s) == 0 ? 1.0f : 3.0f;
  return brighter * (3.0f + std::sin(2 * p.x) * std::cos(p.y) + std::sin(1.5f * p.z));
}

/// Looks a texture up as a graphics processor does.
float bilinear(const std::vector<glm::vec3>& texels, std::uint32_t width, std::uint32_t height,
               const glm::vec2& uv) {
  const float x = uv.x * static_cast<float>(width) - 0.5f;
  const float y = uv.y * static_cast<float>(height) - 0.5f;
  const float fx = std::floor(x), fy = std::floor(y);
  const auto at = [&](float column, float row) {
    const auto c =
        static_cast<std::size_t>(std::clamp(column, 0.0f, static_cast<float>(width - 1)));
    const auto r = static_cast<std::size_t>(std::clamp(row, 0.0f, static_cast<float>(height - 1)));
    return texels[r * width + c].x;
  };
  return glm::mix(glm::mix(at(fx, fy), at(fx + 1, fy), x - fx),
                  glm::mix(at(fx, fy + 1), at(fx + 1, fy + 1), x - fx), y - fy);
}

bake::BakeParameters baking(double texel = 0, int most_side = 4096) {
  bake::BakeParameters parameters;
  parameters.texel = texel;
  parameters.most_side = most_side;
  parameters.powers = {1.0};
  return parameters;
}

/// Baked light and what it needs.
struct BakedRoom {
  BakedRoom(const Scene& scene, cache::LightMaps& maps, const bake::BakeParameters& parameters)
      : baked(scene, maps, parameters, Progress::none()), texels(baked.layer(0)) {}

  float read(const Scene& scene, const glm::vec3& position, std::uint32_t side) const {
    const auto [a, b, c] = scene.corners(triangle_of(side));
    const auto uv = baked.corners(side);
    // The weights of the corners.
    const glm::vec3 normal = glm::cross(b - a, c - a);
    const float v = glm::dot(glm::cross(b - a, position - a), normal) / glm::dot(normal, normal);
    const float u = glm::dot(glm::cross(position - a, c - a), normal) / glm::dot(normal, normal);
    return bilinear(texels, baked.width(), baked.height(),
                    uv[0] + u * (uv[1] - uv[0]) + v * (uv[2] - uv[0]));
  }

  bake::BakedLight baked;
  std::vector<glm::vec3> texels;
};

}  // namespace

TEST_CASE("Baked textures hold the irradiance of both sides at points of the surface") {
  const Scene scene = with_one_lamp(furnished_room(2));
  FormulaSource source(gentle);
  const RayScene rays(scene);
  cache::LightMaps maps(rays, quiet_parameters(), source);
  const BakedRoom room(scene, maps, baking(0.03));
  REQUIRE(room.texels.size() == std::size_t{room.baked.width()} * room.baked.height());
  // Second derivatives of the light are at most 3 x 4.25 a square metre; texels and nodes of 4 cm
  // each are off by an eighth of it, both ways.
  const double bound = 2 * 2 * 3 * 4.25 * 0.04 * 0.04 / 8;
  const PrimaryHits points = points_on(scene, 5);
  const std::set<std::uint32_t> shared = triangles_in_one_place(scene);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::uint32_t side = points.oriented_face[i];
    if (shared.contains(triangle_of(side))) continue;
    REQUIRE(std::abs(room.read(scene, points.position[i], side) -
                     gentle(points.position[i], side)) < bound + 1e-3);
  }
}

TEST_CASE("Lookups beside a box on the floor take nothing of what lies under it") {
  SceneBuilder builder;
  const std::uint32_t white = builder.add(diffuse(0.5f));
  builder.grid({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1, white);
  builder.box({0.313f, 0.313f, 0.0f}, {0.687f, 0.687f, 0.2f}, white, false);
  const Scene scene = with_one_lamp(std::move(builder).build());
  const float within = GENERATE(0.0f, 1e-4f, 1e4f);  // nothing, what seeps through seams, a lamp
  FormulaSource source([&](const glm::vec3& p, std::uint32_t) {
    const bool under = p.x > 0.313f && p.x < 0.687f && p.y > 0.313f && p.y < 0.687f && p.z == 0;
    return under ? within : 10.0f;
  });
  const RayScene rays(scene);
  cache::LightMaps maps(rays, quiet_parameters(), source);
  const BakedRoom room(scene, maps, baking(0.03));
  const PrimaryHits points = points_on(scene, 60);
  std::size_t beside = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::uint32_t side = points.oriented_face[i];
    const glm::vec3& p = points.position[i];
    if (triangle_of(side) > 1 || face_normal(scene, side).z < 0) continue;  // the floor, from above
    const float away =
        std::max(std::max(0.313f - p.x, p.x - 0.687f), std::max(0.313f - p.y, p.y - 0.687f));
    if (away < (within > 10 ? 0.031f : 1e-4f)) continue;  // lookups take of lamp-lit texels
    if (away < (within > 10 ? 0.06f : 0.03f)) ++beside;
    CAPTURE(within, p.x, p.y);
    CHECK(room.read(scene, p, side) == Approx(10).epsilon(1e-5));
  }
  CHECK(beside > 20);
}

TEST_CASE("Lookups beside a plate a little above the floor take nothing of the slit below it") {
  const auto below = [](const glm::vec3& p) {
    return p.x > 0.313f && p.x < 0.687f && p.y > 0.313f && p.y < 0.687f && p.z == 0;
  };
  // As gathered light: a little comes into the slit, and nodes know how near the plate is.
  class PlateSource : public cache::NodeSource {
   public:
    explicit PlateSource(decltype(below) below) : below_(below) {}
    cache::NodeValues value(const cache::NodeBatch& batch, const Progress&) override {
      cache::NodeValues values{LightTable(1, false), {}, {}};
      for (const glm::vec3& p : batch.points.position) {
        values.light.irradiance.emplace_back(below_(p) ? 0.5f : 10.0f);
        values.error.push_back(0.0f);
        values.distance.push_back(below_(p) ? 0.003f : 1.0f);
      }
      return values;
    }

   private:
    decltype(below) below_;
  };
  SceneBuilder builder;
  const std::uint32_t white = builder.add(diffuse(0.5f));
  builder.grid({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1, white);
  builder.box({0.313f, 0.313f, 0.002f}, {0.687f, 0.687f, 0.03f}, white, true);
  const Scene scene = with_one_lamp(std::move(builder).build());
  PlateSource source(below);
  const RayScene rays(scene);
  cache::LightMaps maps(rays, quiet_parameters(), source);
  const BakedRoom room(scene, maps, baking(0.03));
  const PrimaryHits points = points_on(scene, 60);
  std::size_t beside = 0, deep = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::uint32_t side = points.oriented_face[i];
    const glm::vec3& p = points.position[i];
    if (triangle_of(side) > 1 || face_normal(scene, side).z < 0) continue;
    const float away =
        std::max(std::max(0.313f - p.x, p.x - 0.687f), std::max(0.313f - p.y, p.y - 0.687f));
    CAPTURE(p.x, p.y);
    if (away < -0.07f) {  // below the plate it stays dark
      CHECK(room.read(scene, p, side) == Approx(0.5).epsilon(1e-5));
      ++deep;
    }
    if (away < 1e-4f) continue;
    if (away < 0.03f) ++beside;
    CHECK(room.read(scene, p, side) == Approx(10).epsilon(1e-5));
  }
  CHECK(beside > 20);
  CHECK(deep > 20);
}

TEST_CASE("The brighter side of a triangle is baked, and the other where any light falls") {
  const Scene scene = with_one_lamp(furnished_room(2));
  const std::set<std::uint32_t> shared = triangles_in_one_place(scene);
  const std::size_t alone = scene.triangle_count() - shared.size();
  REQUIRE(alone > scene.triangle_count() / 2);
  const auto sides_under = [&](const FormulaSource::Formula& light) {
    FormulaSource source(light);
    const RayScene rays(scene);
    cache::LightMaps maps(rays, quiet_parameters(), source);
    const BakedRoom room(scene, maps, baking(0.1));
    std::vector<std::uint32_t> sides(room.baked.sides().begin(), room.baked.sides().end());
    std::erase_if(sides, [&](std::uint32_t s) { return shared.contains(triangle_of(s)); });
    return sides;
  };
  const auto backs =
      sides_under([](const glm::vec3&, std::uint32_t s) { return side_of(s) == 1 ? 1.0f : 0.0f; });
  REQUIRE(backs.size() == alone);
  for (const std::uint32_t side : backs) CHECK(side_of(side) == 1);
  CHECK(sides_under(gentle).size() == 2 * alone);
}

TEST_CASE("Sides that neither light nor an eye comes to are not open") {
  // Sides of a closed box on a floor that look to its middle, and the others.
  const auto open_of_box = [](const glm::vec3& lamp) {
    SceneBuilder builder;
    const std::uint32_t white = builder.add(diffuse(0.5f));
    builder.grid({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1, white);
    builder.box({0.3f, 0.3f, 0.0f}, {0.7f, 0.7f, 0.5f}, white, false);
    builder.add(point_light("lamp", lamp));
    Scene scene = std::move(builder).build();
    scene.cameras.clear();
    const std::vector<std::uint8_t> open = bake::open_sides(RayScene(scene));
    std::array<int, 2> count{};
    for (std::uint32_t side = 4; side < open.size(); ++side) {
      const glm::dvec3 corner(scene.corners(triangle_of(side))[0]);
      const bool inwards =
          glm::dot(face_normal(scene, side), glm::dvec3(0.5, 0.5, 0.25) - corner) > 0;
      count[inwards] += open[side];
    }
    return count;
  };
  // The faces of a box have edges in common: where one is seen all are, also the one below.
  CHECK(open_of_box({0.5f, 0.5f, 2.0f}) == std::array{12, 0});
  CHECK(open_of_box({0.5f, 0.5f, 0.2f}) == std::array{0, 12});
}

TEST_CASE("A side that nothing comes to is open where it goes on from one that something does") {
  SceneBuilder builder;
  const std::uint32_t white = builder.add(diffuse(0.5f));
  builder.quad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, white);
  // A prism with a lid hides all of the second triangle and a strip of the first.
  const glm::vec3 a(-0.1f, -0.2f, 0), b(1.2f, 1.1f, 0), c(-0.1f, 1.1f, 0), up(0, 0, 0.3f);
  for (const auto& [from, to] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) {
    builder.grid(from, to - from, up, 1, white);
  }
  builder.triangle(a + up, b + up, c + up, white);
  builder.add(point_light("lamp", {0.9f, 0.1f, 0.5f}));
  Scene scene = std::move(builder).build();
  scene.cameras.clear();
  const std::vector<std::uint8_t> open = bake::open_sides(RayScene(scene));
  for (std::uint32_t side = 0; side < 4; ++side) {
    CHECK(open[side] == (face_normal(scene, side).z > 0 ? 1 : 0));
  }
}

TEST_CASE(
    "Texels become coarser until they fit, and those asked for are refused where they do not") {
  const Scene scene = with_one_lamp(furnished_room(2));
  FormulaSource source(gentle);
  const RayScene rays(scene);
  cache::LightMaps maps(rays, quiet_parameters(), source);
  const BakedRoom small(scene, maps, baking(0, 256));
  CHECK(small.baked.width() <= 256);
  CHECK(small.baked.height() <= 256);
  CHECK(small.baked.texel() > 0.02);
  CHECK_THROWS_AS(BakedRoom(scene, maps, baking(0.001, 256)), UsageError);
}

TEST_CASE("Rectangles on an atlas do not overlap") {
  std::mt19937 random(5);
  std::vector<bake::TexelRectangle> rectangles(300);
  for (auto& r : rectangles) {
    r.width = 1 + random() % 40;
    r.height = 1 + random() % 25;
  }
  const auto atlas = bake::pack(rectangles, 1024);
  REQUIRE(atlas);
  std::vector<int> covered(std::size_t{atlas->width} * atlas->height, 0);
  for (const auto& r : rectangles) {
    REQUIRE(r.x + r.width <= atlas->width);
    REQUIRE(r.y + r.height <= atlas->height);
    for (std::uint32_t y = r.y; y < r.y + r.height; ++y) {
      for (std::uint32_t x = r.x; x < r.x + r.width; ++x) ++covered[y * atlas->width + x];
    }
  }
  CHECK(*std::max_element(covered.begin(), covered.end()) == 1);
  std::vector<bake::TexelRectangle> wide{{0, 0, 65, 1}};
  CHECK_FALSE(bake::pack(wide, 64));
  std::vector<bake::TexelRectangle> many(65, {0, 0, 64, 1});
  CHECK_FALSE(bake::pack(many, 64));
}

}  // namespace photile::test
