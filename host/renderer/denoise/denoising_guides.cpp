#include <algorithm>
#include <vector>

#include "photile/defaults.hpp"
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
        glossy ? hits.lobe[i].normal : glm::vec3(sided_normal(scene, hits.sided_triangle[i]));
    guides.albedo[pixel] += hits.throughput[i] * (hits.diffuse_albedo[i] + specular);
    guides.normal[pixel] += mean(hits.throughput[i]) * normal;
  }
  for (const SeenEmission& seen : batch.emission) {
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

}  // namespace photile
