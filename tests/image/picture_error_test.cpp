#include <catch2/catch.hpp>
#include <cmath>

#include "photile/errors.hpp"
#include "photile/image.hpp"

namespace photile::test {
namespace {

constexpr int side = 32;

Image grey(float value) {
  Image image;
  image.width = image.height = side;
  for (const char* channel : {"R", "G", "B"}) image.add(channel).assign(side * side, value);
  return image;
}

void scale(Image& image, float factor) {
  for (auto& plane : image.channels) {
    for (float& value : plane) value *= factor;
  }
}

}  // namespace

TEST_CASE("a picture that is brighter by a factor has the errors that follow from it") {
  const Image reference = grey(2.0f);
  Image picture = reference;
  scale(picture, 1.1f);
  const PictureError error = picture_error(picture, reference);
  // ((1.1 - 1) x 2)^2 / (2^2 + 0.01 x 2^2)
  CHECK(error.relative_mse == Approx(0.01 / 1.01).epsilon(1e-5));
  CHECK(error.mean_ratio == Approx(1.1).epsilon(1e-6));
  CHECK(error.worst_region == Approx(0.1).epsilon(1e-5));
  // Displayed as 0.18 and 0.198, where white is 1.
  CHECK(error.psnr == Approx(-20 * std::log10(0.018)).epsilon(1e-4));
}

TEST_CASE("equal pictures have no error") {
  const Image picture = grey(0.3f);
  const PictureError error = picture_error(picture, picture);
  CHECK(error.relative_mse == 0);
  CHECK(error.mean_ratio == 1);
  CHECK(error.worst_region == 0);
  CHECK(std::isinf(error.psnr));
}

TEST_CASE("noise averages out of regions and of the mean, and stays in the relative error") {
  const Image reference = grey(1.0f);
  Image picture = reference;
  for (auto& plane : picture.channels) {
    for (std::size_t i = 0; i < plane.size(); ++i)
      plane[i] += (i + i / side) % 2 == 0 ? 0.2f : -0.2f;
  }
  const PictureError error = picture_error(picture, reference);
  CHECK(error.relative_mse == Approx(0.04 / 1.01).epsilon(1e-5));
  CHECK(error.mean_ratio == Approx(1).epsilon(1e-6));
  CHECK(error.worst_region < 1e-6);
}

TEST_CASE("one wrong region is the worst region") {
  const Image reference = grey(1.0f);
  Image picture = reference;
  for (auto& plane : picture.channels) {
    for (int y = 0; y < 2; ++y) {  // a tile of a sixteenth of the height
      for (int x = 4; x < 6; ++x) plane[static_cast<std::size_t>(y * side + x)] = 0.5f;
    }
  }
  const PictureError error = picture_error(picture, reference);
  CHECK(error.worst_region == Approx(0.5).epsilon(1e-6));
  CHECK(error.worst_place.x == 4);
  CHECK(error.worst_place.y == 0);
  CHECK(error.worst_place.width == 2);
  CHECK(error.worst_place.height == 2);
}

TEST_CASE("pixels that see a lamp in the reference do not count, nor do those next to them") {
  Image reference = grey(1.0f), picture = grey(1.0f);
  const auto at = [](int x, int y) { return static_cast<std::size_t>(y * side + x); };
  for (auto& plane : reference.channels) plane[at(5, 7)] = 1000.0f;
  for (auto& plane : picture.channels) plane[at(6, 8)] = 30.0f;  // the lamp's border
  CHECK(picture_error(picture, reference).relative_mse == 0);
  CHECK(picture_error(picture, reference).mean_ratio == 1);
  for (auto& plane : picture.channels) plane[at(7, 8)] = 30.0f;  // beyond
  CHECK(picture_error(picture, reference).relative_mse > 0.5);
}

TEST_CASE("pictures that cannot be compared are refused") {
  const Image reference = grey(1.0f);
  Image other = grey(1.0f);
  other.width = side / 2;
  CHECK_THROWS_AS(picture_error(other, reference), UsageError);
  Image bare;
  bare.width = bare.height = side;
  CHECK_THROWS_AS(picture_error(bare, reference), UsageError);
  CHECK_THROWS_AS(picture_error(reference, grey(0.0f)), InputError);
}

}  // namespace photile::test
