// The one definition of reflection at an opaque surface, compiled by C++ (photon scattering,
// tests) and by OpenCL C (radiance estimate). It uses only + - * / and sqrt, which round alike
// everywhere. What differs between the photons of a hit is a PHOTILE_REAL: a float unless the
// including file defines it as a vector of floats.
//
// The model is a coat on a base, as in glTF 2.0's metallic-roughness materials: a GGX reflection
// over what is Lambertian. With the directions i (towards the light) and o (towards the eye) and h
// half-way between them, per colour channel:
//
//   f(i, o) = F D G2 / (4 n.i n.o)                                                 one facet
//           + Fm (1 - E1(i)) (1 - E1(o)) / (pi (1 - E1_mean))                      several facets
//           + albedo (1 - E(i)) (1 - E(o)) / (pi (1 - E_mean))                     the base
//   F       = F0 + (F90 - F0) (1 - i.h)^5                                          Schlick's
//   E       = (fraction of light that one facet reflects) + Fm (1 - E1)               the coat's
//   albedo
//
// D is the GGX distribution (Walter et al. 2007), G2 Smith's height-correlated masking and
// shadowing (Heitz 2014). E1 is what one facet would reflect with F = 1; the rest meets further
// facets, which give back Fm of it (Kulla and Conty, "Revisiting physically based shading at
// Imageworks", SIGGRAPH 2017). The base gets what the coat lets through, on the way in and on the
// way out (Kelemen and Szirmay-Kalos, "A microfacet based coupled specular-matte BRDF model",
// 2001). Means are over a diffusely lit hemisphere. So f is reciprocal, and a white metal, or a
// white base under any coat, reflects all that falls in, except for the error of the approximation
// of E1 and E (docs/reference/materials.md). glTF's own formula, albedo (1 - F) and one facet,
// loses more than half of the light on a rough white metal, and makes light on a smooth white
// dielectric at grazing angles.
#ifndef PHOTILE_DEVICE_BSDF_H
#define PHOTILE_DEVICE_BSDF_H

#include "photile/device/constants.h"

#ifdef __cplusplus
#include <cmath>
#define PHOTILE_SQRT(x) std::sqrt(x)
#else
#define PHOTILE_SQRT(x) sqrt(x)
#endif

#ifndef PHOTILE_REAL
#define PHOTILE_REAL float
#endif

/// (1 - i.h)^5, Schlick's weight between F0 and F90. `i_dot_h` in [0, 1].
static inline PHOTILE_REAL photile_schlick(PHOTILE_REAL i_dot_h) {
  const PHOTILE_REAL c = i_dot_h < 1.0f ? 1.0f - i_dot_h : (PHOTILE_REAL)(0.0f);
  const PHOTILE_REAL c2 = c * c;
  return c2 * c2 * c;
}

/// D of GGX per steradian of half vectors; its integral against n.h is 1.
static inline PHOTILE_REAL photile_ggx_distribution(PHOTILE_REAL n_dot_h, float alpha) {
  const float a2 = alpha * alpha;
  const PHOTILE_REAL d = n_dot_h * n_dot_h * (a2 - 1.0f) + 1.0f;
  return a2 / (PHOTILE_PI * d * d);
}

/// G1 / (2 n.v): Smith's masking of one direction over twice its cosine, finite at grazing angles.
static inline float photile_ggx_masking(float n_dot_v, float alpha) {
  const float a2 = alpha * alpha;
  return 1.0f / (n_dot_v + PHOTILE_SQRT(n_dot_v * n_dot_v * (1.0f - a2) + a2));
}

/// The reflection without Fresnel's factor, D G2 / (4 n.i n.o), per steradian. 0 where either
/// direction lies behind the surface. `alpha` in [PHOTILE_MIN_GGX_ALPHA, 1].
static inline PHOTILE_REAL photile_ggx_lobe(PHOTILE_REAL n_dot_i, float n_dot_o,
                                            PHOTILE_REAL n_dot_h, float alpha) {
  const PHOTILE_REAL behind = 0.0f;
  if (!(n_dot_o > 0.0f)) return behind;
  const float a2 = alpha * alpha;
  const PHOTILE_REAL from_i = n_dot_o * PHOTILE_SQRT(n_dot_i * n_dot_i * (1.0f - a2) + a2);
  const PHOTILE_REAL from_o = n_dot_i * PHOTILE_SQRT(n_dot_o * n_dot_o * (1.0f - a2) + a2);
  const PHOTILE_REAL lobe = photile_ggx_distribution(n_dot_h, alpha) * 0.5f / (from_i + from_o);
  return n_dot_i > 0.0f ? lobe : behind;
}

/// The albedo of one facet's reflection at one GGX alpha: the quotients of quadratics in the cosine
/// that photile_lobe_albedo evaluates. Coefficients ascend. Filled by photile_albedo_fit.
typedef struct {
  float f0_above[3], f0_below[3];
  float f90_above[3], f90_below[3];
} PhotileAlbedoFit;

static inline void photile_set_quadratic(float* quadratic, float alpha, float a, float b, float c,
                                         float d, float e, float f, float g, float h, float i) {
  quadratic[0] = a + alpha * (b + alpha * c);
  quadratic[1] = d + alpha * (e + alpha * f);
  quadratic[2] = g + alpha * (h + alpha * i);
}

/// The rational fit of MaterialX 1.38 (mx_ggx_dir_albedo_analytic), here in the order 1, alpha,
/// alpha^2 of 1, cosine, cosine^2.
static inline void photile_albedo_fit(float alpha, PhotileAlbedoFit* fit) {
  photile_set_quadratic(fit->f0_above, alpha, 0.1003f, 9.748f, -8.245f,  //
                        -0.6303f, -2.038f, 19.99f, 29.34f, -26.44f, -5.448f);
  photile_set_quadratic(fit->f0_below, alpha, 1.0f, 8.263f, -7.507f,  //
                        -1.765f, 11.53f, 15.86f, 28.96f, -36.11f, 33.37f);
  photile_set_quadratic(fit->f90_above, alpha, 0.9345f, 2.229f, -0.7684f,  //
                        -2.323f, -3.748f, 0.2913f, 1.424f, 1.436f, 0.6286f);
  photile_set_quadratic(fit->f90_below, alpha, 1.0f, 15.94f, 41.26f,  //
                        0.2281f, -55.83f, 300.2f, 13.08f, 54.9f, -285.1f);
}

/// Between 0 and 1; 0 of a NaN.
static inline PHOTILE_REAL photile_unit(PHOTILE_REAL x) {
  const PHOTILE_REAL zero = 0.0f, one = 1.0f;
  const PHOTILE_REAL positive = x > 0.0f ? x : zero;
  return positive < 1.0f ? positive : one;
}

static inline PHOTILE_REAL photile_quotient(const float* above, const float* below,
                                            PHOTILE_REAL x) {
  return photile_unit((above[0] + x * (above[1] + x * above[2])) /
                      (below[0] + x * (below[1] + x * below[2])));
}

/// One facet reflects F0 x `f0_weight` + F90 x `f90_weight` of light at this cosine to the normal;
/// below the horizon as at the horizon. E1 is the sum of the weights.
static inline void photile_lobe_albedo(const PhotileAlbedoFit* fit, PHOTILE_REAL cosine,
                                       PHOTILE_REAL* f0_weight, PHOTILE_REAL* f90_weight) {
  const PHOTILE_REAL x = photile_unit(cosine);
  *f90_weight = photile_quotient(fit->f90_above, fit->f90_below, x);
  const PHOTILE_REAL most = 1.0f - *f90_weight;
  const PHOTILE_REAL weight = photile_quotient(fit->f0_above, fit->f0_below, x);
  *f0_weight = weight < most ? weight : most;
}

/// The mean over a diffusely lit hemisphere in the same form: twice the integral over the cosine of
/// the fit x cosine. The polynomials are accurate to 0.002.
static inline void photile_mean_lobe_albedo(float alpha, float* f0_weight, float* f90_weight) {
  const float a = alpha;
  *f0_weight = 0.9524f + a * (0.0150f + a * (-1.9283f + a * (2.0736f - a * 0.7034f)));
  *f90_weight = 0.0505f + a * (-0.1978f + a * (0.3510f + a * (-0.2979f + a * 0.0968f)));
}

/// Several facets and the base, one channel, per steradian: part[0] + part[1] x `f0_weight` +
/// part[2] x `f90_weight` of i, since E and E1 are linear in the weights. Without a coat (F0 = F90
/// = 0) it is albedo / pi.
///   o, mean   f0_weight and f90_weight of o, and of the mean
static inline void photile_set_diffuse(float albedo, float f0, float f90, const float* o,
                                       const float* mean, float* part) {
  const float e1_mean = mean[0] + mean[1] < 1.0f ? mean[0] + mean[1] : 1.0f;
  const float f_mean = f0 + (f90 - f0) / 21.0f;
  const float fm = f_mean * f_mean * e1_mean / (1.0f - f_mean * (1.0f - e1_mean));
  // The fit is not accurate enough to divide by values near 0: the losses of a smooth coat, and the
  // little light that coats like nearly white metals let through.
  const float lost_mean = 1.0f - e1_mean > 0.01f ? 1.0f - e1_mean : 0.01f;
  const float several = fm * (1.0f - o[0] - o[1]) / (PHOTILE_PI * lost_mean);
  const float passed = 1.0f - fm - (f0 - fm) * o[0] - (f90 - fm) * o[1];
  const float passed_mean = 1.0f - fm - (f0 - fm) * mean[0] - (f90 - fm) * mean[1];
  const float base = albedo / PHOTILE_PI * (passed > 0.0f ? passed : 0.0f) /
                     (passed_mean > 0.1f ? passed_mean : 0.1f);
  part[0] = base * (1.0f - fm) + several;
  part[1] = -base * (f0 - fm) - several;
  part[2] = -base * (f90 - fm) - several;
}

/// Several facets and the base at i, one channel of photile_set_diffuse; at least 0.
static inline PHOTILE_REAL photile_diffuse(float part0, float part1, float part2,
                                           PHOTILE_REAL f0_weight, PHOTILE_REAL f90_weight) {
  const PHOTILE_REAL zero = 0.0f;
  const PHOTILE_REAL diffuse = part0 + part1 * f0_weight + part2 * f90_weight;
  return diffuse > 0.0f ? diffuse : zero;
}

/// The factor of a normal map on f: the cosine of i to the mapped normal over that to the smooth
/// one, at most `most`; 1 where the normals are the same. So light is weighted by its cosine to the
/// mapped normal while photons count by area of the true surface, and nothing reflects more light
/// than the unmapped material would. f is no longer reciprocal (Veach, "Robust Monte Carlo methods
/// for light transport simulation", 1997, section 5.3): i is the light's side.
static inline PHOTILE_REAL photile_bump_weight(PHOTILE_REAL mapped_dot_i, PHOTILE_REAL smooth_dot_i,
                                               float most) {
  const PHOTILE_REAL zero = 0.0f, limit = most;
  const PHOTILE_REAL mapped = mapped_dot_i > 0.0f ? mapped_dot_i : zero;
  const PHOTILE_REAL smooth = smooth_dot_i > 0.0f ? smooth_dot_i : zero;
  const PHOTILE_REAL weight = (mapped + 0.001f) / (smooth + 0.001f);  // finite at grazing angles
  return weight < most ? weight : limit;
}

/// One channel of f, per steradian, without the weight of a normal map. `diffuse` is
/// photile_diffuse(...), `schlick` is photile_schlick(i.h), `lobe` is photile_ggx_lobe(...).
static inline PHOTILE_REAL photile_opaque_bsdf(PHOTILE_REAL diffuse, float f0, float f90,
                                               PHOTILE_REAL schlick, PHOTILE_REAL lobe) {
  return diffuse + (f0 + (f90 - f0) * schlick) * lobe;
}

#endif
