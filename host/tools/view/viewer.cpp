#include "tools/view/viewer.hpp"

#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui.h>

#include <deque>
#include <optional>
#include <string>
#include <utility>

#include "common/output_file.hpp"
#include "export/edited_scene.hpp"
#include "photile/errors.hpp"
#include "tools/preview/live_preview.hpp"
#include "tools/view/display.hpp"
#include "tools/view/frame_worker.hpp"
#include "tools/view/light_board.hpp"
#include "tools/view/light_history.hpp"
#include "tools/view/moods.hpp"
#include "tools/view/navigation.hpp"
#include "tools/view/panels.hpp"
#include "tools/view/photon_map_overlay.hpp"
#include "tools/view/point_worker.hpp"
#include "tools/view/snapshots.hpp"
#include "tools/view/viewpoint.hpp"
#include "tools/view/window.hpp"

namespace photile::view {
namespace {

/// Longest wait for input before the window is drawn again: news of the workers are seen then.
constexpr double redraw_seconds = 1.0 / 60;
/// After the last motion, frames stay small for so long: hands pause.
constexpr double settling_seconds = 0.15;
constexpr std::size_t frames_in_graph = 120;

/// A part of the scene's size that is walked in a second, and that lies ahead when orbiting.
constexpr double walked_share = 0.15, orbit_share = 0.3;

class Viewer {
 public:
  Viewer(const Scene& scene, const Camera& camera, const LightMix& mix,
         PhotonWorker::OpenDevices open_devices, ViewerParameters parameters)
      : scene_(scene),
        parameters_(std::move(parameters)),
        open_devices_(std::move(open_devices)),
        lights_(mix),
        moods_(parameters_.moods.empty() ? Moods::file_of(scene.source) : parameters_.moods),
        viewpoint_(camera),
        navigation_(walked_share * bounding_sphere(scene).radius,
                    orbit_share * bounding_sphere(scene).radius),
        window_(fmt::format("{} - photile", scene.source.filename().string()),
                parameters_.render.film.width, parameters_.render.film.height),
        inspector_(scene),
        points_(scene),
        frames_(parameters_.render.film.samples_per_pixel, parameters_.frames_per_second) {
    if (!parameters_.preview.empty()) {
      preview_.emplace(parameters_.preview, scene.source.filename().string(), mix,
                       *parameters_.notes);
    }
    display_.view = parameters_.view;
    build_maps(std::exchange(parameters_.prepared, std::nullopt), parameters_.keep);
  }

  void run() {
    while (!window_.should_close() && !parameters_.interrupted()) {
      window_.begin_frame(redraw_seconds);
      take_keys();
      follow_input();
      const bool new_frame = take_frame();
      take_errors();
      picked_ = pick_triangle();
      measure_clicked();
      PanelEvents events = panels_shown_ ? show_panels() : PanelEvents();
      events.lights_changed |= std::exchange(lights_restored_, false);
      if (events.expose && frame_) set_exposure();
      if (frame_ && (new_frame || events.lights_changed || events.display_changed ||
                     events.expose || picked_)) {
        DisplayedFrame shown = display(*frame_, lights_.mix(), display_);
        if (display_.photon_map) inspector_.draw(*frame_, shown);
        window_.set_picture(shown.width, shown.height, shown.rgb);
      }
      // A quick frame holds no lamps: it is drawn anew by the nodes.
      relit_ = events.lights_changed && frame_ && !frame_->mixed.empty();
      exposed_ = exposed_ || events.display_changed || (frame_ && events.lights_changed);
      if (preview_ && frame_ && (new_frame || events.lights_changed)) show_preview();
      if (events.maps_changed) build_maps(std::nullopt, {});
      if (!events.mood_to_scene.empty()) write_scene(events.mood_to_scene);
      if (events.removed_point > 0) points_.remove(events.removed_point);
      if (events.keep_points) keep_points();
      window_.draw_frame();
      keep_screenshot();
      window_.show_frame();
      if (parameters_.redrawn) {
        parameters_.redrawn({frame_.get(), new_frame, was_moving_});
      }
    }
    photons_.reset();
    const std::shared_ptr<MapGeneration> maps = frames_.stop();
    if (!parameters_.keep_light_maps || !maps) return;
    if (maps->emitted_photons != parameters_.render.photons.emitted_photons) return;
    if (const auto light_maps = maps->renderer->light_maps()) {
      parameters_.keep_light_maps(*light_maps);
    }
  }

 private:
  void build_maps(std::optional<PreparedPhotons> prepared, KeepPhotons keep) {
    photons_.reset();  // ends what it is at
    photons_.emplace(
        scene_, open_devices_, parameters_.render, std::move(prepared), std::move(keep),
        [this,
         bounded = std::shared_ptr<MapGeneration>()](std::shared_ptr<MapGeneration> maps) mutable {
          if (maps != bounded) {  // else frames are drawn from it by now
            maps->renderer->bound_light_maps(parameters_.light_map_bytes);
          }
          bounded = maps;
          frames_.use(std::move(maps));
        });
  }

  void take_keys() {
    const ImGuiIO& io = ImGui::GetIO();
    if (io.WantTextInput) return;
    if (ImGui::IsKeyPressed(GLFW_KEY_F2, false)) panels_shown_ = !panels_shown_;
    screenshot_wanted_ = ImGui::IsKeyPressed(GLFW_KEY_F12, false);
    if (io.KeyCtrl && ImGui::IsKeyPressed(GLFW_KEY_Q, false)) window_.close();
    if (io.KeyCtrl && ImGui::IsKeyPressed(GLFW_KEY_S, false)) keep_frame();
    if (io.KeyCtrl && ImGui::IsKeyPressed(GLFW_KEY_Z, true)) {
      lights_restored_ = io.KeyShift ? history_.redo(lights_) : history_.undo(lights_);
    }
    if (io.KeyCtrl && ImGui::IsKeyPressed(GLFW_KEY_Y, true)) {
      lights_restored_ = history_.redo(lights_);
    }
  }

  /// Asks for frames of where the viewer is by now.
  void follow_input() {
    const double now = glfwGetTime();
    const bool moved = navigation_.update(viewpoint_);
    if (moved) last_motion_ = now;
    const bool moving = last_motion_ && now - *last_motion_ < settling_seconds;
    const int width = window_.width(), height = window_.height();
    const bool reflections = display_.mode == DisplayMode::glare;
    if (moved || relit_ || moving != was_moving_ || reflections != had_reflections_ ||
        width != asked_width_ || height != asked_height_) {
      // A window that is made small to nothing keeps its last picture.
      if (width > 0 && height > 0) {
        // Layers are needed for all but the picture itself.
        const bool quick = display_.mode == DisplayMode::picture && !display_.photon_map;
        frames_.show({viewpoint_.camera(), width, height, moving, reflections,
                      quick ? scales_of(lights_.mix()) : std::vector<glm::vec3>()});
      }
      was_moving_ = moving;
      had_reflections_ = reflections;
      asked_width_ = width;
      asked_height_ = height;
    }
    double x = 0, y = 0;
    clicked_ = navigation_.clicked(x, y);
    if (clicked_) {
      const ImVec2 size = ImGui::GetIO().DisplaySize;
      probe_ = Probe{x / static_cast<double>(size.x), y / static_cast<double>(size.y)};
    }
  }

  /// Whether a click has picked a triangle whose photons are to be shown.
  bool pick_triangle() {
    if (!clicked_ || !display_.photon_map || !frame_ || !probe_) return false;
    inspector_.pick(*frame_, probe_->x, probe_->y);
    return true;
  }

  /// A click is a measurement, unless it asks for a triangle's photons.
  void measure_clicked() {
    if (!clicked_ || display_.photon_map || !frame_ || !probe_) return;
    if (const auto place = inspector_.place_at(*frame_, probe_->x, probe_->y)) {
      points_.add(place_in_world(scene_, place->position),
                  direction_in_world(scene_, place->normal));
    }
  }

  void keep_points() {
    const std::vector<ClickedPoint> points = points_.points();
    keep("points", ".pts",
         [&](const std::filesystem::path& file) { write_file(file, points_text(points)); });
    keep("points", ".csv", [&](const std::filesystem::path& file) {
      write_file(file, points_csv(points, lights_.mix(), point_settings_.maintenance));
    });
  }

  /// Frames of a moving viewer are too many to be of use elsewhere, or too small.
  void show_preview() {
    const int width = frame_->layers.width, height = frame_->layers.height;
    if (was_moving_ || width != window_.width() || height != window_.height()) return;
    if (frame_->mixed.empty()) {
      preview_->picture(frame_->layers, lights_.mix());
    } else {
      preview_->picture(width, height, frame_->mixed);
    }
  }

  void write_scene(const std::string& mood) {
    try {
      LightBoard board = lights_;
      for (LightControl& control : board.controls()) control.solo = false;
      moods_.apply(mood, board);
      const scene_io::EditedScene copy =
          scene_io::write_edited_scene(scene_.source, parameters_.load, board.mix(), mood);
      message_ = fmt::format("{} is written", copy.file.filename().string());
      for (const std::string& line : copy.left_out) message_ += "\n" + line;
    } catch (const Error& error) {
      message_ = error.what();
    }
  }

  /// Whether there is a new frame.
  bool take_frame() {
    std::shared_ptr<const Frame> latest = frames_.latest();
    if (latest == frame_) return false;
    frame_ = std::move(latest);
    milliseconds_.push_back(static_cast<float>(1e3 * frame_->seconds));
    if (milliseconds_.size() > frames_in_graph) milliseconds_.pop_front();
    // Once, so that a lamp that is turned down is seen to be; of coarse pictures, each anew.
    if (!exposed_) set_exposure();
    exposed_ = exposed_ || frame_->mixed.empty();
    window_.set_title(fmt::format("{} - photile: {} of {} samples, {:.4g}M paths",
                                  scene_.source.filename().string(), frame_->samples_per_pixel,
                                  parameters_.render.film.samples_per_pixel,
                                  static_cast<double>(frame_->emitted_photons) / 1e6));
    return true;
  }

  void set_exposure() { display_.exposure = automatic_stops(*frame_, lights_.mix()); }

  /// Before there is a picture an error ends the walkthrough; later ones are told.
  void take_errors() {
    for (const std::exception_ptr& error : {photons_->take_error(), frames_.take_error()}) {
      if (!error) continue;
      if (!frame_) std::rethrow_exception(error);
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
                     scene_};
    const LightBoard before = lights_;
    const PanelEvents events =
        draw_panels(state, {frame_.get(), photons_->progress(), milliseconds_,
                            display_.photon_map ? inspector_.map() : nullptr});
    history_.note(before, events.lights_changed, ImGui::IsAnyItemActive());
    return events;
  }

  void keep_screenshot() {
    if (!screenshot_wanted_) return;
    keep("screenshot", ".png", [&](const std::filesystem::path& file) {
      write_screenshot(file, window_.width(), window_.height(), window_.read_pixels());
    });
  }

  void keep_frame() {
    if (!frame_ || !frame_->mixed.empty()) return;
    keep("view", ".exr", [&](const std::filesystem::path& file) {
      write_frame(file, scene_, *frame_, lights_.mix());
    });
  }

  template <class Write>
  void keep(const std::string& stem, const std::string& extension, const Write& write) {
    try {
      const std::filesystem::path file = free_name(parameters_.outputs, stem, extension);
      write(file);
      message_ = fmt::format("{} is kept", file.filename().string());
    } catch (const Error& error) {
      message_ = error.what();
    }
  }

  const Scene& scene_;
  ViewerParameters parameters_;
  const PhotonWorker::OpenDevices open_devices_;
  LightBoard lights_;
  LightHistory history_;
  Moods moods_;
  DisplaySettings display_;
  Viewpoint viewpoint_;
  Navigation navigation_;
  Window window_;
  PhotonInspector inspector_;
  PointWorker points_;
  PointSettings point_settings_;
  std::optional<image::LivePreview> preview_;
  std::optional<Probe> probe_;
  std::string message_, new_mood_;
  std::shared_ptr<const Frame> frame_;
  std::deque<float> milliseconds_;
  std::optional<double> last_motion_;  ///< GLFW's clock, seconds
  bool was_moving_ = false, had_reflections_ = false, clicked_ = false, picked_ = false;
  int asked_width_ = 0, asked_height_ = 0;
  bool relit_ = false, exposed_ = false, lights_restored_ = false;
  bool panels_shown_ = true, screenshot_wanted_ = false;
  FrameWorker frames_;
  std::optional<PhotonWorker> photons_;  // last: it delivers to frames_
};

}  // namespace

void run_viewer(const Scene& scene, const Camera& camera, const LightMix& mix,
                PhotonWorker::OpenDevices open_devices, ViewerParameters parameters) {
  Viewer(scene, camera, mix, std::move(open_devices), std::move(parameters)).run();
}

}  // namespace photile::view
