// The BSDF shared with the device, against its defining integrals.
#include "photile/device/bsdf.h"

#include <catch2/catch.hpp>
#include <glm/glm.hpp>

#include "statistical_tests.hpp"
#include "trace/ggx.hpp"
#include "trace/random_stream.hpp"

using namespace photile;
using namespace photile::test;
using namespace photile::trace;

namespace {

/// Unit vector at angle theta from z, azimuth phi.
glm::dvec3 polar(double theta, double phi) {
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

/// Integral over the upper hemisphere by the midpoint rule in (theta^2, phi), dense near the pole.
template <class F>
double over_hemisphere(F&& f, int rings = 1500, int sectors = 240) {
  double sum = 0;
  for (int i = 0; i < rings; ++i) {
    const double s = (i + 0.5) / rings, theta = 0.5 * M_PI * s * s;
    const double ring = M_PI * s / rings * std::sin(theta) * 2 * M_PI / sectors;
    for (int j = 0; j < sectors; ++j) sum += ring * f(polar(theta, 2 * M_PI * (j + 0.5) / sectors));
  }
  return sum;
}

double reflection(const glm::dvec3& i, const glm::dvec3& o, double albedo, double f0,
                  double alpha) {
  const glm::dvec3 h = glm::normalize(i + o);
  const float lobe = photile_ggx_lobe(static_cast<float>(i.z), static_cast<float>(o.z),
                                      static_cast<float>(h.z), static_cast<float>(alpha));
  return photile_opaque_bsdf(static_cast<float>(albedo), static_cast<float>(f0),
                             photile_schlick(static_cast<float>(glm::dot(i, h))), lobe);
}

/// Share of light from i that is reflected anywhere. Integrated over half vectors, where the lobe
/// is smooth: d(o) = 4 i.h d(h); the Lambertian part joins by the same substitution.
double albedo_of(const glm::dvec3& i, double albedo, double f0, double alpha) {
  return over_hemisphere([&](const glm::dvec3& h) {
    const double i_h = glm::dot(i, h);
    const glm::dvec3 o = 2 * i_h * h - i;
    return i_h > 0 && o.z > 0 ? 4 * i_h * o.z * reflection(i, o, albedo, f0, alpha) : 0.0;
  });
}

}  // namespace

TEST_CASE("Schlick's weight is (1 - x)^5, 1 at grazing and 0 at normal incidence") {
  CHECK(photile_schlick(0.0f) == 1.0f);
  CHECK(photile_schlick(1.0f) == 0.0f);
  CHECK(photile_schlick(1.0000001f) == 0.0f);
  CHECK(photile_schlick(0.5f) == 0.03125f);
}

TEST_CASE("The GGX distribution projects to area 1 for every roughness") {
  for (const double alpha : {0.02, 0.1, 0.5, 1.0})
    CHECK(over_hemisphere([&](const glm::dvec3& h) {
            return h.z *
                   photile_ggx_distribution(static_cast<float>(h.z), static_cast<float>(alpha));
          }) == Approx(1).epsilon(2e-3));
}

TEST_CASE("The opaque BSDF is reciprocal") {
  for (const double alpha : {0.02, 0.3, 1.0})
    for (const double theta_i : {0.1, 0.8, 1.5})
      for (const double theta_o : {0.2, 1.1, 1.56})
        for (const double phi : {0.0, 1.0, 3.1}) {
          const glm::dvec3 i = polar(theta_i, 0.4), o = polar(theta_o, 0.4 + phi);
          const double there = reflection(i, o, 0.6, 0.04, alpha);
          CHECK(reflection(o, i, 0.6, 0.04, alpha) == Approx(there).epsilon(1e-5));
          CHECK(there > 0);
        }
}

TEST_CASE("The GGX lobe agrees with Walter's D and Smith's height-correlated G2 in double") {
  for (const double alpha : {0.02, 0.3, 1.0})
    for (const double theta_i : {0.0, 0.8, 1.5})
      for (const double theta_o : {0.2, 1.1}) {
        const glm::dvec3 i = polar(theta_i, 0.0), o = polar(theta_o, M_PI - 0.1);
        const glm::dvec3 h = glm::normalize(i + o);
        const auto lambda = [&](const glm::dvec3& v) {
          const double tangent2 = (1 - v.z * v.z) / (v.z * v.z);
          return 0.5 * (std::sqrt(1 + alpha * alpha * tangent2) - 1);
        };
        const double tangent2 = (1 - h.z * h.z) / (h.z * h.z), a2 = alpha * alpha;
        const double d = a2 / (M_PI * std::pow(h.z, 4) * std::pow(a2 + tangent2, 2));
        const double g2 = 1 / (1 + lambda(i) + lambda(o));
        CHECK(photile_ggx_lobe(static_cast<float>(i.z), static_cast<float>(o.z),
                               static_cast<float>(h.z), static_cast<float>(alpha)) ==
              Approx(d * g2 / (4 * i.z * o.z)).epsilon(2e-3));
      }
  CHECK(photile_ggx_lobe(-0.1f, 0.5f, 0.9f, 0.5f) == 0.0f);
  CHECK(photile_ggx_lobe(0.5f, 0.0f, 0.9f, 0.5f) == 0.0f);
}

TEST_CASE("A metal reflects at most what falls in, and nearly all where it is white and smooth") {
  for (const double alpha : {0.02, 0.1, 0.5, 1.0})
    for (const double theta : {0.0, 0.7, 1.2, 1.5}) {
      const double reflected = albedo_of(polar(theta, 0), 0, 1, alpha);
      CHECK(reflected <= 1.002);
      if (alpha <= 0.1 && theta <= 0.7) CHECK(reflected >= 0.98);
    }
}

TEST_CASE("Under light from everywhere a painted surface reflects at most what falls in") {
  for (const double alpha : {0.05, 0.3, 1.0}) {
    double reflected = 0;  // mean over cosine-weighted incidence
    constexpr int steps = 16;
    for (int s = 0; s < steps; ++s) {
      const double cosine = std::sqrt((s + 0.5) / steps);
      reflected += albedo_of(polar(std::acos(cosine), 0), 0.9, 0.04, alpha) / steps;
    }
    CHECK(reflected <= 1);
    CHECK(reflected > 0.8);
  }
}

TEST_CASE("Visible normals are drawn with the density that their formula claims") {
  constexpr int samples = 200'000, rings = 12, sectors = 12;
  for (const double alpha : {0.1, 0.5, 1.0})
    for (const double theta : {0.0, 0.9, 1.4}) {
      const glm::dvec3 view = polar(theta, 0.3);
      // Rings in x = 1 - cos of the stretched angle, whose tangent is tan / alpha: sharp lobes fill
      // all of them, and the integrand stays smooth up to the horizon.
      const auto ring_of = [&](double cosine) {
        const double tangent2 = (1 - cosine * cosine) / (cosine * cosine) / (alpha * alpha);
        return std::min(static_cast<int>(rings * (1 - 1 / std::sqrt(1 + tangent2))), rings - 1);
      };
      const auto sector_of = [&](const glm::dvec3& h) {
        return std::min(static_cast<int>((std::atan2(h.y, h.x) / (2 * M_PI) + 0.5) * sectors),
                        sectors - 1);
      };
      std::vector<double> counts(rings * sectors, 0.0), expected(rings * sectors, 0.0);
      for (int n = 0; n < samples; ++n) {
        const RandomBlock u = RandomStream(31, n, 0).block(Purpose::photon_scattering, 0);
        const glm::vec3 h = sample_ggx_visible_normal(glm::vec3(view), static_cast<float>(alpha),
                                                      u.uniform(0), u.uniform(1));
        REQUIRE(glm::dot(glm::dvec3(h), view) > -1e-6);
        ++counts[ring_of(h.z) * sectors + sector_of(h)];
      }
      // D cos d(omega) is 2 (1 - x) dx d(phi) / (2 pi).
      constexpr int fine = 40;
      for (int a = 0; a < rings * fine; ++a)
        for (int b = 0; b < sectors * fine; ++b) {
          const double stretched = 1 - (a + 0.5) / (rings * fine);
          const double tangent = alpha * std::sqrt(1 / (stretched * stretched) - 1);
          const double phi = 2 * M_PI * (b + 0.5) / (sectors * fine) - M_PI;
          const glm::dvec3 h = polar(std::atan(tangent), phi);
          const double tangent2_view = (1 - view.z * view.z) / (view.z * view.z);
          const double g1 = 2 / (1 + std::sqrt(1 + alpha * alpha * tangent2_view));
          const double cell = 2 * stretched / (rings * fine * sectors * fine) / h.z;
          expected[a / fine * sectors + b / fine] +=
              samples * g1 * std::max(0.0, glm::dot(view, h)) * cell / view.z;
        }
      // Bins that hardly ever fill are pooled.
      double pooled_count = 0, pooled_expected = 0;
      std::vector<double> kept_counts, kept_expected;
      for (int k = 0; k < rings * sectors; ++k) {
        if (expected[k] >= 20) {
          kept_counts.push_back(counts[k]);
          kept_expected.push_back(expected[k]);
        } else {
          pooled_count += counts[k];
          pooled_expected += expected[k];
        }
      }
      if (pooled_expected >= 5) {
        kept_counts.push_back(pooled_count);
        kept_expected.push_back(pooled_expected);
      } else {
        CHECK(pooled_count < 30);
      }
      CAPTURE(alpha, theta);
      CHECK_VERDICT(counts_agree(kept_counts, kept_expected));
    }
}
