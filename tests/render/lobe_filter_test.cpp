// The filter of gloss: noise goes, light and edges stay.
#include "render/lobe_filter.hpp"

#include <array>
#include <glm/glm.hpp>
#include <random>
#include <string>

#include "pictures.hpp"

namespace photile::test {
namespace {

constexpr int side = 96;

/// Pixels of one varnished floor; the left half reflects 1, the right half 1 + `step`, with noise.
struct Floor {
  LobeFilm film;
  LightLayers black;
  double mean = 0;  ///< of what rays found, of the first layer

  Floor(double step, double noise, std::size_t lights, unsigned seed = 1)
      : film{{2 * side, side, names(lights)}, {LobeFilm::runs * side, side, names(1)}, {}},
        black(side, side, names(lights)) {
    std::mt19937 random(seed);
    // Few rays meet a lamp: most pixels have too little, some far too much.
    std::bernoulli_distribution meets(0.1);
    for (LightLayers::Row& row : film.halves.rows) row.first = {0};
    for (LightLayers::Row& row : black.rows) row.first.assign(side + 1, 0);
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) {
        film.lobes.push_back({.weight = 1,
                              .position = {0.01 * x, 0.01 * y, 0},
                              .normal = {0, 0, 1},
                              .reflectance = glm::vec3(0.04f),
                              .roughness = 0.2f});
        for (int half = 0; half < 2; ++half) {
          float found = 0;
          for (int run = 0; run < 2; ++run) {
            const double own = 1 - noise + noise * (meets(random) ? 10 : 0);
            const auto of_run = static_cast<float>((x < side / 2 ? 1 : 1 + step) * own / 4);
            found += of_run;
            const int column = LobeFilm::runs * x + 2 * half + run;
            film.mixed.layers[0]
                .radiance[static_cast<std::size_t>(LobeFilm::runs * side * y + column)] =
                glm::vec3(4 * of_run);
          }
          set(2 * (side * y + x) + half, found);
          mean += double{found} / (side * side);
        }
      }
    }
  }
  static std::vector<std::string> names(std::size_t lights) {
    return std::vector<std::string>(lights, "light");
  }
  /// The second light gives three times as much as the first.
  void set(int half, float value) {
    for (std::uint16_t light = 0; light < 2; ++light) {
      const glm::vec3 found((light == 0 ? 1.0f : 3.0f) * value);
      if (!film.halves.sparse()) {
        film.halves.layers[light].radiance[static_cast<std::size_t>(half)] = found;
        continue;
      }
      LightLayers::Row& row = film.halves.rows[static_cast<std::size_t>(half / (2 * side))];
      row.light.push_back(light);
      row.radiance.push_back(found);
      row.illuminance.push_back(0);
      if (light == 1) row.first.push_back(static_cast<std::uint32_t>(row.light.size()));
    }
  }
  LightLayers filtered() const {
    LightLayers picture = black;
    constexpr std::array samples = {4, 4, 4, 4};
    add_filtered(picture, film, std::vector<double>(picture.layers.size(), 1.0), samples);
    return picture.dense();
  }
};

struct Moments {
  double mean = 0, deviation = 0;
};

/// Of columns [first, last) of the first layer.
Moments moments(const LightLayers& layers, int first, int last) {
  double sum = 0, squares = 0;
  for (int y = 0; y < side; ++y) {
    for (int x = first; x < last; ++x) {
      const double value = layers.layers[0].radiance[static_cast<std::size_t>(y * side + x)].x;
      sum += value;
      squares += value * value;
    }
  }
  const double count = side * (last - first), mean = sum / count;
  return {mean, std::sqrt(std::max(0.0, squares / count - mean * mean))};
}

TEST_CASE("lobe filter: sparks are spread, and no light is lost") {
  std::vector<double> differences;
  for (unsigned seed = 1; seed <= 16; ++seed) {
    const Floor floor(0, 1, 2, seed);
    const Moments all = moments(floor.filtered(), 0, side);
    differences.push_back(all.mean / floor.mean - 1);
    // Of a pixel: sqrt(9 / 4) = 1.5. 5 x 5 pixels average it to a fifth at best.
    CHECK(all.deviation < 1.5 / 3);
  }
  CHECK_VERDICT(mean_is(differences, 0.0, 0.03));
}

TEST_CASE("lobe filter: where there is no noise, an edge keeps its light") {
  const LightLayers picture = Floor(0.1, 0, 2).filtered();
  CHECK(moments(picture, 0, side / 2).mean == Approx(1).epsilon(1e-4));
  CHECK(moments(picture, side / 2, side).mean == Approx(1.1).epsilon(1e-4));
  CHECK(moments(picture, side / 2 - 1, side / 2).mean == Approx(1).epsilon(1e-4));
}

TEST_CASE("lobe filter: an edge far above the noise stays, and other surfaces do not mix") {
  const Floor floor(20, 0.1, 2);
  CHECK(moments(floor.filtered(), side / 2 - 1, side / 2).mean == Approx(1).epsilon(0.2));
  // Only the right half is metal, and it reflects nothing.
  Floor two(-1, 1, 2);
  for (std::size_t i = 0; i < two.film.lobes.size(); ++i) {
    if (i % side >= side / 2) two.film.lobes[i].reflectance = glm::vec3(0.9f);
  }
  CHECK(moments(two.filtered(), side / 2, side).mean == 0);
}

TEST_CASE("lobe filter: all layers have the same weights, in either form") {
  const LightLayers dense = Floor(0.3, 0.5, 2).filtered();
  const LightLayers sparse = Floor(0.3, 0.5, max_dense_lights + 1).filtered();
  for (std::size_t pixel = 0; pixel < side * side; ++pixel) {
    const float first = dense.layers[0].radiance[pixel].x;
    CHECK(dense.layers[1].radiance[pixel].x == Approx(3 * first).epsilon(1e-5));
    CHECK(sparse.layers[0].radiance[pixel].x == Approx(first).epsilon(1e-5));
  }
}

TEST_CASE("lobe filter: a varnished floor has less noise, and as much light") {
  Scene scene = furnished_room(3);
  scene.materials[0] = glossy(0.2f, 0.2f, 0.15f);
  const Camera camera = above(2.6, 2.2, 2.0, 1.0);
  RenderParameters parameters = small_picture(20'000, 32, 24, 16);
  parameters.light_maps = LightMapMode::on;
  const auto picture = [&](GlossMode gloss, int samples) {
    parameters.gloss = gloss;
    parameters.film.samples_per_pixel = samples;
    return render(scene, camera, device(), parameters).layers;
  };
  const LightLayers truth = picture(GlossMode::rays, 256), rays = picture(GlossMode::rays, 16),
                    filtered = picture(GlossMode::automatic, 16);
  const auto compared = [&](const LightLayers& layers) {
    double squares = 0, sum = 0, all = 0;
    for (std::size_t pixel = 0; pixel < truth.layers[0].radiance.size(); ++pixel) {
      const double right = luminance(truth.layers[0].radiance[pixel]);
      const double off = luminance(layers.layers[0].radiance[pixel]) - right;
      squares += off * off;
      sum += off;
      all += right;
    }
    return std::pair(squares, sum / all);
  };
  CHECK(compared(filtered).first < 0.6 * compared(rays).first);
  CHECK(compared(filtered).second - compared(rays).second == Approx(0).margin(0.002));
}

}  // namespace
}  // namespace photile::test
