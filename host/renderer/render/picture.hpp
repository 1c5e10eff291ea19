// A picture in progress: hits, their light, and the film.
#pragma once

#include <span>
#include <vector>

#include "photile/device.hpp"
#include "photile/light_layers.hpp"
#include "photile/ray_scene.hpp"
#include "photile/renderer.hpp"
#include "render/hit_source.hpp"
#include "render/lobe_filter.hpp"
#include "render/photon_passes.hpp"
#include "render/render_costs.hpp"
#include "render/render_plan.hpp"

namespace photile {

/// Computes the light of what is visible, row by row, and adds it to the film.
class Picture {
 public:
  /// References are kept.
  ///   passes    that are added before `finish`
  ///   mixdown   of its layers, before they take memory; null = all layers stay separate
  Picture(const RayScene& rays, const RenderPlan& plan, std::span<Device> devices, const Film& film,
          int passes, const LayerMixdown* mixdown, RenderCosts& costs);

  /// Adds what is seen by the light of the next pass. Errors: those of LightAtPoints.
  void add(const HitSource& source, PassLight& light, Progress& progress);

  /// Returns the picture, which is moved out of this object.
  ///   radius   of the first pass, metres
  RenderResult finish(double radius);

 private:
  bool filters() const { return !lobes_.lobes.empty(); }
  /// The powers at which layers are shown together.
  std::vector<double> powers() const;
  LightLayers black_layers(int columns_per_pixel) const;
  /// Makes the films that are filled beside the picture.
  void begin_film(const HitSource& source);
  /// Adds what rays found in lobes to the film, unless this is already done.
  void add_lobes();
  /// Rows of the film that this process makes.
  PrimaryHitBatch trace_rows(const HitSource& source, const PassLight& light, int first, int last);
  ///   by_lobes   the hits are on surfaces that are seen in lobes
  void add_hits(const HitSource& source, PassLight& light, PrimaryHitBatch& seen, bool by_lobes,
                const Progress& progress);
  /// Leaves the hits with the numbers of their pixels.
  void add_to_lobes(PrimaryHitBatch& seen, const LightTable& estimates);
  double compile_seconds() const;
  LightTotals totals(const PassLight& light) const;

  const RayScene& rays_;
  const Scene& scene_;
  const RenderPlan& plan_;
  std::span<Device> devices_;
  PrimaryHitParameters film_;
  const LayerMixdown* mixdown_;
  RenderCosts& costs_;
  LightLayers layers_;
  LightLayers runs_;  ///< where errors are requested: of each run of a pixel's samples
  LobeFilm lobes_;    ///< where gloss is filtered; otherwise empty
  std::vector<double> fractions_;
  TimeTaken asked_;         ///< for light
  std::uint64_t hits_ = 0;  ///< at which light was requested
};

}  // namespace photile
