// The BSDF shared with the device, against its defining integrals.
#include "photile/device/bsdf.h"

#include <catch2/catch.hpp>

#include "statistical_tests.hpp"
#include "test_scenes.hpp"
#include "trace/opaque_bsdf.hpp"
#include "trace/random_stream.hpp"

namespace photile::test {

using namespace trace;

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

/// Weights of F0 and F90 in the albedo of one facet's reflection.
struct Weights {
  Weights(double cosine, double alpha) {
    PhotileAlbedoFit fit;
    photile_albedo_fit(static_cast<float>(alpha), &fit);
    photile_lobe_albedo(&fit, static_cast<float>(cosine), &f0, &f90);
  }
  float f0 = 0, f90 = 0;
};

trace::DiffusePart part_of(double cosine, double albedo, double f0, double alpha) {
  return trace::diffuse_part({glm::vec3(static_cast<float>(albedo)),
                              glm::vec3(static_cast<float>(f0)), 1.0f, static_cast<float>(alpha)},
                             static_cast<float>(cosine));
}

/// One facet's reflection alone.
double facet_reflection(const glm::dvec3& i, const glm::dvec3& o, double f0, double alpha) {
  const glm::dvec3 h = glm::normalize(i + o);
  const float lobe = photile_ggx_lobe(static_cast<float>(i.z), static_cast<float>(o.z),
                                      static_cast<float>(h.z), static_cast<float>(alpha));
  return photile_opaque_bsdf(0.0f, static_cast<float>(f0), 1.0f,
                             photile_schlick(static_cast<float>(glm::dot(i, h))), lobe);
}

double reflection(const glm::dvec3& i, const glm::dvec3& o, double albedo, double f0,
                  double alpha) {
  const Weights weights(i.z, alpha);
  const trace::DiffusePart part = part_of(o.z, albedo, f0, alpha);
  return facet_reflection(i, o, f0, alpha) +
         double{photile_diffuse(part[0].r, part[1].r, part[2].r, weights.f0, weights.f90)};
}

/// Share of light from i that f(i, o) reflects anywhere. Integrated over half vectors, where the
/// lobe is smooth: d(o) = 4 i.h d(h); the other parts join by the same substitution.
template <class F>
double reflected_fraction(const glm::dvec3& i, F&& f, int rings = 500, int sectors = 120) {
  return over_hemisphere(
      [&](const glm::dvec3& h) {
        const double i_h = glm::dot(i, h);
        const glm::dvec3 o = 2 * i_h * h - i;
        return i_h > 0 && o.z > 0 ? 4 * i_h * o.z * f(o) : 0.0;
      },
      rings, sectors);
}

double albedo_of(const glm::dvec3& i, double albedo, double f0, double alpha) {
  return reflected_fraction(
      i, [&](const glm::dvec3& o) { return reflection(i, o, albedo, f0, alpha); });
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

TEST_CASE("A white metal, and a white base under a coat, reflect all that falls in from any side") {
  // What is left is the error of the fits to their albedos: docs/reference/materials.md.
  for (const double alpha : {0.05, 0.1, 0.3, 0.6, 1.0})
    for (const double cosine : {0.1, 0.3, 0.6, 0.9, 1.0}) {
      CAPTURE(alpha, cosine);
      const glm::dvec3 i = polar(std::acos(cosine), 0);
      CHECK(albedo_of(i, 0, 1, alpha) == Approx(1).margin(0.04));
      CHECK(albedo_of(i, 1.0, 0.04, alpha) == Approx(1).margin(0.015));
      CHECK(albedo_of(i, 0.9, 0.04, alpha) < 1);
    }
}

TEST_CASE("The fit to the coat's albedo is that of its integral") {
  for (const double alpha : {0.05, 0.1, 0.3, 0.6, 1.0})
    for (const double cosine : {0.1, 0.3, 0.6, 0.9, 1.0}) {
      CAPTURE(alpha, cosine);
      const Weights weights(cosine, alpha);
      const glm::dvec3 i = polar(std::acos(cosine), 0);
      const auto share = [&](double f0) {
        return reflected_fraction(
            i, [&](const glm::dvec3& o) { return facet_reflection(i, o, f0, alpha); });
      };
      CHECK(weights.f0 + weights.f90 == Approx(share(1)).margin(0.035));  // F = 1
      CHECK(weights.f90 == Approx(share(0)).margin(0.006));               // F is Schlick's weight
    }
}

TEST_CASE("The mean of the coat's albedo is that of the fit over a diffusely lit hemisphere") {
  constexpr int steps = 1000;
  for (const float alpha : {0.02f, 0.1f, 0.25f, 0.5f, 0.75f, 1.0f}) {
    PhotileAlbedoFit fit;
    photile_albedo_fit(alpha, &fit);
    double f0_sum = 0, f90_sum = 0;
    for (int s = 0; s < steps; ++s) {
      float f0_weight = 0, f90_weight = 0;
      photile_lobe_albedo(&fit, std::sqrt((static_cast<float>(s) + 0.5f) / steps), &f0_weight,
                          &f90_weight);
      f0_sum += double{f0_weight} / steps;
      f90_sum += double{f90_weight} / steps;
    }
    float f0_mean = 0, f90_mean = 0;
    photile_mean_lobe_albedo(alpha, &f0_mean, &f90_mean);
    CAPTURE(alpha);
    CHECK(f0_mean == Approx(f0_sum).margin(0.003));
    CHECK(f90_mean == Approx(f90_sum).margin(0.002));
  }
}

TEST_CASE("Without a coat the opaque BSDF is Lambertian") {
  const trace::DiffusePart part =
      trace::diffuse_part({glm::vec3(0.7f), glm::vec3(0.0f), 0.0f, 1.0f}, 0.3f);
  const float diffuse = photile_diffuse(part[0].r, part[1].r, part[2].r, 0.4f, 0.2f);
  CHECK(diffuse == Approx(0.7 / M_PI));
  CHECK(photile_opaque_bsdf(diffuse, 0.0f, 0.0f, 0.9f, 5.0f) == diffuse);
}

TEST_CASE("Rays follow a lobe by its part of what is seen, and by what it reflects") {
  const auto rays_of = [](float albedo, float f0, float alpha) {
    const Scene scene = plate(glossy(albedo, f0, alpha), 2);
    const glm::vec3 direction(0, 0, -1);
    return OpaqueBsdf(scene, surface_hit(scene, {0, 0.3f, 0.3f}, direction), direction).lobe_rays();
  };
  // Of 16 that a perfect metal has.
  CHECK(rays_of(0.0f, 0.9f, 0.2f) == Approx(0.9 * 16).epsilon(0.05));
  CHECK(rays_of(0.8f, 0.04f, 0.2f) < 1);  // a twentieth of what is seen
  CHECK(rays_of(0.8f, 0.01f, 0.2f) == 0.5);
  CHECK(rays_of(0.0f, 0.04f, 0.2f) == Approx(8).epsilon(0.05));  // all of it
  CHECK(rays_of(0.0f, 0.04f, 0.005f) < 5);                       // narrower ones scatter less
}

TEST_CASE("Directions are drawn with the density that the opaque BSDF claims") {
  constexpr int samples = 200'000, rings = 16, sectors = 16, fine = 24;
  for (const Material& material : {diffuse(0.6f), glossy(0.5f, 0.04f, 0.3f),
                                   glossy(0.0f, 0.9f, 0.4f), glossy(0.3f, 0.2f, 1.0f)})
    for (const float tilt : {0.0f, 1.5f}) {
      const Scene scene = plate(material, 2);
      const glm::vec3 direction = glm::normalize(glm::vec3(tilt, 0.2f * tilt, -1));
      const SurfacePoint point = surface_hit(scene, {0, 0.3f, 0.3f}, direction);
      const OpaqueBsdf bsdf(scene, point, direction);
      // Cells of equal cosine and azimuth.
      std::vector<double> counts(rings * sectors, 0.0), expected(rings * sectors, 0.0);
      int lost = 0;
      for (int n = 0; n < samples; ++n) {
        const auto drawn = bsdf.sample(RandomStream(77, n, 0).block(Purpose::path_scattering, 0));
        if (!drawn) {
          ++lost;
          continue;
        }
        REQUIRE(bsdf.density(*drawn) > 0);
        const double azimuth = std::atan2(double{drawn->y}, double{drawn->x}) / (2 * M_PI) + 0.5;
        ++counts[std::min(static_cast<int>(rings * drawn->z), rings - 1) * sectors +
                 std::min(static_cast<int>(sectors * azimuth), sectors - 1)];
      }
      double total = 0;
      for (int a = 0; a < rings * fine; ++a)
        for (int b = 0; b < sectors * fine; ++b) {
          const double cosine = (a + 0.5) / (rings * fine);
          const double azimuth = 2 * M_PI * (b + 0.5) / (sectors * fine) - M_PI;
          const double density = bsdf.density(glm::vec3(polar(std::acos(cosine), azimuth))) * 2 *
                                 M_PI / (rings * fine * sectors * fine);
          expected[a / fine * sectors + b / fine] += samples * density;
          total += density;
        }
      CAPTURE(tilt, material.roughness, total);
      CHECK(total < 1.001);
      // Directions that would enter the surface, and bins that hardly ever fill, are one bin.
      std::vector<double> kept_counts{static_cast<double>(lost)};
      std::vector<double> kept_expected{samples * (1 - total)};
      for (int k = 0; k < rings * sectors; ++k) {
        if (expected[k] >= 20) {
          kept_counts.push_back(counts[k]);
          kept_expected.push_back(expected[k]);
        } else {
          kept_counts[0] += counts[k];
          kept_expected[0] += expected[k];
        }
      }
      if (kept_expected[0] < 20) {
        kept_counts[1] += kept_counts[0];
        kept_expected[1] += kept_expected[0];
        kept_counts.erase(kept_counts.begin());
        kept_expected.erase(kept_expected.begin());
      }
      CHECK_VERDICT(counts_agree(kept_counts, kept_expected));
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

}  // namespace photile::test
