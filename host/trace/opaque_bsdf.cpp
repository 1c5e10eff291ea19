#include "trace/opaque_bsdf.hpp"

#include <algorithm>
#include <cmath>

#include "photile/device/bsdf.h"
#include "trace/ggx.hpp"
#include "trace/scatter.hpp"

namespace photile::trace {

namespace {

float largest(const glm::vec3& v) { return std::max({v.x, v.y, v.z}); }

}  // namespace

OpaqueBsdf::OpaqueBsdf(const Scene& scene, const SurfacePoint& point, const glm::vec3& direction)
    : material_(&material_of(scene, point)),
      albedo_(diffuse_albedo(scene, point)),
      normal_(point.normal) {
  if (material_->glossy()) lobe_ = lobe_of(scene, point, direction);
}

OpaqueBsdf::Lobe OpaqueBsdf::lobe_of(const Scene& scene, const SurfacePoint& point,
                                     const glm::vec3& direction) const {
  const Frame frame(shading_normal(scene, point, direction));
  const glm::vec3 view = frame.to_local(-direction);
  const float n_dot_view = std::max(view.z, 1e-6f);
  const float base = largest(material_->specular);
  const float specular_albedo = base + (1.0f - base) * photile_schlick(n_dot_view);
  const float diffuse_albedo = (1.0f - specular_albedo) * largest(albedo_);
  return {frame, std::clamp(material_->roughness, PHOTILE_MIN_GGX_ALPHA, 1.0f), view, n_dot_view,
          specular_albedo / (specular_albedo + diffuse_albedo)};
}

std::optional<glm::vec3> OpaqueBsdf::sample(const RandomBlock& random) const {
  const float u1 = random.uniform(direction_word), u2 = random.uniform(direction_word + 1);
  glm::vec3 direction;
  if (lobe_ && random.uniform(choice_word) < lobe_->share) {
    const glm::vec3& view = lobe_->view;
    const glm::vec3 half = sample_ggx_visible_normal(view, lobe_->alpha, u1, u2);
    direction = glm::normalize(lobe_->frame.to_world(2.0f * glm::dot(view, half) * half - view));
  } else {
    direction = Frame(normal_).to_world(sample_cosine_hemisphere(u1, u2));
  }
  // A Lambertian direction along the surface differs from it by rounding alone.
  if (lobe_ && !(glm::dot(direction, normal_) > 0.0f)) return std::nullopt;
  return direction;
}

float OpaqueBsdf::density(const glm::vec3& direction) const {
  const float cosine = glm::dot(direction, normal_);
  if (!(cosine > 0.0f)) return 0.0f;
  if (!lobe_) return cosine / PHOTILE_PI;
  const glm::vec3 half = glm::normalize(lobe_->view + lobe_->frame.to_local(direction));
  return lobe_->share * ggx_reflection_density(lobe_->n_dot_view, half.z, lobe_->alpha) +
         (1.0f - lobe_->share) * cosine / PHOTILE_PI;
}

glm::vec3 OpaqueBsdf::reflected(const glm::vec3& direction) const {
  const float cosine = glm::dot(direction, normal_);
  if (!(cosine > 0.0f)) return glm::vec3(0.0f);
  if (!lobe_) return albedo_ * (cosine / PHOTILE_PI);
  const glm::vec3 out = lobe_->frame.to_local(direction);
  const glm::vec3 half = glm::normalize(lobe_->view + out);
  const float lobe = photile_ggx_lobe(lobe_->n_dot_view, out.z, half.z, lobe_->alpha);
  const float schlick = photile_schlick(glm::dot(lobe_->view, half));
  glm::vec3 result;
  for (int c = 0; c < 3; ++c)
    result[c] = photile_opaque_bsdf(albedo_[c], material_->specular[c], schlick, lobe) * cosine;
  return result;
}

}  // namespace photile::trace
