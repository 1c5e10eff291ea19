// Who pays for OpenImageIO: the dynamic linker says what it loads.
#include <catch2/catch.hpp>

#include "box_scene.hpp"
#include "child_process.hpp"
#include "file_folder.hpp"

namespace photile::test {
namespace {

/// What the dynamic linker prints while a command runs.
std::string loaded_by(const std::vector<std::string>& arguments) {
  const Outcome outcome =
      run_photile({.arguments = arguments, .environment = {{"LD_DEBUG", "files"}}});
  CAPTURE(arguments);
  CHECK(outcome.exit_code == 0);
  CHECK_THAT(outcome.errors, Catch::Contains("libOpenEXR"));
  return outcome.errors;
}

}  // namespace

TEST_CASE("OpenImageIO is loaded where a picture is read that is no EXR, and nowhere else") {
  const FileFolder folder;
  const std::string box = write_box(folder), picture = folder / "a.exr";
  const std::vector<std::string> render{"render",    box,     "-o",        picture,
                                        "--size",    "16x12", "--quality", "draft",
                                        "--photons", "2k",    "--quiet"};
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"--version"}, render,
        std::vector<std::string>{"measure", box, "--plane", "floor+0.75", "--photons", "2k",
                                 "--rays", "16", "--quiet"},
        std::vector<std::string>{"relight", picture, "--light", "left=x2", "-o", folder / "b.exr"},
        std::vector<std::string>{"compare", picture, picture}}) {
    CHECK_THAT(loaded_by(command), !Catch::Contains("OpenImageIO"));
  }
  folder.write("rug.ppm", "P6 1 1 255\n\x80\x40\x20");
  folder.write("box.mtl", box_mtl() + "newmtl rug\nmap_Kd rug.ppm\n");
  folder.write("box.obj", box_obj() + "vt 0 0\nvt 1 0\nvt 1 1\nusemtl rug\nf 1/1 2/2 3/3\n");
  const std::string texture = folder / "rug.ppm";
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"info", box},
        std::vector<std::string>{"compare", texture, texture}}) {
    CHECK_THAT(loaded_by(command),
               Catch::Contains("photile_openimageio.so") && Catch::Contains("libOpenImageIO.so"));
  }
}

TEST_CASE("what libpng has to say about a picture stays out of the error line") {
  const FileFolder folder;
  // A header with a wrong checksum.
  const std::string png(
      "\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\x01\0\0\0\x01\x08\0\0\0\0\0\0\0\0"
      "\0\0\0\0IEND\xae\x42\x60\x82",
      45);
  const std::string file = folder.write("a.png", png);
  CHECK_THAT(only_error(run_photile({"compare", file, file}), bad_input),
             Catch::Contains("a.png: "));
}

}  // namespace photile::test
