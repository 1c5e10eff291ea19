// Relighting at 1080p with 16 lights against the machine's copy bandwidth, measured in the same run
// with the same threads.
#include <tbb/parallel_for.h>

#include <cstring>
#include <random>

#include "photile/layered_picture.hpp"
#include "photile/light_layers.hpp"
#include "support/bench_record.hpp"

namespace {

using namespace photile;
using namespace photile::bench;

struct Size {
  int width = 1920, height = 1080;
  std::size_t lights = 16;
  std::size_t copy_bytes = 256u << 20;  ///< an array that no cache holds
};

LightLayers random_layers(const Size& size) {
  std::vector<std::string> lights;
  for (std::size_t i = 0; i < size.lights; ++i) lights.push_back("light" + std::to_string(i));
  LightLayers layers = LightLayers(size.width, size.height, lights).dense();
  std::mt19937 generator(1);
  std::uniform_real_distribution<float> uniform(0, 1);
  for (LightLayers::Layer& layer : layers.layers) {
    for (glm::vec3& radiance : layer.radiance) {
      radiance = {uniform(generator), uniform(generator), uniform(generator)};
    }
    for (float& illuminance : layer.illuminance) illuminance = uniform(generator);
  }
  return layers;
}

LightMix mix_of(const LightLayers& layers) {
  LightMix mix;
  for (const LightLayers::Layer& layer : layers.layers) {
    MixedLight light;
    light.name = layer.light;
    light.power = 100.0 + static_cast<double>(mix.lights.size());
    mix.lights.push_back(light);
  }
  return mix;
}

/// Each thread copies ranges of its own, as STREAM's copy does.
void copy(std::vector<char>& to, const std::vector<char>& from) {
  constexpr std::size_t chunk = 8u << 20;  // memcpy streams past the caches from about this size on
  tbb::parallel_for(std::size_t{0}, from.size() / chunk + 1, [&](std::size_t i) {
    const std::size_t first = std::min(i * chunk, from.size());
    std::memcpy(to.data() + first, from.data() + first, std::min(chunk, from.size() - first));
  });
}

void add_row(BenchRecord& record, const char* operation, double bytes, const Timing& timing) {
  record.add({{"operation", operation},
              {"bytes", bytes},
              {"bytes per second", bytes / timing.median()},
              {"seconds", to_json(timing)}});
}

bool run(BenchOptions& options) {
  Size size;
  if (options.quick) {
    size = {64, 48, 4, 1u << 20};
  }
  BenchRecord record("relight", options);
  record.set("width", size.width);
  record.set("height", size.height);
  record.set("lights", size.lights);
  const LightLayers layers = random_layers(size);
  const LightMix mix = mix_of(layers);
  const double pixels = static_cast<double>(size.width) * size.height;
  const double lights = static_cast<double>(size.lights);

  const std::vector<char> from(size.copy_bytes, 1);
  std::vector<char> to(size.copy_bytes);
  add_row(record, "copy", 2.0 * static_cast<double>(size.copy_bytes),
          measure(options.repeats, [&] { copy(to, from); }));

  std::vector<glm::vec3> picture(static_cast<std::size_t>(pixels));
  add_row(record, "combine_layers", pixels * (lights + 1) * sizeof(glm::vec3),
          measure(options.repeats, [&] { combine_layers(layers, mix, picture); }));
  // Layers in; the picture with alpha, and again each layer with its illuminance, out.
  add_row(record, "mix_layers", pixels * (2 * lights + 1) * sizeof(glm::vec4),
          measure(options.repeats, [&] { mix_layers(layers, mix); }));
  record.write();
  return true;
}

}  // namespace

int main(int argument_count, char** arguments) {
  BenchOptions options;
  CLI::App command("Relighting against copy bandwidth", "relight");
  add_options(command, options);
  return run_bench(command, argument_count, arguments, [&] { return run(options); });
}
