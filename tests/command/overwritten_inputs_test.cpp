// No command writes to a file that it reads, whatever name or link leads there.
#include <catch2/catch.hpp>
#include <cstring>
#include <functional>
#include <map>

#include "box_scene.hpp"
#include "child_process.hpp"
#include "file_folder.hpp"
#include "photile/image.hpp"
#include "source_folder.hpp"
#include "weather_text.hpp"

namespace photile::test {
namespace {

namespace fs = std::filesystem;
using Catch::Contains;

using Arguments = std::vector<std::string>;

/// The names and bytes of all files, links followed.
std::map<std::string, std::string> contents(const FileFolder& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder.path)) {
    if (!entry.is_regular_file()) continue;
    const std::string name = fs::relative(entry.path(), folder.path).string();
    files[name] = folder.read(name);
  }
  return files;
}

void write_picture(const std::string& file) {
  Image picture;
  picture.width = picture.height = 4;
  for (const char* channel : {"R", "G", "B"}) picture.add(channel).assign(16, 0.5f);
  if (file.ends_with(".png")) {
    write_png(file, picture);
  } else {
    write_exr(file, picture);
  }
}

/// The box, its walls with a texture.
std::string write_textured_box(const FileFolder& folder) {
  write_picture(folder / "rug.png");
  const std::string scene = write_box(folder);
  folder.write("box.mtl", box_mtl() + "newmtl rug\nmap_Kd rug.png\n");
  folder.write("box.obj", box_obj() + "vt 0 0\nvt 1 0\nvt 1 1\nusemtl rug\nf 1/1 2/2 3/3\n");
  return scene;
}

/// A shining triangle, its vertices in a file of their own.
std::string write_gltf(const FileFolder& folder) {
  const float vertices[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  std::string bytes(sizeof vertices, '\0');
  std::memcpy(bytes.data(), vertices, sizeof vertices);
  folder.write("lamp.bin", bytes);
  return folder.write("lamp.gltf", R"({"asset": {"version": "2.0"}, "scene": 0,
    "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
    "materials": [{"emissiveFactor": [1, 1, 1]}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                   "min": [0, 0, 0], "max": [1, 1, 0]}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}],
    "buffers": [{"uri": "lamp.bin", "byteLength": 36}]})");
}

const Arguments& ways() {
  static const Arguments all{"its name", "another spelling", "symbolic link", "hard link",
                             "linked folder"};
  return all;
}

/// Another name of `input` that ends in `ending`, by one of the ways.
std::string name_of(const FileFolder& folder, const std::string& input, const std::string& ending,
                    const std::string& way) {
  const bool fits = input.ends_with(ending);
  if (way == "its name" && fits) return folder / input;
  if (way == "another spelling" && fits) return folder / ("./" + input);
  if (way == "linked folder" && fits) {
    fs::create_directory_symlink(".", folder / "elsewhere");
    return folder / ("elsewhere/" + input);
  }
  const std::string link = folder / ("link" + ending);
  if (way == "hard link") {
    fs::create_hard_link(folder / input, link);
  } else {
    fs::create_symlink(input, link);
  }
  return link;
}

/// Runs a command for each way to name `input` as an output and expects that it refuses.
///   prepare   fills the folder and returns the arguments up to the output
void check_refused(const std::function<Arguments(const FileFolder&)>& prepare,
                   const std::string& input, const std::string& ending) {
  for (const std::string& way : ways()) {
    const FileFolder folder;
    Arguments arguments = prepare(folder);
    const std::string output = name_of(folder, input, ending, way);
    arguments.push_back(output);
    const auto before = contents(folder);
    INFO(way << " of " << input << " by " << arguments.front());
    const Outcome outcome = run_photile(arguments);
    CHECK_THAT(last_error(outcome, usage), Contains(output) && Contains("an input of this run"));
    CHECK(contents(folder) == before);
  }
}

}  // namespace

TEST_CASE("render keeps the files that options name") {
  const auto with = [](const char* option, const char* input, const std::string& prefix = "") {
    return [=](const FileFolder& folder) {
      const std::string scene = write_box(folder), file = folder.write(input, "kept");
      return Arguments{"render", scene, "-o", folder / "out.exr", option, prefix + file, "--stats"};
    };
  };
  check_refused(with("--environment", "sky.exr"), "sky.exr", "");
  check_refused(with("--ies", "lamp.ies", "lamp="), "lamp.ies", ".ies");
  check_refused(with("--load-maps", "maps"), "maps", "");
}

TEST_CASE("render keeps the scene and the files that it names") {
  const auto textured = [](const char* option) {
    return [=](const FileFolder& folder) {
      return Arguments{"render", write_textured_box(folder), "-o", folder / "out.exr", option};
    };
  };
  check_refused(textured("--luminance"), "rug.png", ".png");
  check_refused(textured("--stats"), "box.mtl", ".mtl");
  check_refused(textured("--save-maps"), "box.obj", ".obj");
  check_refused(textured("--illuminance"), "rug.png", ".png");
  check_refused(
      [](const FileFolder& folder) {
        return Arguments{"render", write_gltf(folder), "-o", folder / "out.exr", "--stats"};
      },
      "lamp.bin", ".bin");
}

TEST_CASE("relight and compare keep the pictures that they read") {
  check_refused(
      [](const FileFolder& folder) {
        write_picture(folder / "in.exr");
        return Arguments{"relight", folder / "in.exr", "-o"};
      },
      "in.exr", ".exr");
  for (const char* input : {"a.exr", "b.exr"}) {
    for (const auto& [option, ending] : {std::pair("--json", ".exr"), std::pair("-o", ".png")}) {
      check_refused(
          [option = option](const FileFolder& folder) {
            write_picture(folder / "a.exr");
            write_picture(folder / "b.exr");
            return Arguments{"compare", folder / "a.exr", folder / "b.exr", option};
          },
          input, ending);
    }
  }
}

TEST_CASE("measure keeps the files that say where to measure") {
  const char* plane = R"([{"name": "desk", "origin": [0, 0, 0], "u": [1, 0, 0], "v": [0, 0, 1]}])";
  for (const auto& [option, input, ending] :
       {std::tuple("--grid", "desk.json", ".json"), std::tuple("--points", "desk.csv", ".csv")}) {
    check_refused(
        [&, option = option, input = input](const FileFolder& folder) {
          return Arguments{"measure", write_box(folder), option, folder.write(input, plane), "-o"};
        },
        input, ending);
  }
}

TEST_CASE("measure keeps what lies under the names of its numbered plans and its tables") {
  const FileFolder folder;
  const std::string scene = write_box(folder);
  fs::create_directory(folder / "bee");
  fs::create_hard_link(folder / "box.mtl", folder / "plan-2.svg");
  fs::create_symlink("../box.mtl", folder / "bee/working_plane.res");
  const std::string points = folder.write("points.json", R"([
    {"name": "a", "origin": [0, 0, 0], "u": [0.5, 0, 0], "v": [0, 0, -0.5]},
    {"name": "b", "origin": [0, 0, 0], "u": [0.5, 0, 0], "v": [0, 0, -0.5]}])");
  const auto before = contents(folder);
  for (const Arguments& more : {Arguments{"--grid", points, "-o", folder / "plan.svg"},
                                Arguments{"--plane", "1", "--honeybee", folder / "bee"}}) {
    Arguments arguments{"measure", scene};
    arguments.insert(arguments.end(), more.begin(), more.end());
    CHECK_THAT(last_error(run_photile(arguments), usage), Contains("an input of this run"));
    CHECK(contents(folder) == before);
  }
}

TEST_CASE("daylight keeps what lies under the names of its tables, before it computes the year") {
  const FileFolder folder;
  const auto by_day = [](int, int, int hour) { return hour > 8 && hour < 17 ? 300 : 0; };
  const std::string scene = write_box(folder);
  const std::string weather = folder.write("year.epw", weather_text(by_day, by_day));
  fs::create_directories(folder / "bee/__static_apertures__/default/total");
  fs::create_symlink("../../../../box.mtl",
                     folder / "bee/__static_apertures__/default/total/working_plane.npy");
  const auto before = contents(folder);
  const Arguments arguments{"daylight",  scene,   "--plane",    "1",
                            "--weather", weather, "--honeybee", folder / "bee"};
  CHECK_THAT(last_error(run_photile(arguments), usage), Contains("an input of this run"));
  CHECK(contents(folder) == before);
  fs::remove(folder / "bee/__static_apertures__/default/total/working_plane.npy");
  Arguments twice = arguments;
  twice.insert(twice.end(), {"-o", folder / "bee/grids_info.json"});
  CHECK_THAT(last_error(run_photile(twice), usage), Contains("grids_info.json"));
}

TEST_CASE("walk keeps its camera path, and the scene under the name of any frame") {
  check_refused(
      [](const FileFolder& folder) {
        return Arguments{"walk",
                         write_box(folder),
                         "-o",
                         folder / "frame.#.exr",
                         "--camera-path",
                         folder.write("path.json", "{}"),
                         "--contact-sheet"};
      },
      "path.json", ".png");

  const FileFolder folder;
  const std::string scene = write_box(folder);
  const std::string path = folder.write("path.json", R"({"keyframes": [
    {"time": 0, "position": [0, 0, 0.9], "look_at": [0, 0, 0]},
    {"time": 1, "position": [0, 0, 0.8], "look_at": [0, 0, 0]}]})");
  fs::create_hard_link(folder / "box.mtl", folder / "frame.2.exr");
  const auto before = contents(folder);
  const Outcome outcome = run_photile(
      {"walk", scene, "-o", folder / "frame.#.exr", "--camera-path", path, "--fps", "1"});
  CHECK_THAT(last_error(outcome, usage), Contains("frame.2.exr") && Contains("box.mtl"));
  CHECK(contents(folder) == before);
}

TEST_CASE("trade, view and validate keep what they read") {
  check_refused(
      [](const FileFolder& folder) {
        return Arguments{"view", write_textured_box(folder), "--save-maps"};
      },
      "rug.png", "");

  const FileFolder folder;
  const std::string scene = write_box(folder);
  fs::create_directory(folder / "out");
  fs::create_symlink("../box.mtl", folder / "out/trade.csv");
  fs::copy(source_folder() / "kernels", folder / "kernels", fs::copy_options::recursive);
  const auto before = contents(folder);
  CHECK_THAT(last_error(run_photile({"trade", scene, "-o", folder / "out"}), usage),
             Contains("out/trade.csv") && Contains("box.mtl"));
  Run validate;
  validate.arguments = {"validate", "--integrator", "photon-map", "--json",
                        folder / "kernels/estimate/estimate.cl"};
  validate.environment["PHOTILE_KERNEL_DIR"] = folder / "kernels";
  CHECK_THAT(last_error(run_photile(validate), usage), Contains("an input of this run"));
  CHECK(contents(folder) == before);
}

TEST_CASE("two outputs that are one file are refused, also where it does not exist yet") {
  const FileFolder folder;
  const std::string scene = write_box(folder);
  fs::create_symlink("new.png", folder / "dangling.png");
  folder.write("a.png", "kept");
  fs::create_hard_link(folder / "a.png", folder / "b.png");
  for (const auto& [first, second] :
       {std::pair("new.png", "dangling.png"), std::pair("dangling.png", "new.png"),
        std::pair("a.png", "b.png"), std::pair("new.png", "./new.png")}) {
    const auto outcome =
        run_photile({"render", scene, "-o", folder / first, "-o", folder / second});
    CHECK_THAT(only_error(outcome, usage),
               Contains(first) && Contains(second) && Contains("twice"));
    CHECK(folder.read("a.png") == "kept");
    CHECK(!fs::exists(folder / "new.png"));
  }
}

TEST_CASE("a folder without kernels is refused, for its kernels would not be used") {
  const FileFolder folder;
  Run run;
  run.arguments = {"render", write_box(folder), "-o", folder / "out.png", "--size",
                   "8x8",    "--photons",       "1k", "--quality",        "draft"};
  for (const std::string& kernels : {folder / "missing", folder.path.string()}) {
    run.environment["PHOTILE_KERNEL_DIR"] = kernels;
    CHECK_THAT(last_error(run_photile(run), usage), Contains(kernels) && Contains("no kernel"));
  }
}

}  // namespace photile::test
