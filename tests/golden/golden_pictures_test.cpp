// Pictures of today beside those of the day when they were last looked at. What is right is for the
// other tests to say: these notice that something has changed at all, however many tests it passes.
//
// Of each picture tests/golden/NAME.json holds means of tiles of 8 x 8 pixels, per light and
// colour, over 16 seeds, and their standard errors. Differences are signed and of means, so that
// noise cancels and a shift does not. PHOTILE_RENEW_GOLDEN=1 writes the files anew and tells what
// has changed: tests/golden/renew.sh.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>

#include "../render/pictures.hpp"
#include "photile/path_tracer.hpp"
#include "photile/renderer.hpp"
#include "test_device.hpp"
#include "test_scenes.hpp"

namespace photile::test {
namespace {

constexpr int seeds = 16, tile = 8, width = 4 * tile, height = 3 * tile;
/// Student t, 30 degrees of freedom: 1e-6 on both sides, shared by the 78 values of a picture.
constexpr double t_critical = 7.8;

struct Tile {
  double mean = 0, error = 0;
};
using Tiles = std::map<std::string, Tile>;  ///< "light, colour, column, row", and "light, colour"

/// A room with all that there is: gloss, a mirror, glass and two lamps.
Scene room() {
  Scene scene = furnished_room(2);
  scene.materials[0] = glossy(glm::vec3(0.4f), glm::vec3(0.2f), 0.3f);
  scene.materials[1] = mirror(glm::vec3(0.8f));
  scene.materials[2].interaction = Interaction::glass;
  scene.materials[2].index_of_refraction = 1.5f;
  scene.materials[2].thin = true;
  return scene;
}

/// Means over the pixels of each tile, and over all of them.
void add_picture(const LightLayers& layers, std::map<std::string, std::vector<double>>& values) {
  for (const LightLayers::Layer& layer : layers.layers) {
    glm::dvec3 whole(0.0);
    for (int row = 0; row < height / tile; ++row) {
      for (int column = 0; column < width / tile; ++column) {
        glm::dvec3 sum(0.0);
        for (int y = row * tile; y < (row + 1) * tile; ++y) {
          for (int x = column * tile; x < (column + 1) * tile; ++x) {
            sum += layer.radiance[static_cast<std::size_t>(y * width + x)];
          }
        }
        for (int c = 0; c < 3; ++c) {
          const std::string name = layer.light + ", " + "RGB"[c] + ", column " +
                                   std::to_string(column) + ", row " + std::to_string(row);
          values[name].push_back(sum[c] / (tile * tile));
        }
        whole += sum;
      }
    }
    for (int c = 0; c < 3; ++c) {
      values[layer.light + ", " + "RGB"[c]].push_back(whole[c] / (width * height));
    }
  }
}

template <class Render>
Tiles tiles_of(const Render& render_seed) {
  std::map<std::string, std::vector<double>> values;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) add_picture(render_seed(seed), values);
  Tiles tiles;
  for (const auto& [name, of_seeds] : values) {
    Tile& result = tiles[name];
    for (const double value : of_seeds) result.mean += value / seeds;
    for (const double value : of_seeds) {
      result.error += (value - result.mean) * (value - result.mean) / (seeds * (seeds - 1));
    }
    result.error = std::sqrt(result.error);
  }
  return tiles;
}

std::filesystem::path file_of(const std::string& name) {
  return std::filesystem::path(PHOTILE_GOLDEN) / (name + ".json");
}

Tiles golden(const std::string& name) {
  Tiles tiles;
  std::ifstream stream(file_of(name));
  if (!stream) return tiles;
  for (const auto& [key, value] : nlohmann::json::parse(stream).items()) {
    tiles[key] = {value[0], value[1]};
  }
  return tiles;
}

void write(const std::string& name, const Tiles& tiles) {
  std::ofstream stream(file_of(name));
  const char* separator = "{\n";
  for (const auto& [key, value] : tiles) {
    stream << separator << " \"" << key << "\": "
           << nlohmann::json{std::stod(fmt::format("{:.6g}", value.mean)),
                             std::stod(fmt::format("{:.3g}", value.error))};
    separator = ",\n";
  }
  stream << "\n}\n";
}

/// Standard errors between two tiles. Rounding of other compilers counts for none.
double deviation(const Tile& now, const Tile& then) {
  constexpr double rounding = 1e-5;
  const double difference =
      std::max(0.0, std::abs(now.mean - then.mean) - rounding * std::abs(then.mean));
  return difference == 0 ? 0 : difference / std::hypot(now.error, then.error);
}

void compare(const std::string& name, const Tiles& now) {
  const Tiles then = golden(name);
  const char* const renew = std::getenv("PHOTILE_RENEW_GOLDEN");
  if (renew != nullptr && renew == std::string("1")) {
    for (const auto& [key, tile_now] : now) {
      const auto before = then.find(key);
      if (before == then.end()) continue;
      const double errors = deviation(tile_now, before->second);
      if (errors == 0) continue;
      std::cout << fmt::format("{}: {}: {:.5g} -> {:.5g}, {:.1f} standard errors\n", name, key,
                               before->second.mean, tile_now.mean, errors);
    }
    write(name, now);
    return;
  }
  REQUIRE(then.size() == now.size());
  double mean = 0, error = 0;
  for (const auto& [key, tile_now] : now) {
    const auto before = then.find(key);
    CAPTURE(name, key);
    REQUIRE(before != then.end());
    CAPTURE(before->second.mean, tile_now.mean, before->second.error, tile_now.error);
    CHECK(deviation(tile_now, before->second) <= t_critical);
    mean += tile_now.mean;
    error += tile_now.error;
  }
  // A typical tile would show a change of so much: less, and this proved nothing.
  CHECK((t_critical + 3.1) * std::sqrt(2.0) * error < 0.5 * mean);
}

RenderParameters small(std::uint64_t seed) {
  RenderParameters parameters = small_picture(20'000, width, height, 4);
  parameters.seed = seed;
  return parameters;
}

}  // namespace

TEST_CASE("a room by photon maps looks as it did when it was last looked at", "[slow]") {
  const Scene scene = room();
  compare("estimated", tiles_of([&](std::uint64_t seed) {
            return render(scene, room_camera(), device(), small(seed)).layers;
          }));
}

TEST_CASE("a room by rays from nodes looks as it did when it was last looked at", "[slow]") {
  const Scene scene = room();
  compare("gathered", tiles_of([&](std::uint64_t seed) {
            RenderParameters parameters = small(seed);
            parameters.light_maps = LightMapMode::on;
            parameters.light_map_rays = 16;
            return render(scene, room_camera(), device(), parameters).layers;
          }));
}

TEST_CASE("a room by paths looks as it did when it was last looked at", "[slow]") {
  const Scene scene = room();
  compare("traced", tiles_of([&](std::uint64_t seed) {
            RenderParameters parameters = small(seed);
            parameters.film.samples_per_pixel = 64;
            return trace_paths(scene, room_camera(), eye_rays(parameters)).layers;
          }));
}

}  // namespace photile::test
