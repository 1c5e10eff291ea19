// Photon maps that are kept for many pictures: what SceneRenderer offers, of any hits.
#pragma once

#include <memory>
#include <vector>

#include "render/rendering.hpp"

namespace photile {

class KeptMaps {
 public:
  /// As SceneRenderer, but that of several passes only the first is prepared.
  KeptMaps(std::shared_ptr<const PreparedScene> scene, std::span<Device> devices,
           const RenderParameters& parameters, PreparedPhotons* prepared, const KeepPhotons& keep,
           Progress& progress);

  /// As SceneRenderer.
  struct Pass {
    std::vector<Device> devices;  ///< its own, if any
    std::unique_ptr<Rendering> rendering;
  };
  Pass prepare_pass(int pass, std::vector<Device> devices, Progress& progress) const;
  void add(Pass pass);
  /// All that are not added yet.
  void add_passes(Progress& progress);

  /// As SceneRenderer.
  RenderResult render(const HitSource& hits, const Film& film, Progress& progress,
                      const LightPooling* pooling = nullptr);

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
  const std::shared_ptr<const PreparedScene> scene_;
  std::span<Device> devices_;
  const RenderParameters parameters_;
  Rendering rendering_;
  std::vector<Pass> further_;
};

}  // namespace photile
