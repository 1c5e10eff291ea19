// What pages are told, and what they ask for.
#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

#include "common/ascii_text.hpp"
#include "common/json_object.hpp"
#include "photile/errors.hpp"
#include "photile/limits.hpp"
#include "serve/live_room.hpp"
#include "serve/page_requests.hpp"
#include "view/light_board.hpp"

namespace photile::serve {
namespace {

using nlohmann::json;

/// Seconds that a page waits for news before it is told that there are none.
constexpr auto news_wait = std::chrono::milliseconds(500);
constexpr std::size_t longest_name = 100;
/// Points of one viewer that are measured.
constexpr std::size_t most_points = 99;

}  // namespace

/// What one page has been told.
class LiveRoom::News : public NewsSource {
 public:
  News(LiveRoom& room, std::string viewer, int edition) : room_(room), viewer_(std::move(viewer)) {
    const std::lock_guard lock(room_.mutex_);
    Viewer& listening = room_.viewers_[viewer_];
    ++listening.pages;
    listening.edition = edition;
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
    const std::shared_ptr<LiveLight>& light = room_.edition_.light;
    if (viewer.edition != room_.edition_.number) {  // the page shows what it has until then
      tell("stale", true);
      if (light->version() > 0) tell("reload", true);
      return news.empty() ? "" : news.dump();
    }
    if (light) tell("light", light->version());
    tell("settings", settings_of(room_.parameters_.render));
    if (room_.parameters_.luminaires) tell("luminaires", room_.parameters_.luminaires->state());
    if (room_.year_.possible()) {
      tell("year", {{"running", room_.year_.running()}, {"lines", room_.year_.lines()}});
    }
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

/// Moods that name lights which are gone are left out.
void LiveRoom::find_presets() {
  const LightMix& mix = edition_.mix;
  std::vector<publish::Preset> presets{{"As opened", mix, {}}};
  for (const std::string& name : moods_.names()) {
    try {
      presets.push_back(publish::preset_of(name, mix, moods_.changes(name, mix)));
    } catch (const UsageError& error) {
      message_ = error.what();
    }
  }
  presets_ = publish::to_json(presets);
}

std::unique_ptr<NewsSource> LiveRoom::listen(const WebRequest& request) {
  return std::make_unique<News>(*this, request.viewer.substr(0, longest_name),
                                parse_number<int>(request.since).value_or(1));
}

std::optional<WebReply> LiveRoom::answer(const WebRequest& request) {
  constexpr const char* bytes = "application/octet-stream";
  const json body = request.posts ? parsed(request.body) : json();
  std::unique_lock lock(mutex_);
  if (!request.posts && request.what.empty()) {
    news_.wait_for(lock, std::chrono::seconds(30), [&] { return !edition_.page.empty(); });
    return WebReply{"text/html; charset=utf-8", edition_.page};
  }
  const auto viewer = viewers_.find(request.viewer);
  if (viewer == viewers_.end()) return std::nullopt;
  if (viewer->second.edition != edition_.number) return WebReply{};  // it is told to load again
  if (!request.posts) {
    if (request.what == "light" && edition_.light) {
      const std::shared_ptr<const LiveLight> light = edition_.light;
      lock.unlock();
      return WebReply{bytes, light->since(parse_number<std::uint64_t>(request.since).value_or(0))};
    }
    const std::shared_ptr<const view::Frame> picture = viewer->second.picture;
    if (request.what != "picture" || !picture) return std::nullopt;
    lock.unlock();
    return WebReply{bytes, picture_bytes(*picture)};
  }
  json answer = json::object();
  if (request.what == "view") {
    viewer->second.request = view_in(body, edition_.mix);
    viewer->second.done = viewer->second.request.moving;
    viewer->second.picture = nullptr;
    show(viewer->first);
  } else if (request.what == "lamps") {
    lamps_ = body;
    lamps_by_ = viewer->first;
    ++lamps_number_;
  } else if (request.what == "point") {
    point(viewer->second, body);
  } else if (request.what == "moods" && body.contains("write")) {
    const std::string name = JsonObject(body, "mood", {"write"}).text("write", "");
    SceneLoadOptions load = parameters_.load;
    if (parameters_.luminaires) load.luminaires_text = parameters_.luminaires->text();
    const view::Moods moods = moods_;
    const std::shared_ptr<const Scene> scene = edition_.scene;
    const view::LightBoard board(edition_.mix);
    lock.unlock();
    answer["message"] = view::write_mood(*scene, load, board, moods, name);
    return WebReply{"application/json", json_text(answer, -1)};
  } else if (request.what == "moods") {
    change_moods(body);
  } else if (request.what == "luminaires" && parameters_.luminaires) {
    answer = parameters_.luminaires->edit(body);
  } else if (request.what == "year" && year_.possible()) {
    year_.start();
  } else if (request.what == "settings") {
    change_settings(body);
  } else if (request.what == "exr" || request.what == "glare") {
    const JsonObject asked(body, request.what, {"mix", "limit"});
    const std::shared_ptr<const view::Frame> picture = viewer->second.picture;
    const bool marks = request.what == "glare";
    if (!picture || (marks && !picture->reflections)) return std::nullopt;
    const LightMix mix =
        mix_of_layers(picture->layers, edition_.mix, lights_in(body, edition_.mix.lights.size()));
    const double limit = marks ? asked.number("limit", 0, limits::max_light_power) : 0;
    if (marks && !(limit > 0)) asked.refuse("'limit' is not above 0");
    lock.unlock();
    if (marks) return WebReply{bytes, glare_bytes(*picture, mix, limit)};
    const image::White white = parameters_.white.value_or(
        white_of_scene(picture->layers, *picture->scene, mix.lumen_per_watt));
    return WebReply{"image/x-exr", exr_of(*picture, mix, white)};
  } else if (request.what == "photons") {
    const JsonObject ray(body, "photons", {"eye", "direction"});
    const glm::dvec3 eye = ray.vector("eye"), direction = direction_in(ray, "direction");
    const auto photons = frame_ ? frame_->photons : nullptr;
    const std::shared_ptr<const Scene> scene = edition_.scene;
    const std::shared_ptr<const LiveLight> light = edition_.light;
    if (!photons || !light) return std::nullopt;
    lock.unlock();
    std::string found = photon_bytes(light->rays(), *photons, eye, direction);
    if (found.empty()) return std::nullopt;
    return WebReply{bytes, std::move(found)};
  } else {
    return std::nullopt;
  }
  ++changes_;
  news_.notify_all();
  return WebReply{"application/json", json_text(answer, -1)};
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
  const glm::dvec3 normal = direction_in(point, "normal");
  viewer.points[number] = points_.add(position_in_world(*edition_.scene, point.vector("place")),
                                      direction_in_world(*edition_.scene, normal));
}

/// Keeps the lamps of a page under a name, or removes a mood.
void LiveRoom::change_moods(const json& body) {
  const JsonObject mood(body, "mood", {"keep", "remove", "lights"});
  const bool keeps = mood.has("keep");
  const std::string name = mood.text(keeps ? "keep" : "remove", "");
  if (name.empty() || name.size() > longest_name) mood.refuse("has no name, or too long a name");
  if (!keeps) {
    moods_.remove(name);
  } else {
    moods_.keep(name, board_in(body.value("lights", json::object()), edition_.mix));
  }
  find_presets();
  ++moods_number_;
}

/// What a page sets of the settings; photons are traced again.
void LiveRoom::change_settings(const json& body) {
  parameters_.render = settings_in(body, parameters_.render);
  settings_changed_ = true;
  traced_as_asked_ = false;
  for (auto& [name, viewer] : viewers_) viewer.done = viewer.request.moving;
}

}  // namespace photile::serve
