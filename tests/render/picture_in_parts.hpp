// A picture whose rows are estimated a few at a time, as where many lights are pooled.
#pragma once

#include <memory>
#include <span>

#include "photile/light_layers.hpp"
#include "render/hit_source.hpp"
#include "render/render_session.hpp"
#include "test_device.hpp"

namespace photile::test {

/// In at least 16 parts of rows where there are as many: each layer is pooled into itself.
inline LightLayers picture_in_parts(const Scene& scene, const Camera& camera,
                                    const RenderParameters& parameters) {
  LayerMixdown itself;
  for (const LightGroup& group : light_groups_of(scene).groups) {
    itself.layer_of.push_back(static_cast<std::uint32_t>(itself.layers.size()));
    itself.layers.push_back(group.name);
    itself.scale.push_back(1.0f);
  }
  RenderSession session(std::make_shared<const PreparedScene>(scene), std::span(&device(), 1),
                        parameters, Progress::none());
  return session.render(camera_hits(camera), parameters.film, Progress::none(), &itself).layers;
}

}  // namespace photile::test
