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

 private:
  const PreparedScene scene_;
  Rendering rendering_;
};

}  // namespace photile
