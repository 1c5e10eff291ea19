#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <initializer_list>
#include <span>
#include <utility>
#include <vector>

#include "common/module.hpp"
#include "photile/defaults.hpp"
#include "photile/errors.hpp"
#include "photile/ray_scene.hpp"
#include "photile/renderer.hpp"

namespace photile {

namespace {

constexpr int rows_at_a_time = 64;  ///< bounds the memory of the hits

float mean(const glm::vec3& value) { return (value.x + value.y + value.z) / 3.0f; }

void add(DenoisingGuides& guides, const Scene& scene, const PrimaryHitBatch& batch,
         float sample_weight) {
  const PrimaryHits& hits = batch.hits;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const std::uint32_t pixel = hits.pixel[i];
    const bool glossy = !hits.lobe.empty();
    const glm::vec3 specular = glossy ? hits.lobe[i].specular : glm::vec3(0.0f);
    const glm::vec3 normal =
        glossy ? hits.lobe[i].normal : glm::vec3(face_normal(scene, hits.oriented_face[i]));
    guides.albedo[pixel] += hits.throughput[i] * (hits.diffuse_albedo[i] + specular);
    guides.normal[pixel] += mean(hits.throughput[i]) * normal;
  }
  for (const VisibleEmission& seen : batch.emission) {
    guides.albedo[seen.pixel] += glm::vec3(sample_weight);
  }
}

}  // namespace

DenoisingGuides denoising_guides(const RayScene& rays, const Camera& camera, const Film& film,
                                 std::uint64_t seed) {
  const std::size_t pixels =
      static_cast<std::size_t>(film.width) * static_cast<std::size_t>(film.height);
  DenoisingGuides guides{std::vector<glm::vec3>(pixels, glm::vec3(0.0f)),
                         std::vector<glm::vec3>(pixels, glm::vec3(0.0f))};
  PrimaryHitParameters primary;
  primary.width = film.width;
  primary.height = film.height;
  primary.samples_per_pixel = std::min(film.samples_per_pixel, defaults::denoising_samples);
  primary.seed = seed;
  const float sample_weight = 1.0f / static_cast<float>(primary.samples_per_pixel);
  for (int row = 0; row < film.height; row += rows_at_a_time) {
    const int end = std::min(row + rows_at_a_time, film.height);
    add(guides, rays.scene(), trace_primary_hits(rays, camera, primary, row, end), sample_weight);
  }
  for (glm::vec3& albedo : guides.albedo) {
    albedo = glm::clamp(albedo, glm::vec3(0.0f), glm::vec3(1.0f));
  }
  return guides;
}

// The declarations of the library's C interface (oidn.h of version 2) that are used here.
struct OidnDevice;
struct OidnFilter;

namespace {

constexpr int device_type_cpu = 1;
constexpr int format_float3 = 3;

}  // namespace

struct Denoiser::Library {
  Library(const std::filesystem::path& file, int threads) : module(file) {
    if (!module.error().empty()) {
      throw UsageError(
          fmt::format("--denoise: {}; run 'cmake/fetch.sh denoiser' in photile's source folder, or "
                      "give the library's path: --denoise FOLDER/libOpenImageDenoise.so.2",
                      module.error()));
    }
    find(new_device, "oidnNewDevice", file);
    find(release_device, "oidnReleaseDevice", file);
    find(set_device_int, "oidnSetDeviceInt", file);
    find(get_device_int, "oidnGetDeviceInt", file);
    find(commit_device, "oidnCommitDevice", file);
    find(get_error, "oidnGetDeviceError", file);
    find(new_filter, "oidnNewFilter", file);
    find(release_filter, "oidnReleaseFilter", file);
    find(set_image, "oidnSetSharedFilterImage", file);
    find(set_bool, "oidnSetFilterBool", file);
    find(commit_filter, "oidnCommitFilter", file);
    find(execute_filter, "oidnExecuteFilter", file);
    device = {new_device(device_type_cpu), release_device};
    if (!device)
      throw UsageError(
          fmt::format("--denoise: {} cannot create a device; try another version", file.string()));
    if (threads > 0) set_device_int(device.get(), "numThreads", threads);
    commit_device(device.get());
    check("no device");
  }

  template <class Function>
  void find(Function*& function, const char* name, const std::filesystem::path& file) {
    function = module.find<Function>(name);
    if (!function) {
      throw UsageError(
          fmt::format("--denoise: {} has no {}: it is not a library of Open Image Denoise 2",
                      file.string(), name));
    }
  }

  void check(const char* doing) const {
    const char* message = nullptr;
    if (get_error(device.get(), &message) != 0) {
      throw DeviceError(
          fmt::format("Open Image Denoise: {}: {}", doing, message ? message : "unknown error"));
    }
  }

  std::string version() const {
    return fmt::format("Open Image Denoise {}.{}.{}", get_device_int(device.get(), "versionMajor"),
                       get_device_int(device.get(), "versionMinor"),
                       get_device_int(device.get(), "versionPatch"));
  }

  Module module;
  OidnDevice* (*new_device)(int) = nullptr;
  void (*release_device)(OidnDevice*) = nullptr;
  void (*set_device_int)(OidnDevice*, const char*, int) = nullptr;
  int (*get_device_int)(OidnDevice*, const char*) = nullptr;
  void (*commit_device)(OidnDevice*) = nullptr;
  int (*get_error)(OidnDevice*, const char**) = nullptr;
  OidnFilter* (*new_filter)(OidnDevice*, const char*) = nullptr;
  void (*release_filter)(OidnFilter*) = nullptr;
  void (*set_image)(OidnFilter*, const char*, void*, int, std::size_t width, std::size_t height,
                    std::size_t offset, std::size_t pixel_stride, std::size_t row_stride) = nullptr;
  void (*set_bool)(OidnFilter*, const char*, bool) = nullptr;
  void (*commit_filter)(OidnFilter*) = nullptr;
  void (*execute_filter)(OidnFilter*) = nullptr;
  std::unique_ptr<OidnDevice, void (*)(OidnDevice*)> device{nullptr, nullptr};
};

namespace {

/// Moves what was denoised back to within the known errors of what it was.
void stay_within(std::span<const glm::vec3> before, std::span<const glm::vec3> errors,
                 std::span<glm::vec3> denoised) {
  for (std::size_t i = 0; i < denoised.size(); ++i) {
    const glm::vec3 reach = defaults::denoising_errors * errors[i];
    denoised[i] = glm::clamp(denoised[i], before[i] - reach, before[i] + reach);
  }
}

}  // namespace

Denoiser::Denoiser(const std::filesystem::path& library, int threads)
    : library_(std::make_unique<Library>(library, threads)), version_(library_->version()) {}

Denoiser::~Denoiser() = default;

LightLayers Denoiser::denoised(const LightLayers& layers, const DenoisingGuides& guides,
                               const LightLayers* errors) const {
  LightLayers result = layers.dense();
  const LightLayers known = errors ? errors->dense() : LightLayers();
  const auto width = static_cast<std::size_t>(layers.width);
  const auto height = static_cast<std::size_t>(layers.height);
  using Pixels = std::vector<glm::vec3>;
  Pixels output(width * height);
  /// The filter of these pictures, whose names are the library's.
  const auto filter_of = [&](std::initializer_list<std::pair<const char*, const Pixels*>> images) {
    std::unique_ptr<OidnFilter, void (*)(OidnFilter*)> filter(
        library_->new_filter(library_->device.get(), "RT"), library_->release_filter);
    for (const auto& [name, pixels] : images) {
      // The library only reads what is no output; its interface does not say so.
      library_->set_image(filter.get(), name, const_cast<glm::vec3*>(pixels->data()), format_float3,
                          width, height, 0, 0, 0);
    }
    return filter;
  };
  const auto execute = [&](OidnFilter* filter, const char* failure) {
    library_->commit_filter(filter);
    library_->execute_filter(filter);
    library_->check(failure);
  };
  // Guides of few samples are noisy where a pixel sees several surfaces. The library's authors
  // advise to denoise them first, and to say so: details that they tell are then kept.
  Pixels albedo(width * height), normal(width * height);
  execute(filter_of({{"albedo", &guides.albedo}, {"output", &albedo}}).get(),
          "the albedo was not denoised");
  execute(filter_of({{"normal", &guides.normal}, {"output", &normal}}).get(),
          "the normals were not denoised");
  for (LightLayers::Layer& layer : result.layers) {
    const auto filter = filter_of({{"color", &layer.radiance},
                                   {"albedo", &albedo},
                                   {"normal", &normal},
                                   {"output", &output}});
    library_->set_bool(filter.get(), "hdr", true);
    library_->set_bool(filter.get(), "cleanAux", true);
    execute(filter.get(), "the picture was not denoised");
    if (errors) {
      const auto light = static_cast<std::size_t>(&layer - result.layers.data());
      stay_within(layer.radiance, known.layers[light].radiance, output);
    }
    layer.radiance = output;
  }
  return result;
}

}  // namespace photile
