// A scene prepared for ray tracing.
#pragma once

#include <cstdint>
#include <memory>

#include "photile/scene.hpp"
#include "photile/scene_needs.hpp"

namespace photile {

/// The scene's triangles in an Embree BVH. Immutable and shared between threads once built.
class RayScene {
 public:
  /// Builds the BVH. `scene` must outlive this object.
  /// Errors: Error(failure) when Embree cannot allocate.
  explicit RayScene(const Scene& scene);
  ~RayScene();
  RayScene(RayScene&&) noexcept;
  RayScene& operator=(RayScene&&) noexcept;

  const Scene& scene() const;
  const SceneNeeds& needs() const;  ///< of the scene, computed once
  std::uint64_t bytes() const;      ///< held by Embree

  struct Impl;

 private:
  friend const Impl& impl_of(const RayScene& scene);

  std::unique_ptr<Impl> impl_;
};

}  // namespace photile
