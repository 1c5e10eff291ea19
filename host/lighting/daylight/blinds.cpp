#include "daylight/blinds.hpp"

#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <numeric>

#include "common/ascii_text.hpp"
#include "photile/errors.hpp"
#include "trace/scatter.hpp"

namespace photile::daylight {
namespace {

// IES LM-83-12.
constexpr float glaring_lux = 1'000;
constexpr double most_points = 0.02;

void close(const BlindGroup& group, Material& material) {
  if (material.interaction != Interaction::glass || !material.thin) {
    throw UsageError(fmt::format(
        "--blinds {}: '{}' is no thin pane of glass; give the scene with closed blinds as a file",
        group.glob, material.name));
  }
  Material clear = material;
  clear.transmission = glm::vec3(1.0f);
  const auto most = static_cast<double>(trace::pane_transmittance(clear, 1.0f).y);
  const double now = luminance(glm::dvec3(trace::pane_transmittance(material, 1.0f)));
  if (group.transmittance > now + 1e-6) {
    throw UsageError(
        fmt::format("--blinds {}={:g}: '{}' lets {:.3g} through without them; give less",
                    group.glob, group.transmittance, material.name, now));
  }
  material.transmission = glm::vec3(static_cast<float>(group.transmittance / most));
}

}  // namespace

BlindGroup BlindGroup::parse(const std::string& text) {
  const std::size_t equals = text.rfind('=');
  const auto value = equals == std::string::npos || equals == 0
                         ? std::nullopt
                         : parse_signed(text.substr(equals + 1));
  if (!value || !(*value >= 0) || *value > 1) {
    throw UsageError(fmt::format(
        "--blinds {}: use MATERIAL=TRANSMITTANCE, such as 'Glass*=0.05', or a scene's file", text));
  }
  return {text.substr(0, equals), *value};
}

std::vector<Material> materials_with(const Scene& scene, std::span<const BlindGroup> groups,
                                     BlindState state) {
  std::vector<Material> materials = scene.materials;
  for (std::size_t group = 0; group < groups.size(); ++group) {
    bool found = false;
    for (Material& material : materials) {
      if (::fnmatch(groups[group].glob.c_str(), material.name.c_str(), 0) != 0) continue;
      found = true;
      if ((state >> group & 1) != 0) close(groups[group], material);
    }
    if (!found) {
      throw UsageError(fmt::format(
          "--blinds {}: there is no such material; photile info lists them", groups[group].glob));
    }
  }
  return materials;
}

std::vector<std::size_t> blind_schedule(std::span<const std::vector<float>> sun,
                                        std::span<const int> closed, std::size_t sensors,
                                        std::size_t hours) {
  std::vector<std::size_t> order(sun.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return closed[a] < closed[b]; });
  std::vector<std::size_t> chosen(hours, order.back());
  for (std::size_t hour = 0; hour < hours; ++hour) {
    for (const std::size_t state : order) {
      std::size_t bright = 0;
      for (std::size_t sensor = 0; sensor < sensors; ++sensor)
        bright += sun[state][sensor * hours + hour] >= glaring_lux ? 1 : 0;
      if (static_cast<double>(bright) > most_points * static_cast<double>(sensors)) continue;
      chosen[hour] = state;
      break;
    }
  }
  return chosen;
}

}  // namespace photile::daylight
