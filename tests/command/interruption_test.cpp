// Runs that are watched, stopped or killed.
#include <sys/resource.h>
#include <sys/wait.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <chrono>
#include <cstdlib>
#include <random>
#include <thread>

#include "box_scene.hpp"
#include "command/terminal_progress.hpp"
#include "photile/image.hpp"
#include "skipped.hpp"

namespace photile::test {
namespace {

using app::progress_bar;
using app::StageProgress;
using Catch::Contains;

// SIGINT and SIGTERM stop a render: exit code 130, earlier files kept, nothing half written.

TEST_CASE("a signal during a render, or the making of a page, gives 130 and keeps earlier files") {
  const FileFolder folder;
  Run run;
  const auto [command, name, more] = GENERATE(table<std::string, std::string, std::string>(
      {{"render", "out.exr", "--photons 2G"},
       {"publish", "out.html", "--photons 4M"},
       {"publish", "out.html", "--photons 16M --for 60min"}}));
  run.arguments = typed(command, write_box(folder), "-o", folder / name, more.c_str());
  if (command == "render") {
    run.arguments.insert(run.arguments.end(), {"--stats", folder / "out.json"});
  }
  run.terminal = true;
  run.signal_when = "%  ";  // only a bar under way prints one
  run.signal = GENERATE(SIGINT, SIGTERM);
  folder.write(name, "earlier");
  const Outcome outcome = run_photile(run);
  INFO(outcome.errors);
  CHECK(outcome.exit_code == 130);
  CHECK_THAT(outcome.errors, Contains("interrupted"));
  CHECK(folder.read(name) == "earlier");
  CHECK(folder.file_count() == 3);  // the scene's two files and the earlier output
}

TEST_CASE("a picture that takes gigabytes is told before anything is traced") {
  const FileFolder folder;
  const Outcome outcome =
      run_photile({.arguments = typed("render", write_box(folder), "-o", folder / "a.exr",
                                      "--photons 2G --size 16384x16384"),
                   .signal_when = "GB of memory",
                   .signal = SIGTERM});
  CHECK(last_error(outcome, 130) == "interrupted");
  const auto told = outcome.errors.find("16384 x 16384 pixels with 2 lights takes");
  CHECK(told != std::string::npos);
  // On a busy machine the first line of progress may come before the signal.
  CHECK(outcome.errors.find("photons:") > told);
}

/// Runs a line of shell text in which $photile is the command.
Outcome run_in_shell(const FileFolder& folder, const std::string& text,
                     const std::string& shell = "bash") {
  const std::string file = folder.write("line.sh", "photile='" + command() + "'\n" + text);
  const std::string output = folder / "output", errors = folder / "errors";
  const int status = std::system(("XDG_CACHE_HOME='" PHOTILE_TEST_CACHE "' " + shell + " '" + file +
                                  "' > '" + output + "' 2> '" + errors + "'")
                                     .c_str());
  return {WEXITSTATUS(status), folder.read("output"), folder.read("errors")};
}

TEST_CASE("a reader that goes away costs no picture, and is no error") {
  const FileFolder folder;
  const std::string scene = write_box(folder);
  const Outcome told = run_in_shell(
      folder,
      "$photile render '" + scene + "' -o '" + (folder / "a.exr") +
          "' --photons 20k --size 16x16 2>&1 | head -c 1 > /dev/null; exit ${PIPESTATUS[0]}");
  CHECK(told.exit_code == 0);
  CHECK(folder.read("a.exr").size() > 100);
  const Outcome listed =
      run_in_shell(folder, "$photile settings | head -c 1 > /dev/null; exit ${PIPESTATUS[0]}");
  CHECK(listed.exit_code == 0);
  CHECK(listed.errors.empty());
}

TEST_CASE("where no more files can be opened, the limit is told, and not a lack of runtimes") {
  const FileFolder folder;
  const std::string scene = write_box(folder);
  const Outcome outcome = run_in_shell(
      folder, "for n in $(seq 3 14); do ulimit -Sn $n; $photile render '" + scene + "' -o '" +
                  (folder / "a.exr") + "' --photons 1000 --size 4x4 -q; done");
  CHECK_THAT(outcome.errors, Contains("ulimit -n") && !Contains("install a runtime"));
}

/// Of those that have ended: other programs do not change it, as they do the time on the wall.
double processor_seconds_of_children() {
  rusage usage{};
  ::getrusage(RUSAGE_CHILDREN, &usage);
  return static_cast<double>(usage.ru_utime.tv_sec) +
         1e-6 * static_cast<double>(usage.ru_utime.tv_usec);
}

TEST_CASE("a signal while polygons that cross themselves are read gives 130 and one line at once") {
  const FileFolder folder;
  write_box(folder);
  // Minutes of work: 40 polygons whose corners are the same random points, in another order each.
  std::mt19937 random(1);
  std::string text = "mtllib box.mtl\nusemtl wall\n";
  constexpr int corners = 60'000;
  for (int i = 0; i < corners; ++i) {
    text += "v " + std::to_string(random() % 100'000) + " " + std::to_string(random() % 100'000) +
            " 0\n";
  }
  std::vector<std::string> names;
  for (int i = 1; i <= corners; ++i) names.push_back(" " + std::to_string(i));
  for (int polygon = 0; polygon < 40; ++polygon) {
    std::shuffle(names.begin(), names.end(), random);
    text += "f";
    for (const std::string& name : names) text += name;
    text += "\n";
  }
  Run run;
  run.arguments = typed("render", folder.write("crossing.obj", text), "-q -o", folder / "out.png");
  run.signal_delay = std::chrono::milliseconds(3'000);
  run.signal = GENERATE(SIGINT, SIGTERM);
  const double before = processor_seconds_of_children();
  const Outcome outcome = run_photile(run);
  CHECK(only_error(outcome, 130) == "interrupted");
  CHECK(processor_seconds_of_children() - before < 10);
}

TEST_CASE("a signal while kernels are compiled gives 130 and one line", "[slow]") {
  const FileFolder folder;
  const std::string scene = write_box(folder);
  for (int turn = 0; turn < 8; ++turn) {
    const std::string cache = folder / "cache" + std::to_string(turn);
    const Outcome outcome =
        run_photile({.arguments = typed("render", scene, "-o", folder / "out.png", "--photons 20M"),
                     .environment = {{"XDG_CACHE_HOME", cache}},
                     .signal_when = "device: ",
                     .signal_delay = std::chrono::milliseconds(120 * turn),
                     .signal = turn % 2 == 0 ? SIGINT : SIGTERM});
    INFO(turn << ": " << outcome.errors);
    CHECK(last_error(outcome, 130) == "interrupted");
    std::filesystem::remove_all(cache);
  }
}

TEST_CASE("a test of devices that is stopped leaves the verdict that is kept", "[slow]") {
  const FileFolder folder;
  // Of all that is kept, the verdicts alone stay.
  const auto verdicts = [&] {
    std::string all;
    for (const auto& file : std::filesystem::recursive_directory_iterator(folder / "cache")) {
      if (!file.is_regular_file()) continue;
      if (file.path().extension() == ".test") {
        all += bytes_of(file.path());
      } else {
        std::filesystem::remove(file.path());
      }
    }
    return all;
  };
  Run run{.arguments = typed("devices --test"),
          .environment = {{"XDG_CACHE_HOME", folder / "cache"}}};
  succeed(run);
  const std::string passed = verdicts();
  REQUIRE_THAT(passed, Contains("passed"));
  for (int turn = 0; turn < 6; ++turn) {
    run.signal_delay = std::chrono::milliseconds(100 + 120 * turn);
    const Outcome outcome = run_photile(run);
    INFO(turn << ": " << outcome.errors << outcome.output);
    CHECK((outcome.exit_code == 130 || outcome.exit_code == 0));
    CHECK(verdicts() == passed);
  }
}

// Killed at any moment, and on a disk that is full: old files or whole new ones, and nothing else.

using Clock = std::chrono::steady_clock;

/// Runs photile in a folder of a disk of such a size, which no other process sees; tells what is
/// left there.
Outcome run_on_small_disk(const FileFolder& folder, const std::string& arguments,
                          const std::string& size = "64k") {
  const std::string disk = folder / "disk";
  return run_in_shell(folder,
                      "mount -t tmpfs -o size=" + size + " none '" + disk + "' && \"$photile\" " +
                          arguments + "; code=$?; ls -A '" + disk + "'; exit $code",
                      "unshare -m sh");
}

TEST_CASE("killed a hundred times at any moment, a render leaves the old picture or a new one",
          "[slow]") {
  const FileFolder folder;
  const std::vector<std::string> arguments =
      typed("render", write_box(folder), "-o", folder / "out.exr", "-o", folder / "out.png",
            "--photons 20k --size 200x150 --quality draft");
  const auto begin = Clock::now();
  succeed(arguments);
  const auto whole = std::chrono::duration<double>(Clock::now() - begin);
  const std::vector<float> expected = *read_image(folder / "out.exr").find("G");
  const std::string png = folder.read("out.png");
  std::mt19937 random(1);
  int killed = 0, old = 0;
  for (int turn = 0; turn < 100; ++turn) {
    const std::string before = "old";
    folder.write("out.exr", before);
    folder.write("out.png", before);
    const pid_t child = start_photile(arguments);
    std::this_thread::sleep_for(whole * std::uniform_real_distribution<double>(0.2, 1.1)(random));
    ::kill(child, SIGKILL);
    int status = 0;
    REQUIRE(::waitpid(child, &status, 0) == child);
    killed += WIFSIGNALED(status) ? 1 : 0;
    if (folder.read("out.exr") == before) {
      ++old;
    } else {
      CHECK(*read_image(folder / "out.exr").find("G") == expected);
    }
    CHECK((folder.read("out.png") == before || folder.read("out.png") == png));
  }
  CHECK(killed > 20);
  CHECK(old > 20);
  succeed(arguments);
  CHECK(folder.file_count() == 4);  // the scene's, and the pictures: nothing of killed runs
}

TEST_CASE("on a disk of 64 KB, or 4 KB, every kind of output fails by its name and leaves nothing",
          "[slow]") {
  const FileFolder folder;
  write_box(folder);
  std::filesystem::create_directory(folder / "disk");
  if (run_on_small_disk(folder, "--version").exit_code != 0) {
    skip("this process may mount nothing");
    return;
  }
  succeed(typed("render", folder / "box.obj", "-o", folder / "large.exr",
                "--photons 5k --size 200x150 --quality draft"));
  std::string points;
  for (int i = 0; i < 3'000; ++i) points += "0.1 -0.9 0.1 0 1 0\n";
  folder.write("many.pts", points);
  folder.write("path.json", R"([{"time": 0, "position": [0, 0, 0.5], "look_at": [0, 0, 0],
    "fov": 60}])");
  const auto [size, command, name] = GENERATE(table<std::string, std::string, std::string>({
      {"64k", "render SCENE DRAFT --size 200x150 -o DISK/a.exr", "a.exr"},
      {"4k", "render SCENE DRAFT --size 200x150 -o DISK/a.png", "a.png"},
      {"64k", "render SCENE DRAFT --size 4x4 --save-maps DISK/a.maps -o NOWHERE.exr", "a.maps"},
      {"64k", "render SCENE -q --photons 5k --size 200x150 -o NOWHERE.exr --errors DISK/e.exr",
       "e.exr"},
      {"4k", "render SCENE DRAFT --size 200x150 -o NOWHERE.exr --illuminance DISK/lux.png",
       "lux.png"},
      {"4k", "render SCENE DRAFT --size 200x150 -o NOWHERE.exr --luminance DISK/cd.png", "cd.png"},
      {"4k", "render SCENE DRAFT --size 200x150 -o NOWHERE.exr --glare DISK/glare.png",
       "glare.png"},
      {"4k", "render SCENE DRAFT --size 4x4 -o NOWHERE.exr --stats DISK/a.json", "a.json"},
      {"64k", "relight LARGE -o DISK/a.exr", "a.exr"},
      {"64k", "measure SCENE POINTS MANY -o DISK/a.csv", "a.csv"},
      {"64k", "measure SCENE POINTS MANY -o DISK/a.json", "a.json"},
      {"64k", "walk SCENE DRAFT --camera-path PATH --size 200x150 -o DISK/frame.#.exr",
       "frame.1.exr"},
      {"64k", "bake SCENE -q --photons 5k --texel 0.02 -o DISK/room.gltf", "room.light00.exr"},
      {"64k", "publish SCENE DRAFT --texel 0.2 -o DISK/room.html", "room.html"},
      {"16k", "publish SCENE DRAFT --texel 0.02 -o DISK/room.glb", "room.light00.exr"},
      {"4k", "compare LARGE LARGE -o DISK/c.png", "c.png"},
  }));
  CAPTURE(command);
  const Outcome outcome = run_on_small_disk(folder, filled(command, folder), size);
  CHECK_THAT(last_error(outcome, failure), Contains("disk/" + name));
  CHECK_THAT(outcome.errors, !Contains("No such file"));
  CHECK(outcome.output.empty());
}

// Progress: the bar's text, the bar on a terminal, plain lines elsewhere.

const StageProgress half_done{"trace photons", 50, 100, "paths", 2.0};

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
  CHECK_THAT(progress_bar({"a", 0, 100, "paths", 1}, 100), !Contains("%") && Contains("1.00 s"));
  CHECK_THAT(progress_bar({"a", 150, 100, "paths", 1}, 100), Contains("100%"));
  CHECK_THAT(progress_bar({"a", 150, 0, "paths", 1}, 100), !Contains("%") && Contains("1.00 s"));
}

TEST_CASE("a render without a terminal prints plain lines, the device first") {
  const FileFolder folder;
  const Outcome outcome = succeed(small_render(folder));
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
  const Outcome outcome = succeed(run);
  // Between two carriage returns no more than the terminal's 99 usable columns are printed.
  const std::string& text = outcome.errors;
  std::size_t column = 0, widest = 0;
  for (std::size_t i = 0; i + 1 < text.size(); ++i) {
    if (text[i] == '\r' && text[i + 1] != '\n') widest = std::max(widest, column);
    column = text[i] == '\r' || text[i] == '\n' ? 0 : column + 1;
  }
  CHECK(std::clamp<std::size_t>(widest, 20, 102) == widest);  // 3 of them erase the line
  CHECK_THAT(outcome.error_lines().back(), !Contains("%"));
}

TEST_CASE("a quiet render prints nothing, on a terminal or not") {
  const FileFolder folder;
  Run run = small_render(folder);
  run.arguments.emplace_back("--quiet");
  run.terminal = GENERATE(false, true);
  const Outcome outcome = succeed(run);
  CHECK(outcome.output.empty());
  CHECK(outcome.errors.empty());
}

TEST_CASE("an error is coloured on a terminal, but not where NO_COLOR is set") {
  Run run{.arguments = {"info", "/nonexistent-folder/scene.obj"}, .terminal = true};
  CHECK_THAT(run_photile(run).errors, Contains("\033[1;31merror:"));
  run.environment.emplace("NO_COLOR", "1");
  CHECK_THAT(run_photile(run).errors, !Contains("\033"));
}

}  // namespace
}  // namespace photile::test
