// A room whose light is being computed, for pages that show it: each has its own eye, and all have
// the same lamps.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "image/white.hpp"
#include "photile/camera.hpp"
#include "photile/layered_picture.hpp"
#include "photile/load_scene.hpp"
#include "photile/renderer.hpp"
#include "photile/scene.hpp"
#include "photile/statistics.hpp"
#include "publish/published_room.hpp"
#include "serve/live_light.hpp"
#include "serve/live_luminaires.hpp"
#include "serve/web_server.hpp"
#include "view/frame_worker.hpp"
#include "view/moods.hpp"
#include "view/photon_worker.hpp"
#include "view/point_worker.hpp"
#include "view/year_worker.hpp"

namespace photile::serve {

struct LiveRoomParameters {
  RenderParameters render;  ///< with light maps
  /// Makes the mix of the scene, also when it is loaded again.
  std::function<LightMix(const Scene&)> mix_of;
  /// The view that pages open with, in the scene's coordinates.
  std::function<Camera(const Scene&)> camera_of;
  SceneLoadOptions load;   ///< with which it was loaded, for copies of its file
  SkySituation situation;  ///< of a sky of patches
  /// Photons of an earlier run in place of all tracing, or none.
  std::optional<TracedPhotons> prepared;
  KeepPhotons keep;  ///< is given all photons of the scene once they are there; may be empty
  std::shared_ptr<LiveLuminaires> luminaires;  ///< that are edited; null = none
  view::YearWorker::Measure measure_year;      ///< of daylight, when it is asked for; may be empty
  std::filesystem::path moods;                 ///< file of moods
  std::uint64_t light_map_bytes = 0;           ///< that nodes may take; 0 = no bound
  std::optional<image::White> white;           ///< none = that of the lamps
  bool white_balance = true;                   ///< whether it is shown as white
  DisplayView view = ToneMapping{}.view;
  std::string title, version;
};

class LiveRoom {
 public:
  /// The reference is kept. Errors: InputError for a damaged file of moods; those of
  /// publish::check_materials.
  LiveRoom(const Scene& scene, view::PhotonWorker::OpenDevices open_devices,
           LiveRoomParameters parameters);

  /// Makes the page, for which those who ask for it wait, and starts to trace photons.
  void make_page();
  /// Takes what threads have found since, and gives them work. To be called some hundred times a
  /// second, by one thread. Errors: those of PhotonWorker and FrameWorker before there is light;
  /// later ones are told to the pages.
  void step();
  /// Seconds since the last page was closed; 0 while one is open, or none has been yet.
  double left_alone() const;
  /// Ends the work.
  ///   keep   is given the light maps of all photons of the first scene, where there are any; may
  ///          be empty
  void finish(const std::function<void(const LightMapContents&)>& keep);

  // For WebServer, on any thread.

  /// Errors: InputError for a body that is damaged; OutputError where moods cannot be written.
  std::optional<WebReply> answer(const WebRequest& request);
  std::unique_ptr<NewsSource> listen(const WebRequest& request);

 private:
  class News;

  /// The room as pages of one text show it. Another one follows when the scene is loaded again.
  struct Edition {
    int number = 1;
    std::shared_ptr<const Scene> scene;
    LightMix mix;
    std::shared_ptr<LiveLight> light;  ///< null before the page is made
    std::string page;
  };

  struct Viewer {
    int edition = 1;                             ///< that its page shows
    int pages = 0;                               ///< that listen by its name
    view::FrameRequest request;                  ///< of no size: where it looks is not known yet
    bool done = false;                           ///< `picture` has all samples
    std::shared_ptr<const view::Frame> picture;  ///< of that request, with layers; or null
    std::uint64_t picture_number = 0;
    std::map<int, int> points;  ///< that were clicked: of the page's numbers those of `points_`
  };

  Edition made(int number, std::shared_ptr<const Scene> scene);
  void take_scene();
  void retrace();
  void take_maps();
  void show(const std::string& viewer);
  void take_frame();
  void take_errors();
  void tell(std::string problem);
  void point(Viewer& viewer, const nlohmann::json& body);
  void change_moods(const nlohmann::json& body);
  void change_settings(const nlohmann::json& body);
  void find_presets();
  nlohmann::json work_of(const Viewer& viewer) const;
  void changed();

  const std::shared_ptr<const Scene> first_scene_;
  LiveRoomParameters parameters_;
  view::PointWorker points_;
  view::YearWorker year_;

  mutable std::mutex mutex_;
  std::condition_variable news_;
  std::uint64_t changes_ = 0;  ///< of all below: wakes those who wait for news
  Edition edition_;
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
  bool seen_ = false;                           ///< any frame
  std::atomic<bool> settings_changed_ = false;  ///< since photons were traced
  bool traced_as_asked_ = true;                 ///< by the settings that the command was given

  std::optional<Edition> next_;  ///< once there are photons in its scene: of the thread of `step`
  view::FrameWorker frames_;
  view::PhotonFeed photons_;
};

}  // namespace photile::serve
