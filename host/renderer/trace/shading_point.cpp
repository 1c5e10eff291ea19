#include "trace/shading_point.hpp"

#include <algorithm>

#include "photile/device/bsdf.h"
#include "trace/sampling.hpp"
#include "trace/scatter.hpp"

namespace photile::trace {

std::optional<glm::vec3> ShadingPoint::sample(const RandomBlock& choice,
                                              const RandomBlock& random) const {
  if (bsdf_.lambertian() || choice.bit(0)) return bsdf_.sample(random);
  return Frame(point_.normal)
      .to_world(sample_cosine_hemisphere(random.uniform(direction_word),
                                         random.uniform(direction_word + 1)));
}

float ShadingPoint::density(const glm::vec3& direction) const {
  if (bsdf_.lambertian()) return bsdf_.density(direction);
  return 0.5f * (bsdf_.density(direction) + cosine(direction) / PHOTILE_PI);
}

float ShadingPoint::cosine(const glm::vec3& direction) const {
  return std::max(0.0f, glm::dot(direction, point_.normal));
}

}  // namespace photile::trace
