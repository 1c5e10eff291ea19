// `photile render --glare`.
#include <catch2/catch.hpp>

#include "box_scene.hpp"
#include "child_process.hpp"
#include "file_folder.hpp"
#include "photile/image.hpp"

namespace photile::test {
namespace {

using Catch::Contains;

std::vector<std::string> render(const std::string& scene, std::vector<std::string> more) {
  std::vector<std::string> arguments{"render",    scene, "--size",    "40x30",
                                     "--samples", "1",   "--quality", "draft"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

}  // namespace

TEST_CASE("matt walls have no reflections to mark, with photons or paths") {
  const std::string integrator = GENERATE("photon-map", "path");
  const FileFolder folder;
  const Outcome outcome = run_photile(
      render(write_box(folder), {"--glare", folder / "glare.png", "--integrator", integrator}));
  INFO(outcome.errors);
  REQUIRE(outcome.exit_code == 0);
  CHECK_THAT(outcome.errors, Contains("glare: no reflection is above"));
  CHECK(read_image(folder / "glare.png").width == 40);
}

TEST_CASE("glare needs a PNG to be written to") {
  const FileFolder folder;
  CHECK_THAT(only_error(run_photile(render(write_box(folder), {"-q", "--glare", "marks.exr"})), 2),
             Contains("marks.exr") && Contains(".png"));
}

}  // namespace photile::test
