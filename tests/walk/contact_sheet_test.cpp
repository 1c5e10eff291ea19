// Frames on a contact sheet, each in its place.
#include <catch2/catch.hpp>

#include "photile/defaults.hpp"
#include "walk/frames.hpp"

namespace photile::test {

using walk::ContactSheet;

namespace {

constexpr int gap = 4;

/// Red on its left half and black on the right; green all over.
Image frame(int width, int height, float red, float green) {
  Image image;
  image.width = width;
  image.height = height;
  for (const char* channel : {"R", "G", "B"}) image.add(channel);
  for (std::size_t i = 0; i < image.pixels(); ++i) {
    const bool left = static_cast<int>(i) % width < width / 2;
    image.channels[0][i] = left ? red : 0;
    image.channels[1][i] = green;
  }
  return image;
}

float at(const Image& sheet, const char* channel, int x, int y) {
  return (*sheet.find(channel))[static_cast<std::size_t>(y * sheet.width + x)];
}

}  // namespace

TEST_CASE("frames lie from left to right and from top to bottom, the rest of the sheet is grey") {
  constexpr int width = 6, height = 4;
  ContactSheet sheet(5, width, height);  // 3 columns, 2 rows
  for (int i = 0; i < 5; ++i) sheet.add(i, frame(width, height, 0.5f, 0.1f * float(i + 1)));
  const Image& image = sheet.image();
  CHECK(image.width == 3 * width + 4 * gap);
  CHECK(image.height == 2 * height + 3 * gap);
  for (int i = 0; i < 5; ++i) {
    INFO("frame " << i);
    const int left = gap + i % 3 * (width + gap), top = gap + i / 3 * (height + gap);
    CHECK(at(image, "G", left, top) == Approx(0.1 * (i + 1)));
    CHECK(at(image, "G", left + width - 1, top + height - 1) == Approx(0.1 * (i + 1)));
    CHECK(at(image, "R", left + 2, top) == 0.5f);
    CHECK(at(image, "R", left + 3, top) == 0.0f);
    CHECK(at(image, "G", left - 1, top) == at(image, "G", 0, 0));
  }
  const int sixth = gap + 2 * (width + gap);
  CHECK(at(image, "G", sixth, gap + height + gap) == at(image, "G", 0, 0));
}

TEST_CASE("large frames are drawn small, as the means of their pixels") {
  constexpr int small = defaults::contact_sheet_width;
  ContactSheet sheet(1, 4 * small, 4 * 100);
  Image stripes = frame(4 * small, 4 * 100, 0, 0);
  for (std::size_t i = 0; i < stripes.pixels(); i += 2) stripes.channels[2][i] = 1;
  sheet.add(0, stripes);
  CHECK(sheet.image().width == small + 2 * gap);
  CHECK(sheet.image().height == 100 + 2 * gap);
  for (const int x : {0, 100, small - 1}) {
    CHECK(at(sheet.image(), "B", gap + x, gap + 50) == Approx(0.5));
  }
}

}  // namespace photile::test
