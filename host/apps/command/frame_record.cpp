#include "command/frame_record.hpp"

#include <nlohmann/json.hpp>

#include "common/content_hash.hpp"
#include "photile/errors.hpp"
#include "scene/scene_hash.hpp"

namespace photile::app {
namespace {

constexpr const char* attribute = "photile.settings";

}  // namespace

std::string digest_of(const Scene& scene) {
  ContentHash hash;
  scene::add_scene(scene, hash);
  return hash.hex();
}

std::string frame_settings(const std::string& scene_digest, const RunRecord& record,
                           const Camera& camera) {
  nlohmann::json settings = run_json(record);
  for (const char* other : {"asked", "devices", "stages", "total_seconds",
                            "total_processor_seconds", "peak_host_bytes"}) {
    settings.erase(other);
  }
  ContentHash hash;
  hash.add(scene_digest);
  hash.add(settings.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
  for (const glm::dvec3& v : {camera.position, camera.forward, camera.up, camera.right}) {
    hash.add(v);
  }
  hash.add(camera.vertical_field_of_view);
  return hash.hex();
}

void set_settings(PictureHeader& picture, const std::string& settings) {
  picture.attributes[attribute] = settings;
}

bool is_finished(const std::filesystem::path& picture, const std::string& settings) {
  std::error_code error;
  if (!std::filesystem::exists(picture, error)) return false;
  try {
    const PictureHeader header = read_header(picture);
    const auto found = header.attributes.find(attribute);
    if (found == header.attributes.end() || found->second != settings) return false;
    check_pixels(picture);
    return true;
  } catch (const Error&) {
    return false;  // another program's file, or a damaged one: made anew
  }
}

bool is_whole(const std::filesystem::path& picture) {
  std::error_code error;
  if (!std::filesystem::exists(picture, error)) return false;
  try {
    check_pixels(picture);
    return true;
  } catch (const Error&) {
    return false;
  }
}

}  // namespace photile::app
