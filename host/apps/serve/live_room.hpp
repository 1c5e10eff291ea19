// A room whose light is being computed, for pages that show it: each has its own eye, and all have
// the same lamps.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "image/white.hpp"
#include "photile/layered_picture.hpp"
#include "photile/load_scene.hpp"
#include "photile/renderer.hpp"
#include "photile/scene.hpp"
#include "photile/statistics.hpp"
#include "publish/published_room.hpp"
#include "serve/live_light.hpp"
#include "serve/web_server.hpp"
#include "view/frame_worker.hpp"
#include "view/moods.hpp"
#include "view/photon_worker.hpp"
#include "view/point_worker.hpp"

namespace photile::serve {

struct LiveRoomParameters {
  RenderParameters render;            ///< with light maps
  SkySituation situation;             ///< of a sky of patches
  std::filesystem::path moods;        ///< file of moods
  std::uint64_t light_map_bytes = 0;  ///< that nodes may take; 0 = no bound
  std::optional<image::White> white;  ///< none = that of the lamps
  bool white_balance = true;          ///< whether it is shown as white
  DisplayView view = ToneMapping{}.view;
  std::string title, version;
};

class LiveRoom {
 public:
  /// Starts to trace photons. References are kept. Errors: InputError for a damaged file of moods;
  /// those of publish::check_materials.
  LiveRoom(const Scene& scene, const LightMix& mix, view::PhotonWorker::OpenDevices open_devices,
           LiveRoomParameters parameters);

  /// Makes the page: those who ask for it wait until then.
  void make_page();
  /// Takes what threads have found since, and gives them work. To be called some hundred times a
  /// second, by one thread. Errors: those of PhotonWorker and FrameWorker before there is light;
  /// later ones are told to the pages.
  void step();
  /// Seconds since the last page was closed; 0 while one is open, or none has been yet.
  double left_alone() const;

  // For WebServer, on any thread.

  /// Errors: InputError for a body that is damaged; OutputError where moods cannot be written.
  std::optional<WebReply> answer(const WebRequest& request);
  std::unique_ptr<NewsSource> listen(const std::string& viewer);

 private:
  class News;

  struct Viewer {
    int pages = 0;                               ///< that listen by its name
    view::FrameRequest request;                  ///< of no size: where it looks is not known yet
    bool done = false;                           ///< `picture` has all samples
    std::shared_ptr<const view::Frame> picture;  ///< of that request, with layers; or null
    std::uint64_t picture_number = 0;
    std::map<int, int> points;  ///< that were clicked: of the page's numbers those of `points_`
  };

  void show(const std::string& viewer);
  void take_frame();
  void take_errors();
  void look(Viewer& viewer, const std::string& name, const nlohmann::json& body);
  void point(Viewer& viewer, const nlohmann::json& body);
  void change_moods(const nlohmann::json& body);
  nlohmann::json presets() const;
  nlohmann::json work_of(const Viewer& viewer) const;
  std::string picture_bytes(const view::Frame& frame) const;
  void changed();

  const Scene& scene_;
  const std::shared_ptr<const Scene> shared_scene_;
  const LightMix mix_;
  const LiveRoomParameters parameters_;
  view::PointWorker points_;

  mutable std::mutex mutex_;
  std::condition_variable news_;
  std::uint64_t changes_ = 0;  ///< of all below: wakes those who wait for news
  std::string page_;
  std::map<std::string, Viewer> viewers_;
  std::string shown_;  ///< the viewer for whom frames are made
  std::shared_ptr<const view::Frame> frame_;
  view::Moods moods_;
  nlohmann::json presets_;  ///< of the moods
  nlohmann::json lamps_;    ///< as the last page that changed them has them
  std::string lamps_by_;
  std::uint64_t lamps_number_ = 0, moods_number_ = 0;
  image::White white_{1, 1, 1};
  bool white_is_known_ = false;  ///< from a picture
  std::string message_;          ///< an error after the first light
  Stopwatch since_left_;
  bool visited_ = false;

  std::shared_ptr<LiveLight> light_;  ///< null before the page is made
  view::FrameWorker frames_;
  view::PhotonFeed photons_;
};

}  // namespace photile::serve
