#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <future>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "command/command_line.hpp"
#include "command/option_group.hpp"
#include "command/output_files.hpp"
#include "command/processes.hpp"
#include "command/render_options.hpp"
#include "command/run_record.hpp"
#include "command/saved_maps_option.hpp"
#include "command/setting_options.hpp"
#include "command/summary.hpp"
#include "command/terminal_progress.hpp"
#include "common/files.hpp"
#include "gltf/cameras.hpp"
#include "loading/load_scene.hpp"
#include "loading/surroundings.hpp"
#include "photile/errors.hpp"
#include "photile/layered_picture.hpp"
#include "photile/limits.hpp"
#include "photile/progress.hpp"
#include "photile/renderer.hpp"
#include "reading/camera_path.hpp"
#include "view/frame.hpp"
#include "walk/frames.hpp"

namespace photile::app {
namespace {

struct WalkOptions {
  RenderOptions render;
  std::string path;       ///< file; "" = the scene's animation
  std::string animation;  ///< name or index, "" = the first
  std::string output;     ///< EXR pattern
  std::string png;        ///< PNG pattern, "" = none
  std::string sheet;      ///< file, "" = none
  bool quick = false;     ///< frames of light maps alone
  double frames_per_second = 24;
  int first_number = 1;
  std::optional<walk::FrameRange> frames;  ///< none = all
};

reading::CameraMotion motion_of(const WalkOptions& options, const Camera& camera) {
  if (!options.path.empty()) return reading::read_camera_path(options.path, camera);
  try {
    return gltf::read_camera_animation(options.render.scene, options.render.load, camera,
                                       options.animation);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{} (--camera-path)", error.what()));
  }
}

int count_of(const reading::CameraMotion& motion, double frames_per_second) {
  const double count = std::floor((motion.end - motion.begin) * frames_per_second + 1e-6) + 1;
  if (count > limits::max_frames) {
    throw UsageError(fmt::format("{:.0f} frames are more than {}; give fewer with --fps", count,
                                 limits::max_frames));
  }
  return static_cast<int>(count);
}

/// Positions in the walk, from 0, of the frames to be made. Errors: UsageError where there are
/// none.
std::vector<int> frames_to_make(const WalkOptions& options, int count) {
  std::vector<int> frames;
  for (int frame = 0; frame < count; ++frame) {
    if (!options.frames || options.frames->contains(options.first_number + frame)) {
      frames.push_back(frame);
    }
  }
  if (frames.empty()) {
    throw UsageError(fmt::format("--frames: the walk has frames {} to {}; give some of them",
                                 options.first_number, options.first_number + count - 1));
  }
  return frames;
}

/// Frames of a walk, rendered or found finished.
class Walk {
 public:
  Walk(WalkOptions& options, const Scene& scene, const LightMix& mix, const Camera& camera,
       std::span<Device> devices, TerminalProgress& progress)
      : options_(options),
        scene_(scene),
        mix_(mix),
        motion_(motion_of(options, camera)),
        count_(count_of(motion_, options.frames_per_second)),
        frames_(frames_to_make(options, count_)),
        to_exr_(options.output.ends_with(".exr")),
        names_(options.output),
        devices_(devices),
        progress_(progress),
        scene_digest_(digest_of(scene)),
        surfaces_(digest_of_surfaces(scene)) {
    if (!options.png.empty()) png_names_.emplace(options.png);
    if (!to_exr_) png_names_.emplace(options.output);
    for (const int frame : frames_) {
      if (frame == 0) continue;  // check_names has noted it
      if (to_exr_) note_output(names_.of(number(frame)));
      if (png_names_) note_output(png_names_->of(number(frame)));
    }
    if (!options.sheet.empty()) {
      const Film& film = options.render.parameters.film;
      sheet_.emplace(std::min(count_, most_on_sheet), film.width, film.height);
    }
  }

  void run() {
    const std::vector<bool> finished = find_finished();
    const auto kept = static_cast<std::size_t>(std::count(finished.begin(), finished.end(), true));
    if (kept > 0) {
      progress_.note(fmt::format("{} of {} frames are already finished with these settings", kept,
                                 frames_.size()));
    }
    if (kept < frames_.size() || !options_.render.save_maps.empty()) make_maps();
    if (png_names_ && kept < frames_.size() && frames_.front() != 0) expose_by_first();
    progress_.begin("render frames", frames_.size() - kept, "frames");
    for (std::size_t i = 0; i < frames_.size(); ++i) {
      progress_.throw_if_cancelled();
      const int frame = frames_[i];
      const bool keeps = finished[i];
      std::optional<Image> root;
      if (!keeps) root = options_.quick ? draw(frame) : render(frame);
      wait_for_shown();
      if (!leads()) continue;
      const auto keep = [this, frame, root = std::move(root)] {
        if (options_.quick && root && to_exr_) write_exr(names_.of(number(frame)), *root);
        show(frame, root);
      };
      if (options_.quick) {
        shown_ = std::async(std::launch::async, keep);  // while the next one is drawn
      } else {
        keep();
      }
      if (!keeps) progress_.advance(1);
    }
    wait_for_shown();
    progress_.end();
    if (renderer_) keep_light_maps(renderer_->light_maps(), options_.render, progress_);
    if (sheet_ && leads()) write_png(options_.sheet, sheet_->image());
  }

 private:
  static constexpr int most_on_sheet = 100;

  int number(int frame) const { return options_.first_number + frame; }

  /// In the scene's coordinates.
  Camera camera_at(int frame) const {
    return in_scene(scene_, motion_.at(motion_.begin + frame / options_.frames_per_second));
  }

  RunRecord record_of(const Camera& camera) const {
    RunRecord record;
    record.scene = scene_.source.filename().string();
    record.ground = loading::ground_reflectance(options_.render.load);
    record.surfaces = surfaces_;
    record.camera = camera.name;
    record.integrator = "photon-map";
    record.quality = options_.render.quality;
    record.used = options_.render.parameters;
    record.mix = mix_;
    for (const Device& device : devices_) record.devices.push_back(device.info());
    record.device_fractions.assign(devices_.size(), 0.0);
    return record;
  }

  std::string settings_of(const Camera& camera) const {
    return frame_settings(scene_digest_, record_of(camera), camera) +
           (options_.quick ? " quick" : "");
  }

  /// Whether each frame that is to be made exists already.
  std::vector<bool> find_finished() const {
    std::vector<bool> finished(frames_.size(), false);
    if (!to_exr_) return finished;
    if (!leads()) return as_first_says({});
    for (std::size_t i = 0; i < frames_.size(); ++i) {
      progress_.throw_if_cancelled();
      finished[i] = is_finished(names_.of(number(frames_[i])), settings_of(camera_at(frames_[i])));
    }
    return as_first_says(finished);
  }

  /// Displayed with the exposure and white of the walk's first frame, which another process may
  /// make.
  void expose_by_first() {
    const std::string file = names_.of(number(0));
    const bool there = leads() && to_exr_ && is_finished(file, settings_of(camera_at(0)));
    const bool read = as_first_says({there}).front();
    LightLayers layers;
    expose(read ? read_image(file) : options_.quick ? draw(0) : picture_of(0, layers)->root());
  }

  void expose(const Image& first) {
    const Image* const only = &first;
    shown_as_ = with_one_exposure(shown_as(options_.render.pictures, first), std::span(&only, 1));
  }

  void make_maps() {
    std::optional<TracedPhotons> prepared = load_maps(scene_, options_.render, progress_);
    renderer_.emplace(scene_, devices_, options_.render.parameters, prepared ? &*prepared : nullptr,
                      keep_maps(scene_, options_.render, progress_), progress_);
    find_white();
  }

  /// The exposure of the first frame, whichever frames are made here: a few pixels of it suffice.
  void find_white() {
    constexpr int rows = 96, samples = 4;
    Film film = options_.render.parameters.film;
    film.width = std::max(1, film.width * rows / film.height);
    film.height = rows;
    film.samples_per_pixel = samples;
    QuietProgress quiet(progress_);
    const RenderResult first = renderer_->render(camera_at(0), film, quiet);
    white_ = white_of_scene(options_.render.pictures, first.layers, scene_, mix_.lumen_per_watt);
  }

  /// Renders a frame to its file and returns its R, G, B.
  Image render(int frame) {
    LightLayers layers;
    const auto picture = picture_of(frame, layers);
    if (!leads()) return {};
    if (!shown_as_) expose(picture->root());
    if (to_exr_) write_exr(names_.of(number(frame)), *picture);
    for (const std::string& line : picture->overflows()) {
      progress_.warn(fmt::format("frame {}: {}", number(frame), line));
    }
    return picture->root();
  }

  /// Stores the layers that it refers to in `layers`.
  std::unique_ptr<LayeredPicture> picture_of(int frame, LightLayers& layers) {
    const Camera camera = camera_at(frame);
    QuietProgress quiet(progress_);
    const Film& film = options_.render.parameters.film;
    RenderResult result = renderer_->render(camera, film, quiet);
    RunRecord record = record_of(camera);
    const std::string settings = settings_of(camera);
    record.used = result.used;
    record.stored_photons = result.stored_photons;
    record.stages = result.statistics;
    layers = std::move(result.layers);
    auto picture = mixed_picture(layers, mix_);
    set_camera_attributes(picture->header(), in_world(scene_, camera), film.width, film.height);
    set_run_attributes(picture->header(), record);
    set_settings(picture->header(), settings);
    image::keep_white(picture->header(), white_);
    return picture;
  }

  /// Errors: those of the code that wrote it.
  void wait_for_shown() {
    if (shown_.valid()) shown_.get();
  }

  /// R, G, B of a frame of light maps alone.
  Image draw(int frame) {
    const Camera camera = camera_at(frame);
    const Film& film = options_.render.parameters.film;
    std::vector<glm::vec3> picture(static_cast<std::size_t>(film.width) *
                                   static_cast<std::size_t>(film.height));
    QuietProgress quiet(progress_);
    renderer_->draw(camera, film, view::scales_of(mix_), std::numeric_limits<double>::infinity(),
                    picture, quiet);
    Image image;
    image.width = film.width;
    image.height = film.height;
    for (int channel = 0; channel < 3; ++channel) {
      std::vector<float>& plane = image.add(std::string(1, "RGB"[channel]));
      for (std::size_t pixel = 0; pixel < picture.size(); ++pixel) {
        plane[pixel] = picture[pixel][channel];
      }
    }
    set_camera_attributes(image, in_world(scene_, camera), film.width, film.height);
    set_run_attributes(image, record_of(camera));
    set_settings(image, settings_of(camera));
    image::keep_white(image, white_);
    return image;
  }

  /// The frame as PNG and on the contact sheet, all as the first.
  void show(int frame, std::optional<Image> root) {
    const int place = walk::place_on_sheet(frame, count_, most_on_sheet);
    const bool on_sheet = sheet_ && place >= 0;
    const bool to_png = png_names_ && (root || !is_whole(png_names_->of(number(frame))));
    if (!sheet_ && !png_names_) return;
    if (shown_as_ && !on_sheet && !to_png) return;
    const std::filesystem::path file = names_.of(number(frame));
    if (!root) root = read_image(file);
    if (!shown_as_) expose(*root);
    if (!on_sheet && !to_png) return;
    const Image displayed = tone_map(*root, *shown_as_);
    if (to_png) write_png(png_names_->of(number(frame)), displayed);
    if (on_sheet) sheet_->add(place, displayed);
  }

  const WalkOptions& options_;
  const Scene& scene_;
  const LightMix& mix_;
  const reading::CameraMotion motion_;
  const int count_;  ///< of the whole walk
  const std::vector<int> frames_;
  const bool to_exr_;
  const walk::FrameNames names_;
  std::optional<walk::FrameNames> png_names_;
  std::span<Device> devices_;
  TerminalProgress& progress_;
  const std::string scene_digest_, surfaces_;
  std::optional<SceneRenderer> renderer_;
  std::optional<walk::ContactSheet> sheet_;
  image::White white_{1, 1, 1};  ///< that all frames keep
  std::optional<ToneMapping> shown_as_;
  std::future<void> shown_;  ///< the frame before; last: it uses all of the above
};

///   off   light maps were refused by name
void check_quick(WalkOptions& options, bool off) {
  const bool to_exr = options.output.ends_with(".exr");
  if (options.quick && off) {
    throw UsageError("--quick draws light maps; leave out light_maps=off");
  }
  if (options.quick) options.render.parameters.light_maps = LightMapMode::on;
  if (!to_exr && !options.png.empty()) {
    throw UsageError("--png: --output already writes PNG; leave out one of them");
  }
}

void check_names(const WalkOptions& options) {
  std::vector<std::filesystem::path> files{
      walk::FrameNames(options.output).of(options.first_number)};
  if (!options.png.empty()) {
    files.push_back(walk::FrameNames(options.png).of(options.first_number));
  }
  if (!options.sheet.empty()) files.emplace_back(options.sheet);
  if (!options.render.save_maps.empty()) files.emplace_back(options.render.save_maps);
  note_inputs_of(options.render);
  note_input(options.path);
  for (const std::filesystem::path& file : files) {
    if (file.has_parent_path()) make_folder(file.parent_path());
  }
  check_outputs(files);
}

void check_share(const WalkOptions& options) {
  if (options.sheet.empty() || !options.frames) return;
  throw UsageError(
      "--contact-sheet shows all frames; leave it out here, and make it when all are finished");
}

void run_walk(WalkOptions& options) {
  handle_signals();
  check_share(options);
  RenderOptions& render = options.render;
  check(render.parameters);
  share_rendering(render);
  check_names(options);

  const ThreadLimit threads(render.threads);
  TerminalProgress progress(render.quiet || !leads());
  const Scene scene = loading::load_scene(render.scene, render.load, progress);
  const LightMix mix = mix_of(scene, render);
  const Camera camera = camera_of(scene, render);
  set_film_size(render.parameters.film, render.size, camera);
  const Camera base = in_world(scene, camera);
  std::vector<Device> devices = devices_for(render, progress);
  tell_scene(scene, mix, render.load, progress);
  Walk(options, scene, mix, base, devices, progress).run();
}

}  // namespace

void add_walk_command(CLI::App& photile) {
  auto options = std::make_shared<WalkOptions>();
  CLI::App* command = photile.add_subcommand(
      "walk", "Render the frames of a moving camera from one set of photon maps");
  const OptionGroup output(*command, "Output"), motion(*command, "Motion");
  output
      .add("-o,--output", options->output, "PATTERN",
           "frames to write, such as frame.####.exr, or .png; a name without #### gets the number "
           "before its ending",
           file_ending_in({".exr", ".png"}))
      ->required();
  output.flag("--quick", options->quick,
              "draw only light maps, as the live page does while its viewer moves: matt surfaces, "
              "no layers");
  output.add("--png", options->png, "PATTERN.png", "frames as PNG, with the exposure of the first",
             file_ending_in({".png"}));
  add_exposure_option(output, options->render.pictures.tone_mapping.exposure);
  add_white_option(output, options->render.pictures.white);
  output.add("--contact-sheet", options->sheet, "FILE.png", "all frames on one PNG",
             file_ending_in({".png"}));
  CLI::Option* path = motion.add("--camera-path", options->path, "FILE",
                                 "keyframes of the camera as JSON; default: the scene's animation");
  motion
      .add("--animation", options->animation, "NAME|INDEX",
           "animation of a glTF scene; default: the first that moves the camera")
      ->excludes(path);
  motion
      .add("--fps", options->frames_per_second, "X", "frames per second of the motion",
           positive_number())
      ->capture_default_str();
  motion
      .add("--first-number", options->first_number, "N", "number of the first frame",
           count_between(0, limits::max_frames))
      ->capture_default_str();
  motion.call(
      "--frames",
      [&frames = options->frames](const std::string& text) {
        frames = walk::parse_frame_range(text);
      },
      "A[-B[xS]]", "frames to render, by number: A to B, every S-th", frame_range());
  set_quality(options->render.quality_options(), Quality::good);
  add_picture_settings(*command, options->render,
                       {display_view_setting(options->render.pictures.tone_mapping),
                        white_balance_setting(options->render.pictures)});
  add_saved_maps_options(*command, options->render);
  command->callback([options] {
    check_quick(*options, options->render.parameters.light_maps == LightMapMode::off);
    run_walk(*options);
  });
}

}  // namespace photile::app
