// Kernels compiled while other stages run.
#pragma once

#include <future>
#include <span>

#include "photile/device.hpp"
#include "photile/progress.hpp"
#include "photile/renderer.hpp"
#include "photile/scene.hpp"

namespace photile {

/// Compiles the kernels of a rendering on its own thread. A runtime may compile a kernel within its
/// first launch, so a sample with the needs of the scene is rendered; only the compiled kernels are
/// kept.
class KernelPreparation {
 public:
  /// Starts on those devices that have not run any kernel yet. Until wait() returns, no other
  /// code may use the devices. References are kept.
  ///   lists      of neighbours will be requested, besides estimates
  ///   caustics   will have separate estimates
  KernelPreparation(const Scene& scene, std::span<Device> devices,
                    const RenderParameters& parameters, bool lists, bool caustics);

  /// Returns once the kernels are ready; immediately from the second call on. Errors: DeviceError,
  /// but not DeviceMemoryError: where there is no memory for the sample, kernels are compiled when
  /// they are used.
  void wait();

 private:
  std::future<void> done_;
};

/// Compiles the kernels that scenes of many triangles need in pictures of the qualities draft and
/// good: of matt and glossy surfaces, with and without normal maps, and of up to max_dense_lights
/// layers. Where kernels are kept between runs, they are available from now on.
void compile_usual_kernels(Device& device, Progress& progress);

}  // namespace photile
