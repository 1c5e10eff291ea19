// A picture whose rows are estimated a few at a time, as where many lights are pooled.
#pragma once

#include <span>

#include "photile/light_groups.hpp"
#include "photile/light_pooling.hpp"
#include "render/rendering.hpp"
#include "test_device.hpp"

namespace photile::test {

/// In at least 16 parts of rows where there are as many: each layer is pooled into itself.
inline LightLayers picture_in_parts(const Scene& scene, const Camera& camera,
                                    const RenderParameters& parameters) {
  LightPooling itself;
  for (const LightGroup& group : light_groups_of(scene).groups) {
    itself.layer_of.push_back(static_cast<std::uint32_t>(itself.layers.size()));
    itself.layers.push_back(group.name);
    itself.scale.push_back(1.0f);
  }
  const PreparedScene prepared(scene);
  Rendering rendering(prepared, std::span(&device(), 1), parameters, Progress::none());
  rendering.expect_one_picture();
  rendering.start(parameters.film, 0, &itself);
  rendering.prepare(0, nullptr, nullptr);
  rendering.add_pass(CameraHits(camera));
  return rendering.finish().layers;
}

}  // namespace photile::test
