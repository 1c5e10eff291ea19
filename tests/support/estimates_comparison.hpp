// Compares estimates with those of the double-precision oracle.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <random>
#include <vector>

#include "oracle/density_oracle.hpp"
#include "oracle/kernel_weights.hpp"
#include "oracle/rounding.hpp"
#include "photile/estimator.hpp"

namespace photile::test {

using reference::estimate_tolerance;

/// The lobe's peak amplifies the rounding of the half vector by 1 / alpha^2, alpha = 0.3.
inline double glossy_tolerance(int k) { return estimate_tolerance(k) * 12.0; }

/// Estimates in double precision, [hit][light].
using ExpectedEstimates = std::vector<std::vector<glm::dvec3>>;

inline ExpectedEstimates expected_irradiance(const reference::DensityOracle& oracle,
                                             const PrimaryHits& hits, int k, double radius,
                                             DensityKernel kernel = DensityKernel::constant) {
  ExpectedEstimates expected;
  for (std::size_t hit = 0; hit < hits.size(); ++hit) {
    expected.push_back(oracle.irradiance(hits.position[hit], hits.oriented_face[hit], k,
                                         static_cast<float>(radius), kernel));
  }
  return expected;
}

/// A fraction of the rational fit to the coat's albedo, whose constants are
/// MaterialX's (mx_ggx_dir_albedo_analytic), in the order of its source: 1, x, y, x y, x^2, y^2,
/// x^2 y, x y^2, x^2 y^2 of the cosine x and alpha y.
inline double coat_polynomial(const std::array<double, 9>& c, double x, double y) {
  return c[0] + c[1] * x + c[2] * y + c[3] * x * y + c[4] * x * x + c[5] * y * y +
         c[6] * x * x * y + c[7] * x * y * y + c[8] * x * x * y * y;
}

/// Weights of F0 and F90 in the albedo of one region's reflection at this cosine.
inline std::array<double, 2> coat_weights(double cosine, double alpha) {
  using Polynomial = std::array<double, 9>;
  constexpr Polynomial f0_above{0.1003, -0.6303, 9.748, -2.038, 29.34,
                                -8.245, -26.44,  19.99, -5.448};
  constexpr Polynomial f0_below{1.0, -1.765, 8.263, 11.53, 28.96, -7.507, -36.11, 15.86, 33.37};
  constexpr Polynomial f90_above{0.9345,  -2.323, 2.229,  -3.748, 1.424,
                                 -0.7684, 1.436,  0.2913, 0.6286};
  constexpr Polynomial f90_below{1.0, 0.2281, 15.94, -55.83, 13.08, 41.26, 54.9, 300.2, -285.1};
  const auto quotient = [&](const Polynomial& above, const Polynomial& below) {
    const double x = std::clamp(cosine, 0.0, 1.0);
    return std::clamp(coat_polynomial(above, x, alpha) / coat_polynomial(below, x, alpha), 0.0,
                      1.0);
  };
  const double of_f90 = quotient(f90_above, f90_below);
  return {std::min(quotient(f0_above, f0_below), 1 - of_f90), of_f90};
}

/// Their means, of the polynomials that photile/device/bsdf.h states.
inline std::array<double, 2> mean_coat_weights(double a) {
  return {0.9524 + a * (0.0150 + a * (-1.9283 + a * (2.0736 - a * 0.7034))),
          0.0505 + a * (-0.1978 + a * (0.3510 + a * (-0.2979 + a * 0.0968)))};
}

/// Several regions and the base, as the head of photile/device/bsdf.h states them.
inline double diffuse_bsdf(double n_dot_i, double n_dot_o, double albedo, double f0, double f90,
                           double alpha) {
  const auto mean = mean_coat_weights(alpha);
  const double e1_mean = std::min(1.0, mean[0] + mean[1]);
  const double f_mean = f0 + (f90 - f0) / 21;
  const double fm = f_mean * f_mean * e1_mean / (1 - f_mean * (1 - e1_mean));
  const auto e = [&](const std::array<double, 2>& w) {
    return f0 * w[0] + f90 * w[1] + fm * (1 - w[0] - w[1]);
  };
  const auto i = coat_weights(n_dot_i, alpha), o = coat_weights(n_dot_o, alpha);
  const double several = fm * (1 - i[0] - i[1]) * (1 - o[0] - o[1]) /
                         (glm::pi<double>() * std::max(0.01, 1 - e1_mean));
  const double base = albedo * (1 - e(i)) * std::max(0.0, 1 - e(o)) /
                      (glm::pi<double>() * std::max(0.1, 1 - e(mean)));
  return std::max(0.0, several + base);
}

/// What a normal map multiplies the BSDF by; 1 where the lobe has none.
inline double bump_weight(glm::dvec3 i, const HitLobe& lobe, glm::dvec3 albedo) {
  if (lobe.smooth_normal == glm::vec3(0.0f)) return 1;
  const glm::dvec3 reflectance = albedo + glm::dvec3(lobe.specular);
  const double most =
      1 / std::clamp(std::max({reflectance.r, reflectance.g, reflectance.b}), 1e-3, 1.0);
  return std::min(most, (std::max(0.0, glm::dot(i, glm::dvec3(lobe.normal))) + 1e-3) /
                            (std::max(0.0, glm::dot(i, glm::dvec3(lobe.smooth_normal))) + 1e-3));
}

/// The BSDF as the head of photile/device/bsdf.h states it, written down afresh in double
/// precision.
inline double coated_bsdf(glm::dvec3 i, glm::dvec3 o, glm::dvec3 n, double albedo, double f0,
                          double f90, double alpha, double bump = 1) {
  const glm::dvec3 h = glm::normalize(i + o);
  const double fresnel = f0 + (f90 - f0) * std::pow(1 - glm::dot(i, h), 5.0);
  const double ni = glm::dot(n, i), no = glm::dot(n, o), nh = glm::dot(n, h);
  double lobe = 0;
  if (ni > 0 && no > 0) {
    const double a2 = alpha * alpha;
    const double d = a2 / (glm::pi<double>() * std::pow(nh * nh * (a2 - 1) + 1, 2.0));
    const double visibility =
        0.5 / (no * std::sqrt(ni * ni * (1 - a2) + a2) + ni * std::sqrt(no * no * (1 - a2) + a2));
    lobe = d * visibility;
  }
  return bump * (diffuse_bsdf(ni, no, albedo, f0, f90, alpha) + fresnel * lobe);
}

/// Radiance of glossy hits: the BSDF summed over the oracle's neighbours.
inline ExpectedEstimates expected_radiance(const reference::DensityOracle& oracle,
                                           const Photons& photons, const PrimaryHits& hits,
                                           std::size_t lights, int k, double radius,
                                           DensityKernel kernel = DensityKernel::constant) {
  ExpectedEstimates expected;
  for (std::size_t hit = 0; hit < hits.size(); ++hit) {
    const auto near =
        oracle.nearest(hits.position[hit], hits.oriented_face[hit], k, static_cast<float>(radius));
    const auto count = static_cast<std::size_t>(k);
    // Of one photon, that one.
    const std::size_t used =
        near.photons.size() == count ? std::max<std::size_t>(count - 1, 1) : near.photons.size();
    std::vector<glm::dvec3>& sums = expected.emplace_back(lights, glm::dvec3(0.0));
    for (std::size_t n = 0; n < used; ++n) {
      const std::uint32_t photon = near.photons[n];
      const double weight =
          reference::weight_at(kernel, std::sqrt(near.squared_distance[n] / near.squared_radius)) /
          reference::mean_weight(kernel);
      for (int c = 0; c < 3; ++c) {
        sums[lights > 1 ? photons.light[photon] : 0][c] +=
            weight * double{photons.flux[photon][c]} *
            coated_bsdf(
                photons.incoming[photon], hits.outgoing[hit], hits.lobe[hit].normal,
                hits.diffuse_albedo[hit][c], hits.lobe[hit].specular[c], hits.lobe[hit].f90,
                hits.lobe[hit].roughness,
                bump_weight(photons.incoming[photon], hits.lobe[hit], hits.diffuse_albedo[hit])) /
            (glm::pi<double>() * near.squared_radius);
      }
    }
  }
  return expected;
}

/// Estimates as [hit][light], whichever form they have.
inline std::vector<glm::vec3> by_light(const std::vector<glm::vec3>& values,
                                       const LightTable& estimates, std::size_t lights) {
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
    const glm::vec3 normal = glm::vec3(face_normal(scene, hits.oriented_face[i]));
    hits.outgoing.push_back(
        glm::normalize(normal + glm::vec3(uniform(random), uniform(random), uniform(random))));
    hits.lobe.push_back({scene.materials[0].specular, scene.materials[0].roughness, normal});
  }
}

}  // namespace photile::test
