#include <catch2/catch.hpp>
#include <cmath>

#include "tools/trade/quality_target.hpp"

namespace photile::test {
namespace {

const ErrorModel error_model{.noise = 1.5, .sampling = 0.004, .bias = 2, .exponent = 1};
const TimeModel time_model{.fixed = 0.1,
                           .per_photon = 1e-6,
                           .per_sample = 2e-7,
                           .per_sample_neighbour = 3e-9,
                           .samples_per_picture = 200'000};

double expected(const QualityChoice& choice) {
  return std::sqrt(error_model.relative_mse(static_cast<double>(choice.photons), choice.neighbours,
                                            choice.samples_per_pixel));
}

}  // namespace

TEST_CASE("settings for a wanted error are expected to stay below it, and not far") {
  const double wanted = GENERATE(0.2, 0.1, 0.05, 0.04);
  const QualityChoice choice =
      choose_settings({.relative_error = wanted}, error_model, time_model, 1'000'000);
  CHECK(choice.reached);
  CHECK(choice.expected_error == Approx(expected(choice)));
  CHECK(choice.expected_error < wanted);
  CHECK(choice.expected_error > 0.5 * wanted);  // what is better than wanted costs time
}

TEST_CASE("no other settings of the search are faster and within the error") {
  const QualityChoice choice =
      choose_settings({.relative_error = 0.05}, error_model, time_model, 1'000'000);
  const double chosen = time_model.first_picture(static_cast<double>(choice.photons),
                                                 choice.neighbours, choice.samples_per_pixel);
  for (double k = 8; k < 8192; k *= 1.3) {
    for (double photons = 1e4; photons < 1e8; photons *= 1.3) {
      for (const double samples : {1., 2., 4., 8., 16.}) {
        if (std::sqrt(error_model.relative_mse(photons, k, samples)) > 0.56 * 0.05) continue;
        CHECK(time_model.first_picture(photons, k, samples) > 0.99 * chosen);
      }
    }
  }
}

TEST_CASE("within a frame time the error is made least, and the photons stay") {
  const QualityChoice choice =
      choose_settings({.frame_seconds = 0.2}, error_model, time_model, 1'000'000);
  CHECK(choice.reached);
  CHECK(choice.photons == 1'000'000);
  CHECK(time_model.frame(choice.neighbours, choice.samples_per_pixel) <= 0.2);
  const QualityChoice slower =
      choose_settings({.frame_seconds = 0.8}, error_model, time_model, 1'000'000);
  CHECK(slower.expected_error < choice.expected_error);
}

TEST_CASE("a frame time bounds the settings for a wanted error, which then take more photons") {
  const QualityChoice free =
      choose_settings({.relative_error = 0.08}, error_model, time_model, 1'000'000);
  const double frame = 0.7 * free.expected_frame_seconds;
  const QualityChoice bound = choose_settings({.relative_error = 0.08, .frame_seconds = frame},
                                              error_model, time_model, 1'000'000);
  CHECK(bound.expected_frame_seconds <= frame);
  if (bound.reached) CHECK(bound.expected_error <= 0.08);
}

TEST_CASE("a target out of reach is said to be, and approached") {
  const QualityChoice fast =
      choose_settings({.frame_seconds = 1e-6}, error_model, time_model, 1'000'000);
  CHECK_FALSE(fast.reached);
  CHECK(fast.samples_per_pixel == 1);
  CHECK(fast.neighbours == 8);
  const QualityChoice exact =
      choose_settings({.relative_error = 1e-6}, error_model, time_model, 1'000'000);
  CHECK_FALSE(exact.reached);
  const QualityChoice reachable =
      choose_settings({.relative_error = 0.05}, error_model, time_model, 1'000'000);
  CHECK(exact.expected_error < reachable.expected_error);
}

}  // namespace photile::test
