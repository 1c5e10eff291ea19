// Photon maps that are kept for many pictures: what SceneRenderer offers, of any hits.
#pragma once

#include "render/rendering.hpp"

namespace photile {

class KeptMaps {
 public:
  /// As SceneRenderer.
  KeptMaps(const Scene& scene, std::span<Device> devices, const RenderParameters& parameters,
           PreparedPhotons* prepared, const KeepPhotons& keep, Progress& progress);

  RenderResult render(const HitSource& hits, const Film& film, Progress& progress);

  /// Quick pictures, where light maps are read.
  LightMapFrames& frames() { return rendering_.frames(); }
  bool reads_light_maps() const { return rendering_.plan().reads_light_maps(); }

 private:
  const PreparedScene scene_;
  Rendering rendering_;
};

}  // namespace photile
