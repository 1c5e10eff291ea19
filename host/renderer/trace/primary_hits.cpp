#include <tbb/parallel_for.h>

#include <glm/gtc/constants.hpp>
#include <optional>
#include <string>
#include <utility>

#include "common/touched_memory.hpp"
#include "common/value_range.hpp"
#include "photile/errors.hpp"
#include "photile/light_layers.hpp"
#include "photile/limits.hpp"
#include "photile/ray_scene.hpp"
#include "trace/eye_path.hpp"
#include "trace/hit_batch.hpp"
#include "trace/light_sampler.hpp"
#include "trace/ray_query.hpp"

namespace photile {

namespace {

using trace::EyeRecord;

void check_range(const char* what, std::int64_t value, std::int64_t low, std::int64_t high) {
  if (value < low || value > high)
    throw UsageError(std::string(what) + ": " + std::to_string(value) + " is not between " +
                     std::to_string(low) + " and " + std::to_string(high));
}

void check(const PrimaryHitParameters& film, int first_row, int last_row) {
  check_setting("width", setting_value(film.width));
  check_setting("height", setting_value(film.height));
  check_setting("samples_per_pixel", setting_value(film.samples_per_pixel));
  check_setting("max_specular_depth", setting_value(film.max_specular_depth));
  if (film.direct_rays != 0) check_setting("direct_rays", setting_value(film.direct_rays));
  check_setting("passes", setting_value(film.passes));
  check_range("first row", first_row, 0, film.height);
  check_range("last row", last_row, first_row, film.height);
  check_range("pass", film.pass, 0, film.passes - 1);
  const std::int64_t samples = (film.samples_per_pixel - 1) / film.passes + 1;
  check_range("samples in one batch", std::int64_t{last_row - first_row} * film.width * samples, 0,
              static_cast<std::int64_t>(limits::max_stored_photons));
}

PrimaryHitBatch trace_rows(const RayScene& ray_scene, const Camera& camera,
                           const PrimaryHitParameters& parameters, int first_row, int last_row,
                           std::span<const std::uint32_t> map_of, bool reflections_only) {
  check(parameters, first_row, last_row);
  const std::vector<glm::vec3> radiance = emitted_radiance_at_unit_power(ray_scene.scene());
  const trace::DistantLights distant(ray_scene.scene());
  std::optional<trace::LightSampler> light_sampler;
  std::optional<trace::DirectRays> direct;
  std::optional<trace::LobeRays> lobes;
  const bool lobe_rays = parameters.lobe_rays && !reflections_only;
  if (parameters.direct_rays > 0 || lobe_rays) light_sampler.emplace(ray_scene.scene());
  if (parameters.direct_rays > 0) {
    direct.emplace(trace::DirectRays{ray_scene, *light_sampler, parameters.direct_rays});
  }
  if (lobe_rays) lobes.emplace(trace::LobeRays{ray_scene, *light_sampler});
  const FilmDirections directions = camera.directions(parameters.width, parameters.height);
  const trace::EyeSetup setup{.rays = &impl_of(ray_scene),
                              .film = &directions,
                              .eye = glm::vec3(camera.position),
                              .parameters = &parameters,
                              .emitted_radiance = &radiance,
                              .distant = &distant,
                              .direct = direct ? &*direct : nullptr,
                              .lobes = lobes ? &*lobes : nullptr,
                              .reflections_only = reflections_only};
  std::vector<EyeRecord> rows(static_cast<std::size_t>(last_row - first_row));
  std::vector<EyeRecord> reflected_rows(rows.size());
  tbb::parallel_for(first_row, last_row, [&](int y) {
    const trace::FlushDenormals flush_denormals;
    EyeRecord& row = rows[static_cast<std::size_t>(y - first_row)];
    EyeRecord& reflected = reflected_rows[static_cast<std::size_t>(y - first_row)];
    for (int x = 0; x < parameters.width; ++x) {
      const bool edge = parameters.times_at_edges > 1 && trace::shows_edge(setup, x, y, row);
      const int times = edge ? parameters.times_at_edges : 1;
      for (int sample = parameters.pass; sample < times * parameters.samples_per_pixel;
           sample += parameters.passes) {
        trace::trace_eye_path(setup, x, y, sample, times, row, reflected);
      }
    }
  });

  PrimaryHitBatch batch = trace::batch_of(ray_scene, std::move(rows), parameters.runs, map_of);
  if (!lobe_rays) return batch;
  batch.lobes = joined(
      reflected_rows.size(), [&](std::size_t row) -> const auto& {
        return reflected_rows[row].lobes;
      });
  PrimaryHitBatch reflected =
      trace::batch_of(ray_scene, std::move(reflected_rows), parameters.runs, map_of);
  batch.rays += reflected.rays;
  for (VisibleEmission& seen : reflected.emission) seen.illuminance = 0;  // of another surface
  batch.reflected = std::move(reflected.hits);
  batch.reflected_emission = std::move(reflected.emission);
  return batch;
}

}  // namespace

PrimaryHitBatch trace_primary_hits(const RayScene& ray_scene, const Camera& camera,
                                   const PrimaryHitParameters& parameters, int first_row,
                                   int last_row, std::span<const std::uint32_t> map_of) {
  return trace_rows(ray_scene, camera, parameters, first_row, last_row, map_of, false);
}

PrimaryHitBatch trace::trace_reflected_hits(const RayScene& ray_scene, const Camera& camera,
                                            const PrimaryHitParameters& parameters, int first_row,
                                            int last_row, std::span<const std::uint32_t> map_of) {
  return trace_rows(ray_scene, camera, parameters, first_row, last_row, map_of, true);
}

void PixelLobes::add(const PixelLobes& more) {
  weight += more.weight;
  position += more.position;
  normal += more.normal;
  reflectance += more.reflectance;
  roughness += more.roughness;
}

std::vector<glm::vec3> emitted_radiance_at_unit_power(const Scene& scene) {
  const LightGroups groups = light_groups_of(scene);
  std::vector<glm::vec3> radiance;
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const Light& light = scene.lights[i];
    if (light.emission_texture != none) {
      radiance.push_back(static_cast<float>(groups.fraction[i]) * light.texel_radiance);
      continue;
    }
    double area = 0;
    for (const std::uint32_t triangle : light.triangles) area += triangle_area(scene, triangle);
    if (light.two_sided) area *= 2;
    radiance.push_back(area > 0 ? glm::vec3(glm::dvec3(light.color) * groups.fraction[i] /
                                            (glm::pi<double>() * area))
                                : glm::vec3(0.0f));
  }
  return radiance;
}

}  // namespace photile
