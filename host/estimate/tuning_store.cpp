#include "estimate/tuning_store.hpp"

#include <cstdint>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>

#include "common/output_file.hpp"
#include "common/run_files.hpp"
#include "device/cache_folder.hpp"
#include "device/cache_key.hpp"
#include "device/program_source.hpp"
#include "estimate/specialisation.hpp"
#include "estimate/tuning.hpp"
#include "photile/errors.hpp"

namespace photile {
namespace estimate {
namespace {

using nlohmann::json;

/// Hash of every kernel whose speed was measured.
std::string kernels_hash() {
  std::string text;
  for (const EstimateStrategy strategy : all_estimate_strategies) {
    Specialisation specialisation;
    specialisation.strategy = strategy;
    text += device::assemble_source(specialisation.kernel_file());
  }
  return device::hash(text).hex();
}

/// Scenes with the same name use the same variant of the kernels.
std::string variant_name(const SceneNeeds& needs) {
  return std::string(needs.light_count > 1 ? "several lights" : "one light") +
         (needs.glossy ? ", glossy" : ", diffuse");
}

json to_json(const EstimateTuning& tuning) {
  return {{"strategy", name_of(tuning.strategy)},
          {"vector_width", tuning.vector_width},
          {"hits_per_item", tuning.hits_per_item},
          {"work_group_size", tuning.work_group_size},
          {"photons_per_cell", tuning.photons_per_cell},
          {"private_distances", tuning.private_distances}};
}

/// Zero, which no tuning allows, for anything but a whole number of some sense: get<int> alone
/// would also take 1e300, whose conversion is undefined. Errors: json::exception where it is
/// missing.
int whole_number(const json& object, const char* name) {
  const json& value = object.at(name);
  const auto number = value.is_number_integer() ? value.get<std::int64_t>() : 0;
  return number > 0 && number <= 1'000'000 ? static_cast<int>(number) : 0;
}

/// Errors: json::exception for anything missing or of another type.
std::optional<EstimateTuning> from_json(const json& object) {
  EstimateTuning tuning;
  const auto word = object.at("strategy").get<std::string>();
  bool known = false;
  for (const EstimateStrategy strategy : all_estimate_strategies) {
    if (name_of(strategy) != word) continue;
    tuning.strategy = strategy;
    known = true;
  }
  tuning.vector_width = whole_number(object, "vector_width");
  tuning.hits_per_item = whole_number(object, "hits_per_item");
  tuning.work_group_size = whole_number(object, "work_group_size");
  object.at("photons_per_cell").get_to(tuning.photons_per_cell);
  object.at("private_distances").get_to(tuning.private_distances);
  if (!known || !tuning_problem(tuning).empty()) return std::nullopt;
  return tuning;
}

/// The tunings of these very kernels by variant; an empty object where the file holds none.
json read_variants(const std::filesystem::path& file) {
  std::error_code error;
  // Nothing but a file: opening a FIFO would hang.
  if (!std::filesystem::is_regular_file(file, error)) return json::object();
  constexpr std::uintmax_t most_bytes = 1u << 20;  // a thousand times what is ever written
  if (std::filesystem::file_size(file, error) > most_bytes || error) return json::object();
  std::ifstream stream(file, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  const json content = json::parse(text, nullptr, false);
  if (!content.is_object() || content.value("kernels", json()) != kernels_hash()) {
    return json::object();
  }
  const json variants = content.value("variants", json());
  return variants.is_object() ? variants : json::object();
}

}  // namespace

std::filesystem::path tuning_file(const std::filesystem::path& folder, const DeviceInfo& device) {
  return folder / ("tuning-" + device::program_key(device, "", "").hex() + ".json");
}

void write_tuning(const std::filesystem::path& file, const SceneNeeds& needs,
                  const EstimateTuning& tuning) {
  json variants = read_variants(file);
  variants[variant_name(needs)] = to_json(tuning);
  const json content = {{"kernels", kernels_hash()}, {"variants", variants}};
  write_file(file, content.dump(2) + "\n");
}

std::optional<EstimateTuning> read_tuning(const std::filesystem::path& file,
                                          const SceneNeeds& needs) {
  try {
    const json variants = read_variants(file);
    const auto found = variants.find(variant_name(needs));
    return found == variants.end() ? std::nullopt : from_json(*found);
  } catch (const json::exception&) {
    return std::nullopt;
  }
}

}  // namespace estimate

void store_tuning(const DeviceInfo& device, const SceneNeeds& needs, const EstimateTuning& tuning) {
  const auto folder = device::persistent_cache_folder();
  if (!folder) {
    throw OutputError(
        "no folder to keep the tuning in; set XDG_CACHE_HOME to a folder that can be written");
  }
  estimate::write_tuning(estimate::tuning_file(*folder, device), needs, tuning);
}

std::optional<EstimateTuning> stored_tuning(const DeviceInfo& device, const SceneNeeds& needs) {
  const auto folder = device::persistent_cache_folder();
  if (!folder) return std::nullopt;
  const auto file = estimate::tuning_file(*folder, device);
  note_input(file);
  return estimate::read_tuning(file, needs);
}

}  // namespace photile
