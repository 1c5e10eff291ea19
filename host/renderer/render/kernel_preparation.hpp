// Kernels compiled while other stages run.
#pragma once

#include <future>
#include <span>

#include "photile/device.hpp"
#include "photile/progress.hpp"
#include "photile/renderer.hpp"
#include "photile/scene.hpp"

namespace photile {

/// Has the kernels of a rendering compiled on a thread of its own. A runtime may compile a kernel
/// within its first launch, so a sample with the needs of the scene is rendered; what a device
/// keeps of it are the kernels.
class KernelPreparation {
 public:
  /// Begins with those devices that have not run any kernel yet. Until wait() returns, nobody else
  /// may use the devices. References are kept.
  ///   lists      of neighbours will be asked for, beside estimates
  ///   caustics   will have estimates of their own
  KernelPreparation(const Scene& scene, std::span<Device> devices,
                    const RenderParameters& parameters, bool lists, bool caustics);

  /// Returns once the kernels are there; at once from the second call on. Errors: DeviceError, but
  /// no DeviceMemoryError: where the sample finds no room, kernels are compiled when they are used.
  void wait();

 private:
  std::future<void> done_;
};

/// Has the kernels compiled that scenes of many triangles want in pictures of the qualities draft
/// and good: of matt and glossy surfaces, with and without normal maps, and of up to
/// max_dense_lights layers. Where kernels are kept between runs, they are there from now on.
void compile_usual_kernels(Device& device, Progress& progress);

}  // namespace photile
