// Pictures that OpenImageIO writes.
#pragma once

#include <OpenImageIO/imageio.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <vector>

namespace photile::test {

/// Writes bytes or floats as the specification says, in the format that the file's name ends in.
template <typename T>
void write_by_oiio(const std::filesystem::path& file, const OIIO::ImageSpec& spec,
                   const std::vector<T>& pixels) {
  const auto output = OIIO::ImageOutput::create(file.string());
  REQUIRE(output);
  REQUIRE(output->open(file.string(), spec));
  REQUIRE(output->write_image(OIIO::BaseTypeFromC<T>::value, pixels.data()));
  REQUIRE(output->close());
}

}  // namespace photile::test
