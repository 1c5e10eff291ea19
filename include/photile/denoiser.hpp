// An optional last step of a picture: Open Image Denoise, where its library is found at run time.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <memory>
#include <string>
#include <vector>

#include "photile/camera.hpp"
#include "photile/light_layers.hpp"
#include "photile/ray_scene.hpp"
#include "photile/renderer.hpp"

namespace photile {

/// What leads a denoiser over edges: means of each pixel, row by row from the top. Mirrors and
/// glass show what is seen by them, in their tint.
struct DenoisingGuides {
  std::vector<glm::vec3> albedo;  ///< in [0, 1]; 1 where a lamp or the surroundings are seen
  std::vector<glm::vec3> normal;  ///< in world space, of the mean of the samples, not longer than 1
};

/// The guides of a picture.
///   film   its size; at most defaults::denoising_samples of its samples are traced
DenoisingGuides denoising_guides(const RayScene& rays, const Camera& camera, const Film& film,
                                 std::uint64_t seed);

/// A loaded library of Open Image Denoise 2, and its device on the processor
/// (https://www.openimagedenoise.org/documentation.html).
class Denoiser {
 public:
  /// Loads the library.
  ///   library   name or path of the shared library, as the dynamic linker takes it
  ///   threads   0 = all cores
  /// Errors: UsageError where there is none, it lacks a function, or has no device.
  explicit Denoiser(const std::filesystem::path& library, int threads = 0);
  ~Denoiser();

  /// "Open Image Denoise 2.3.0".
  const std::string& version() const { return version_; }

  /// The layers with the radiance of each denoised on its own, led by the guides; the illuminance
  /// as it is. What a layer has does not depend on the powers of lamps, so that mixing stays
  /// linear; but the sum of denoised layers is not the denoised sum. A plane for each light: 16
  /// bytes per pixel and light.
  ///   errors   standard errors of the layers, where they are known: a value moves by at most
  ///            defaults::denoising_errors of them. Null: by any amount
  /// Errors: DeviceError of the library.
  LightLayers denoised(const LightLayers& layers, const DenoisingGuides& guides,
                       const LightLayers* errors) const;

 private:
  struct Library;
  std::unique_ptr<Library> library_;
  std::string version_;
};

}  // namespace photile
