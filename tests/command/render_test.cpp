// `photile render` as a whole: what it writes.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <nlohmann/json.hpp>
#include <set>
#include <vector>

#include "box_scene.hpp"
#include "command/run_record.hpp"
#include "photile/image.hpp"
#include "render/render_costs.hpp"

namespace photile::test {
namespace {

using Catch::Contains;

template <class... Parts>
void render_draft(const FileFolder& folder, const Parts&... options) {
  succeed(typed("render", write_box(folder), "--photons 100k --quality draft", options...));
}

double mean(const Image& picture, const std::string& channel) {
  const auto* plane = picture.find(channel);
  REQUIRE(plane != nullptr);
  double sum = 0;
  for (const float value : *plane) sum += static_cast<double>(value);
  return sum / static_cast<double>(plane->size());
}

/// The names of a record's stages, whose times add up to those of the process.
std::vector<std::string> checked_stages(const nlohmann::json& record) {
  double seconds = 0, processor_seconds = 0;
  std::vector<std::string> names;
  for (const auto& stage : record["stages"]) {
    INFO(stage["stage"]);
    names.push_back(stage["stage"]);
    seconds += stage["seconds"].get<double>();
    processor_seconds += stage["processor_seconds"].get<double>();
    // What two rows counted would be missing from the last, "everything else".
    constexpr double rounding = 1e-6;
    CHECK(stage["seconds"] >= -rounding);
    CHECK(stage["processor_seconds"] >= -rounding);
  }
  REQUIRE_FALSE(names.empty());
  CHECK(names.back() == "everything else");
  CHECK(std::set<std::string>(names.begin(), names.end()).size() == names.size());
  CHECK(seconds == Approx(record["total_seconds"].get<double>()));
  CHECK(processor_seconds == Approx(record["total_processor_seconds"].get<double>()));
  return names;
}

TEST_CASE("naive maps take whole discs, and the EXR says so") {
  const FileFolder folder;
  render_draft(folder, "--size 16x12 --set maps=naive -o", folder / "out.exr");
  const Image picture = read_image(folder / "out.exr");
  CHECK(picture.attributes.at("photile.maps") == "naive");
  CHECK(picture.attributes.at("photile.area") == "disc");
}

TEST_CASE("an EXR tells how it was made") {
  const FileFolder folder;
  render_draft(folder,
               "--size 16x12 --seed 9 -k 30 --set radius=0.25 --set angle_degrees=45 "
               "--set lumen_per_watt=179 -o",
               folder / "out.exr");
  const Image picture = read_image(folder / "out.exr");
  const auto attribute = [&](const char* name) { return picture.attributes.at(name); };
  CHECK(attribute("photile.scene") == "box.obj");
  CHECK(attribute("photile.seed") == "9");
  CHECK(attribute("photile.photons_emitted") == "100000");
  CHECK(attribute("photile.neighbours") == "30");
  CHECK(attribute("photile.radius") == "0.25 m");
  CHECK(attribute("photile.angle_degrees") == "45 degrees");
  CHECK(attribute("photile.area") == "clipped");
  CHECK(attribute("photile.kernel") == "constant");
  CHECK(attribute("photile.maps") == "auto");
  CHECK(attribute("photile.efficacy") == "179");
  CHECK(attribute("photile.units") == "W/(m2 sr)");
  CHECK_FALSE(attribute("photile.device").empty());
  CHECK_FALSE(attribute("photile.version").empty());
  CHECK(std::stoull(attribute("photile.photons_stored")) > 0);
  CHECK(nlohmann::json::parse(attribute("photile.lights")).size() == 2);
  CHECK(picture.matrices.size() == 2);  // worldToCamera and worldToNDC
}

TEST_CASE("a camera stands where --eye says and looks where --look-at says, whatever points up") {
  const FileFolder folder;
  render_draft(folder, "--eye 0.25,-0.5,0.5 --look-at 0.25,-0.5,-0.5 -o", folder / "out.exr");
  CHECK_THAT(read_image(folder / "out.exr").attributes.at("photile.view"),
             Contains("-vp 0.25 -0.5 0.5 -vd 0 0 -1 -vu 0 1 0"));
  render_draft(folder, "--eye 0.25,-0.5,0.5 --look-at 0.25,0.5,0.5 --set up=z -o",
               folder / "out.exr");
  CHECK_THAT(read_image(folder / "out.exr").attributes.at("photile.view"),
             Contains("-vp 0.25 -0.5 0.5 -vd 0 1 0 -vu 0 0 1"));
}

TEST_CASE("a render writes every output that it is asked for, in the size asked for") {
  const FileFolder folder;
  render_draft(folder, "--size 20x10 -o", folder / "a.exr", "-o", folder / "b.png", "-o",
               folder / "c.png");
  for (const char* name : {"a.exr", "b.png", "c.png"}) {
    const Image picture = read_image(folder / name);
    CHECK(picture.width == 20);
    CHECK(picture.height == 10);
  }
  CHECK(folder.read("b.png") == folder.read("c.png"));
}

TEST_CASE("the statistics are JSON with every stage, the parameters and the lights") {
  const FileFolder folder;
  render_draft(folder, "--size 16x12 -o", folder / "a.png", "--stats", folder / "a.json");
  const auto statistics = folder.json("a.json");
  CHECK(statistics["scene"] == "box.obj");
  CHECK(statistics["parameters"]["photons_emitted"] == 100'000);
  CHECK(statistics["lights"].size() == 2);
  CHECK(statistics["photons_stored"] > 0);
  const std::vector<std::string> names = checked_stages(statistics);
  for (const std::string stage : {"load libraries", "open devices", "load scene",
                                  "automatic radius", "release memory", "write pictures"}) {
    CHECK_THAT(names, Catch::VectorContains(stage));
  }
  CHECK(names.size() >= 6);  // and trace, group, build, estimate between them
}

TEST_CASE("the stages add up with maps that are kept, with reflections and by paths") {
  const FileFolder folder;
  const auto names_with = [&](const auto&... options) {
    render_draft(folder, "--size 16x12 -o", folder / "a.png", "--stats", folder / "a.json",
                 options...);
    return checked_stages(folder.json("a.json"));
  };
  using Catch::VectorContains;
  CHECK_THAT(
      names_with("--save-maps", folder / "a.maps", "--glare", folder / "glare.png"),
      VectorContains(std::string("save photons")) && VectorContains(std::string("reflections")));
  CHECK_THAT(names_with("--load-maps", folder / "a.maps"),
             VectorContains(std::string("load photons")));
  succeed(typed("render", write_box(folder), "--integrator path --size 16x12 -o", folder / "a.png",
                "--stats", folder / "a.json"));
  checked_stages(folder.json("a.json"));
}

TEST_CASE("naive maps are darker than those of neighbour groups at borders, hence in the mean") {
  const FileFolder folder;
  render_draft(folder, "--size 32x24 -o", folder / "neighbour-groups.exr");
  render_draft(folder, "--size 32x24 --set maps=naive -o", folder / "naive.exr");
  CHECK(mean(read_image(folder / "naive.exr"), "G") <
        mean(read_image(folder / "neighbour-groups.exr"), "G"));
}

TEST_CASE("a profiled render lists the time of each kernel") {
  const FileFolder folder;
  const Outcome outcome =
      succeed(typed("render", write_box(folder), "--photons 10k --size 16x12 -o", folder / "a.png",
                    "--quality draft --set profile=on"));
  CHECK_THAT(outcome.errors, Contains("\nkernel ") && Contains("launches"));
}

TEST_CASE("the last row is what no other one has taken") {
  app::RunRecord record;
  add_time(record.stages, "load scene", {.seconds = 1, .processor_seconds = 2});
  add_time(record.stages, "release memory", {.seconds = 0.5, .processor_seconds = 0.25});
  add_time(record.stages, "release memory", {.seconds = 0.5, .processor_seconds = 0.25});
  close(record, {.seconds = 5, .processor_seconds = 8});
  REQUIRE(record.stages.size() == 3);
  CHECK(record.stages[1].stage == "release memory");
  CHECK(record.stages[1].seconds == 1);
  CHECK(record.stages[2].stage == "everything else");
  CHECK(record.stages[2].seconds == 3);
  CHECK(record.stages[2].processor_seconds == 5.5);
  CHECK(record.total.seconds == 5);
}

TEST_CASE("microseconds per hit leave out what compiling kernels took") {
  RenderCosts costs;
  costs.estimate.add({.seconds = 2.0, .processor_seconds = 4.0});
  costs.estimate_compile_seconds = 1.5;
  costs.hit_count = 1'000'000;
  const RunStatistics stages = costs.statistics();
  const auto stage = std::find_if(stages.begin(), stages.end(), [](const StageStatistics& one) {
    return one.stage == "radiance estimate";
  });
  REQUIRE(stage != stages.end());
  const auto figure =
      std::find_if(stage->figures.begin(), stage->figures.end(),
                   [](const auto& one) { return one.first == "microseconds per hit"; });
  REQUIRE(figure != stage->figures.end());
  CHECK(figure->second == Approx(0.5));
}

TEST_CASE("the statistics tell the mean, median and largest number of photons a map") {
  RenderCosts costs;
  costs.map_sizes = {40, 3, 300, 5};
  costs.largest_map = 300;
  std::map<std::string, double> figures;
  for (const StageStatistics& stage : costs.statistics()) {
    if (stage.stage == "build photon maps")
      figures.insert(stage.figures.begin(), stage.figures.end());
  }
  CHECK(figures.at("photons per map, mean") == Approx(87));
  CHECK(figures.at("photons per map, median") == Approx(22.5));
  CHECK(figures.at("photons per map, largest") == Approx(300));
}

TEST_CASE("where no surface stores photons the lamps are seen, and a line says that it is all") {
  const FileFolder folder;
  const std::string scene = folder.write(
      "lamp.obj", "mtllib lamp.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\no lamp\nusemtl lamp\nf 1 2 3\n");
  folder.write("lamp.mtl", "newmtl lamp\nKd 0 0 0\nKe 1 1 1\n");
  const std::string quality = GENERATE("draft", "good");
  const Outcome outcome = succeed(typed("render", scene, "-o", folder / "out.exr",
                                        "--photons 100 --size 4x4 --quality", quality));
  CHECK_THAT(outcome.errors, Contains("lamp.obj: only mirrors and glass are lit"));
  const Image picture = read_image(folder / "out.exr");
  const std::vector<float>& red = *picture.find("R");
  CHECK(*std::max_element(red.begin(), red.end()) == Approx(1));
}

// `photile render --integrator path`: the same files as photon maps give, without their options.

std::vector<std::string> by_paths(const FileFolder& folder,
                                  const std::vector<std::string>& options) {
  return typed("render", write_box(folder), "--integrator path --size 16x12", options);
}

TEST_CASE("paths need no OpenCL device and give layers that can be relit") {
  const FileFolder folder;
  succeed({.arguments = by_paths(folder, {"-o", folder / "a.exr", "--stats", folder / "a.json"}),
           .environment = {{"OCL_ICD_VENDORS", folder / "no runtimes"}}});
  const Image picture = read_image(folder / "a.exr");
  CHECK(picture.find("Combined_left.R") != nullptr);
  CHECK(picture.find("Illuminance_right.Y") != nullptr);
  CHECK(picture.attributes.at("photile.integrator") == "path");
  CHECK(picture.attributes.count("photile.photons_emitted") == 0);
  CHECK(picture.attributes.count("photile.device") == 0);
  const auto statistics = folder.json("a.json");
  CHECK(statistics["parameters"]["integrator"] == "path");
  CHECK_FALSE(statistics.contains("photons_stored"));

  succeed({"relight", folder / "a.exr", "--light", "left=off", "-o", folder / "b.exr"});
  CHECK(*read_image(folder / "b.exr").find("R") == *picture.find("Combined_right.R"));
}

TEST_CASE("a signal stops paths with 130") {
  const FileFolder folder;
  const Outcome outcome =
      run_photile({.arguments = by_paths(folder, {"-o", folder / "out.exr", "--samples", "65536"}),
                   .terminal = true,
                   .signal_when = "%  "});  // only a bar under way prints one
  INFO(outcome.errors);
  CHECK(outcome.exit_code == 130);
  CHECK_FALSE(std::filesystem::exists(folder / "out.exr"));
}

// A room without lamps: light comes from a sky, or none is needed.

/// The box without its lamps and one of its walls.
std::string write_unlit_box(const FileFolder& folder) {
  std::string obj = open_box_obj();
  obj.erase(obj.find("v -0.8 0.99"));
  folder.write("box.mtl", box_mtl());
  return folder.write("unlit.obj", obj);
}

TEST_CASE("a room without lamps is lit by a sky in every command") {
  const FileFolder folder;
  const std::string room = write_unlit_box(folder);
  const std::string eyes = folder.write("eyes.pts", "0 0 0.5 0 0 -1\n");
  const std::string path =
      folder.write("path.json", R"([{"time": 0, "position": [0, 0, 0.5], "look_at": [0, 0, 0]},
                       {"time": 0.04, "position": [0, 0, 0.4], "look_at": [0, 0, 0]}])");
  const char *sky = "--sky overcast=10000",
             *picture = "--quality draft --photons 2k -k 20 --size 16x12",
             *rays = "--rays 32 --repeats 2 --photons 10k",
             *plane = "--plane floor+0.75 --wall-band 0.2 --inside 0,0,0";
  for (const auto& command :
       {typed("render", room, "-o", folder / "a.exr", sky, picture),
        typed("walk", room, "-o", folder / "walk.png", "--camera-path", path, sky, picture),
        typed("trace", room, "-o", folder / "a.photons", "--photons 2k", sky),
        typed("measure", room, sky, plane, rays),
        typed("measure", room, "--daylight-factor", plane, rays),
        typed("daylight", room, "--weather", write_weather(folder), "--patches 145", plane, rays),
        typed("glare", room, "--observers", eyes, "--ratings ugr", rays, sky)}) {
    CAPTURE(command[0], command[3]);
    succeed(typed(command, "--quiet"));
  }
}

// `photile render --errors`: the noise of each light's layer, as the picture states it.

constexpr int seeds = 6;

// A room this small has four times the rays that are set.
void render_picture(const FileFolder& folder, const std::string& file, const std::string& seed,
                    const std::vector<std::string>& more) {
  succeed(typed("render", write_box(folder), "-o", file,
                "--size 24x18 --samples 4 --photons 50k -k 50 --set light_map_rays=4 --seed", seed,
                more));
}

/// A picture and its errors, of this seed.
void render(const FileFolder& folder, int seed) {
  const std::string name = std::to_string(seed);
  render_picture(folder, folder / name + ".exr", name, {"--errors", folder / name + "-errors.exr"});
}

TEST_CASE("the stated errors of a light are the scatter of its layer from seed to seed") {
  const FileFolder folder;
  std::vector<Image> pictures, errors;
  for (int seed = 1; seed <= seeds; ++seed) {
    render(folder, seed);
    pictures.push_back(read_image(folder / std::to_string(seed) + ".exr"));
    errors.push_back(read_image(folder / std::to_string(seed) + "-errors.exr"));
    REQUIRE(errors.back().channel_names == pictures.back().channel_names);
  }
  for (const std::string channel : {"Illuminance_left.Y", "Illuminance_right.Y"}) {
    CAPTURE(channel);
    double stated = 0, measured = 0;
    for (std::size_t pixel = 0; pixel < pictures.front().pixels(); ++pixel) {
      double sum = 0, squares = 0;
      for (int i = 0; i < seeds; ++i) {
        const double value = (*pictures[i].find(channel))[pixel];
        sum += value;
        squares += value * value;
        stated += std::pow((*errors[i].find(channel))[pixel], 2) / seeds;
      }
      measured += (squares - sum * sum / seeds) / (seeds - 1);
    }
    // A ratio of variances: the stated error leaves out what photons share.
    CHECK(stated / measured > 0.4);
    CHECK(stated / measured < 2.0);
  }
}

TEST_CASE("stated errors change no bit of the picture, and each is in proportion to its light") {
  const FileFolder folder;
  render(folder, 1);
  render_picture(folder, folder / "alone.exr", "1", {});
  CHECK(read_image(folder / "1.exr").channels == read_image(folder / "alone.exr").channels);
  succeed({"relight", folder / "1-errors.exr", "--light", "left=x3", "-o", folder / "relit.exr"});
  const Image before = read_image(folder / "1-errors.exr"),
              after = read_image(folder / "relit.exr");
  const auto& own = *before.find("Combined_left.G");
  const auto& tripled = *after.find("Combined_left.G");
  CHECK(*std::max_element(own.begin(), own.end()) > 0);
  for (std::size_t pixel = 0; pixel < own.size(); ++pixel) {
    CHECK(tripled[pixel] == Approx(3 * own[pixel]));
  }
  CHECK(*before.find("Combined_right.G") == *after.find("Combined_right.G"));
}

// `photile info` against what the written scene is known to hold, and both integrators.

TEST_CASE("a luminaire beside an OBJ is stated in lumens and in its electrical watts") {
  const FileFolder folder;
  const std::string scene = write_box(folder);
  folder.write("lamp.ies",
               "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 3 1 1 2 0.1 0.1 0\n1 1 120\n0 90 180\n0\n"
               "100 100 100\n");
  folder.write("lamps.json", R"([{"name": "tubes", "file": "lamp.ies", "position": [0, 0.9, 0],
                                  "count": [2, 1], "spacing": [0.3, 0]}])");
  const std::vector<std::string> lamps{"--luminaires", folder / "lamps.json"};
  const double lumens = 400 * glm::pi<double>();
  const auto facts = nlohmann::json::parse(succeed(typed("info --json", scene, lamps)).output);
  REQUIRE(facts["lights"].size() == 4);
  CHECK(facts["lights"][0]["watts"].get<double>() > 0);  // radiant, as OBJ has it
  const auto& tube = facts["lights"][3];
  CHECK(tube["lumens"].get<double>() == Approx(lumens).epsilon(1e-9));
  CHECK(tube["electrical_watts"].get<double>() == Approx(120));
  CHECK(tube["unit"] == "lm");
  CHECK_FALSE(tube.contains("watts"));
  CHECK(facts["groups"][0]["electrical_watts"].get<double>() == Approx(240));
  CHECK_FALSE(facts["groups"][0].contains("watts"));
  const std::string text = succeed(typed("info", scene, lamps)).output;
  CHECK_THAT(text, Contains("photometric, 1257 lm, takes 120 W, of group tubes") &&
                       Contains("group: tubes: 2 lights, 2513 lm\n"));
  // Dimmed, it takes less.
  const std::string picture = folder / "a.exr";
  const Outcome rendered =
      succeed(typed("render", scene, "-o", picture,
                    "--size 16x12 --quality draft --photons 2k -k 20 --light tubes=x0.5", lamps));
  CHECK_THAT(rendered.errors + rendered.output, Contains("628.3 lm, takes 60 W"));
  const std::string relit = succeed({"relight", picture}).output;
  CHECK_THAT(relit,
             Contains("group: tubes: 1257 lm\n") && Contains("light: left: ") && Contains(" W ("));
}

TEST_CASE("both integrators render a floor under a sky, as a layer that can be relit") {
  const FileFolder folder;
  const std::string integrator = GENERATE("photon-map", "path");
  const std::string picture = folder / "floor.exr";
  folder.write("floor.obj", "v -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0 1\nf 4 3 2 1\n");
  succeed(typed("render", folder / "floor.obj", "-o", picture,
                "--size 64x48 --samples 4 --integrator", integrator,
                "--quality draft --sky uniform=6830"));
  const Image image = read_image(picture);
  const auto* sky = image.find("Combined_sky.G");
  const auto* illuminance = image.find("Illuminance_sky.Y");
  REQUIRE(sky != nullptr);
  REQUIRE(illuminance != nullptr);
  // Somewhere the floor is seen, with 6830 lux, and somewhere the sky, with 10 / pi W/(m2 sr).
  float most = 0;
  for (const float lux : *illuminance) most = std::max(most, lux);
  CHECK(most == Approx(6830).epsilon(integrator == "path" ? 0.5 : 0.3));
  float brightest = 0;
  for (const float radiance : *sky) brightest = std::max(brightest, radiance);
  CHECK(brightest >= Approx(10 / 3.14159265).epsilon(0.01));
  succeed({"relight", picture, "--light", "sky=x2", "-o", folder / "twice.exr"});
}

}  // namespace
}  // namespace photile::test
