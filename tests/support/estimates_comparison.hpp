// Compares estimates with those of the double-precision oracle.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <random>
#include <vector>

#include "photile/estimator.hpp"
#include "reference/density_oracle.hpp"
#include "reference/kernel_weights.hpp"

namespace photile::test {

/// Largest relative difference over hits and lights. Sums of k positive floats are right to k units
/// of 2^-24, the area to a few.
inline double estimate_tolerance(int k) { return (static_cast<double>(k) + 16.0) / (1 << 24); }

/// The lobe's peak amplifies the rounding of the half vector by 1 / alpha^2, alpha = 0.3.
inline double glossy_tolerance(int k) { return estimate_tolerance(k) * 12.0; }

/// Estimates in double precision, [hit][light].
using ExpectedEstimates = std::vector<std::vector<glm::dvec3>>;

inline ExpectedEstimates expected_irradiance(const reference::DensityOracle& oracle,
                                             const PrimaryHits& hits, int k, double radius,
                                             DensityKernel kernel = DensityKernel::constant) {
  ExpectedEstimates expected;
  for (std::size_t hit = 0; hit < hits.size(); ++hit) {
    expected.push_back(oracle.irradiance(hits.position[hit], hits.sided_triangle[hit], k,
                                         static_cast<float>(radius), kernel));
  }
  return expected;
}

/// The model of glTF 2.0, appendix B, written down afresh in double precision.
inline double gltf_bsdf(glm::dvec3 i, glm::dvec3 o, glm::dvec3 n, double albedo, double f0,
                        double alpha) {
  const glm::dvec3 h = glm::normalize(i + o);
  const double fresnel = f0 + (1 - f0) * std::pow(1 - glm::dot(i, h), 5.0);
  const double ni = glm::dot(n, i), no = glm::dot(n, o), nh = glm::dot(n, h);
  double lobe = 0;
  if (ni > 0 && no > 0) {
    const double a2 = alpha * alpha;
    const double d = a2 / (glm::pi<double>() * std::pow(nh * nh * (a2 - 1) + 1, 2.0));
    const double visibility =
        0.5 / (no * std::sqrt(ni * ni * (1 - a2) + a2) + ni * std::sqrt(no * no * (1 - a2) + a2));
    lobe = d * visibility;
  }
  return (1 - fresnel) * albedo / glm::pi<double>() + fresnel * lobe;
}

/// Radiance of glossy hits: the BSDF summed over the oracle's neighbours.
inline ExpectedEstimates expected_radiance(const reference::DensityOracle& oracle,
                                           const Photons& photons, const PrimaryHits& hits,
                                           std::size_t lights, int k, double radius,
                                           DensityKernel kernel = DensityKernel::constant) {
  ExpectedEstimates expected;
  for (std::size_t hit = 0; hit < hits.size(); ++hit) {
    const auto near =
        oracle.nearest(hits.position[hit], hits.sided_triangle[hit], k, static_cast<float>(radius));
    const auto count = static_cast<std::size_t>(k);
    const std::size_t used = near.photons.size() == count ? count - 1 : near.photons.size();
    std::vector<glm::dvec3>& sums = expected.emplace_back(lights, glm::dvec3(0.0));
    for (std::size_t n = 0; n < used; ++n) {
      const std::uint32_t photon = near.photons[n];
      const double weight =
          reference::weight_at(kernel, std::sqrt(near.squared_distance[n] / near.squared_radius)) /
          reference::mean_weight(kernel);
      for (int c = 0; c < 3; ++c) {
        sums[lights > 1 ? photons.light[photon] : 0][c] +=
            weight * double{photons.flux[photon][c]} *
            gltf_bsdf(photons.incoming[photon], hits.outgoing[hit], hits.lobe[hit].normal,
                      hits.diffuse_albedo[hit][c], hits.lobe[hit].specular[c],
                      hits.lobe[hit].roughness) /
            (glm::pi<double>() * near.squared_radius);
      }
    }
  }
  return expected;
}

/// Estimates as [hit][light], whichever form they have.
inline std::vector<glm::vec3> by_light(const std::vector<glm::vec3>& values,
                                       const Estimates& estimates, std::size_t lights) {
  if (estimates.first.empty() || values.empty()) return values;
  const std::size_t hits = estimates.first.size() - 1;
  std::vector<glm::vec3> dense(hits * lights, glm::vec3(0.0f));
  for (std::size_t hit = 0; hit < hits; ++hit) {
    for (std::uint64_t i = estimates.first[hit]; i < estimates.first[hit + 1]; ++i) {
      // Added, so that a light with two estimates at a hit is seen.
      dense.at(hit * lights + estimates.light.at(i)) += values.at(i);
    }
  }
  return dense;
}

/// Largest relative difference over hits, lights and channels.
inline double worst_difference(const std::vector<glm::vec3>& estimates,
                               const ExpectedEstimates& expected) {
  double worst = 0;
  std::size_t index = 0;
  for (const auto& of_hit : expected) {
    for (const glm::dvec3& truth : of_hit) {
      for (int c = 0; c < 3; ++c) {
        const double difference = std::abs(estimates.at(index)[c] - truth[c]);
        worst = std::max(worst, difference / std::max(truth[c], 1e-30));
      }
      ++index;
    }
  }
  return worst;
}

/// Random directions to the eye and the lobe of the scene's first material.
inline void add_lobes(PrimaryHits& hits, const Scene& scene, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<float> uniform(-0.5f, 0.5f);
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const glm::vec3 normal = glm::vec3(sided_normal(scene, hits.sided_triangle[i]));
    hits.outgoing.push_back(
        glm::normalize(normal + glm::vec3(uniform(random), uniform(random), uniform(random))));
    hits.lobe.push_back({scene.materials[0].specular, scene.materials[0].roughness, normal});
  }
}

}  // namespace photile::test
