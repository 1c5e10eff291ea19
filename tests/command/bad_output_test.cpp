// Outputs that cannot be written are refused before the long work, and never left half written.
#include <catch2/catch.hpp>

#include "box_scene.hpp"
#include "child_process.hpp"
#include "file_folder.hpp"
#include "photile/image.hpp"

namespace photile::test {
namespace {

using Catch::Contains;

/// The only line of a render that was refused before it began: no device line came before.
std::string refusal(const std::vector<std::string>& outputs, int exit_code) {
  const FileFolder folder;
  std::vector<std::string> arguments{"render", write_box(folder)};
  arguments.insert(arguments.end(), outputs.begin(), outputs.end());
  return only_error(run_photile(arguments), exit_code);
}

/// An EXR of one light layer, so large that a small limit on file sizes cuts it.
std::string write_layered_picture(const FileFolder& folder) {
  Image picture;
  picture.width = picture.height = 64;
  for (const char* channel : {"R", "G", "B", "Combined_a.R", "Combined_a.G", "Combined_a.B"}) {
    std::vector<float>& plane = picture.add(channel);
    // Noise, so that compression cannot save the day.
    std::uint32_t state = 1;
    for (float& value : plane) {
      state = state * 1664525u + 1013904223u;
      value = static_cast<float>(state) * 1e-9f;
    }
  }
  write_exr(folder / "in.exr", picture);
  return folder / "in.exr";
}

}  // namespace

TEST_CASE("an output in a folder that does not exist is refused before the work") {
  const std::string option = GENERATE("-o", "--illuminance", "--stats");
  const std::string file = "/nonexistent-folder/out.png";
  CHECK_THAT(refusal({"-o", "/nonexistent-folder/out.png", option, file}, failure),
             Contains("/nonexistent-folder/out.png"));
}

TEST_CASE("an output that is a folder is refused before the work") {
  const FileFolder folder;
  std::filesystem::create_directory(folder / "out.exr");
  CHECK_THAT(refusal({"-o", folder / "out.exr"}, failure), Contains("out.exr"));
}

TEST_CASE("a folder for outputs that cannot be made is refused before the work") {
  const FileFolder folder;
  const std::string scene = write_box(folder), below_a_file = folder / "box.mtl/results";
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"trade", scene, "-o", below_a_file},
        std::vector<std::string>{"measure", scene, "--plane", "1", "--honeybee", below_a_file}}) {
    CHECK_THAT(only_error(run_photile(arguments), failure),
               Contains("box.mtl/results") && Contains("cannot make this folder"));
  }
}

TEST_CASE("statistics to a device that is always full are refused before the work") {
  const FileFolder folder;
  CHECK_THAT(refusal({"-o", folder / "out.exr", "--stats", "/dev/full"}, failure),
             Contains("/dev/full"));
  CHECK(folder.file_count() == 0);
}

TEST_CASE("an output of an unknown format is a usage error") {
  const FileFolder folder;
  CHECK_THAT(refusal({"-o", folder / "out.jpg"}, usage), Contains("out.jpg") && Contains(".exr"));
  CHECK_THAT(refusal({"--luminance", folder / "out.exr"}, usage), Contains(".png"));
}

TEST_CASE("an output named twice is a usage error") {
  const FileFolder folder;
  CHECK_THAT(refusal({"-o", folder / "out.png", "-o", folder / "./out.png"}, usage),
             Contains("twice"));
}

TEST_CASE("an output that is the scene itself is a usage error and the scene is kept") {
  const FileFolder folder;
  const std::string scene = write_box(folder);
  const std::string before = folder.read("box.obj");
  const Outcome outcome =
      run_photile({"render", scene, "-o", folder / "out.exr", "--stats", folder / "./box.obj"});
  CHECK_THAT(only_error(outcome, usage), Contains("box.obj"));
  CHECK(folder.read("box.obj") == before);
}

TEST_CASE("a disk that fills up while an EXR is written leaves the earlier file and no other") {
  const FileFolder folder;
  const std::string input = write_layered_picture(folder);
  folder.write("out.exr", "earlier");
  Run run;
  run.arguments = {"relight", input, "--light", "a=x2", "-o", folder / "out.exr"};
  run.file_size_limit = 10'000;  // the picture has 64 x 64 x 6 floats of noise
  CHECK_THAT(only_error(run_photile(run), failure), Contains("out.exr"));
  CHECK(folder.read("out.exr") == "earlier");
  CHECK(folder.file_count() == 2);
}

}  // namespace photile::test
