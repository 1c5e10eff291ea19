// Progress: the bar's text, the bar on a terminal, plain lines elsewhere.
#include <algorithm>
#include <catch2/catch.hpp>

#include "box_scene.hpp"
#include "child_process.hpp"
#include "command/terminal_progress.hpp"
#include "file_folder.hpp"

namespace photile::test {
namespace {

using app::progress_bar;
using app::StageProgress;
using Catch::Contains;

Run small_render(const FileFolder& folder) {
  Run run;
  run.arguments = {"render", write_box(folder), "-o",    folder / "out.png", "--photons",
                   "20k",    "--size",          "16x12", "--quality",        "draft"};
  return run;
}

const StageProgress half_done{"trace photons", 50, 100, "paths", 2.0};

}  // namespace

TEST_CASE("a bar shows the share done, the time elapsed and remaining, and the rate") {
  const std::string bar = progress_bar(half_done, 100);
  CHECK_THAT(bar, Contains("trace photons") && Contains(" 50%") && Contains("2.00 s | 2.00 s") &&
                      Contains("25 paths/s"));
  CHECK(std::count(bar.begin(), bar.end(), '=') == 20);  // half of the widest bar, 40
}

TEST_CASE("a bar leaves the last column of any terminal free") {
  for (int width = 0; width < 200; ++width) {
    CHECK(static_cast<int>(progress_bar(half_done, width).size()) <= std::max(0, width - 1));
  }
}

TEST_CASE("a bar copes with nothing done, too much done and an unknown total") {
  CHECK_THAT(progress_bar({"a", 0, 100, "paths", 0}, 100), Contains("  0%") && Contains("| ?"));
  CHECK_THAT(progress_bar({"a", 150, 100, "paths", 1}, 100), Contains("100%"));
  CHECK_THAT(progress_bar({"a", 150, 0, "paths", 1}, 100), !Contains("%") && Contains("1.00 s"));
}

TEST_CASE("a render without a terminal prints plain lines, the device first") {
  const FileFolder folder;
  const Outcome outcome = run_photile(small_render(folder));
  INFO(outcome.errors);
  REQUIRE(outcome.exit_code == 0);
  CHECK(outcome.output.empty());
  CHECK(outcome.errors.find_first_of("\r\033") == std::string::npos);
  const auto lines = outcome.error_lines();
  CHECK_THAT(lines[0], Catch::StartsWith("device: "));
  CHECK_THAT(outcome.errors, Contains("16 triangles") && Contains("light: left: area, ") &&
                                 Contains("load scene: ") && Contains("write pictures: ") &&
                                 Contains("\ntotal "));
}

TEST_CASE("a render on a terminal draws a bar on one line and removes it") {
  const FileFolder folder;
  Run run = small_render(folder);
  run.terminal = true;
  const Outcome outcome = run_photile(run);
  INFO(outcome.errors);
  REQUIRE(outcome.exit_code == 0);
  CHECK_THAT(outcome.errors, Contains("\r") && Contains("%"));
  // Between two carriage returns no more than the terminal's 99 usable columns are printed.
  std::size_t column = 0, widest = 0;
  for (const char character : outcome.errors) {
    column = character == '\r' ? 0 : column + 1;
    if (character == '%') widest = std::max(widest, column);
  }
  CHECK(widest < 100);
  CHECK_THAT(outcome.error_lines().back(), !Contains("%"));
}

TEST_CASE("a quiet render prints nothing, on a terminal or not") {
  const FileFolder folder;
  Run run = small_render(folder);
  run.arguments.emplace_back("--quiet");
  run.terminal = GENERATE(false, true);
  const Outcome outcome = run_photile(run);
  CHECK(outcome.exit_code == 0);
  CHECK(outcome.output.empty());
  CHECK(outcome.errors.empty());
}

TEST_CASE("an error is coloured on a terminal, but not where NO_COLOR is set") {
  Run run;
  run.arguments = {"info", "/nonexistent-folder/scene.obj"};
  run.terminal = true;
  CHECK_THAT(run_photile(run).errors, Contains("\033[1;31merror:"));
  run.environment.emplace("NO_COLOR", "1");
  CHECK_THAT(run_photile(run).errors, !Contains("\033"));
}

}  // namespace photile::test
