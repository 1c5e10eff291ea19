// Sampling of the GGX reflection of device/bsdf.h by its visible normals (Heitz, "Sampling the GGX
// distribution of visible normals", Journal of Computer Graphics Techniques, 2018).
#pragma once

#include <glm/glm.hpp>

namespace photile::trace {

/// A microfacet normal as seen from unit direction `view` (view.z > 0), both in the frame of the
/// shading normal. Its density is G1 (view.normal) D / view.z per steradian.
glm::vec3 sample_ggx_visible_normal(const glm::vec3& view, float alpha, float u1, float u2);

/// Density per steradian of directions reflected about such a normal: G1 D / (4 n.view).
float ggx_reflection_density(float n_dot_view, float n_dot_half, float alpha);

}  // namespace photile::trace
