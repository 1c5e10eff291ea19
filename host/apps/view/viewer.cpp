#include "view/viewer.hpp"

#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui.h>

#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "photile/errors.hpp"
#include "view/frame.hpp"
#include "view/frame_worker.hpp"
#include "view/light_board.hpp"
#include "view/luminaire_session.hpp"
#include "view/moods.hpp"
#include "view/navigation.hpp"
#include "view/panels.hpp"
#include "view/photon_map.hpp"
#include "view/photon_worker.hpp"
#include "view/picture_area.hpp"
#include "view/point_worker.hpp"
#include "view/settings_history.hpp"
#include "view/snapshots.hpp"
#include "view/window.hpp"
#include "view/year_worker.hpp"

namespace photile::view {
namespace {

/// Longest wait for input before the window is drawn again: news of the workers are seen then.
constexpr double redraw_seconds = 1.0 / 60;
/// Seconds for which frames stay small after the last motion, since hands pause.
constexpr double settling_seconds = 0.15;
constexpr std::size_t frames_in_graph = 120;

/// A part of the scene's size that is walked in a second, and that lies ahead when orbiting.
constexpr double walked_share = 0.15, orbit_share = 0.3;

/// So that the picture beside the panel has the size that is asked for.
std::optional<WindowSize> opening_size(const ViewerParameters& parameters) {
  if (parameters.fills_screen) return std::nullopt;
  const Film& film = parameters.render.film;
  return WindowSize{film.width + panel_width, film.height};
}

class Viewer {
 public:
  Viewer(const Scene& scene, const Camera& camera, const LightMix& mix,
         PhotonWorker::OpenDevices open_devices, ViewerParameters parameters)
      : scene_(std::shared_ptr<void>(), &scene),
        newest_scene_(scene_),
        parameters_(std::move(parameters)),
        lights_(mix, MovingSky::of(mix, parameters_.situation)),
        moods_(parameters_.moods.empty() ? Moods::file_of(scene.source) : parameters_.moods),
        viewpoint_(camera),
        navigation_(walked_share * bounding_sphere(scene).radius,
                    orbit_share * bounding_sphere(scene).radius),
        window_(fmt::format("{} - photile", scene.source.filename().string()),
                opening_size(parameters_)),
        points_(scene_),
        year_(parameters_.measure_year),
        frames_(parameters_.render.film.samples_per_pixel, parameters_.frames_per_second),
        photons_(std::move(open_devices), parameters_.light_map_bytes) {
    inspector_.emplace(scene);
    display_.view = parameters_.view;
    if (!parameters_.luminaire_file.empty()) {
      luminaires_.emplace(parameters_.luminaire_file, parameters_.luminaires, scene,
                          parameters_.load);
    }
    history_.emplace(lights_, luminaires_ ? &*luminaires_ : nullptr);
    if (parameters_.situation.time) {
      lights_.daylight().moment = SkyMoment::of(*parameters_.situation.time);
    }
    if (lights_.sky()) move_sky();
    photons_.trace(scene_, parameters_.render, std::exchange(parameters_.prepared, std::nullopt),
                   parameters_.keep);
  }

  void run() {
    while (!closed() && !parameters_.interrupted()) {
      window_.begin_frame(redraw_seconds);
      take_keys();
      history_->begin_frame();
      take_edit_keys();
      follow_input();
      take_maps();
      const bool new_frame = take_frame();
      if (keep_requested_) keep_frame();
      take_errors();
      picked_ = pick_triangle();
      take_click();
      PanelEvents events = panels_shown_ || closing() ? show_panels() : PanelEvents();
      events.lights_changed |= std::exchange(lights_keyed_, false);
      history_->end_frame(events.lights_changed, ImGui::IsAnyItemActive());
      events.lights_changed |= std::exchange(lights_restored_, false);
      const bool sky_moved = lights_.sky() && !(lights_.daylight().moment == shown_moment_);
      if (sky_moved) move_sky();
      if (events.expose && frame_) {
        display_.exposure = 0;
        set_exposure();
      }
      if (frame_ && (new_frame || events.lights_changed || events.display_changed ||
                     events.expose || picked_)) {
        DisplayedFrame shown = display(*frame_, lights_.shown_mix(), display_);
        if (display_.photon_map) inspector_->draw(*frame_, shown);
        window_.set_picture(shown.width, shown.height, shown.rgb);
      }
      // A quick frame holds no lamps: it is drawn anew by the nodes.
      if (events.lights_changed && frame_ && !frame_->mixed.empty()) {
        frames_.show(request(was_moving_, true));
      }
      exposed_ =
          exposed_ || events.display_changed || (frame_ && events.lights_changed && !sky_moved);
      if (events.maps_changed) trace();
      if (!events.mood_to_scene.empty()) {
        message_ = write_mood(*scene_, parameters_.load, lights_, moods_, events.mood_to_scene);
      }
      if (events.removed_point > 0) points_.remove(events.removed_point);
      if (events.keep_points) {
        message_ = keep_points(parameters_.outputs, points_.points(), lights_,
                               point_settings_.maintenance);
      }
      if (events.save_luminaires) luminaires_->save(message_);
      if (luminaires_ && luminaires_->close_as(events.closing, message_)) window_.close();
      if (luminaires_ && panels_shown_) luminaires_->tool().draw(viewpoint_.camera());
      window_.draw_frame();
      keep_screenshot();
      window_.show_frame();
      if (parameters_.redrawn) {
        parameters_.redrawn({frame_.get(), new_frame, was_moving_});
      }
    }
    if (luminaires_) luminaires_->tell_unsaved(*parameters_.notes);
    if (keep_requested_) parameters_.notes->note("the picture was not yet whole, and is not kept");
    photons_.stop();
    const std::shared_ptr<MapGeneration> maps = frames_.stop();
    if (!parameters_.keep_light_maps || !maps || maps->scene != first_scene_) return;
    if (maps->emitted_photons != parameters_.render.photons.emitted_photons) return;
    if (const auto light_maps = maps->renderer->light_map_contents()) {
      parameters_.keep_light_maps(*light_maps);
    }
  }

 private:
  /// Photons are kept of the first scene alone: of others there is no file.
  void trace() { photons_.trace(newest_scene_, parameters_.render, std::nullopt, {}); }

  /// Another scene is shown from its first maps on; until then, the last is.
  void take_maps() {
    if (luminaires_) {
      if (auto scene = luminaires_->take_scene(message_)) {
        newest_scene_ = std::move(scene);
        parameters_.load.luminaires_text = luminaires_->editor().list().text();
        trace();
      }
    }
    std::shared_ptr<MapGeneration> maps = photons_.take();
    if (!maps) return;
    if (maps->scene == scene_) {
      frames_.use(std::move(maps));
      return;
    }
    scene_ = maps->scene;
    const LightMix mix = parameters_.mix_of(*scene_);
    lights_.adopt(mix, MovingSky::of(mix, parameters_.situation));
    if (lights_.sky()) mixdown_ = std::make_shared<const LayerMixdown>(lights_.mixdown());
    points_.use(scene_);
    inspector_.emplace(*scene_);
    frame_.reset();  // its layers are those of other lights; the window keeps showing it
    frames_.use(std::move(maps), request(was_moving_));
  }

  /// Unsaved changes are asked about first.
  bool closed() {
    if (!window_.should_close()) return false;
    if (!luminaires_ || luminaires_->may_close()) return true;
    window_.keep_open();
    return false;
  }

  bool closing() const { return luminaires_ && luminaires_->closing(); }

  void take_keys() {
    const ImGuiIO& io = ImGui::GetIO();
    if (io.WantTextInput) return;
    if (ImGui::IsKeyPressed(GLFW_KEY_F2, false)) panels_shown_ = !panels_shown_;
    screenshot_requested_ = ImGui::IsKeyPressed(GLFW_KEY_F12, false);
    if (io.KeyCtrl && ImGui::IsKeyPressed(GLFW_KEY_Q, false)) window_.close();
    if (io.KeyCtrl && ImGui::IsKeyPressed(GLFW_KEY_S, false)) {
      keep_requested_ = true;
      told_of_luminaires_.clear();
      if (luminaires_ && luminaires_->editor().unsaved()) luminaires_->save(told_of_luminaires_);
      message_ = beside_luminaires("the picture is kept as soon as it is whole");
    }
    const bool undo = io.KeyCtrl && ImGui::IsKeyPressed(GLFW_KEY_Z, true);
    const bool redo = io.KeyCtrl && ImGui::IsKeyPressed(GLFW_KEY_Y, true);
    if (undo || redo) {
      lights_restored_ = undo && !io.KeyShift ? history_->undo() : history_->redo();
    }
  }

  /// Takes the keys of the sky and of luminaires.
  void take_edit_keys() {
    const ImGuiIO& io = ImGui::GetIO();
    if (io.WantTextInput) return;
    lights_keyed_ = lights_.sky() && take_sky_keys(lights_.daylight().moment);
    if (luminaires_) luminaires_->tool().take_keys();
  }

  /// Frames' layers hold the sky of a moment: others are asked for, quick ones while it moves.
  void move_sky() {
    shown_moment_ = lights_.daylight().moment;
    mixdown_ = std::make_shared<const LayerMixdown>(lights_.mixdown());
    last_motion_ = glfwGetTime();
    sky_moved_ = true;
    if (display_.adapts) exposed_ = false;
  }

  /// Asks for frames of where the viewer is by now.
  void follow_input() {
    const double now = glfwGetTime();
    const bool lamps_held = luminaires_ && luminaires_->tool().drag(viewpoint_.camera());
    const bool moved = navigation_.update(viewpoint_, lamps_held);
    if (moved) last_motion_ = now;
    const bool moving = last_motion_ && now - *last_motion_ < settling_seconds;
    const int width = window_.picture_width(), height = window_.picture_height();
    const bool reflections = display_.mode == DisplayMode::glare;
    const bool sky_moved = std::exchange(sky_moved_, false);
    if (moved || sky_moved || moving != was_moving_ || reflections != had_reflections_ ||
        width != asked_width_ || height != asked_height_) {
      // A window that is minimised keeps its last picture.
      if (width > 0 && height > 0) frames_.show(request(moving));
      was_moving_ = moving;
      had_reflections_ = reflections;
      asked_width_ = width;
      asked_height_ = height;
    }
    clicked_ = navigation_.clicked();
    if (clicked_) {
      const glm::dvec2 shares = PictureArea::now().shares(ImGui::GetIO().MousePos);
      probe_ = Probe{shares.x, shares.y};
    }
  }

  FrameRequest request(bool moving, bool relit = false) const {
    // Layers are needed for all but the picture itself.
    const bool quick = display_.mode == DisplayMode::picture && !display_.photon_map;
    return {viewpoint_.camera(),
            window_.picture_width(),
            window_.picture_height(),
            moving,
            display_.mode == DisplayMode::glare,
            relit,
            quick ? scales_of(lights_.mix()) : std::vector<glm::vec3>(),
            mixdown_};
  }

  /// Whether a click has picked a triangle whose photons are to be shown.
  bool pick_triangle() {
    if (!clicked_ || !display_.photon_map || !frame_ || !probe_) return false;
    inspector_->pick(*frame_, probe_->x, probe_->y);
    return true;
  }

  /// A click is a measurement, unless it asks for a triangle's photons, or for lamps.
  void take_click() {
    if (!clicked_ || display_.photon_map || !frame_ || !probe_) return;
    const auto place = inspector_->surface_at(*frame_, probe_->x, probe_->y);
    const glm::dvec3 direction =
        PictureArea::now().direction(frame_->camera, ImGui::GetIO().MousePos);
    if (luminaires_ && luminaires_->click(frame_->camera, direction, place, message_)) {
      probe_.reset();
    } else if (place) {
      points_.add(position_in_world(*scene_, place->position),
                  direction_in_world(*scene_, place->normal));
    }
  }

  /// Whether there is a new frame.
  bool take_frame() {
    std::shared_ptr<const Frame> latest = frames_.latest();
    if (latest == frame_ || !latest || latest->scene != scene_) return false;
    seen_ = true;
    frame_ = std::move(latest);
    milliseconds_.push_back(static_cast<float>(1e3 * frame_->seconds));
    if (milliseconds_.size() > frames_in_graph) milliseconds_.pop_front();
    // Once, so that a lamp that is turned down is seen to be; of coarse pictures, each anew.
    if (!exposed_) set_exposure();
    if (!white_is_set_) set_white();
    exposed_ = exposed_ || frame_->mixed.empty();
    window_.set_title(fmt::format("{} - photile: {} of {} samples, {:.4g}M paths",
                                  scene_->source.filename().string(), frame_->samples_per_pixel,
                                  parameters_.render.film.samples_per_pixel,
                                  static_cast<double>(frame_->emitted_photons) / 1e6));
    return true;
  }

  void set_exposure() { display_.automatic_stops = automatic_stops(*frame_, lights_.shown_mix()); }

  /// That of the lamps as the scene has them: no change of a lamp moves it.
  void set_white() {
    const LightMix loaded = LightMix::of(*scene_, parameters_.load.lumen_per_watt);
    LightBoard board(loaded, MovingSky::of(loaded, parameters_.situation));
    board.daylight() = lights_.daylight();
    white_ = parameters_.white ? *parameters_.white : white_of(*frame_, board.shown_mix());
    if (parameters_.white_balance) display_.white = white_;
    white_is_set_ = frame_->mixed.empty();
  }

  /// Before there is a picture an error ends the walkthrough; later ones are shown.
  void take_errors() {
    for (const std::exception_ptr& error : {photons_.take_error(), frames_.take_error()}) {
      if (!error) continue;
      if (!seen_) std::rethrow_exception(error);
      try {
        std::rethrow_exception(error);
      } catch (const std::exception& told) {
        message_ = told.what();
      }
    }
  }

  PanelEvents show_panels() {
    const std::vector<ClickedPoint> points = points_.points();
    PanelState state{lights_,
                     moods_,
                     display_,
                     parameters_.render,
                     navigation_.speed(),
                     probe_,
                     message_,
                     new_mood_,
                     points,
                     point_settings_,
                     *scene_,
                     year_,
                     luminaires_ ? &luminaires_->tool() : nullptr,
                     closing()};
    return draw_panels(
        state, {frame_.get(), photons_.progress(), parameters_.render.film.samples_per_pixel,
                milliseconds_, display_.photon_map ? inspector_->map() : nullptr,
                luminaires_ && luminaires_->loading()});
  }

  void keep_screenshot() {
    if (!screenshot_requested_) return;
    message_ = keep_as(parameters_.outputs, "screenshot", ".png", [&](const auto& file) {
      write_screenshot(file, window_.width(), window_.height(), window_.read_pixels());
    });
  }

  void keep_frame() {
    if (!frame_ || !frame_->mixed.empty()) return;
    keep_requested_ = false;
    message_ =
        beside_luminaires(keep_as(parameters_.outputs, "view", ".exr", [&](const auto& file) {
          write_frame(file, *scene_, *frame_, lights_.shown_mix(), white_);
        }));
  }

  /// The message of Ctrl+S, after that of saving luminaires.
  std::string beside_luminaires(const std::string& what) const {
    return told_of_luminaires_.empty() ? what : told_of_luminaires_ + "; " + what;
  }

  std::shared_ptr<const Scene> scene_;         ///< that is shown
  std::shared_ptr<const Scene> newest_scene_;  ///< that photons are traced in
  const std::shared_ptr<const Scene> first_scene_ = scene_;
  ViewerParameters parameters_;
  LightBoard lights_;
  Moods moods_;
  DisplaySettings display_;
  Viewpoint viewpoint_;
  Navigation navigation_;
  Window window_;
  std::optional<PhotonInspector> inspector_;
  PointWorker points_;
  YearWorker year_;
  PointSettings point_settings_;
  std::optional<LuminaireSession> luminaires_;  ///< where a file of them is edited
  std::optional<SettingsHistory> history_;
  std::optional<Probe> probe_;
  std::string message_, new_mood_;
  std::string told_of_luminaires_;  ///< by the last Ctrl+S
  std::shared_ptr<const Frame> frame_;
  std::deque<float> milliseconds_;
  std::optional<double> last_motion_;  ///< GLFW's clock, seconds
  bool was_moving_ = false, had_reflections_ = false, clicked_ = false, picked_ = false;
  int asked_width_ = 0, asked_height_ = 0;
  /// The moment that frames were requested with, of a sky that hours move.
  SkyMoment shown_moment_;
  std::shared_ptr<const LayerMixdown> mixdown_;
  bool sky_moved_ = false;
  image::White white_{1, 1, 1};  ///< that pictures keep
  bool white_is_set_ = false;    ///< by a frame whose lights are known
  bool exposed_ = false, lights_restored_ = false, lights_keyed_ = false;
  bool seen_ = false;  ///< any frame
  bool panels_shown_ = true, screenshot_requested_ = false;
  bool keep_requested_ = false;  ///< a frame that has layers, which a quick one has not
  FrameWorker frames_;
  PhotonFeed photons_;
};

}  // namespace

void run_viewer(const Scene& scene, const Camera& camera, const LightMix& mix,
                PhotonWorker::OpenDevices open_devices, ViewerParameters parameters) {
  Viewer(scene, camera, mix, std::move(open_devices), std::move(parameters)).run();
}

}  // namespace photile::view
