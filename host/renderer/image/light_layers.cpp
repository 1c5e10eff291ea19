#include "photile/light_layers.hpp"

#include "photile/scene.hpp"

namespace photile {
namespace {

template <class T>
std::uint64_t bytes_of(const std::vector<T>& values) {
  return values.size() * sizeof(T);
}

std::size_t pixels_of(const LightLayers& layers) {
  return static_cast<std::size_t>(layers.width) * static_cast<std::size_t>(layers.height);
}

void add_plane(LightLayers::Layer& layer, std::size_t pixels) {
  layer.radiance.assign(pixels, glm::vec3(0.0f));
  layer.illuminance.assign(pixels, 0.0f);
}

std::vector<std::string> layer_names(const Scene& scene) {
  std::vector<std::string> names;
  for (const LightGroup& group : light_groups_of(scene).groups) names.push_back(group.name);
  return names;
}

}  // namespace

LightLayers::LightLayers(int width, int height, const Scene& scene)
    : LightLayers(width, height, layer_names(scene)) {}

LightLayers::LightLayers(int width, int height, const std::vector<std::string>& names)
    : width(width), height(height) {
  for (const std::string& name : names) layers.push_back({name, {}, {}});
  if (names.size() > max_dense_lights) {
    rows.resize(static_cast<std::size_t>(height));
    for (Row& row : rows) row.first.assign(static_cast<std::size_t>(width) + 1, 0);
  } else {
    for (Layer& layer : layers) add_plane(layer, pixels_of(*this));
  }
}

std::uint64_t LightLayers::bytes() const {
  std::uint64_t sum = 0;
  for (const Layer& layer : layers) sum += bytes_of(layer.radiance) + bytes_of(layer.illuminance);
  for (const Row& row : rows) {
    sum += bytes_of(row.first) + bytes_of(row.light) + bytes_of(row.radiance) +
           bytes_of(row.illuminance);
  }
  return sum;
}

LightLayers LightLayers::dense() const {
  LightLayers result = *this;
  if (!sparse()) return result;
  result.rows.clear();
  for (Layer& layer : result.layers) add_plane(layer, pixels_of(*this));
  for (std::size_t y = 0; y < rows.size(); ++y) {
    const Row& row = rows[y];
    for (std::size_t x = 0; x + 1 < row.first.size(); ++x) {
      const std::size_t pixel = y * static_cast<std::size_t>(width) + x;
      for (std::uint32_t i = row.first[x]; i < row.first[x + 1]; ++i) {
        result.layers[row.light[i]].radiance[pixel] = row.radiance[i];
        result.layers[row.light[i]].illuminance[pixel] = row.illuminance[i];
      }
    }
  }
  return result;
}

}  // namespace photile
