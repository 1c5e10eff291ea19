// How a live page loads its scene: under a sky that moves, and again, with other luminaires, on its
// own thread.
#pragma once

#include <condition_variable>
#include <exception>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "loading/load_scene.hpp"
#include "photile/load_scene.hpp"

namespace photile::view {

class SceneLoader {
 public:
  ///   options   with the file of luminaires
  SceneLoader(std::filesystem::path scene, SceneLoadOptions options);
  ~SceneLoader();

  /// Loads it with these entries (LuminaireList::text); earlier requests are cancelled.
  void load(const std::string& luminaires);

  struct Loaded {
    std::string luminaires;
    std::shared_ptr<const loading::SourcedScene> scene;
  };
  /// The newest scene that is loaded, once.
  std::optional<Loaded> take();
  /// Why the newest list cannot be loaded, or null; each is returned once.
  std::exception_ptr take_error();
  bool busy() const;

 private:
  void work(const std::stop_token& stop);

  const std::filesystem::path scene_;
  SceneLoadOptions options_;
  mutable std::mutex mutex_;
  std::condition_variable_any wake_;
  std::optional<std::string> requested_;
  bool loading_ = false;
  std::optional<Loaded> loaded_;
  std::exception_ptr error_;
  std::jthread thread_;  // last: it uses all of the above
};

/// Where options give a site or a weather file, or ask for patches, and for no other sky or sun:
/// puts patches into the scene that is to be loaded, and returns the site and the time that move
/// them. Without a site they are one group of lights.
SkySituation take_moving_sky(SceneLoadOptions& options);

}  // namespace photile::view
