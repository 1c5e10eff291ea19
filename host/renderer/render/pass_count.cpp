#include "render/pass_count.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <optional>
#include <string>

#include "photile/defaults.hpp"
#include "photile/errors.hpp"
#include "photile/light_layers.hpp"
#include "photile/limits.hpp"

namespace photile {

namespace {

/// Squared radius of pass `pass` over that of the first.
double shrinkage(int pass) {
  double product = 1;
  for (int i = 1; i <= pass; ++i) product *= (i + defaults::pass_alpha) / (i + 1);
  return product;
}

}  // namespace

PassEstimate estimate_of_pass(int pass, const PassEstimate& first) {
  const double factor = shrinkage(pass);
  const int least = std::min(first.neighbours, defaults::least_pass_neighbours);
  const auto neighbours = static_cast<int>(std::lround(first.neighbours * factor));
  return {first.radius * std::sqrt(factor), std::max(neighbours, least)};
}

namespace {

constexpr std::uint64_t unknown = std::numeric_limits<std::uint64_t>::max();

/// The number that follows `label` in a file of lines "label number"; an empty label: at its start.
std::optional<std::uint64_t> number_in(const char* file, const std::string& label) {
  std::ifstream stream(file);
  std::string word;
  while (!label.empty() && stream >> word && word != label) {
  }
  std::uint64_t number = 0;
  if (stream >> number) return number;
  return std::nullopt;
}

std::uint64_t system_bytes() {
  const auto kib = number_in("/proc/meminfo", "MemTotal:");
  return kib ? *kib * 1024 : unknown;
}

std::uint64_t control_group_bytes() {
  return number_in("/sys/fs/cgroup/memory.max", "").value_or(unknown);  // "max" is no number
}

}  // namespace

std::uint64_t installed_host_bytes() { return std::min(system_bytes(), control_group_bytes()); }

std::uint64_t bytes_per_stored_photon(const SceneNeeds& needs) {
  constexpr std::uint64_t copies = 2;      // while arrays are joined and sorted
  constexpr std::uint64_t references = 4;  // an entry repeats the record
  const std::uint64_t record = 3 * sizeof(float) + 3 * sizeof(float) + sizeof(std::uint32_t) +
                               (needs.several_lights() ? sizeof(std::uint16_t) : 0) +
                               (needs.glossy ? 3 * sizeof(float) : 0);
  return (copies + references) * record;
}

int passes_within(std::uint64_t paths, double stored_per_path, std::uint64_t bytes_per_photon,
                  std::uint64_t memory_bytes) {
  const double stored = static_cast<double>(paths) * stored_per_path;
  const double most =
      std::min(static_cast<double>(memory_bytes) / 2 / static_cast<double>(bytes_per_photon),
               // Paths differ: keep a distance to what cannot be indexed.
               0.9 * static_cast<double>(limits::max_stored_photons));
  const double passes = std::ceil(stored / std::max(1.0, most));
  return static_cast<int>(std::clamp(passes, 1.0, 1.0 + limits::max_passes));
}

int automatic_passes(const RayScene& rays, const PhotonTracerParameters& parameters,
                     Progress& progress, std::uint64_t memory) {
  constexpr std::uint64_t few = 10'000;
  if (parameters.emitted_photons <= 10 * few) return 1;  // fits wherever a scene does
  PhotonTracerParameters sample = parameters;
  sample.emitted_photons = few;
  const PhotonTracerResult traced = trace_photons(rays, sample);
  const double stored_per_path =
      static_cast<double>(traced.photons.size() + traced.caustics.size()) /
      static_cast<double>(few);
  const int passes = passes_within(parameters.emitted_photons, stored_per_path,
                                   bytes_per_stored_photon(rays.needs()), memory);
  if (passes > limits::max_passes) {
    throw UsageError(
        fmt::format("{} photons do not fit in {} bytes of memory even in {} passes; "
                    "use fewer photons",
                    parameters.emitted_photons, memory, limits::max_passes));
  }
  if (passes > 1) {
    progress.note(
        fmt::format("{0} photons do not fit in half of {1:.1f} GB of memory: they are traced in "
                    "{2} passes; passes={2} gives the same picture on any machine",
                    parameters.emitted_photons, static_cast<double>(memory) / 1e9, passes));
  }
  return passes;
}

void check_picture_memory(int width, int height, std::size_t lights, double bytes,
                          Progress& progress) {
  constexpr double worth_telling = 1e9;
  if (bytes <= worth_telling) return;
  const std::string found =
      fmt::format("a picture of {} x {} pixels with {} light{} takes {:.1f} GB", width, height,
                  lights, lights == 1 ? "" : "s", bytes / 1e9);
  const auto installed = static_cast<double>(installed_host_bytes());
  if (bytes > installed) {
    throw UsageError(fmt::format(
        "{}, but this machine has {:.1f}; give a smaller size, or group lights by --light-group",
        found, installed / 1e9));
  }
  progress.note(found + " of memory");
}

void check_picture_memory(int width, int height, const Scene& scene, Progress& progress) {
  const std::size_t lights = light_groups_of(scene).groups.size();
  if (lights > max_dense_lights) return;  // each pixel has those that reach it
  check_picture_memory(width, height, lights, 16.0 * width * height * static_cast<double>(lights),
                       progress);
}

}  // namespace photile
