#include "serve/live_pictures.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <glm/gtc/packing.hpp>
#include <iterator>

#include "common/foreign_text.hpp"
#include "image/glare.hpp"
#include "report/printing.hpp"

namespace photile::serve {
namespace {

using nlohmann::json;

/// The largest exponent of what is sent as half floats.
constexpr int half_exponent = 14;
/// Colours of marks, after which they begin again.
constexpr int mark_colours = 7;
/// Triangles of a kind, and photons of a kind, that are sent.
constexpr std::size_t most_sent = 200'000;

std::string start_of(const json& header) {
  std::string text = json_text(header, -1);
  if (text.size() % 2 != 0) text += ' ';
  return fmt::format("{:08x}", text.size()) + text;
}

}  // namespace

std::string picture_bytes(const view::Frame& frame) {
  const LightLayers dense = frame.layers.sparse() ? frame.layers.dense() : LightLayers();
  const LightLayers& layers = frame.layers.sparse() ? dense : frame.layers;
  const auto width = static_cast<std::size_t>(layers.width);
  const auto height = static_cast<std::size_t>(layers.height);
  std::vector<int> exponents;
  for (const LightLayers::Layer& layer : layers.layers) {
    float most = 0;
    for (const glm::vec3& pixel : layer.radiance) {
      most = std::max({most, pixel.x, pixel.y, pixel.z});
    }
    exponents.push_back(most > 0 ? half_exponent - std::ilogb(most) : 0);
  }
  json header{{"width", width},
              {"height", height},
              {"samples", frame.samples_per_pixel},
              {"exponents", exponents}};
  for (const LightLayers::Layer& layer : layers.layers) header["layers"].push_back(layer.light);
  const std::string start = start_of(header);
  std::string bytes(start.size() + layers.layers.size() * height * width * 6, '\0');
  std::copy(start.begin(), start.end(), bytes.begin());
  tbb::parallel_for(std::size_t{0}, layers.layers.size() * height, [&](std::size_t row) {
    const std::size_t layer = row / height, y = height - 1 - row % height;
    const float scale = std::ldexp(1.0f, exponents[layer]);
    char* to = bytes.data() + start.size() + row * width * 6;
    for (std::size_t x = 0; x < width; ++x) {
      const glm::vec3& pixel = layers.layers[layer].radiance[y * width + x];
      for (int c = 0; c < 3; ++c, to += 2) {
        const auto half = std::bit_cast<std::array<char, 2>>(glm::packHalf1x16(scale * pixel[c]));
        std::copy(half.begin(), half.end(), to);
      }
    }
  });
  return bytes;
}

std::string glare_bytes(const view::Frame& frame, const LightMix& mix, double limit) {
  const image::Glare glare = image::find_glare(frame.layers, *frame.reflections, mix, limit);
  json header{
      {"width", frame.layers.width}, {"height", frame.layers.height}, {"limit", glare.limit}};
  for (int i = 0; i < mark_colours; ++i) header["colours"].push_back(image::mark_colour(i));
  header["lights"] = json::array();
  for (std::size_t i = 0; i < glare.lights.size(); ++i) {
    const image::LightGlare& light = glare.lights[i];
    header["lights"].push_back({{"name", light.light},
                                {"part", light.fraction},
                                {"peak", light.peak},
                                {"colour", i % mark_colours}});
  }
  std::string bytes = start_of(header);
  const auto width = static_cast<std::size_t>(frame.layers.width);
  for (std::size_t row = glare.marks.size() / width; row-- > 0;) {
    for (std::size_t x = 0; x < width; ++x) {
      const int mark = glare.marks[row * width + x];
      bytes += static_cast<char>(mark < 0 ? 0 : 1 + mark % mark_colours);
    }
  }
  return bytes;
}

std::string photon_bytes(const RayScene& rays, const view::InspectablePhotons& photons,
                         const glm::dvec3& eye, const glm::dvec3& direction) {
  const Scene& scene = rays.scene();
  const std::uint32_t face = view::face_along(rays, eye, direction);
  if (face == none) return "";
  const view::PhotonMapView map = view::view_of_map(scene, photons, face);
  json counts = json::array(), found = json::array();
  std::string bytes;
  const auto add = [&](const glm::vec3& place) {
    const auto floats = std::bit_cast<std::array<char, sizeof(glm::vec3)>>(place);
    bytes.append(floats.begin(), floats.end());
  };
  const auto count = [&](std::size_t size) {
    found.push_back(size);
    counts.push_back(std::min(size, most_sent));
    return std::min(size, most_sent);
  };
  const auto add_faces = [&](const std::vector<std::uint32_t>& faces) {
    for (const std::uint32_t each : std::span(faces).first(count(faces.size()))) {
      auto corners = scene.corners(triangle_of(each));
      if (side_of(each) != 0) std::swap(corners[1], corners[2]);  // seen from that side
      for (const glm::vec3& corner : corners) add(corner);
    }
  };
  const auto add_photons = [&](const std::vector<glm::vec3>& places) {
    for (const glm::vec3& place : std::span(places).first(count(places.size()))) add(place);
  };
  add_faces({face});
  add_faces(map.group);
  add_faces(map.patch);
  add_photons(map.own_photons);
  add_photons(map.group_photons);
  return start_of({{"triangle", triangle_of(face)},
                   {"side", side_of(face)},
                   {"counts", counts},
                   {"found", found}}) +
         bytes;
}

LightMix mix_of_layers(const LightLayers& layers, const LightMix& mix,
                       std::span<const ShownLight> lights) {
  LightMix shown;
  shown.lumen_per_watt = mix.lumen_per_watt;
  std::vector<std::size_t> number_of;  // of each layer in the mix; none: that of the sky
  for (const LightLayers::Layer& layer : layers.layers) {
    const auto found =
        std::find_if(mix.lights.begin(), mix.lights.end(),
                     [&](const MixedLight& light) { return light.name == layer.light; });
    number_of.push_back(static_cast<std::size_t>(found - mix.lights.begin()));
  }
  for (std::size_t layer = 0; layer < number_of.size(); ++layer) {
    MixedLight& light = shown.lights.emplace_back();
    if (const std::size_t i = number_of[layer]; i < mix.lights.size()) {
      light = mix.lights[i];
      light.power = lights[i].power;
      light.tint = lights[i].tint;
      continue;
    }
    light.name = layers.layers[layer].light;
    for (std::size_t i = 0; i < mix.lights.size(); ++i) {
      if (std::find(number_of.begin(), number_of.end(), i) != number_of.end()) continue;
      light.unit = mix.lights[i].unit;
      if (lights[i].power > 0) light.power = 1;
    }
  }
  return shown;
}

image::White white_of_scene(const LightLayers& layers, const Scene& scene, double lumen_per_watt) {
  const LightMix loaded = LightMix::of(scene, lumen_per_watt);
  std::vector<ShownLight> lights;
  for (const MixedLight& light : loaded.lights) lights.push_back({light.power, light.tint});
  return image::white_of(layers, mix_of_layers(layers, loaded, lights));
}

std::string exr_of(const view::Frame& frame, const LightMix& mix, const image::White& white) {
  const report::ScratchFolder folder;
  const std::filesystem::path file = folder.path() / "view.exr";
  view::write_frame(file, *frame.scene, frame, mix, white);
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

}  // namespace photile::serve
