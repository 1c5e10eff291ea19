#include "trace/opaque_bsdf.hpp"

#include <algorithm>
#include <cmath>

#include "photile/device/bsdf.h"
#include "trace/sampling.hpp"
#include "trace/scatter.hpp"

namespace photile::trace {

namespace {

/// One ray a sample is noisy where a lobe is wide and reflects much; photons are where it is
/// narrow.
constexpr float narrow_lobe_alpha = 0.3f, faint_lobe_albedo = 0.25f;

/// Rays of a sample that follow the lobe of a metal; narrower lobes than this scatter so much less.
constexpr float most_lobe_rays = 16, scattering_lobe_alpha = 0.04f;
/// Rays of a lobe that hardly reflects: every other sample has one.
constexpr float least_lobe_rays = 0.5f;
/// A lobe over a dark base is most of what is seen, however little it reflects: it has half as many
/// as a metal whose whole reflection it is.
constexpr float rays_of_share = 0.5f;

}  // namespace

OpaqueBsdf::OpaqueBsdf(const Scene& scene, const SurfacePoint& point, const glm::vec3& direction,
                       PathStart start)
    : surface_(reflectance(scene, point)),
      normal_(point.normal),
      base_normal_(point.normal),
      start_(start) {
  const bool mapped = material_of(scene, point).normal_texture != none;
  if (surface_.f90 > 0.0f || mapped) lobe_ = lobe_of(scene, point, direction);
}

OpaqueBsdf::Lobe OpaqueBsdf::lobe_of(const Scene& scene, const SurfacePoint& point,
                                     const glm::vec3& direction) const {
  const ShadingNormals normals = shading_normals(scene, point, direction);
  // Where light comes from may lie behind a mapped normal; the eye sees the smooth one there.
  Lobe lobe{.frame = Frame(start_ == PathStart::light ? normals.mapped : normals.seen)};
  lobe.mapped = normals.mapped != normals.smooth;
  lobe.smooth_normal = normals.smooth;
  lobe.view = lobe.frame.to_local(-direction);
  lobe.n_dot_view = std::max(lobe.view.z, 1e-6f);
  photile_albedo_fit(surface_.alpha, &lobe.fit);
  lobe.diffuse = diffuse_part(surface_, lobe.n_dot_view);
  float f0_weight = 0, f90_weight = 0;
  photile_lobe_albedo(&lobe.fit, lobe.n_dot_view, &f0_weight, &f90_weight);
  const float specular_albedo = largest(surface_.f0) * f0_weight + surface_.f90 * f90_weight;
  const float diffuse_albedo = largest(diffuse_reflectance(lobe.diffuse, surface_.alpha));
  const float sum = specular_albedo + diffuse_albedo;
  const bool in_front = lobe.view.z > 0.0f;
  lobe.albedo = in_front ? specular_albedo : 0.0f;
  lobe.fraction = sum > 0.0f && in_front ? specular_albedo / sum : 0.0f;
  return lobe;
}

void OpaqueBsdf::shade_smoothly(const Scene& scene, const SurfacePoint& point) {
  if (material_of(scene, point).normal_texture != none) return;
  base_normal_ = shading_normal(scene, point);
}

void OpaqueBsdf::drop_diffuse() {
  surface_.albedo = glm::vec3(0.0f);
  if (lobe_) lobe_->diffuse = diffuse_part(surface_, lobe_->n_dot_view);
}

void OpaqueBsdf::keep_lobe() {
  surface_.albedo = glm::vec3(0.0f);
  if (!lobe_) return;
  lobe_->diffuse = {};
  lobe_->fraction = 1.0f;
}

void OpaqueBsdf::drop_lobe() {
  surface_.f0 = glm::vec3(0.0f);
  surface_.f90 = 0.0f;
  if (lobe_) lobe_->fraction = 0.0f;
}

void OpaqueBsdf::widen_lobe(float least_alpha) {
  surface_.alpha = std::max(surface_.alpha, least_alpha);
  if (!lobe_) return;
  photile_albedo_fit(surface_.alpha, &lobe_->fit);
  lobe_->diffuse = diffuse_part(surface_, lobe_->n_dot_view);
}

bool OpaqueBsdf::lobe_suits_rays() const {
  if (!lobe_ || !(lobe_->albedo > 0.0f)) return false;
  return surface_.alpha < narrow_lobe_alpha || lobe_->albedo < faint_lobe_albedo;
}

double OpaqueBsdf::lobe_rays() const {
  if (!lobe_) return 0.0;
  const float scatters = std::min(1.0f, surface_.alpha / scattering_lobe_alpha);
  const float part = std::max(lobe_->albedo, rays_of_share * lobe_->fraction);
  return double{std::max(least_lobe_rays, most_lobe_rays * scatters * part)};
}

glm::vec3 OpaqueBsdf::base_reflectance() const {
  return lobe_ ? diffuse_reflectance(lobe_->diffuse, surface_.alpha) : surface_.albedo;
}

glm::vec3 OpaqueBsdf::lobe_reflectance() const {
  if (!lobe_) return glm::vec3(0.0f);
  float f0_weight = 0, f90_weight = 0;
  photile_lobe_albedo(&lobe_->fit, lobe_->n_dot_view, &f0_weight, &f90_weight);
  return surface_.f0 * f0_weight + surface_.f90 * f90_weight;
}

std::optional<glm::vec3> OpaqueBsdf::sample(const RandomBlock& random) const {
  const float u1 = random.uniform(direction_word), u2 = random.uniform(direction_word + 1);
  glm::vec3 direction;
  if (lobe_ && random.uniform(choice_word) < lobe_->fraction) {
    const glm::vec3& view = lobe_->view;
    const glm::vec3 half = sample_ggx_visible_normal(view, surface_.alpha, u1, u2);
    direction = glm::normalize(lobe_->frame.to_world(2.0f * glm::dot(view, half) * half - view));
  } else {
    direction = Frame(base_normal_).to_world(sample_cosine_hemisphere(u1, u2));
  }
  // A Lambertian direction along the surface differs from it by rounding alone.
  if (!lambertian() && !(glm::dot(direction, normal_) > 0.0f)) return std::nullopt;
  return direction;
}

float OpaqueBsdf::density(const glm::vec3& direction) const {
  const float cosine = glm::dot(direction, normal_);
  if (!(cosine > 0.0f)) return 0.0f;
  const float of_base = std::max(0.0f, glm::dot(direction, base_normal_)) / PHOTILE_PI;
  if (!lobe_) return of_base;
  const glm::vec3 half = glm::normalize(lobe_->view + lobe_->frame.to_local(direction));
  return lobe_->fraction * ggx_reflection_density(lobe_->n_dot_view, half.z, surface_.alpha) +
         (1.0f - lobe_->fraction) * of_base;
}

float OpaqueBsdf::bump_at(const glm::vec3& out) const {
  if (!lobe_->mapped) return 1.0f;
  const glm::vec3& light = start_ == PathStart::eye ? out : lobe_->view;
  return photile_bump_weight(light.z, glm::dot(lobe_->frame.to_world(light), lobe_->smooth_normal),
                             most_bump(surface_.albedo + surface_.f0));
}

glm::vec3 OpaqueBsdf::base_deviation(const glm::vec3& direction) const {
  if (!lobe_ || !(glm::dot(direction, normal_) > 0.0f)) return glm::vec3(0.0f);
  const float cosine = std::max(0.0f, glm::dot(direction, base_normal_));
  const glm::vec3 out = lobe_->frame.to_local(direction), mean = base_reflectance() / PHOTILE_PI;
  float f0_weight = 0, f90_weight = 0;
  photile_lobe_albedo(&lobe_->fit, out.z, &f0_weight, &f90_weight);
  glm::vec3 result;
  for (int c = 0; c < 3; ++c) {
    result[c] = photile_diffuse(lobe_->diffuse[0][c], lobe_->diffuse[1][c], lobe_->diffuse[2][c],
                                f0_weight, f90_weight) -
                mean[c];
  }
  return bump_at(out) * cosine * result;
}

glm::vec3 OpaqueBsdf::reflected(const glm::vec3& direction) const {
  const float cosine = glm::dot(direction, normal_);
  if (!(cosine > 0.0f)) return glm::vec3(0.0f);
  const float base_cosine = std::max(0.0f, glm::dot(direction, base_normal_));
  if (!lobe_) return surface_.albedo * (base_cosine / PHOTILE_PI);
  const glm::vec3 out = lobe_->frame.to_local(direction);
  const glm::vec3 half = glm::normalize(lobe_->view + out);
  const bool behind = lobe_->mapped && !(lobe_->view.z > 0.0f);
  const float lobe =
      behind ? 0.0f : photile_ggx_lobe(lobe_->n_dot_view, out.z, half.z, surface_.alpha);
  const float schlick = photile_schlick(glm::dot(lobe_->view, half));
  float f0_weight = 0, f90_weight = 0;
  photile_lobe_albedo(&lobe_->fit, out.z, &f0_weight, &f90_weight);
  const float bump = bump_at(out);
  glm::vec3 result;
  for (int c = 0; c < 3; ++c) {
    const float diffuse = photile_diffuse(lobe_->diffuse[0][c], lobe_->diffuse[1][c],
                                          lobe_->diffuse[2][c], f0_weight, f90_weight);
    result[c] =
        bump * cosine * photile_opaque_bsdf(diffuse, surface_.f0[c], surface_.f90, schlick, lobe);
    if (base_cosine != cosine) result[c] += (base_cosine - cosine) * diffuse;
  }
  return result;
}

glm::vec3 sample_ggx_visible_normal(const glm::vec3& view, float alpha, float u1, float u2) {
  // Stretch the view so that the lobe becomes a hemisphere.
  const glm::vec3 v = glm::normalize(glm::vec3(alpha * view.x, alpha * view.y, view.z));
  const float length2 = v.x * v.x + v.y * v.y;
  const glm::vec3 t1 =
      length2 > 0.0f ? glm::vec3(-v.y, v.x, 0.0f) / std::sqrt(length2) : glm::vec3(1, 0, 0);
  const glm::vec3 t2 = glm::cross(v, t1);
  // A point on the part of the disc that the hemisphere shows to the view.
  glm::vec2 p = sample_disc(u1, u2);
  const float s = 0.5f * (1.0f + v.z);
  p.y = (1.0f - s) * std::sqrt(std::max(0.0f, 1.0f - p.x * p.x)) + s * p.y;
  const glm::vec3 n =
      p.x * t1 + p.y * t2 + std::sqrt(std::max(0.0f, 1.0f - p.x * p.x - p.y * p.y)) * v;
  return glm::normalize(glm::vec3(alpha * n.x, alpha * n.y, std::max(0.0f, n.z)));
}

float ggx_reflection_density(float n_dot_view, float n_dot_half, float alpha) {
  if (!(n_dot_half > 0.0f)) return 0.0f;
  return 0.5f * photile_ggx_masking(n_dot_view, alpha) *
         photile_ggx_distribution(n_dot_half, alpha);
}

}  // namespace photile::trace
