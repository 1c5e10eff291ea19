#include "gltf/light_traits.hpp"

#include <fmt/format.h>

#include "gltf/document.hpp"
#include "photile/limits.hpp"

namespace photile::gltf {
namespace {

/// The number `key`, or 0 where it is absent; outside [lowest, highest] 0 with a warning.
double number_within(const tinygltf::Value& extras, const char* key, double lowest, double highest,
                     const std::string& name, files::Warnings& warnings) {
  if (!extras.Has(key)) return 0;
  const double value = number_member(extras, key, -1.0);
  if (value >= lowest && value <= highest) return value;
  warnings.add("node", name,
               fmt::format("{} is no number from {} to {}; ignored", key, lowest, highest));
  return 0;
}

}  // namespace

reading::LightTraits light_traits(const tinygltf::Value& extras, const std::string& name,
                                  files::Warnings& warnings) {
  constexpr double least_lumens = 1e-12, most_lumens = 1e18;
  return {string_member(extras, "photile_group"),
          number_within(extras, "photile_lumens", least_lumens, most_lumens, name, warnings),
          number_within(extras, "photile_kelvin", limits::min_color_temperature,
                        limits::max_color_temperature, name, warnings)};
}

}  // namespace photile::gltf
