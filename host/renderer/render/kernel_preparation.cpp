#include "render/kernel_preparation.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "estimate/device_test.hpp"
#include "estimate/photon_estimate.hpp"
#include "photile/errors.hpp"
#include "photile/estimator.hpp"
#include "photile/neighbour_groups.hpp"
#include "photile/photon_maps.hpp"
#include "photile/renderer.hpp"

namespace photile {
namespace {

/// Whether a map may hold photons of different normals that agree: queries then compare normals, by
/// separate kernels. Among many triangles there are always some such.
bool may_mix_normals(const Scene& scene, double angle_degrees) {
  constexpr std::size_t many = 256;
  constexpr double alike = 1 - 1e-4;
  const std::size_t count = scene.triangle_count();
  if (count > many) return true;
  const double least_cosine = std::cos(glm::radians(angle_degrees));
  for (std::uint32_t a = 0; a < count; ++a) {
    for (std::uint32_t b = 0; b < a; ++b) {
      const double cosine = std::abs(
          glm::dot(face_normal(scene, oriented(a, 0)), face_normal(scene, oriented(b, 0))));
      if (cosine >= least_cosine && cosine < alike) return true;
    }
  }
  return false;
}

/// A point of the unit square once the half below its diagonal is turned up by 80 degrees about it:
/// the normals of the halves differ by more than most groups allow, and either's by less from those
/// of a patch that holds both.
glm::vec3 folded(const glm::vec3& point) {
  if (point.x <= point.y) return point;
  const float angle = glm::radians(80.0f), middle = 0.5f * (point.x + point.y);
  const float across = 0.5f * (point.x - point.y);
  return {middle + across * std::cos(angle), middle - across * std::cos(angle),
          std::sqrt(2.0f) * across * std::sin(angle)};
}

///   normal_filtered   some map holds photons of different normals that agree
estimate::PlaneSample sample_of(const SceneNeeds& needs, bool normal_filtered, int neighbours) {
  constexpr estimate::PlaneSampleSize size{.photons = 1000, .hits_per_side = 16};
  estimate::PlaneSample sample = estimate::make_plane_sample(needs, neighbours, size);
  sample.radius = 2;  // the square is one patch
  if (!normal_filtered) return sample;
  for (auto* points : {&sample.scene.vertices, &sample.photons.position, &sample.hits.position}) {
    std::transform(points->begin(), points->end(), points->begin(), folded);
  }
  return sample;
}

bool is_fresh(const Device& device) {
  return device.programs_built() + device.programs_from_cache() == 0;
}

///   lists      lists of neighbours are asked for, too
///   caustics   estimates by their kernel, too
void prepare(Device& device, const estimate::PlaneSample& sample,
             const RenderParameters& parameters, bool lists, bool caustics) {
  try {
    const NeighbourGroups groups = find_map_groups(sample.scene, sample.photons, parameters.maps,
                                                   {sample.radius, parameters.angle_degrees});
    const PhotonMaps maps(device, sample.scene, sample.photons, groups,
                          {sample.radius, parameters.photons_per_cell});
    EstimateParameters estimate{
        .neighbours = parameters.neighbours, .area = parameters.area, .kernel = parameters.kernel};
    Estimator estimator(maps, sample.scene, estimate);
    estimator.estimate(sample.hits);
    if (lists) estimator.nearest(sample.hits);
    if (!caustics) return;
    estimate.kernel = caustic_kernel;
    Estimator(maps, sample.scene, estimate).estimate(sample.hits);
  } catch (const DeviceMemoryError&) {
  }
}

}  // namespace

KernelPreparation::KernelPreparation(const Scene& scene, std::span<Device> devices,
                                     const RenderParameters& parameters, bool lists,
                                     bool caustics) {
  if (std::none_of(devices.begin(), devices.end(), is_fresh)) return;
  done_ = std::async(std::launch::async, [&scene, devices, &parameters, lists, caustics] {
    const SceneNeeds needs = needs_of(scene);
    const estimate::PlaneSample sample =
        sample_of(needs, may_mix_normals(scene, parameters.angle_degrees), parameters.neighbours);
    for (Device& device : devices) {
      if (is_fresh(device)) prepare(device, sample, parameters, lists, caustics);
    }
  });
}

void compile_usual_kernels(Device& device, Progress& progress) {
  const std::array<SceneNeeds, 3> surfaces{
      SceneNeeds{}, {.glossy = true}, {.glossy = true, .normal_maps = true}};
  const std::array qualities{Quality::draft, Quality::good};
  progress.begin("compile kernels", qualities.size() * surfaces.size() * max_dense_lights,
                 "kinds of scenes");
  for (const Quality quality : qualities) {
    RenderParameters parameters;
    set_quality(parameters, quality);
    for (SceneNeeds needs : surfaces) {
      for (needs.light_count = 1; needs.light_count <= max_dense_lights; ++needs.light_count) {
        progress.throw_if_cancelled();
        prepare(device, sample_of(needs, true, parameters.neighbours), parameters, true,
                needs.glossy);
        progress.advance(1);
      }
    }
  }
  progress.end();
}

void KernelPreparation::wait() {
  if (done_.valid()) done_.get();
}

}  // namespace photile
