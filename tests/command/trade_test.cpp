// Measurements of the program's own: time against error, closed forms; and baked rooms.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "box_scene.hpp"
#include "photile/image.hpp"

namespace photile::test {
namespace {

using Catch::Contains;

// `photile trade`, and pictures made until one is good enough.

std::size_t lines_of(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

TEST_CASE("a trade writes its files and prints a row for each requested error", "[slow]") {
  const FileFolder folder;
  const std::string results = folder / "results";
  const Outcome outcome =
      succeed(typed("trade", write_box(folder), "-o", results,
                    "--size 24x18 --photons 4k -k 8 --samples 1 --reference-samples 16 -q"));
  for (const char* error : {"10%", "5%", "2%", "1%"}) CHECK_THAT(outcome.output, Contains(error));

  const auto record = nlohmann::json::parse(bytes_of(results + "/trade.json"));
  CHECK(record["reference_samples"] == 16);
  CHECK(record["reference_relative_mse"] > 0);
  const std::size_t renderings = record["renderings"].size();
  CHECK(renderings > 20);
  CHECK(lines_of(bytes_of(results + "/trade.csv")) == renderings + 1);  // and a header
  CHECK_FALSE(bytes_of(results + "/reference.exr").empty());

  // The reference that it wrote is one that it reads, and then traces none.
  const Outcome again = succeed(typed("trade", folder / "box.obj", "-o", folder / "again",
                                      "--size 24x18 --photons 4k -k 8 --samples 1 --reference",
                                      results + "/reference.exr", "-q"));
  CHECK(bytes_of(folder / "again/reference.exr").empty());
}

TEST_CASE("pictures are made until one states the requested error, which its settings make again") {
  const FileFolder folder;
  const auto render = [&](const auto&... more) {
    return succeed(typed("render", write_box(folder), "--size 24x18", more...));
  };
  const Outcome outcome =
      render("--set light_map_rays=8 --photons 20k --samples 2 --target-error 0.4% -o",
             folder / "box.exr", "--stats", folder / "box.json");
  CHECK_THAT(outcome.errors, Contains("picture 1: standard error") && Contains("picture 2: "));
  const auto record = nlohmann::json::parse(bytes_of(folder / "box.json"));
  const auto maps = std::find_if(record["stages"].begin(), record["stages"].end(),
                                 [](const auto& s) { return s["stage"] == "light maps"; });
  REQUIRE(maps != record["stages"].end());
  CHECK((*maps)["figures"]["standard error percent"] <= 0.4);
  CHECK(record["asked"]["target_error"].get<double>() == Approx(0.004));

  const auto& used = record["parameters"];
  CHECK(used["light_map_rays"] > 8);
  render("-o", folder / "again.exr", "--set", "light_map_rays=" + used["light_map_rays"].dump(),
         "--photons", used["photons_emitted"].dump(), "--samples", used["samples_per_pixel"].dump(),
         "--set", "passes=" + used["passes"].dump(), "--set light_maps=on -q");
  const Image made = read_image(folder / "box.exr"), again = read_image(folder / "again.exr");
  CHECK(made.channels == again.channels);
}

TEST_CASE("an error that is out of reach is told") {
  const FileFolder folder;
  const Outcome outcome = succeed(typed("render", write_box(folder), "-o", folder / "box.exr",
                                        "--size 24x18 --target-error 0.001% --for 1ms"));
  CHECK_THAT(outcome.errors, Contains("warning: a standard error of 0.001% was not reached"));
}

TEST_CASE("pictures are made for a time") {
  const FileFolder folder;
  const Outcome outcome = succeed(
      typed("render", write_box(folder), "-o", folder / "box.exr", "--size 24x18 --for 1ms"));
  CHECK_THAT(outcome.errors,
             Contains("picture 1: ") &&
                 Contains("--photons 1500000 -k 100 --samples 4 --set light_map_rays=16") &&
                 !Contains("picture 2"));
  CHECK_FALSE(bytes_of(folder / "box.exr").empty());
}

// `photile validate`: the table, the JSON and the exit codes.

TEST_CASE("validate prints expected, measured and error, and says the same in JSON") {
  const FileFolder folder;
  const Outcome outcome = succeed({"validate", "--case", "point light", "--integrator", "path",
                                   "--paths", "100", "--json", folder / "readings.json"});
  CHECK_THAT(outcome.output, Contains("expected") && Contains("point light over a surface") &&
                                 Contains("below the lamp") && Contains("ok"));
  const auto record = folder.json("readings.json");
  REQUIRE(record["readings"].size() == 4);
  for (const auto& reading : record["readings"]) {
    CHECK(reading["unit"] == "lx");
    CHECK(reading["path"]["verdict"] == "ok");
    CHECK(reading["path"]["seeds"] >= 16);
    CHECK(reading["path"]["value"] == Approx(reading["expected"].get<double>()).epsilon(0.001));
    CHECK_FALSE(reading.contains("photon_map"));
  }
}

TEST_CASE("readings that are too noisy for 1% make validate fail") {
  const std::vector<std::string> command = {
      "validate", "--case", "an obstruction", "--integrator", "path", "--paths", "1", "--quiet"};
  const Outcome outcome = run_photile(command);
  CHECK(outcome.exit_code == 1);
  CHECK_THAT(outcome.output, Contains("too noisy"));
  CHECK_THAT(last_error(outcome, 1), Contains(" of 3 readings") && Contains("--paths"));

  // Where both streams end in one place the error is the last line, whole.
  std::string line = PHOTILE_COMMAND;
  for (const std::string& word : command) line += " '" + word + "'";
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> both(popen((line + " 2>&1").c_str(), "r"),
                                                             &pclose);
  std::string text;
  for (int c = std::fgetc(both.get()); c != EOF; c = std::fgetc(both.get())) {
    text += static_cast<char>(c);
  }
  CHECK(text == outcome.output + outcome.errors);
}

// `photile bake`: the files that it writes, and what other programs find in them.

std::vector<std::string> bake(const FileFolder& folder, const std::vector<std::string>& more = {}) {
  return typed("bake", write_box(folder), "-o", folder / "baked.gltf", "--photons 50k", more);
}

TEST_CASE("a baked scene has a second set of coordinates and a picture for each light") {
  const FileFolder folder;
  succeed(bake(folder));
  const nlohmann::json document = folder.json("baked.gltf");
  const auto& primitive = document["meshes"][0]["primitives"][0];
  const auto& lights = document["accessors"][primitive["attributes"]["TEXCOORD_1"].get<int>()];
  CHECK(lights["type"] == "VEC2");
  CHECK(lights["count"] ==
        document["accessors"][primitive["attributes"]["POSITION"].get<int>()]["count"]);
  for (const int axis : {0, 1}) {
    CHECK(lights["min"][axis] >= 0.0);
    CHECK(lights["max"][axis] <= 1.0);
  }
  const auto& maps = document["scenes"][0]["extras"]["photile"]["light_maps"];
  REQUIRE(maps.size() == 2);
  for (const auto& map : maps) {
    const Image picture = read_image(folder / map["uri"].get<std::string>());
    CHECK(picture.attributes.at("photile.light") == map["light"].get<std::string>());
    const std::vector<float>& green = *picture.find("G");
    CHECK(*std::max_element(green.begin(), green.end()) > 0);
    CHECK(*std::min_element(green.begin(), green.end()) >= 0);
  }
  CHECK(std::filesystem::file_size(folder / "baked.bin") ==
        document["buffers"][0]["byteLength"].get<std::size_t>());
}

/// A little-endian number of four bytes.
std::size_t word_at(const std::string& bytes, std::size_t place) {
  std::size_t number = 0;
  for (std::size_t i = 4; i-- > 0;) {
    number = number << 8 | static_cast<unsigned char>(bytes[place + i]);
  }
  return number;
}

TEST_CASE("a baked scene in one file holds what the files of the other form hold") {
  const FileFolder folder;
  Image picture;
  picture.width = 5;
  picture.height = 3;
  for (const char* channel : {"R", "G", "B"}) {
    std::vector<float>& plane = picture.add(channel);
    for (std::size_t i = 0; i < plane.size(); ++i) plane[i] = static_cast<float>(i % 4) / 4;
  }
  write_png(folder / "tiles.png", picture);
  folder.write("box.mtl", box_mtl() + "newmtl tiles\nKd 0.5 0.5 0.5\nmap_Kd tiles.png\n");
  const std::string scene =
      folder.write("box.obj", box_obj() +
                                  "vt 0 0\nvt 1 0\nvt 0 1\nv -0.5 0 0\nv 0.5 0 0\nv 0 0 "
                                  "0.5\nusemtl tiles\nf 17/1 18/2 19/3\n");
  const auto bake_to = [&](const std::string& name) {
    succeed(typed("bake", scene, "-o", folder / name, "--photons 50k -q"));
  };
  bake_to("files.gltf");
  bake_to("one.glb");
  nlohmann::json files = folder.json("files.gltf");
  const std::string glb = folder.read("one.glb"), bin = folder.read("files.bin");
  REQUIRE(glb.substr(0, 4) == "glTF");
  CHECK(word_at(glb, 4) == 2);
  CHECK(word_at(glb, 8) == glb.size());
  const std::size_t text_bytes = word_at(glb, 12), buffer = 20 + text_bytes + 8;
  CHECK(text_bytes % 4 == 0);
  REQUIRE(glb.substr(16, 4) == "JSON");
  REQUIRE(glb.substr(buffer - 4, 4) == std::string("BIN\0", 4));
  CHECK(word_at(glb, buffer - 8) == glb.size() - buffer);
  nlohmann::json one = nlohmann::json::parse(glb.substr(20, text_bytes));
  CHECK_FALSE(one["buffers"][0].contains("uri"));
  const auto bytes_of_view = [](const nlohmann::json& document, std::size_t number,
                                const std::string& bytes, std::size_t from) {
    const auto& view = document["bufferViews"][number];
    CHECK(view["byteOffset"].get<std::size_t>() % 4 == 0);
    return bytes.substr(from + view["byteOffset"].get<std::size_t>(),
                        view["byteLength"].get<std::size_t>());
  };
  REQUIRE(one["images"].size() == 1);
  CHECK(one["images"][0]["mimeType"] == "image/png");
  CHECK(bytes_of_view(one, one["images"][0]["bufferView"], glb, buffer) ==
        folder.read(files["images"][0]["uri"].get<std::string>()));
  REQUIRE(one["accessors"].size() == files["accessors"].size());
  for (std::size_t i = 0; i < one["accessors"].size(); ++i) {
    CHECK(bytes_of_view(one, one["accessors"][i]["bufferView"], glb, buffer) ==
          bytes_of_view(files, files["accessors"][i]["bufferView"], bin, 0));
  }
  CHECK(one["meshes"] == files["meshes"]);
  CHECK(one["materials"] == files["materials"]);
  for (const char* light : {"light00.exr", "light01.exr"}) {
    CHECK(folder.read("one." + std::string(light)) == folder.read("files." + std::string(light)));
  }
  CHECK_FALSE(std::filesystem::exists(folder / "one.bin"));
}

// `photile publish`: what the browser shows is in tests/publish.

TEST_CASE("a page and a scene for other programs are written with the same light") {
  const FileFolder folder;
  const std::string scene = write_box(folder);
  const auto publish = [&](const std::vector<std::string>& more) {
    return typed("publish", scene, "--photons 20k --quality draft --texel 0.2", more);
  };
  succeed(publish({"-o", folder / "room.html", "-o", folder / "room.glb"}));
  CHECK_THAT(folder.read("room.html"), Contains("<!DOCTYPE html>"));
  CHECK(folder.read("room.glb").substr(0, 4) == "glTF");
  CHECK(read_image(folder / "room.light01.exr").find("G"));
}

TEST_CASE("pages are made for a time, the first from a quarter of the rays", "[slow]") {
  const FileFolder folder;
  const std::string scene = write_box(folder);
  const auto publish = [&](const std::vector<std::string>& more) {
    return typed("publish", scene, "-o", folder / "room.html", "--texel 0.2", more);
  };
  const Outcome outcome = succeed(publish({"--for", "1ms"}));
  CHECK_THAT(outcome.errors, Contains("standard error ") &&
                                 Contains("; --photons 1500000 -k 100 --set light_map_rays=16\n") &&
                                 !Contains("passes"));
  const std::string page = folder.read("room.html");
  succeed(typed("publish", scene, "-o", folder / "same.html",
                "--texel 0.2 --title box --photons 1500000 -k 100 --set light_map_rays=16"));
  CHECK(page == folder.read("same.html"));
  // Those of a longer time have several parts.
  succeed(typed("publish", scene, "-o", folder / "one.html",
                "--texel 0.2 --title box --photons 20k --set light_map_rays=8"));
  succeed(typed("publish", scene, "-o", folder / "three.html",
                "--texel 0.2 --title box --photons 20k --set light_map_rays=24 --set passes=3"));
  CHECK(folder.read("one.html") != folder.read("three.html"));
}

}  // namespace
}  // namespace photile::test
