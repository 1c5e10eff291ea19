// The one definition of reflection at an opaque surface, compiled by C++ (photon scattering,
// tests) and by OpenCL C (radiance estimate). Nothing but + - * / and sqrt, which round alike
// everywhere. What differs between the photons of a hit is a PHOTILE_REAL: a float unless whoever
// includes this defines it as a vector of floats.
//
// The model is glTF 2.0's (specification, appendix B.3): a Lambertian base under a GGX reflection,
// mixed by Fresnel's law as Schlick approximates it at the half vector h between the directions i
// (towards the light) and o (towards the eye):
//
//   f(i, o) = (1 - F) albedo / pi + F D G2 / (4 n.i n.o),   F = F0 + (1 - F0) (1 - i.h)^5
//
// D is the GGX distribution (Walter et al. 2007), G2 Smith's height-correlated masking and
// shadowing (Heitz 2014). albedo and F0 are per colour channel. f is reciprocal. It reflects at
// most what falls in while F0 or the albedo is small; glTF's mix does not take from the base what
// the reflection gives near grazing angles.
#ifndef PHOTILE_DEVICE_BSDF_H
#define PHOTILE_DEVICE_BSDF_H

#ifdef __OPENCL_VERSION__
#define PHOTILE_SQRT(x) sqrt(x)
#else
#include <cmath>
#define PHOTILE_SQRT(x) std::sqrt(x)
#endif

/// Smallest GGX alpha. Narrower lobes lose their peak to single precision and no density of photons
/// would resolve them; smoother surfaces are mirrors.
#define PHOTILE_MIN_GGX_ALPHA 0.02f

#ifndef PHOTILE_REAL
#define PHOTILE_REAL float
#endif

#define PHOTILE_PI 3.14159265358979f

/// (1 - i.h)^5, Schlick's weight between F0 and 1. `i_dot_h` in [0, 1].
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

/// One channel of f, per steradian. `schlick` = photile_schlick(i.h), `lobe` is
/// photile_ggx_lobe(...).
static inline PHOTILE_REAL photile_opaque_bsdf(float albedo, float f0, PHOTILE_REAL schlick,
                                               PHOTILE_REAL lobe) {
  const PHOTILE_REAL fresnel = f0 + (1.0f - f0) * schlick;
  return (1.0f - fresnel) * albedo / PHOTILE_PI + fresnel * lobe;
}

#endif
