#include "view/photon_feed.hpp"

#include <utility>

namespace photile::view {

void PhotonFeed::trace(std::shared_ptr<const Scene> scene, const RenderParameters& parameters,
                       std::optional<PreparedPhotons> prepared, KeepPhotons keep) {
  worker_.reset();
  take();  // of the scene before
  const Scene& traced = *scene;
  worker_.emplace(traced, open_devices_, parameters, std::move(prepared), std::move(keep),
                  [this, scene = std::move(scene), bounded = std::shared_ptr<MapGeneration>()](
                      std::shared_ptr<MapGeneration> maps) mutable {
                    if (maps != bounded) {  // else frames are drawn from it by now
                      maps->scene = scene;
                      maps->renderer->bound_light_maps(light_map_bytes_);
                    }
                    bounded = maps;
                    const std::lock_guard lock(mutex_);
                    delivered_ = std::move(maps);
                  });
}

std::shared_ptr<MapGeneration> PhotonFeed::take() {
  const std::lock_guard lock(mutex_);
  return std::exchange(delivered_, nullptr);
}

}  // namespace photile::view
