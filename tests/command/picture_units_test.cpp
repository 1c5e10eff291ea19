// Pictures of other programs, compared.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <string>

#include "child_process.hpp"
#include "file_folder.hpp"
#include "photile/image.hpp"

namespace photile::test {

TEST_CASE("pictures are compared as the light that their files say they are") {
  const FileFolder folder;
  const auto write = [&](const std::string& name, float value, float white) {
    Image image;
    image.width = image.height = 8;
    for (const char* channel : {"R", "G", "B"}) image.add(channel).assign(64, value);
    if (white > 0) image.numbers["whiteLuminance"] = white;
    write_exr(folder / name, image);
    return folder / name;
  };
  const auto mean_ratio = [&](const std::string& a, const std::string& b) {
    succeed({"compare", a, b, "--json", folder / "compared.json"});
    return nlohmann::json::parse(folder.read("compared.json"))["picture"]["mean_ratio"]
        .get<double>();
  };
  std::string radiance = "#?RADIANCE\nEXPOSURE=4\nFORMAT=32-bit_rle_rgbe\n\n+X 8 +Y 8\n";
  for (int i = 0; i < 64; ++i) radiance += "\x80\x80\x80\x82";  // 2
  folder.write("a.hdr", radiance);
  const std::string half = write("half.exr", 0.5f, 0);
  CHECK(mean_ratio(folder / "a.hdr", half) == Approx(1));
  // 50 in units of 1 cd/m2 are 0.5 in units of 100 cd/m2.
  const std::string hundreds = write("hundreds.exr", 0.5f, 100), ones = write("ones.exr", 50, 1);
  CHECK(mean_ratio(hundreds, ones) == Approx(1));
  CHECK(mean_ratio(ones, hundreds) == Approx(1));
  CHECK(mean_ratio(hundreds, half) == Approx(1));  // of which no unit is known
}

}  // namespace photile::test
