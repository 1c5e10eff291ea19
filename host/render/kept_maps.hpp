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
  LightMapFrames& frames(Progress& progress) {
    rendering_.report_to(progress);
    return rendering_.frames();
  }
  LightMapEstimates& light_maps(Progress& progress) {
    rendering_.report_to(progress);
    return rendering_.light_maps();
  }
  bool reads_light_maps() const { return rendering_.plan().reads_light_maps(); }
  std::optional<LightMapContents> light_map_contents() const {
    return rendering_.light_map_contents();
  }

 private:
  const PreparedScene scene_;
  Rendering rendering_;
};

}  // namespace photile
