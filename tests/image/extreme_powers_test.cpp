// Powers of 1e-12 to 1e12 through mixing, the EXR file and relighting (docs/extremes.md).
#include <cmath>

#include "picture_support.hpp"

namespace photile::test {
namespace {

const std::vector<std::string> light_names{"star", "lamp", "glow", "speck"};
const std::vector<double> powers{1e12, 1e3, 1e-3, 1e-12};

LightMix extreme_mix() {
  LightMix mix;
  for (std::size_t i = 0; i < light_names.size(); ++i)
    mix.lights.push_back(mixed(light_names[i], powers[i]));
  return mix;
}

/// A product is rounded twice (the power, the product), a sum of n lights n - 1 times more.
constexpr double layer_bound = 2.0 / (1 << 24);
constexpr double root_bound = layer_bound + 3.0 / (1 << 24);

/// Largest relative error of a layer, and of the root, against double precision.
struct Errors {
  double layer = 0, root = 0;
};

Errors errors_of(const Image& picture, const LightLayers& layers,
                 const std::vector<double>& expected_powers) {
  Errors errors;
  const std::vector<std::string> channels{"R", "G", "B"};
  for (std::size_t pixel = 0; pixel < layers.layers[0].radiance.size(); ++pixel) {
    for (int c = 0; c < 3; ++c) {
      const std::string& channel = channels[static_cast<std::size_t>(c)];
      double sum = 0;
      for (std::size_t i = 0; i < light_names.size(); ++i) {
        const double truth = expected_powers[i] * double{layers.layers[i].radiance[pixel][c]};
        const double found = (*picture.find("Combined_" + light_names[i] + "." + channel))[pixel];
        if (truth > 0) errors.layer = std::max(errors.layer, std::abs(found / truth - 1));
        sum += truth;
      }
      errors.root = std::max(errors.root, std::abs((*picture.find(channel))[pixel] / sum - 1));
    }
  }
  return errors;
}

}  // namespace

TEST_CASE("extremes: powers of 1e-12 to 1e12 keep their digits in the file and in its sum") {
  const TemporaryFolder folder;
  const LightLayers layers = random_layers(9, 7, light_names);
  write_exr(folder / "a.exr", mix_layers(layers, extreme_mix()));
  const Errors errors = errors_of(read_image(folder / "a.exr"), layers, powers);
  CHECK(errors.layer <= layer_bound);
  CHECK(errors.root <= root_bound);
}

TEST_CASE("extremes: with the brightest light off, relighting leaves the others' digits") {
  const LightLayers layers = random_layers(9, 7, light_names);
  const Image relit = relight(mix_layers(layers, extreme_mix()), {LightChange::parse("star=off")});
  const Errors errors = errors_of(relit, layers, {0, 1e3, 1e-3, 1e-12});
  CHECK(errors.layer <= layer_bound);
  CHECK(errors.root <= root_bound);
}

TEST_CASE("extremes: from 1e-12 to 1e12 and back, relighting errs by a few roundings") {
  const LightLayers layers = random_layers(9, 7, light_names);
  const Image turned =
      relight(mix_layers(layers, extreme_mix()),
              {LightChange::parse("speck=1e12"), LightChange::parse("star=1e-12")});
  const Errors errors = errors_of(turned, layers, {1e-12, 1e3, 1e-3, 1e12});
  CHECK(errors.layer <= 2 * layer_bound);
  CHECK(errors.root <= 2 * root_bound);
}

TEST_CASE("extremes: the exposure of a picture does not depend on the unit of its radiance") {
  const LightLayers layers = random_layers(9, 7, {"lamp"});
  LightMix mix;
  mix.lights = {mixed("lamp", 1)};
  const Image expected = tone_map(mix_layers(layers, mix), {});
  for (const double power : {1e-30, 1e-12, 1e12, 1e30}) {
    mix.lights[0].power = power;
    const Image shown = tone_map(mix_layers(layers, mix), {});
    double worst = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t i = 0; i < shown.channels[c].size(); ++i) {
        worst =
            std::max(worst, std::abs(double{shown.channels[c][i]} / expected.channels[c][i] - 1));
      }
    }
    CAPTURE(power);
    CHECK(worst <= 1e-6);
  }
}

}  // namespace photile::test
