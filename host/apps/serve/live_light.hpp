// Light maps of every light that get better, as pages take them: in tiles of one picture.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "bake/light_atlas.hpp"
#include "cache/charts.hpp"
#include "photile/camera.hpp"
#include "photile/ray_scene.hpp"
#include "photile/statistics.hpp"
#include "view/photon_worker.hpp"

namespace photile::serve {

class LiveLight {
 public:
  /// Lays out the picture. The reference is kept.
  ///   layers    of the scene
  ///   changed   told, on the thread of `take`, whenever tiles have changed
  LiveLight(const Scene& scene, std::size_t layers, std::function<void()> changed);

  const bake::LightAtlas& atlas() const { return atlas_; }
  const RayScene& rays() const { return rays_; }

  /// Takes the light of what a camera sees, as frames show it by now, and of a little more surface,
  /// unless that was done a moment ago and there is more to come, or there is too little for a
  /// first picture. One thread, which may call FrameRenderer::light_at.
  ///   drawn   the camera's frame
  void take(const Camera& camera, const view::MapGeneration& maps, const DrawnFrame& drawn);

  /// Number of the newest state; 0 = there is no light yet. Any thread.
  std::uint64_t version() const;
  /// The tiles that have changed since a state, for page/live.js: the length of a JSON text, that
  /// text, and the bytes that it refers to. Any thread.
  std::string since(std::uint64_t version) const;

 private:
  struct Part {
    bake::LightAtlas::TexelPoints points;  ///< that may still change, once known
    bool known = false, taken = false;
  };
  struct Tile {
    std::uint64_t version = 0;
    double brightest = 0;
    std::string
        bytes;  ///< of a `light` section (publish/sections.hpp), its lights one below another
  };

  std::vector<std::uint32_t> sides_to_draw() const;
  std::vector<std::uint32_t> parts_in_view(const Camera& camera) const;
  void note_levels(std::span<const std::size_t> taken);
  void code(const std::vector<std::uint8_t>& changed);

  const Scene& scene_;
  const std::size_t layers_;
  const std::function<void()> changed_;
  const RayScene rays_;
  cache::Charts charts_;
  const bake::LightAtlas atlas_;
  std::vector<std::uint32_t> part_of_chart_;   ///< into parts_, or none
  std::vector<Part> parts_;                    ///< by the number of a chart in the atlas
  std::vector<std::vector<glm::vec3>> light_;  ///< per layer and texel, at power 1
  const view::MapGeneration* maps_ = nullptr;  ///< those of the last time
  Stopwatch since_taken_;
  double cost_ = 0;  ///< of the last time, seconds

  mutable std::mutex mutex_;
  std::uint64_t version_ = 0;
  std::vector<double> brightest_;  ///< per layer, of the first state: what tiles are multiples of
  std::vector<glm::vec3> mean_;    ///< per layer, of the first state: for what no tile has yet
  std::vector<Tile> tiles_;        ///< row by row
};

}  // namespace photile::serve
