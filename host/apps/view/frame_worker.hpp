// Frames of the walkthrough, rendered on their own thread.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "view/frame.hpp"
#include "view/photon_worker.hpp"

namespace photile::view {

/// What a frame is to show.
struct FrameRequest {
  Camera camera;  ///< in the scene's coordinates
  int width = 0, height = 0;
  /// Standing still, frames get more and more samples.
  bool moving = false;
  bool reflections = false;  ///< asks for Frame::reflections
  /// Per layer, power x tint: asks for quick frames where there are light maps, while the viewer
  /// moves and until no node is lacking. Empty: frames with layers are requested.
  std::vector<glm::vec3> powers = {};
  /// How the layers of frames that have some are mixed; null = each light for itself.
  std::shared_ptr<const LayerMixdown> mixdown = nullptr;
};

/// Renders what was asked for last from the newest maps. A frame in progress is finished while the
/// viewer moves, and cancelled when it starts to move.
class FrameWorker {
 public:
  using Drawn = std::function<void(const Camera&, MapGeneration&, const DrawnFrame&)>;

  ///   most_samples        per pixel, standing still
  ///   frames_per_second   aimed at while moving
  ///   drawn               told on the worker's thread of each quick frame, before more nodes are
  ///                       valued; may be empty
  FrameWorker(int most_samples, double frames_per_second, Drawn drawn = {});
  ~FrameWorker();

  void show(const FrameRequest& request);
  /// Maps of another scene, which has other powers, come with what is to be seen.
  void use(std::shared_ptr<MapGeneration> maps, const FrameRequest* request = nullptr);

  /// Ends the work. Returns the newest maps, which this does not use any longer; null: there are
  /// none.
  std::shared_ptr<MapGeneration> stop();

  /// The newest frame; null before the first.
  std::shared_ptr<const Frame> latest() const;
  /// Whether the newest frame has all samples of the newest maps.
  bool finished() const;
  /// The error that ended the work, or null; each is returned once.
  std::exception_ptr take_error();

 private:
  /// The input of the next frame.
  struct Task {
    FrameRequest request;
    std::shared_ptr<MapGeneration> maps;
    int samples = 1;
    std::uint64_t version = 0;
    bool quick = false;
  };

  void work(std::stop_token stop);
  bool next_task(std::stop_token stop, Task& task);
  std::shared_ptr<const Frame> render(const std::stop_token& stop, const Task& task);
  void draw(const std::stop_token& stop, const Task& task);
  void keep(const Task& task, std::shared_ptr<const Frame> frame, int samples);
  bool outdated(const Task& task) const;
  double time_to_fill(const Task& task, double draw_seconds) const;

  const int most_samples_;
  const Drawn drawn_;
  mutable std::mutex mutex_;
  std::condition_variable_any wake_;
  FrameRequest request_;
  std::shared_ptr<MapGeneration> maps_;
  std::uint64_t version_ = 0;       ///< counts requests and maps
  std::uint64_t done_version_ = 0;  ///< of the newest frame
  int done_samples_ = 0;            ///< of the newest frame, 0 where it was a quick one
  std::shared_ptr<const Frame> latest_;
  std::exception_ptr error_;
  // The worker's alone:
  const double frame_seconds_;  ///< aimed at while moving
  double draw_seconds_ = 0;     ///< of the newest quick frame, its nodes left out
  std::jthread thread_;         // last: it uses all of the above
};

}  // namespace photile::view
