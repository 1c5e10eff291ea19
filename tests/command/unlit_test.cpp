// A room without lamps: light comes from a sky, or none is needed.
#include <catch2/catch.hpp>

#include "box_scene.hpp"
#include "child_process.hpp"
#include "file_folder.hpp"
#include "weather_text.hpp"

namespace photile::test {
namespace {

using Catch::Contains;

/// The box without its lamps and one of its walls.
std::string write_unlit_box(const FileFolder& folder) {
  std::string obj = box_obj();
  obj.erase(obj.find("v -0.8 0.99"));
  const std::string wall = "f 1 4 8 5\n";
  obj.erase(obj.find(wall), wall.size());
  folder.write("box.mtl", box_mtl());
  return folder.write("unlit.obj", obj);
}

}  // namespace

TEST_CASE("a room without lamps is lit by a sky in every command") {
  const FileFolder folder;
  const std::string room = write_unlit_box(folder);
  const auto always = [](int, int, int hour) { return hour > 8 && hour < 17 ? 200 : 0; };
  const std::string weather = folder.write("year.epw", weather_text(always, always));
  const std::string eyes = folder.write("eyes.pts", "0 0 0.5 0 0 -1\n");
  const std::vector<std::string> sky{"--sky", "overcast=10000"},
      place{"--plane", "floor+0.75", "--wall-band", "0.2", "--inside",  "0,0,0",
            "--rays",  "32",         "--repeats",   "2",   "--photons", "10k"};
  const auto joined = [](std::vector<std::string> all,
                         std::initializer_list<std::vector<std::string>> more) {
    for (const auto& words : more) all.insert(all.end(), words.begin(), words.end());
    all.emplace_back("--quiet");
    return all;
  };
  const std::vector<std::string> picture{"--quality", "draft", "--photons", "2k",
                                         "-k",        "20",    "--size",    "16x12"};
  for (const auto& command :
       {joined({"render", room, "-o", folder / "a.exr"}, {sky, picture}),
        joined({"walk", room, "-o", folder / "walk.png", "--camera-path",
                folder.write("path.json", R"([{"time": 0, "position": [0, 0, 0.5],
                    "look_at": [0, 0, 0]}, {"time": 0.04, "position": [0, 0, 0.4],
                    "look_at": [0, 0, 0]}])")},
               {sky, picture}),
        joined({"trace", room, "-o", folder / "a.photons", "--photons", "2k"}, {sky}),
        joined({"measure", room}, {sky, place}),
        joined({"measure", room, "--daylight-factor"}, {place}),
        joined({"daylight", room, "--weather", weather, "--patches", "145"}, {place}),
        joined({"glare", room, "--observers", eyes, "--ratings", "ugr", "--rays", "32", "--repeats",
                "2", "--photons", "10k"},
               {sky})}) {
    CAPTURE(command[0], command[3]);
    const Outcome outcome = run_photile(command);
    INFO(outcome.errors);
    CHECK(outcome.exit_code == 0);
  }
}

TEST_CASE("info takes a room without lamps and says what is missing, others refuse it") {
  const FileFolder folder;
  const std::string room = write_unlit_box(folder);
  const Outcome info = run_photile({"info", room});
  CHECK(info.exit_code == 0);
  CHECK_THAT(info.output, Contains("material: wall") && Contains("warning: no lights") &&
                              Contains("--luminaires") && Contains("--sky"));
  CHECK(run_photile({"info", room, "--json"}).exit_code == 0);
  CHECK_THAT(
      only_error(run_photile({"render", room, "-o", folder / "a.exr", "--quiet"}), bad_input),
      Contains("no lights"));
}

}  // namespace photile::test
