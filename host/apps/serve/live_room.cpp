#include "serve/live_room.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <cmath>
#include <glm/gtc/packing.hpp>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "common/ascii_text.hpp"
#include "common/foreign_text.hpp"
#include "common/json_object.hpp"
#include "image/white.hpp"
#include "loading/surroundings.hpp"
#include "photile/errors.hpp"
#include "photile/limits.hpp"
#include "view/light_board.hpp"
#include "view/moving_sky.hpp"

namespace photile::serve {
namespace {

using nlohmann::json;

/// Seconds that a page waits for news before it is told that there are none.
constexpr auto news_wait = std::chrono::milliseconds(500);
/// Pixels on a side of a picture, and bytes of all of its layers.
constexpr int most_side = 8192;
constexpr double most_picture_bytes = 1e9;
constexpr std::size_t longest_name = 100;
/// Points of one viewer that are measured.
constexpr std::size_t most_points = 99;
/// Pixels of the view that light is computed for before a page tells its own.
constexpr int opening_width = 1280, opening_height = 800;
/// The largest exponent of what is sent as half floats.
constexpr int half_exponent = 14;

json parsed(const std::string& body) {
  check_json_depth(body, "request");
  json document = json::parse(body, nullptr, /*allow_exceptions=*/false);
  if (!document.is_object()) throw InputError("request: is no JSON object");
  return document;
}

/// An sRGB colour that tints a light so.
glm::vec3 srgb_of(const glm::dvec3& linear) {
  const double most = std::max({linear.x, linear.y, linear.z, 1e-9});
  glm::vec3 colour;
  for (int c = 0; c < 3; ++c) {
    const double part = std::max(0.0, linear[c] / most);
    colour[c] = static_cast<float>(part <= 0.0031308 ? 12.92 * part
                                                     : 1.055 * std::pow(part, 1 / 2.4) - 0.055);
  }
  return colour;
}

bool is_same(const Camera& a, const Camera& b) {
  return a.position == b.position && a.forward == b.forward &&
         a.vertical_field_of_view == b.vertical_field_of_view;
}

}  // namespace

/// What one page has been told.
class LiveRoom::News : public NewsSource {
 public:
  News(LiveRoom& room, std::string viewer) : room_(room), viewer_(std::move(viewer)) {
    const std::lock_guard lock(room_.mutex_);
    ++room_.viewers_[viewer_].pages;
    room_.visited_ = true;
  }

  ~News() override {
    const std::lock_guard lock(room_.mutex_);
    Viewer& viewer = room_.viewers_[viewer_];
    if (--viewer.pages > 0) return;
    for (const auto& [number, point] : viewer.points) room_.points_.remove(point);
    room_.viewers_.erase(viewer_);
    room_.since_left_ = Stopwatch();
  }

  std::string next() override {
    std::unique_lock lock(room_.mutex_);
    room_.news_.wait_for(lock, news_wait, [&] { return room_.changes_ != changes_; });
    changes_ = room_.changes_;
    const Viewer& viewer = room_.viewers_[viewer_];
    json news = json::object();
    const auto tell = [&](const char* what, json value) {
      if (told_[what] == value) return;
      told_[what] = value;
      news[what] = std::move(value);
    };
    if (room_.light_) tell("light", room_.light_->version());
    if (viewer.picture) tell("picture", viewer.picture_number);
    if (room_.white_is_known_) tell("white", room_.white_);
    tell("work", room_.work_of(viewer));
    if (!room_.message_.empty()) tell("message", room_.message_);
    if (room_.lamps_number_ > lamps_number_) {
      lamps_number_ = room_.lamps_number_;
      if (room_.lamps_by_ != viewer_) news["lamps"] = room_.lamps_;
    }
    if (room_.moods_number_ > moods_number_) {
      moods_number_ = room_.moods_number_;
      news["presets"] = room_.presets_;
    }
    if (!viewer.points.empty()) tell_points(viewer, news);
    return news.empty() ? "" : news.dump(-1, ' ', false, json::error_handler_t::replace);
  }

 private:
  /// The repeats of points that have not been told yet.
  void tell_points(const Viewer& viewer, json& news) {
    const std::vector<view::ClickedPoint> points = room_.points_.points();
    for (const auto& [number, measured] : viewer.points) {
      for (const view::ClickedPoint& point : points) {
        if (point.number != measured) continue;
        std::size_t& told = repeats_[measured];
        if (point.repeats.size() == told) break;
        json repeats = json::array();
        for (std::size_t i = told; i < point.repeats.size(); ++i) {
          json lights = json::array();
          for (const glm::vec3& light : point.repeats[i]) {
            lights.push_back({light.x, light.y, light.z});
          }
          repeats.push_back(std::move(lights));
        }
        news["points"].push_back({{"number", number}, {"from", told}, {"repeats", repeats}});
        told = point.repeats.size();
      }
    }
  }

  LiveRoom& room_;
  const std::string viewer_;
  std::map<std::string, json> told_;
  std::uint64_t changes_ = 0, lamps_number_ = 0, moods_number_ = 0;
  std::map<int, std::size_t> repeats_;  ///< of points
};

LiveRoom::LiveRoom(const Scene& scene, const LightMix& mix,
                   view::PhotonWorker::OpenDevices open_devices, LiveRoomParameters parameters)
    : scene_(scene),
      shared_scene_(std::shared_ptr<void>(), &scene),
      mix_(mix),
      parameters_(std::move(parameters)),
      points_(shared_scene_),
      moods_(parameters_.moods),
      frames_(parameters_.render.film.samples_per_pixel, defaults::view_frames_per_second,
              [this](const Camera& camera, view::MapGeneration& maps, const DrawnFrame& drawn) {
                std::shared_ptr<LiveLight> light;
                {
                  const std::lock_guard lock(mutex_);
                  light = light_;
                }
                if (light) light->take(camera, maps, drawn.lacking == 0);
              }),
      photons_(std::move(open_devices), parameters_.light_map_bytes) {
  publish::check_materials(scene);
  presets_ = presets();
  std::vector<double> powers;
  for (const MixedLight& light : mix_.lights) powers.push_back(mix_.lumens_of(light));
  if (parameters_.white_balance) {
    white_ = parameters_.white ? *parameters_.white : image::white_of_light(powers, mix_);
  }
  photons_.trace(shared_scene_, parameters_.render, std::nullopt, {});
}

void LiveRoom::make_page() {
  const auto light = std::make_shared<LiveLight>(scene_, mix_.lights.size(), [this] { changed(); });
  ToneMapping display;
  display.view = parameters_.view;
  display.white = white_;
  std::string page = publish::page_text({.scene = scene_,
                                         .atlas = light->atlas(),
                                         .light = nullptr,
                                         .mix = mix_,
                                         .node_errors = nullptr,
                                         .presets = {},
                                         .hours = publish::sky_hours(mix_, parameters_.situation),
                                         .display = display,
                                         .title = parameters_.title,
                                         .version = parameters_.version});
  const std::lock_guard lock(mutex_);
  light_ = light;
  page_ = std::move(page);
  moods_number_ = 1;
  if (shown_.empty()) {  // light for the first page, before it tells where it looks
    view::FrameRequest request;
    request.camera = publish::opening_camera(scene_);
    request.width = opening_width;
    request.height = opening_height;
    request.powers = view::scales_of(mix_);
    frames_.show(request);
  }
  ++changes_;
  news_.notify_all();
}

void LiveRoom::changed() {
  const std::lock_guard lock(mutex_);
  ++changes_;
  news_.notify_all();
}

void LiveRoom::step() {
  if (std::shared_ptr<view::MapGeneration> maps = photons_.take()) {
    if (!maps->renderer->reads_light_maps()) {
      throw UsageError("a live page needs light maps, which these settings do without");
    }
    frames_.use(std::move(maps));
  }
  take_errors();
  const std::lock_guard lock(mutex_);
  take_frame();
  const auto current = viewers_.find(shown_);
  if (current != viewers_.end() && !current->second.done) return;
  for (auto& [name, viewer] : viewers_) {
    if (!viewer.done && viewer.request.width > 0) return show(name);
  }
}

/// Makes frames for a viewer from now on.
void LiveRoom::show(const std::string& viewer) {
  shown_ = viewer;
  frames_.show(viewers_[viewer].request);
}

void LiveRoom::take_frame() {
  const std::shared_ptr<const view::Frame> latest = frames_.latest();
  if (!latest || latest == frame_) return;
  frame_ = latest;
  ++changes_;
  news_.notify_all();
  const auto found = viewers_.find(shown_);
  if (found == viewers_.end() || !latest->mixed.empty()) return;
  Viewer& viewer = found->second;
  const view::FrameRequest& asked = viewer.request;
  if (asked.moving || !is_same(asked.camera, latest->camera) ||
      asked.width != latest->layers.width || asked.height != latest->layers.height) {
    return;
  }
  viewer.picture = latest;
  ++viewer.picture_number;
  viewer.done = latest->samples_per_pixel >= parameters_.render.film.samples_per_pixel;
  if (white_is_known_ || asked.mixdown) return;
  white_is_known_ = true;
  if (parameters_.white || !parameters_.white_balance) return;
  white_ = image::white_of(latest->layers, LightMix::of(scene_, mix_.lumen_per_watt));
}

void LiveRoom::take_errors() {
  for (const std::exception_ptr& error : {photons_.take_error(), frames_.take_error()}) {
    if (!error) continue;
    if (!frame_) std::rethrow_exception(error);
    try {
      std::rethrow_exception(error);
    } catch (const std::exception& told) {
      const std::lock_guard lock(mutex_);
      message_ = told.what();
      ++changes_;
    }
  }
}

double LiveRoom::left_alone() const {
  const std::lock_guard lock(mutex_);
  return visited_ && viewers_.empty() ? since_left_.seconds() : 0.0;
}

/// What is under way for a viewer; null once the picture is there.
json LiveRoom::work_of(const Viewer& viewer) const {
  const double lacking = frame_ && !frame_->mixed.empty() ? frame_->lacking : 0.0;
  if (viewer.done && (viewer.picture || lacking == 0)) return nullptr;
  const view::WorkProgress photons = photons_.progress();
  if (!photons.stage.empty()) {
    return {{"stage", photons.stage}, {"share", std::round(100 * photons.share) / 100}};
  }
  return {{"stage", lacking > 0 ? "gather light" : "exact picture"},
          {"share", lacking > 0 ? std::round(100 * (1 - lacking)) / 100 : 0.0}};
}

json LiveRoom::presets() const {
  std::vector<publish::Preset> presets{{"As opened", mix_, {}}};
  for (const std::string& name : moods_.names()) {
    presets.push_back(publish::preset_of(name, mix_, moods_.changes(name, mix_)));
  }
  return publish::to_json(presets);
}

std::unique_ptr<NewsSource> LiveRoom::listen(const std::string& viewer) {
  return std::make_unique<News>(*this, viewer.substr(0, longest_name));
}

std::optional<WebReply> LiveRoom::answer(const WebRequest& request) {
  constexpr const char* bytes = "application/octet-stream";
  std::unique_lock lock(mutex_);
  if (!request.posts) {
    if (request.what.empty()) {
      news_.wait_for(lock, std::chrono::seconds(30), [&] { return !page_.empty(); });
      return WebReply{"text/html; charset=utf-8", page_};
    }
    if (request.what == "light" && light_) {
      const std::shared_ptr<const LiveLight> light = light_;
      lock.unlock();
      return WebReply{bytes, light->since(parse_number<std::uint64_t>(request.since).value_or(0))};
    }
    const auto viewer = viewers_.find(request.viewer);
    if (request.what != "picture" || viewer == viewers_.end() || !viewer->second.picture) {
      return std::nullopt;
    }
    const std::shared_ptr<const view::Frame> frame = viewer->second.picture;
    lock.unlock();
    return WebReply{bytes, picture_bytes(*frame)};
  }
  const auto viewer = viewers_.find(request.viewer);
  if (viewer == viewers_.end()) return std::nullopt;
  const json body = parsed(request.body);
  if (request.what == "view") {
    look(viewer->second, viewer->first, body);
  } else if (request.what == "lamps") {
    lamps_ = body;
    lamps_by_ = viewer->first;
    ++lamps_number_;
  } else if (request.what == "point") {
    point(viewer->second, body);
  } else if (request.what == "moods") {
    change_moods(body);
  } else {
    return std::nullopt;
  }
  ++changes_;
  news_.notify_all();
  return WebReply{"application/json", "{}"};
}

/// Where a viewer looks from now on.
void LiveRoom::look(Viewer& viewer, const std::string& name, const json& body) {
  const JsonObject view(body, "view",
                        {"eye", "forward", "angle", "width", "height", "moving", "sky"});
  const glm::dvec3 eye = view.vector("eye"), forward = view.vector("forward");
  if (!(glm::length(forward) > 0.5)) view.refuse("looks nowhere");
  view::FrameRequest& request = viewer.request;
  request.camera = Camera::look_at(eye, eye + forward, {0, 1, 0}, view.number("angle", 0.01, 3.0));
  request.width = view.count("width", 1, most_side);
  request.height = view.count("height", 1, most_side);
  request.moving = body.value("moving", json()) == true;
  request.powers = view::scales_of(mix_);
  request.mixdown = nullptr;
  std::size_t layers = mix_.lights.size();
  if (view.has("sky")) {
    const std::vector<std::uint32_t> patches = loading::patch_of_layers(mix_);
    const json& sky = body["sky"];
    if (!sky.is_array() || sky.size() != patches.size()) view.refuse("has another sky");
    auto mixdown = std::make_shared<LayerMixdown>();
    mixdown->layer_of.assign(patches.size(), 0);
    mixdown->scale.assign(patches.size(), 1.0f);
    for (std::size_t i = 0; i < patches.size(); ++i) {
      if (patches[i] != none) {
        if (!sky[i].is_number()) view.refuse("has another sky");
        mixdown->scale[i] = sky[i].get<float>();
        continue;
      }
      mixdown->layer_of[i] = static_cast<std::uint32_t>(mixdown->layers.size());
      mixdown->layers.push_back(mix_.lights[i].name);
    }
    for (std::size_t i = 0; i < patches.size(); ++i) {
      if (patches[i] != none) {
        mixdown->layer_of[i] = static_cast<std::uint32_t>(mixdown->layers.size());
      }
    }
    mixdown->layers.emplace_back("sky");
    layers = mixdown->layers.size();
    request.mixdown = std::move(mixdown);
  }
  const double bytes = 16.0 * request.width * request.height * static_cast<double>(layers);
  if (bytes > most_picture_bytes) request.moving = true;  // no exact picture
  viewer.done = request.moving;
  viewer.picture = nullptr;
  show(name);
}

/// A point that a viewer clicked, by the page's number; without a place: it is removed.
void LiveRoom::point(Viewer& viewer, const json& body) {
  const JsonObject point(body, "point", {"number", "place", "normal"});
  const int number = point.count("number", 1, std::numeric_limits<int>::max());
  const auto known = viewer.points.find(number);
  if (known != viewer.points.end()) {
    points_.remove(known->second);
    viewer.points.erase(known);
  }
  if (!point.has("place")) return;
  if (viewer.points.size() == most_points) {
    point.refuse(fmt::format("{} points are measured at most; remove some", most_points));
  }
  const glm::dvec3 normal = point.vector("normal");
  if (!(std::abs(glm::length(normal) - 1) < 0.01)) point.refuse("has no normal of length 1");
  viewer.points[number] = points_.add(position_in_world(scene_, point.vector("place")),
                                      direction_in_world(scene_, glm::normalize(normal)));
}

/// Keeps the lamps of a page under a name, or removes a mood.
void LiveRoom::change_moods(const json& body) {
  const JsonObject mood(body, "mood", {"keep", "remove", "lights"});
  const bool keeps = mood.has("keep");
  const std::string name = mood.text(keeps ? "keep" : "remove", "");
  if (name.empty() || name.size() > longest_name) mood.refuse("has no name, or a long one");
  if (!keeps) {
    moods_.remove(name);
  } else {
    view::LightBoard board(mix_, view::MovingSky::of(mix_, parameters_.situation));
    for (view::LightControl& control : board.controls()) {
      const json lights = body.value("lights", json::object());
      if (!lights.is_object() || !lights.contains(control.name)) continue;
      const JsonObject light(lights[control.name], "mood", {"power", "on", "kelvin", "colour"});
      control.power = light.number("power", 0, limits::max_light_power);
      control.on = lights[control.name].value("on", json()) == true;
      if (light.has("kelvin")) {
        control.kelvin =
            light.number("kelvin", limits::min_color_temperature, limits::max_color_temperature);
      } else if (light.has("colour")) {
        control.color = srgb_of(light.vector("colour"));
      }
    }
    moods_.keep(name, board);
  }
  presets_ = presets();
  ++moods_number_;
}

/// For page/live.js: the length of a JSON text, that text, and half floats: the radiance of each
/// layer, times a power of two, rows from below.
std::string LiveRoom::picture_bytes(const view::Frame& frame) const {
  const LightLayers dense = frame.layers.sparse() ? frame.layers.dense() : LightLayers();
  const LightLayers& layers = frame.layers.sparse() ? dense : frame.layers;
  const auto width = static_cast<std::size_t>(layers.width);
  const auto height = static_cast<std::size_t>(layers.height);
  std::vector<int> exponents;
  for (const LightLayers::Layer& layer : layers.layers) {
    float most = 0;
    for (const glm::vec3& pixel : layer.radiance) {
      most = std::max({most, pixel.x, pixel.y, pixel.z});
    }
    exponents.push_back(most > 0 ? half_exponent - std::ilogb(most) : 0);
  }
  json header{{"width", width},
              {"height", height},
              {"samples", frame.samples_per_pixel},
              {"exponents", exponents}};
  for (const LightLayers::Layer& layer : layers.layers) header["layers"].push_back(layer.light);
  std::string text = json_text(header, -1);
  if (text.size() % 2 != 0) text += ' ';  // what follows lies at an even place
  const std::string start = fmt::format("{:08x}", text.size()) + text;
  std::string bytes(start.size() + layers.layers.size() * height * width * 6, '\0');
  std::copy(start.begin(), start.end(), bytes.begin());
  tbb::parallel_for(std::size_t{0}, layers.layers.size() * height, [&](std::size_t row) {
    const std::size_t layer = row / height, y = height - 1 - row % height;
    const float scale = std::ldexp(1.0f, exponents[layer]);
    char* to = bytes.data() + start.size() + row * width * 6;
    for (std::size_t x = 0; x < width; ++x) {
      const glm::vec3& pixel = layers.layers[layer].radiance[y * width + x];
      for (int c = 0; c < 3; ++c, to += 2) {
        const auto half = std::bit_cast<std::array<char, 2>>(glm::packHalf1x16(scale * pixel[c]));
        std::copy(half.begin(), half.end(), to);
      }
    }
  });
  return bytes;
}

}  // namespace photile::serve
