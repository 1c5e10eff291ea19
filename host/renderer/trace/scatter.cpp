#include "trace/scatter.hpp"

#include <algorithm>
#include <cmath>

#include "scene/panes.hpp"
#include "trace/opaque_bsdf.hpp"

namespace photile::trace {

std::optional<Scattered> scatter_opaque(const Scene& scene, const SurfacePoint& point,
                                        const glm::vec3& direction, const RandomBlock& random) {
  const OpaqueBsdf bsdf(scene, point, direction, PathStart::light);
  const std::optional<glm::vec3> scattered = bsdf.sample(random);
  if (!scattered) return std::nullopt;
  if (!bsdf.glossy()) return Scattered{*scattered, bsdf.albedo()};  // f x cosine / density, exactly
  // The adjoint of the radiance estimate, which multiplies f by flux per geometric area.
  const float density = bsdf.density(*scattered);
  if (!(density > 0.0f)) return std::nullopt;
  return Scattered{*scattered, bsdf.reflected(*scattered) / density};
}

namespace {

struct Deflected {
  glm::vec3 direction;
  bool transmitted;
};

glm::vec3 reflect(const glm::vec3& direction, const glm::vec3& normal) {
  return glm::normalize(direction - 2.0f * glm::dot(direction, normal) * normal);
}

/// Snell's law; only where there is no total internal reflection.
glm::vec3 refract(const glm::vec3& direction, const glm::vec3& normal, float cos_i, float eta) {
  const float sin2_t = eta * eta * std::max(0.0f, 1.0f - cos_i * cos_i);
  const float cos_t = std::sqrt(std::max(0.0f, 1.0f - sin2_t));
  return glm::normalize(eta * direction + (eta * cos_i - cos_t) * normal);
}

/// A smooth dielectric as a ray meets it.
struct Boundary {
  Boundary(const Material& material, bool entering, const glm::vec3& direction,
           const glm::vec3& normal)
      : cos_i(std::min(1.0f, -glm::dot(direction, normal))),
        eta(entering || material.thin ? 1.0f / material.index_of_refraction
                                      : material.index_of_refraction),
        reflectance(fresnel_dielectric(cos_i, eta)) {
    if (material.thin) reflectance = scene::pane_reflectance(reflectance);
  }
  glm::vec3 transmitted(const Material& material, const glm::vec3& direction,
                        const glm::vec3& normal) const {
    return material.thin ? direction : refract(direction, normal, cos_i, eta);
  }

  float cos_i;
  float eta;
  float reflectance;
};

Deflected deflect(const Material& material, bool entering, const glm::vec3& direction,
                  const glm::vec3& normal, float choice) {
  if (material.interaction == Interaction::mirror) return {reflect(direction, normal), false};
  const Boundary boundary(material, entering, direction, normal);
  if (choice < boundary.reflectance) return {reflect(direction, normal), false};
  return {boundary.transmitted(material, direction, normal), true};
}

/// The factor of the radiance of a ray that the surface transmits: (index where it comes from /
/// index beyond)^2.
double radiance_factor(const Material& material, bool entering) {
  if (material.thin) return 1;
  const double index{material.index_of_refraction};
  return entering ? 1 / (index * index) : index * index;
}

}  // namespace

float fresnel_dielectric(float cos_i, float eta) {
  const float sin2_t = eta * eta * std::max(0.0f, 1.0f - cos_i * cos_i);
  if (sin2_t >= 1.0f) return 1.0f;
  const float cos_t = std::sqrt(1.0f - sin2_t);
  const float perpendicular = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
  const float parallel = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
  return 0.5f * (perpendicular * perpendicular + parallel * parallel);
}

glm::vec3 pane_transmittance(const Material& material, float cosine) {
  const float fresnel =
      fresnel_dielectric(std::min(1.0f, cosine), 1.0f / material.index_of_refraction);
  return (1.0f - scene::pane_reflectance(fresnel)) * material.transmission;
}

Scattered scatter_specular(const Scene& scene, const SurfacePoint& point,
                           const glm::vec3& direction, float choice) {
  const Material& material = material_of(scene, point);
  const bool entering = on_front(scene, point);
  Deflected deflected =
      deflect(material, entering, direction, shading_normals(scene, point, direction).seen, choice);
  // A shading normal far from the geometric one can send the ray to the wrong side of the surface,
  // where it would leak; the geometric normal never does.
  const bool beyond = glm::dot(deflected.direction, point.normal) < 0.0f;
  if (beyond != deflected.transmitted)
    deflected = deflect(material, entering, direction, point.normal, choice);

  if (material.interaction == Interaction::mirror) return {deflected.direction, material.specular};
  if (!deflected.transmitted) return {deflected.direction, glm::vec3(1.0f)};
  return {deflected.direction, material.transmission, radiance_factor(material, entering)};
}

std::optional<SplitLight> both_parts(const Scene& scene, const SurfacePoint& point,
                                     const glm::vec3& direction) {
  const Material& material = material_of(scene, point);
  if (material.interaction == Interaction::mirror) return std::nullopt;
  const bool entering = on_front(scene, point);
  const glm::vec3 normal = shading_normals(scene, point, direction).seen;
  const Boundary boundary(material, entering, direction, normal);
  if (!(boundary.reflectance > 0.0f && boundary.reflectance < 1.0f)) return std::nullopt;
  const glm::vec3 back = reflect(direction, normal);
  const glm::vec3 on = boundary.transmitted(material, direction, normal);
  if (glm::dot(back, point.normal) < 0.0f || !(glm::dot(on, point.normal) < 0.0f)) {
    return std::nullopt;
  }
  return SplitLight{boundary.reflectance,
                    {back, glm::vec3(1.0f)},
                    {on, material.transmission, radiance_factor(material, entering)}};
}

}  // namespace photile::trace
