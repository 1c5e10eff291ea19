// Light maps over several photon passes: nodes come to hold the mean of all.
#include <algorithm>
#include <utility>
#include <vector>

#include "light_maps/light_maps_impl.hpp"

namespace photile {
namespace {

/// A batch of nodes that a pass values.
struct Valued {
  std::vector<std::uint32_t> nodes;
  Estimates light;
};

/// The mean of the passes before and one more.
template <class Light>
Light with(const Light& mean, const Light& light, std::uint32_t passes) {
  return mean + (light - mean) / static_cast<float>(passes + 1);
}

/// Of nodes that hold every light.
void add_dense(std::uint32_t passes, const Valued& valued, std::size_t lights, Estimates& means) {
  for (std::size_t i = 0; i < valued.nodes.size(); ++i) {
    for (std::size_t light = 0; light < lights; ++light) {
      glm::vec3& mean = means.irradiance[valued.nodes[i] * lights + light];
      mean = with(mean, valued.light.irradiance[i * lights + light], passes);
      if (means.by_normal.empty()) continue;
      glm::vec4& by_normal = means.by_normal[valued.nodes[i] * lights + light];
      by_normal = with(by_normal, valued.light.by_normal[i * lights + light], passes);
    }
  }
}

/// Of nodes that hold those lights alone that reach them: all rows are written anew.
void add_rows(std::uint32_t passes, std::span<const Valued> all, std::size_t lights,
              Estimates& means) {
  struct Row {
    const Valued* valued = nullptr;
    std::size_t place = 0;
  };
  std::vector<Row> row_of(means.first.size() - 1);
  for (const Valued& valued : all) {
    for (std::size_t i = 0; i < valued.nodes.size(); ++i) row_of[valued.nodes[i]] = {&valued, i};
  }
  const bool smooth =
      !means.by_normal.empty() || std::any_of(all.begin(), all.end(), [](const Valued& valued) {
        return !valued.light.by_normal.empty();
      });
  Estimates written;
  written.first.push_back(0);
  std::vector<glm::vec3> found(lights, glm::vec3(0.0f));  // by the pass
  std::vector<glm::vec4> by_normal(lights, glm::vec4(0.0f));
  std::vector<std::uint8_t> held(lights, 0);
  for (std::size_t node = 0; node < row_of.size(); ++node) {
    const auto [valued, place] = row_of[node];
    const std::size_t first = valued ? valued->light.first[place] : 0;
    const std::size_t last = valued ? valued->light.first[place + 1] : 0;
    for (std::size_t i = first; i < last; ++i) {
      found[valued->light.light[i]] += valued->light.irradiance[i];
      if (smooth) by_normal[valued->light.light[i]] += valued->light.by_normal[i];
    }
    const auto write = [&](std::uint16_t light, const glm::vec3& irradiance, const glm::vec4& own) {
      written.light.push_back(light);
      written.irradiance.push_back(irradiance);
      if (smooth) written.by_normal.push_back(own);
    };
    for (std::size_t i = means.first[node]; i < means.first[node + 1]; ++i) {
      const std::uint16_t light = means.light[i];
      const glm::vec4 own = smooth ? means.by_normal[i] : glm::vec4(0.0f);
      if (valued) {
        write(light, with(means.irradiance[i], found[light], passes),
              with(own, by_normal[light], passes));
      } else {
        write(light, means.irradiance[i], own);
      }
      held[light] = 1;
    }
    for (std::size_t i = first; i < last; ++i) {
      const std::uint16_t light = valued->light.light[i];
      if (std::exchange(held[light], 1) == 0) {
        write(light, with({}, found[light], passes), with({}, by_normal[light], passes));
      }
      found[light] = glm::vec3(0.0f);
      by_normal[light] = glm::vec4(0.0f);
    }
    for (std::size_t i = written.first.back(); i < written.light.size(); ++i) {
      held[written.light[i]] = 0;
    }
    written.first.push_back(written.light.size());
  }
  means = std::move(written);
}

}  // namespace

void LightMaps::Impl::add_pass(std::uint32_t passes, NodeSource& source, std::size_t first,
                               std::size_t last, const Progress& progress) {
  // The coarsest first: finer ones may depend on them.
  std::vector<Valued> by_level(static_cast<std::size_t>(levels));
  for (std::size_t node = first; node < last; ++node) {
    by_level[static_cast<std::size_t>(light_maps::level_of(places[node], levels))].nodes.push_back(
        static_cast<std::uint32_t>(node));
  }
  for (Valued& level : by_level) {
    progress.throw_if_cancelled();
    std::vector<light_maps::NodePlace> at;
    for (const std::uint32_t node : level.nodes) at.push_back(places[node]);
    if (!at.empty()) level.light = values_of(at, source, progress).first.irradiance;
  }
  if (needs.many_lights()) {
    add_rows(passes, by_level, parameters.powers.size(), values);
  } else {
    for (const Valued& level : by_level) add_dense(passes, level, parameters.powers.size(), values);
  }
}

std::uint64_t LightMaps::refine(NodeSource& source, const Progress& progress, std::uint64_t most) {
  const std::span<NodeSource* const> further = source.further();
  std::vector<std::size_t>& refined = impl_->refined;
  refined.resize(further.size(), 0);
  std::uint64_t lacking = 0;
  for (std::uint32_t pass = 0; pass < further.size(); ++pass) {
    const std::size_t ready = pass == 0 ? impl_->together.size() : refined[pass - 1];
    const std::uint64_t count = std::min<std::uint64_t>(most, ready - refined[pass]);
    if (count > 0) {
      impl_->add_pass(pass + 1, *further[pass], refined[pass], refined[pass] + count, progress);
      refined[pass] += count;
      impl_->refinements += count;
      most -= count;
    }
    lacking += impl_->together.size() - refined[pass];
  }
  return lacking;
}

}  // namespace photile
