// The bundled scenes look as they did when golden.csv was made, but for the noise of 16 seeds. The
// truth of pictures is told elsewhere (tests/validation, tests/reference): these tell that a change
// changes what it is meant to.
//
// PHOTILE_RENEW_GOLDEN=1 writes golden.csv anew, and says what has changed.

#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <glm/glm.hpp>
#include <iostream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "file_bytes.hpp"
#include "light/light_at_points.hpp"
#include "photile/load_scene.hpp"
#include "photile/renderer.hpp"
#include "source_folder.hpp"
#include "test_device.hpp"

namespace photile::test {
namespace {

constexpr int golden_seeds = 16;                       ///< that a picture is rendered with
constexpr int width = 32, height = 24, tile_side = 8;  ///< pixels

/// Mean over the seeds, and standard deviation from one to another, of some pixels of a picture.
struct TileMean {
  std::string tile;  ///< "column:row", or "all"
  glm::dvec4 mean{0}, deviation{0};
};

/// One picture by one method.
struct TileMeans {
  std::string picture;
  std::vector<TileMean> tiles;  ///< "all" first
};

/// Pixels of one seed, row by row: radiance as linear R, G, B, and illuminance E of what is seen,
/// which lamps in the picture do not drown.
using Pixels = std::vector<glm::dvec4>;

struct TileComparison {
  /// Largest difference over the one that is allowed, and where: above 1 the pictures differ.
  double most = 0;
  std::string where;
  double change = 0;   ///< of the illuminance in the whole picture, relative
  double visible = 0;  ///< the least such change that would fail
};

/// Student's t for 30 degrees of freedom, two-sided, at 1 - (1 - 1e-6)^(1/1000).
constexpr double t_critical = 8.72;
/// Of the whole picture: float sums in another order, where no seed differs from another.
constexpr double rounding = 1e-5;

TileMean over_seeds(const std::string& tile, const std::vector<glm::dvec4>& values) {
  TileMean result{.tile = tile};
  for (const glm::dvec4& value : values) result.mean += value / double{golden_seeds};
  glm::dvec4 squares(0);
  for (const glm::dvec4& value : values) {
    squares += (value - result.mean) * (value - result.mean);
  }
  result.deviation = glm::sqrt(squares / double{golden_seeds - 1});
  return result;
}

/// How far the means may lie apart, where the whole picture has the mean `all`.
double allowed(double before, double now, double all) {
  const double pooled = std::sqrt((before * before + now * now) / 2);
  return t_critical * pooled * std::sqrt(2.0 / golden_seeds) + rounding * all;
}

/// Means of tiles, and of all pixels.
TileMeans tile_means(const std::string& picture, const std::vector<Pixels>& seeds) {
  const auto mean_of = [&](const Pixels& pixels, int left, int top, int columns, int rows) {
    glm::dvec4 sum(0);
    for (int y = top; y < top + rows; ++y) {
      for (int x = left; x < left + columns; ++x) {
        sum += pixels[static_cast<std::size_t>(y * width + x)];
      }
    }
    return sum / double(columns * rows);
  };
  const auto add = [&](TileMeans& means, const std::string& tile, int left, int top, int columns,
                       int rows) {
    std::vector<glm::dvec4> values;
    for (const Pixels& pixels : seeds) values.push_back(mean_of(pixels, left, top, columns, rows));
    means.tiles.push_back(over_seeds(tile, values));
  };
  TileMeans means{.picture = picture, .tiles = {}};
  add(means, "all", 0, 0, width, height);
  for (int row = 0; row < height / tile_side; ++row) {
    for (int column = 0; column < width / tile_side; ++column) {
      add(means, fmt::format("{}:{}", column, row), column * tile_side, row * tile_side, tile_side,
          tile_side);
    }
  }
  return means;
}

/// Student's test of two means with one variance, for each tile and channel: error probability 1e-6
/// over a thousand of them (Sidak). Throws std::logic_error where the tiles are not the same.
TileComparison compare(const TileMeans& before, const TileMeans& now) {
  if (before.tiles.size() != now.tiles.size() || before.picture != now.picture) {
    throw std::logic_error(now.picture + " has other tiles than the golden one");
  }
  TileComparison result;
  const glm::dvec4 all = before.tiles.front().mean;
  for (std::size_t i = 0; i < now.tiles.size(); ++i) {
    const TileMean &a = before.tiles[i], &b = now.tiles[i];
    for (int channel = 0; channel < 4; ++channel) {
      const double most = std::abs(b.mean[channel] - a.mean[channel]) /
                          allowed(a.deviation[channel], b.deviation[channel], all[channel]);
      if (most <= result.most) continue;
      result.most = most;
      result.where = fmt::format("tile {}, {}: {:.5g} in place of {:.5g}", b.tile, "RGBE"[channel],
                                 b.mean[channel], a.mean[channel]);
    }
  }
  const TileMean& whole = before.tiles.front();
  result.change = now.tiles.front().mean[3] / all[3] - 1;
  result.visible = allowed(whole.deviation[3], whole.deviation[3], all[3]) / all[3];
  return result;
}

/// The means as CSV: picture, tile, and mean and deviation of R, G, B and E.
std::string to_csv(const std::vector<TileMeans>& pictures) {
  std::string text = "picture,tile,R,G,B,E,deviation R,deviation G,deviation B,deviation E\n";
  for (const TileMeans& picture : pictures) {
    for (const TileMean& tile : picture.tiles) {
      text += picture.picture + "," + tile.tile;
      for (int i = 0; i < 4; ++i) text += fmt::format(",{:.7g}", tile.mean[i]);
      for (int i = 0; i < 4; ++i) text += fmt::format(",{:.3g}", tile.deviation[i]);
      text += "\n";
    }
  }
  return text;
}

std::vector<TileMeans> from_csv(const std::string& text) {
  std::vector<TileMeans> pictures;
  std::istringstream lines(text);
  std::string line;
  std::getline(lines, line);  // the header
  while (std::getline(lines, line)) {
    std::istringstream fields(line);
    std::string picture, tile, number;
    std::getline(fields, picture, ',');
    std::getline(fields, tile, ',');
    std::vector<double> numbers;
    while (std::getline(fields, number, ',')) numbers.push_back(std::stod(number));
    if (numbers.size() != 8) throw std::logic_error("no line of tiles: " + line);
    if (pictures.empty() || pictures.back().picture != picture) {
      pictures.push_back({.picture = picture, .tiles = {}});
    }
    pictures.back().tiles.push_back(
        {.tile = tile,
         .mean = {numbers[0], numbers[1], numbers[2], numbers[3]},
         .deviation = {numbers[4], numbers[5], numbers[6], numbers[7]}});
  }
  return pictures;
}

enum class Method {
  photons,  ///< photon estimates at nodes
  nodes,    ///< light maps whose nodes gather, as the quality good
  paths
};

struct Golden {
  std::string scene;  ///< below scenes/
  Method method;
  std::string name() const {
    const std::string file = std::filesystem::path(scene).stem().string();
    return file + (method == Method::photons ? " by photons"
                   : method == Method::nodes ? " by nodes"
                                             : " by paths");
  }
};

/// Every method where it has most to do.
const std::vector<Golden> few_pictures = {{"gallery/glossy-floor.gltf", Method::photons},
                                          {"cornell-box/cornell-box.gltf", Method::nodes},
                                          {"gallery/sun-and-sky.gltf", Method::paths}};
/// Every bundled scene.
const std::vector<Golden> other_pictures = {
    {"cornell-box/cornell-box.gltf", Method::photons},
    {"cornell-box/cornell-box-specular.gltf", Method::photons},
    {"gallery/coloured-lamps.gltf", Method::photons},
    {"gallery/downlights.gltf", Method::photons},
    {"gallery/glass-sphere.gltf", Method::photons},
    {"living-room/living-room.gltf", Method::photons},
    {"gallery/metal-ring.gltf", Method::photons},
    {"gallery/sun-and-sky.gltf", Method::photons},
    {"cornell-box/cornell-box.gltf", Method::paths},
    {"gallery/sun-and-sky.gltf", Method::nodes},
    {"gallery/glossy-floor.gltf", Method::nodes},
    {"gallery/glossy-floor.gltf", Method::paths}};

RenderParameters parameters_of(Method method, std::uint64_t seed) {
  RenderParameters parameters;
  if (method == Method::nodes) set_quality(parameters, Quality::good);
  if (method == Method::photons) parameters.neighbours = 500;
  parameters.seed = seed;
  const int samples = method == Method::nodes ? 2 : method == Method::photons ? 8 : 32;
  parameters.film = {width, height, samples};
  parameters.photons.emitted_photons = 30'000;
  return parameters;
}

/// The sum of all lights.
Pixels picture_of(const Scene& scene, Method method, std::uint64_t seed) {
  const RenderParameters parameters = parameters_of(method, seed);
  const Camera& camera = scene.cameras.front();
  const LightLayers layers =
      (method == Method::paths ? trace_paths(scene, camera, eye_rays(parameters)).layers
                               : render(scene, camera, device(), parameters).layers)
          .dense();
  const std::vector<double> powers = light::layer_powers(scene);
  Pixels pixels(static_cast<std::size_t>(width * height), glm::dvec4(0));
  for (std::size_t layer = 0; layer < powers.size(); ++layer) {
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      const LightLayers::Layer& light = layers.layers[layer];
      pixels[i] += powers[layer] * glm::dvec4(light.radiance[i], light.illuminance[i]);
    }
  }
  return pixels;
}

TileMeans rendered(const Golden& golden) {
  SceneLoadOptions options;
  if (golden.scene == "gallery/sun-and-sky.gltf") {
    options.sun = Sun::parse("60,40,40000");
    options.sky = Sky::parse("clear=12000");
    options.ground = 0;
  }
  const Scene scene = load_scene(source_folder() / "scenes" / golden.scene, options);
  std::vector<Pixels> seeds;
  for (std::uint64_t seed = 1; seed <= golden_seeds; ++seed)
    seeds.push_back(picture_of(scene, golden.method, seed));
  return tile_means(golden.name(), seeds);
}

const TileMeans* find(const std::vector<TileMeans>& pictures, const std::string& name) {
  for (const TileMeans& picture : pictures) {
    if (picture.picture == name) return &picture;
  }
  return nullptr;
}

/// A picture as if its lamps were that much brighter.
TileMeans brighter(TileMeans means, double factor) {
  for (TileMean& tile : means.tiles) {
    tile.mean *= factor;
    tile.deviation *= factor;
  }
  return means;
}

/// Whether these pictures look as they did, but for the noise of 16 seeds.
void check_pictures(const std::vector<Golden>& pictures) {
  const auto file = source_folder() / "tests/golden/golden.csv";
  const std::vector<TileMeans> before = from_csv(bytes_of(file));
  const bool renew = std::getenv("PHOTILE_RENEW_GOLDEN") != nullptr;
  std::vector<TileMeans> all;
  for (const Golden& golden : pictures) {
    all.push_back(rendered(golden));
    const TileMeans& now = all.back();
    const TileMeans* const known = find(before, now.picture);
    if (known == nullptr) {
      if (!renew)
        FAIL("golden.csv lacks " << now.picture << "; renew it with PHOTILE_RENEW_GOLDEN=1");
      std::cout << now.picture << ": new\n";
      continue;
    }
    const TileComparison found = compare(*known, now);
    const std::string line =
        fmt::format("{}: {:+.2f}% (seen from {:.1f}% on); most: {}, {:.2f} of what is allowed",
                    now.picture, 100 * found.change, 100 * found.visible,
                    found.where.empty() ? "nothing" : found.where, found.most);
    if (renew) {
      std::cout << line << "\n";
      continue;
    }
    INFO(line);
    CHECK(found.most <= 1);
    // Otherwise the test would prove little: lamps so much brighter have to be seen.
    CHECK(found.visible < 0.15);
    CHECK(compare(*known, brighter(now, 1.01 + found.visible + std::abs(found.change))).most > 1);
  }
  CHECK(before.size() == few_pictures.size() + other_pictures.size());
  if (!renew) return;
  for (const TileMeans& picture : before) {
    if (!find(all, picture.picture)) all.push_back(picture);
  }
  std::ofstream(file) << to_csv(all);
}

}  // namespace

TEST_CASE("the bundled scenes look as they did, by every method") { check_pictures(few_pictures); }
TEST_CASE("all other bundled scenes look as they did", "[slow]") { check_pictures(other_pictures); }

}  // namespace photile::test
