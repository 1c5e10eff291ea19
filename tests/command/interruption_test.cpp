// SIGINT and SIGTERM stop a render: exit code 130, earlier files kept, nothing half written.
#include <catch2/catch.hpp>

#include "box_scene.hpp"
#include "child_process.hpp"
#include "file_folder.hpp"

namespace photile::test {

using Catch::Contains;

TEST_CASE("a signal during a render gives 130 and keeps the earlier files") {
  const FileFolder folder;
  Run run;
  run.arguments = {"render",  write_box(folder),   "-o",        folder / "out.exr",
                   "--stats", folder / "out.json", "--photons", "2G"};
  run.terminal = true;
  run.signal_when = "%  ";  // only a bar under way prints one
  run.signal = GENERATE(SIGINT, SIGTERM);
  folder.write("out.exr", "earlier");
  const Outcome outcome = run_photile(run);
  INFO(outcome.errors);
  CHECK(outcome.exit_code == 130);
  CHECK_THAT(outcome.errors, Contains("interrupted"));
  CHECK(folder.read("out.exr") == "earlier");
  CHECK(folder.file_count() == 3);  // the scene's two files and the earlier picture
}

}  // namespace photile::test
