#include "command/run_record.hpp"

#include <fmt/format.h>
#include <sys/resource.h>

#include <nlohmann/json.hpp>
#include <span>

#include "command/command_line.hpp"
#include "command/quality_options.hpp"
#include "command/setting_options.hpp"
#include "command/terminal_progress.hpp"
#include "common/content_hash.hpp"
#include "photile/errors.hpp"
#include "render/render_costs.hpp"
#include "scene/scene_queries.hpp"

namespace photile::app {

namespace {

using nlohmann::json;

json stage_json(const StageStatistics& stage) {
  json entry{{"stage", stage.stage},
             {"seconds", stage.seconds},
             {"processor_seconds", stage.processor_seconds},
             {"host_bytes", stage.host_bytes},
             {"device_bytes", stage.device_bytes},
             {"figures", json::object()}};
  for (const auto& [name, value] : stage.figures) entry["figures"][name] = value;
  return entry;
}

json devices_json(const RunRecord& record) {
  json list = json::array();
  for (std::size_t i = 0; i < record.devices.size(); ++i) {
    const DeviceInfo& device = record.devices[i];
    list.push_back({{"id", device.id},
                    {"name", device.name},
                    {"platform", device.platform},
                    {"type", name_of(device.type)},
                    {"driver_version", device.driver_version},
                    {"share", record.device_fractions[i]}});
  }
  return list;
}

std::string devices_text(std::span<const DeviceInfo> devices) {
  std::string text;
  for (const DeviceInfo& device : devices) {
    text += fmt::format("{}{} ({}, driver {})", text.empty() ? "" : "; ", device.name,
                        device.platform, device.driver_version);
  }
  return text;
}

/// "select, 16 wide".
std::string tuning_text(const DeviceInfo& device) {
  const EstimateTuning tuning = shipped_tuning(device);
  return fmt::format("{}, {} wide", name_of(tuning.strategy), tuning.vector_width);
}

/// The values that were given by name; the parameters hold what followed from them.
json asked_json(const RunRecord& record) {
  json asked{{"quality", name_of(record.quality)}};
  for (const GoalOption& goal : goal_options()) {
    if (record.goal.*goal.value > 0) asked[std::string(goal.name)] = record.goal.*goal.value;
  }
  return asked;
}

json parameters_json(const RunRecord& record) {
  json result = settings_json(record.used, record.has_photons());
  result["integrator"] = record.integrator;
  return result;
}

/// The time of compiling is not part of any kernel's time.
json kernels_json(const RunRecord& record) {
  json list = json::array();
  for (const KernelRecord& kernels : record.kernels) {
    json row{{"device", kernels.device},
             {"compiled", kernels.compiled},
             {"cached", kernels.cached},
             {"compile_seconds", kernels.compile_seconds}};
    for (const device::KernelTime& time : kernels.times) {
      row["times"].push_back(
          {{"kernel", time.kernel}, {"launches", time.launches}, {"seconds", time.seconds}});
    }
    list.push_back(std::move(row));
  }
  return list;
}

}  // namespace

void close(RunRecord& record, const TimeTaken& total) {
  record.total = total;
  TimeTaken rest = total;
  for (const StageStatistics& stage : record.stages) {
    rest = rest - TimeTaken{stage.seconds, stage.processor_seconds};
  }
  add_time(record.stages, "everything else", rest);
}

void set_run_attributes(PictureHeader& picture, const RunRecord& record) {
  auto& attributes = picture.attributes;
  attributes["photile.version"] = version_number();
  attributes["photile.scene"] = record.scene;
  attributes["photile.surfaces"] = record.surfaces;
  if (record.ground) {
    attributes["photile.ground_reflectance"] = fmt::format("{:g}", *record.ground);
  }
  attributes["photile.camera"] = record.camera;
  attributes["photile.integrator"] = record.integrator;
  attributes["photile.quality"] = name_of(record.quality);
  for (const GoalOption& goal : goal_options()) {
    if (record.goal.*goal.value == 0) continue;
    attributes["photile." + std::string(goal.name)] =
        fmt::format("{}{}", record.goal.*goal.value, goal.type == "TIME" ? " seconds" : "");
  }
  if (!record.denoiser.empty()) attributes["photile.denoiser"] = record.denoiser;
  for (const Setting& setting : settings()) {
    if (!record.has_photons() && !is_of_any_integrator(setting)) continue;
    attributes["photile." + std::string(setting.name)] = text_with_unit(setting, record.used);
  }
  if (!record.has_photons()) return;
  attributes["photile.photons_stored"] = std::to_string(record.stored_photons);
  attributes["photile.device"] = devices_text(record.devices);
}

json run_json(const RunRecord& record) {
  json result{{"photile", version_number()},
              {"scene", record.scene},
              {"camera", record.camera},
              {"devices", devices_json(record)},
              {"asked", asked_json(record)},
              {"parameters", parameters_json(record)},
              {"lumen_per_watt", record.mix.lumen_per_watt},
              {"lights", json::array()},
              {"stages", json::array()},
              {"total_seconds", record.total.seconds},
              {"total_processor_seconds", record.total.processor_seconds},
              {"peak_host_bytes", peak_host_bytes()}};
  if (record.ground) result["ground_reflectance"] = *record.ground;
  if (!record.denoiser.empty()) result["denoiser"] = record.denoiser;
  if (record.has_photons()) {
    result["photons_stored"] = record.stored_photons;
    result["tuning"] = tuning_text(record.devices.front());
    result["kernels"] = kernels_json(record);
  }
  for (const MixedLight& light : record.mix.lights) {
    result["lights"].push_back({{"name", light.name},
                                {"power", light.power},
                                {"unit", symbol_of(light.unit)},
                                {"tint", {light.tint.r, light.tint.g, light.tint.b}}});
  }
  for (const StageStatistics& stage : record.stages) {
    result["stages"].push_back(stage_json(stage));
  }
  return result;
}

std::uint64_t peak_host_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;  // Linux counts KiB
}

namespace {

constexpr const char* attribute = "photile.settings";

}  // namespace

std::string digest_of_surfaces(const Scene& scene) {
  ContentHash hash;
  scene::add_surfaces(scene, hash);
  return hex(hash.digest());
}

std::string digest_of(const Scene& scene) {
  ContentHash hash;
  scene::add_scene(scene, hash);
  return hex(hash.digest());
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
  return hex(hash.digest());
}

void set_settings(PictureHeader& picture, const std::string& settings) {
  picture.attributes[attribute] = settings;
}

bool is_finished(const std::filesystem::path& picture, const std::string& settings) {
  try {
    const PictureHeader header = read_header(picture);
    const auto found = header.attributes.find(attribute);
    return found != header.attributes.end() && found->second == settings && is_whole(picture);
  } catch (const Error&) {
    return false;  // not there, another program's file, or a damaged one: made anew
  }
}

bool is_whole(const std::filesystem::path& picture) {
  try {
    check_pixels(picture);
    return true;
  } catch (const Error&) {
    return false;
  }
}

}  // namespace photile::app
