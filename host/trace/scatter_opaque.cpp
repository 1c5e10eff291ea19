#include <algorithm>
#include <cmath>

#include "photile/device/bsdf.h"
#include "trace/ggx.hpp"
#include "trace/sampling.hpp"
#include "trace/scatter.hpp"

namespace photile::trace {

namespace {

float largest(const glm::vec3& v) { return std::max({v.x, v.y, v.z}); }

glm::vec3 sample_lambertian(const glm::vec3& normal, const RandomBlock& random) {
  return Frame(normal).to_world(
      sample_cosine_hemisphere(random.uniform(direction_word), random.uniform(direction_word + 1)));
}

/// Both lobes. The photon comes from `incoming`; photons are traced along the adjoint of the
/// radiance estimate, which multiplies f by flux per geometric area, so the weight is
/// f (geometric cosine of the outgoing direction) / density.
std::optional<Scattered> scatter_glossy(const SurfacePoint& point, const Material& material,
                                        const glm::vec3& albedo, const glm::vec3& shading,
                                        const glm::vec3& incoming, const RandomBlock& random) {
  const Frame frame(shading);
  const float alpha = std::clamp(material.roughness, PHOTILE_MIN_GGX_ALPHA, 1.0f);
  const glm::vec3 in = frame.to_local(incoming);
  const float n_dot_in = std::max(in.z, 1e-6f);

  const float base = largest(material.specular);
  const float specular_albedo = base + (1.0f - base) * photile_schlick(n_dot_in);
  const float diffuse_albedo = (1.0f - specular_albedo) * largest(albedo);
  const float specular_share = specular_albedo / (specular_albedo + diffuse_albedo);

  glm::vec3 direction;
  if (random.uniform(choice_word) < specular_share) {
    const glm::vec3 half = sample_ggx_visible_normal(in, alpha, random.uniform(direction_word),
                                                     random.uniform(direction_word + 1));
    direction = glm::normalize(frame.to_world(2.0f * glm::dot(in, half) * half - in));
  } else {
    direction = sample_lambertian(point.normal, random);
  }
  const float cosine = glm::dot(direction, point.normal);
  if (!(cosine > 0.0f)) return std::nullopt;

  const glm::vec3 out = frame.to_local(direction);
  const glm::vec3 half = glm::normalize(in + out);
  const float lobe = photile_ggx_lobe(n_dot_in, out.z, half.z, alpha);
  const float schlick = photile_schlick(glm::dot(in, half));
  const float density = specular_share * ggx_reflection_density(n_dot_in, half.z, alpha) +
                        (1.0f - specular_share) * cosine / PHOTILE_PI;
  if (!(density > 0.0f)) return std::nullopt;
  Scattered scattered{direction, glm::vec3(0.0f)};
  for (int c = 0; c < 3; ++c)
    scattered.weight[c] =
        photile_opaque_bsdf(albedo[c], material.specular[c], schlick, lobe) * cosine / density;
  return scattered;
}

}  // namespace

std::optional<Scattered> scatter_opaque(const Scene& scene, const SurfacePoint& point,
                                        const glm::vec3& direction, const RandomBlock& random) {
  const Material& material = material_of(scene, point);
  const glm::vec3 albedo = diffuse_albedo(scene, point);
  if (!material.glossy()) return Scattered{sample_lambertian(point.normal, random), albedo};
  return scatter_glossy(point, material, albedo, shading_normal(scene, point, direction),
                        -direction, random);
}

}  // namespace photile::trace
