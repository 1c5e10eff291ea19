// Scenes that cannot be rendered, files that ask for too much, outputs that cannot be written.
#include <catch2/catch.hpp>
#include <cstdint>
#include <cstring>

#include "box_scene.hpp"
#include "child_process.hpp"
#include "file_folder.hpp"
#include "loading/luminaires.hpp"
#include "photile/image.hpp"
#include "view/moods.hpp"

namespace photile::test {
namespace {

using Catch::Contains;

TEST_CASE("of an unreadable scene info and render say the same, and nothing is written") {
  const FileFolder folder;
  const std::string scene = write_box(folder);
  std::filesystem::permissions(scene, std::filesystem::perms::none);
  Run run;
  run.held_to_permissions = true;
  run.arguments = {"info", scene};
  const std::string line = only_error(run_photile(run), bad_input);
  CHECK_THAT(line, Contains("box.obj"));
  run.arguments = {"render", scene, "-o", folder / "out.exr"};
  CHECK(last_error(run_photile(run), bad_input) == line);
  CHECK_FALSE(std::filesystem::exists(folder / "out.exr"));
}

// Small files that ask for much: refused, and in little memory. (Time is no matter of assertions;
// each of these takes less than a second.)

constexpr long most_kilobytes = 256 << 10;  ///< beside the file itself

TEST_CASE("a small EXR that says that it is huge is refused in little memory") {
  // A header of 9,000 x 9,000 pixels of six channels: zeros would compress to two megabytes; what
  // follows the pixels does not count.
  const std::size_t size = GENERATE(2'100'000, 6'000'000);
  CAPTURE(size);
  Image row;
  row.width = 9'000;
  row.height = 1;
  for (const char* name :
       {"R", "G", "B", "Combined_lamp.R", "Combined_lamp.G", "Combined_lamp.B"}) {
    row.add(name);
  }
  const FileFolder folder;
  write_exr(folder / "row.exr", row);
  std::string bytes = folder.read("row.exr");
  const std::string window("dataWindow\0box2i\0", 17);
  const std::int32_t last = 8'999;
  std::memcpy(&bytes[bytes.find(window) + window.size() + 4 * sizeof last], &last, sizeof last);
  bytes.resize(size);
  const std::string file = folder.write("a.exr", bytes);
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"relight", file, "-o", folder / "b.exr"},
        std::vector<std::string>{"compare", file, file},
        std::vector<std::string>{"render", write_box(folder), "-o", folder / "b.exr",
                                 "--environment", file}}) {
    const Outcome taken = run_photile(command);
    CHECK_THAT(last_error(taken, bad_input), Catch::Contains("a.exr: ") &&
                                                 Catch::Contains("pixels per byte") &&
                                                 Catch::Contains("scale it down"));
    CHECK(taken.kilobytes < most_kilobytes);
  }
}

TEST_CASE("JSON that is nested a million deep is refused in a line") {
  constexpr std::size_t levels = 1'000'000;
  const FileFolder folder;
  const std::string file =
      folder.write("deep.json", std::string(levels, '[') + "0" + std::string(levels, ']'));
  CHECK_THROWS_WITH(view::Moods(file), Catch::Contains("deep.json: the JSON is nested more than"));
  // Brackets in texts are none.
  const std::string text = "[{\"name\": \"\\\"" + std::string(levels, '[') + "\"}]";
  CHECK(loading::LuminaireList::parse(text, "texts").entries.size() == 1);
}

}  // namespace
}  // namespace photile::test
