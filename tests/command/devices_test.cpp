// `photile devices` and the choice of a device.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "box_scene.hpp"
#include "photile/image.hpp"
#include "source_folder.hpp"

namespace photile::test {
namespace {

using Catch::Contains;

TEST_CASE("the list of devices is JSON and marks exactly one as selected") {
  const Outcome outcome = succeed({"devices", "--json"});
  const auto devices = nlohmann::json::parse(outcome.output);
  REQUIRE(devices.size() >= 1);
  CHECK(std::count_if(devices.begin(), devices.end(),
                      [](const auto& device) { return device["selected"] == true; }) == 1);
  for (const auto& device : devices) {
    CHECK(device["max_allocation_bytes"] <= device["global_memory_bytes"]);
    CHECK(device["clock_mhz"] > 0);
    // Every OpenCL 1.2 device has these atomics.
    CHECK_THAT(device["extensions"].get<std::string>(),
               Contains("cl_khr_global_int32_base_atomics"));
  }
}

TEST_CASE("the list of devices has a line for each and marks the selected one with a star") {
  const auto count = nlohmann::json::parse(run_photile({"devices", "--json"}).output).size();
  const Outcome outcome = succeed({"devices"});
  CHECK(static_cast<std::size_t>(std::count(outcome.output.begin(), outcome.output.end(), '\n')) ==
        count + 1);
  CHECK_THAT(outcome.output, Contains("* 0:0"));
  // The whole of which parts are chosen.
  CHECK_THAT(succeed({"devices", "--device", "0:0/2"}).output, Contains("* 0:0 "));
}

TEST_CASE("after devices --compile the first picture of an interior compiles nothing", "[slow]") {
  const FileFolder folder;
  std::filesystem::create_directory(folder / "cache");
  Run run{.arguments = {"devices", "--compile"},
          .environment = {{"XDG_CACHE_HOME", folder / "cache"}}};
  const Outcome compiled = succeed(run);
  CHECK_THAT(compiled.errors, Contains(" compiled, ") && !Contains(": 0 compiled"));
  const std::string room = source_folder() / "scenes/living-room/living-room.gltf";
  run.arguments = {"render",    room,   "-o",     folder / "out.png",
                   "--photons", "200k", "--size", "16x12"};
  const Outcome rendered = succeed(run);
  CHECK_THAT(rendered.errors, Contains(": 0 compiled"));
}

TEST_CASE("two halves of a device render the file of the whole, and the record names both") {
  const FileFolder folder;
  const auto render = [&](const std::string& name) {
    return typed("render", write_box(folder), "--photons 5k --size 64x48 --quality draft -o",
                 folder / name, "--stats", folder / "stats.json");
  };
  succeed(render("whole.png"));
  const Outcome outcome =
      succeed({.arguments = render("halves.png"), .environment = {{"PHOTILE_DEVICE", "0:0/2"}}});
  CHECK(folder.read("halves.png") == folder.read("whole.png"));
  CHECK_THAT(outcome.errors, Contains("device: 0:0.0 ") && Contains("device: 0:0.1 ") &&
                                 Contains("share of 0:0.0") && Contains("share of 0:0.1"));
  const auto devices = folder.json("stats.json")["devices"];
  REQUIRE(devices.size() == 2);
  CHECK(devices[0]["id"] == "0:0.0");
  CHECK(devices[1]["id"] == "0:0.1");
  CHECK(devices[0]["share"].get<double>() + devices[1]["share"].get<double>() == Approx(1));
}

TEST_CASE("PHOTILE_DEVICE chooses the device where --device does not") {
  Run run{.arguments = {"devices"}, .environment = {{"PHOTILE_DEVICE", "no-such-device"}}};
  CHECK_THAT(last_error(run_photile(run), no_device), Contains("no-such-device"));
  run.arguments = {"devices", "--device", "0:0"};
  succeed(run);
}

TEST_CASE("the test of devices passes, and not with kernels that compute wrong areas", "[slow]") {
  const FileFolder folder;
  Run run{.arguments = {"devices", "--test"}};
  CHECK_THAT(succeed(run).output, Contains("passed ("));

  const auto file = std::filesystem::path("surface/clipped_disc.clh");
  std::string text = bytes_of(source_folder() / "kernels" / file);
  const std::string area = "disc->area = squared_radius";
  REQUIRE(text.find(area) != std::string::npos);
  text.insert(text.find(area) + std::string("disc->area = ").size(), "1.01f * ");
  std::filesystem::create_directories(folder / "kernels/surface");
  std::ofstream(folder / "kernels/surface/clipped_disc.clh") << text;
  run.environment["PHOTILE_KERNEL_DIR"] = folder / "kernels";
  const Outcome wrong = run_photile(run);
  CHECK_THAT(wrong.output, Contains("not passed: the irradiance of hit"));
  CHECK_THAT(last_error(wrong, no_device), Contains("computes wrong results"));
}

// Each command where a CPU poses as a GPU (tests/device/layers/gpu_layer.cpp): it runs what a GPU
// would, and finds the light that it finds as a CPU.
//
// PoCL compiles a kernel of lanes for ten seconds. Compiled kernels are kept between runs.

/// Lanes add the same photons in another order: roundings of sums of 50 numbers in single
/// precision, of parts of the largest value.
constexpr double rounding = 1e-5;

/// Runs the command on a device of this type alone: where there is none, it fails.
Outcome run_on(const std::string& type, const std::vector<std::string>& arguments,
               std::map<std::string, std::string> environment = {}) {
  environment["PHOTILE_DEVICE"] = type;
  if (type == "gpu") environment["OPENCL_LAYERS"] = PHOTILE_GPU_LAYER;
  return succeed({.arguments = arguments, .environment = std::move(environment)});
}

/// Runs the command on a CPU and as a GPU, each in a folder of its own that holds the box.
struct OnBoth {
  template <class Arguments>
  explicit OnBoth(const Arguments& arguments, std::map<std::string, std::string> as_gpu = {}) {
    CHECK_THAT(run_on("cpu", arguments(cpu)).errors, Contains("device: "));
    CHECK_THAT(run_on("gpu", arguments(gpu), std::move(as_gpu)).errors, Contains("device: "));
  }

  FileFolder cpu, gpu;
};

void check_same_picture(const OnBoth& folders, const std::string& name) {
  const Image cpu = read_image(folders.cpu / name), gpu = read_image(folders.gpu / name);
  REQUIRE(cpu.channel_names == gpu.channel_names);
  for (std::size_t channel = 0; channel < cpu.channels.size(); ++channel) {
    const std::vector<float>&expected = cpu.channels[channel], &found = gpu.channels[channel];
    REQUIRE(found.size() == expected.size());
    const double largest = *std::max_element(expected.begin(), expected.end());
    double difference = 0;
    for (std::size_t i = 0; i < expected.size(); ++i) {
      difference = std::max<double>(difference, std::abs(found[i] - expected[i]));
    }
    CAPTURE(name, cpu.channel_names[channel]);
    CHECK(difference <= rounding * largest);
  }
}

/// Numbers of two JSON documents agree, and all else is the same.
void check_same_values(const nlohmann::json& cpu, const nlohmann::json& gpu) {
  const nlohmann::json expected = cpu.flatten(), found = gpu.flatten();
  REQUIRE(found.size() == expected.size());
  REQUIRE(expected.size() > 10);
  for (const auto& [name, value] : expected.items()) {
    CAPTURE(name);
    REQUIRE(found.contains(name));
    if (value.is_number_float()) {
      CHECK(found[name].get<double>() == Approx(value.get<double>()).epsilon(rounding));
    } else {
      CHECK(found[name] == value);
    }
  }
}

void check_same_values(const OnBoth& folders, const std::string& name) {
  check_same_values(folders.cpu.json(name), folders.gpu.json(name));
}

/// Runs a command that would compile kernels for many minutes until its bar shows that some work is
/// done, and then interrupts it.
///   share   of the work, as the bar shows it
void check_begins(const std::vector<std::string>& arguments, const std::string& share) {
  const FileFolder cache;
  const Outcome outcome = run_photile({.arguments = arguments,
                                       .environment = {{"PHOTILE_DEVICE", "gpu"},
                                                       {"OPENCL_LAYERS", PHOTILE_GPU_LAYER},
                                                       {"XDG_CACHE_HOME", cache.path}},
                                       .terminal = true,
                                       .signal_when = "]   " + share + "  "});
  INFO(outcome.errors);
  CHECK(outcome.exit_code == 130);
}

TEST_CASE("as a GPU, render and measure find the light of the Cornell box that a CPU finds",
          "[slow]") {
  const std::string scene = source_folder() / "scenes/cornell-box/cornell-box.obj";
  const OnBoth rendered([&](const FileFolder& folder) {
    return typed("render", scene, "-o", folder / "box.exr", "--stats", folder / "box.json",
                 "--photons 20k --size 16x16 --quality draft");
  });
  check_same_picture(rendered, "box.exr");
  for (const FileFolder* folder : {&rendered.cpu, &rendered.gpu}) {
    const auto record = nlohmann::json::parse(folder->read("box.json"));
    const bool gpu = folder == &rendered.gpu;
    REQUIRE(record["devices"].size() == 1);
    CHECK(record["devices"][0]["type"] == (gpu ? "gpu" : "cpu"));
    CHECK_THAT(record["tuning"].get<std::string>(), Contains(gpu ? "lanes" : "select"));
  }
  const OnBoth measured([&](const FileFolder& folder) {
    return typed("measure", scene, "--points", folder.write("middle.pts", "0.28 0.1 -0.28 0 1 0\n"),
                 "-o", folder / "box.json", "--photons 20k --rays 64 --repeats 2");
  });
  check_same_values(measured, "box.json");
}

/// Whether some file of a folder that ends so has this text.
bool any_has(const std::filesystem::path& folder, const std::string& ending,
             const std::string& text) {
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string file = entry.path().string();
    if (file.ends_with(ending) && bytes_of(file).find(text) != std::string::npos) return true;
  }
  return false;
}

TEST_CASE("as a GPU, a device that lanes do not fit on runs a kernel that fits any", "[slow]") {
  const auto [variable, value] = GENERATE(table<const char*, const char*>(
      {{"PHOTILE_POSED_GROUP", "16"},    // work-items that run of it together
       {"PHOTILE_POSED_LOCAL", "2048"},  // bytes
       {"PHOTILE_POSED_PRIVATE", "20000"}}));
  CAPTURE(variable);
  const FileFolder dump;
  const std::string scene = source_folder() / "scenes/cornell-box/cornell-box.obj";
  const OnBoth rendered(
      [&](const FileFolder& folder) {
        return typed("render", scene, "-o", folder / "box.exr",
                     "--photons 20k --size 16x16 --quality draft --set light_maps=off");
      },
      {{variable, value}, {"PHOTILE_DUMP_KERNELS", dump / "kernels"}});
  check_same_picture(rendered, "box.exr");
  CHECK(any_has(dump / "kernels", ".options", "-D VECTOR_WIDTH=1 -D CAPACITY=256"));
}

TEST_CASE("as a GPU, a device passes its test", "[slow]") {
  CHECK_THAT(run_on("gpu", {"devices", "--test", "--device", "gpu"}).output,
             Contains("passed") && !Contains("not passed"));
  const auto devices = nlohmann::json::parse(run_on("gpu", {"devices", "--json"}).output);
  REQUIRE(devices.size() >= 1);
  for (const auto& device : devices) CHECK(device["type"] == "gpu");
}

TEST_CASE("as a GPU, a device has kernels compiled ahead", "[slow]") {
  check_begins({"devices", "--compile"}, "2%");
}

TEST_CASE("as a GPU, glare rates what it rates on a CPU", "[slow]") {
  const OnBoth folders([](const FileFolder& folder) {
    return typed("glare", write_box(folder), "--observers",
                 folder.write("eyes.pts", "0.2 0 0.1 0 1 0\n"), "-o", folder / "glare.json",
                 "--photons 20k --rays 64 --repeats 2 --samples 1 --picture-size 64");
  });
  check_same_values(folders, "glare.json");
}

TEST_CASE("as a GPU, daylight finds the year that it finds on a CPU", "[slow]") {
  const OnBoth folders([](const FileFolder& folder) {
    return typed("daylight", write_open_box(folder),
                 "--inside 0,0,0 --plane floor+0.75 --wall-band 0.2 --weather",
                 write_weather(folder), "--lamps-to 500 --patches 145 -o", folder / "year.json",
                 "--photons 20k --rays 64 --repeats 2");
  });
  check_same_values(folders, "year.json");
}

TEST_CASE("as a GPU, walk renders the frames of a CPU", "[slow]") {
  const OnBoth folders([](const FileFolder& folder) {
    const std::string path = folder.write("path.json", R"([
        {"time": 0, "position": [0, 0, 0.9], "look_at": [0, 0, -1], "fov": 60},
        {"time": 1, "position": [0.5, 0, 0.9], "look_at": [0, 0, -1], "fov": 60}])");
    return typed("walk", write_box(folder), "-o", folder / "f.#.exr", "--fps 1 --camera-path", path,
                 "--quality draft --photons 20k --size 16x12");
  });
  check_same_picture(folders, "f.1.exr");
  check_same_picture(folders, "f.2.exr");
}

TEST_CASE("as a GPU, bake writes the light maps of a CPU", "[slow]") {
  const OnBoth folders([](const FileFolder& folder) {
    return std::vector<std::string>{
        "bake", write_box(folder), "-o", folder / "baked.gltf", "--photons", "50k"};
  });
  const auto document = folders.cpu.json("baked.gltf");
  const auto& maps = document["scenes"][0]["extras"]["photile"]["light_maps"];
  REQUIRE(maps.size() == 2);
  for (const auto& map : maps) check_same_picture(folders, map["uri"].get<std::string>());
}

TEST_CASE("as a GPU, photons that were traced to a file give the picture of a CPU", "[slow]") {
  const FileFolder photons;
  run_on("gpu",
         {"trace", write_box(photons), "-o", photons / "box.photons", "--photons", "20k", "-q"});
  const OnBoth folders([&](const FileFolder& folder) {
    return typed("render", photons / "box.obj", "--load-maps", photons / "box.photons",
                 "--photons 20k -o", folder / "box.exr", "--quality draft --size 16x12");
  });
  check_same_picture(folders, "box.exr");
}

TEST_CASE("as a GPU, light that is known in closed form is measured right", "[slow]") {
  CHECK_THAT(
      run_on("gpu", {"validate", "--case", "point light", "--integrator", "photon-map", "--quiet"})
          .output,
      Contains("ok") && !Contains("wrong"));
}

TEST_CASE("as a GPU, trade measures times and errors", "[slow]") {
  const FileFolder folder;
  check_begins({"trade", write_box(folder), "-o", folder / "results", "--size", "16x12",
                "--photons", "4k", "-k", "8", "--samples", "1", "--reference-samples", "16"},
               "3%");  // the first of some 40 settings
}

}  // namespace
}  // namespace photile::test
