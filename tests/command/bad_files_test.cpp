// Scenes that cannot be rendered, files that ask for too much, outputs that cannot be written.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>

#include "box_scene.hpp"
#include "child_process.hpp"
#include "file_folder.hpp"
#include "loading/luminaires.hpp"
#include "photile/image.hpp"
#include "photile/limits.hpp"
#include "view/moods.hpp"

namespace photile::test {
namespace {

using Catch::Contains;

// Scenes that cannot be rendered: exit code 3 and one line that names the file.

/// What both `info` and `render` say of a bad scene; they must agree. Nothing may be written.
std::string refusal(const FileFolder& folder, const std::string& scene,
                    bool held_to_permissions = false) {
  Run run;
  run.held_to_permissions = held_to_permissions;
  run.arguments = {"info", scene};
  const std::string line = only_error(run_photile(run), bad_input);
  run.arguments = {"render", scene, "-o", folder / "out.exr"};
  CHECK(last_error(run_photile(run), bad_input) == line);
  CHECK_FALSE(std::filesystem::exists(folder / "out.exr"));
  return line;
}

TEST_CASE("an unreadable scene is an input error") {
  const FileFolder folder;
  const std::string scene = write_box(folder);
  std::filesystem::permissions(scene, std::filesystem::perms::none);
  constexpr bool held_to_permissions = true;
  CHECK_THAT(refusal(folder, scene, held_to_permissions), Contains("box.obj"));
}

TEST_CASE("what is no scene is an input error that says so, of one line") {
  const FileFolder folder;
  std::filesystem::create_directory(folder / "folder.obj");
  folder.write("empty.obj", "");
  folder.write("list.gltf", "[1, 2, 3]");
  folder.write("cut.glb", "glTF\x02 and then nothing of the kind");
  folder.write("text.txt", "hello");
  folder.write("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n");
  const std::pair<const char*, const char*> said[] = {
      {"none.obj", "none.obj"}, {"two\nlines.obj", "two lines.obj"}, {"folder.obj", "folder.obj"},
      {"empty.obj", "empty"},   {"list.gltf", "malformed"},          {"cut.glb", "malformed"},
      {"text.txt", ".obj"},     {"points.obj", "triangle"}};
  for (const auto& [name, words] : said) {
    CAPTURE(name);
    CHECK_THAT(refusal(folder, folder / name), Contains(words));
  }
}

// Small files that ask for much: refused, and in little memory. (Time is no matter of assertions;
// each of these takes less than a second.)

constexpr long most_kilobytes = 256 << 10;  ///< beside the file itself

std::string repeated(const std::string& text, std::size_t times) {
  std::string all;
  for (std::size_t i = 0; i < times; ++i) all += text;
  return all;
}

/// A glTF text with more members.
std::string gltf(const std::string& members) {
  return R"({"asset": {"version": "2.0"}, )" + members + "}";
}

std::string square(const std::string& more) {
  return gltf(R"("scenes": [{"nodes": [0]}], "materials": [{"emissiveFactor": [1, 1, 1]}], )" +
              more);
}

TEST_CASE("scenes that ask for more than they hold are refused in little memory") {
  const FileFolder folder;
  std::string graph = R"("nodes": [)";
  for (int i = 0; i < 22; ++i) {
    graph += R"({"children": [)" + std::to_string(i + 1) + ", " + std::to_string(i + 1) + "]}, ";
  }
  const auto [name, text] = GENERATE_COPY(table<std::string, std::string>({
      {"graph.gltf", square(graph + R"({"mesh": 0}], "meshes": [{"primitives": []}])")},
      {"most_nodes.gltf", gltf(R"("nodes": [{})" + repeated(",{}", limits::max_nodes - 1) + "]")},
      {"nodes.gltf", gltf(R"("nodes": [{})" + repeated(",{}", limits::max_nodes) + "]")},
      {"deep.gltf", gltf(R"("extras": )" + std::string(1'000'000, '['))},
      {"accessor.gltf", square(R"("nodes": [{"mesh": 0}],
         "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
         "accessors": [{"componentType": 5126, "count": 1000000000, "type": "VEC3", "sparse":
           {"count": 1, "indices": {"bufferView": 0, "componentType": 5121},
            "values": {"bufferView": 0}}}],
         "bufferViews": [{"buffer": 0, "byteLength": 12}],
         "buffers": [{"byteLength": 12, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAA"}])")},
      {"primitives.gltf", square(R"("nodes": [{"mesh": 0}], "meshes": [{"primitives": [)" +
                                 repeated(R"({"attributes": {"POSITION": 0}},)", 9'999) +
                                 R"({"attributes": {"POSITION": 0}}]}],
         "accessors": [{"componentType": 5126, "count": 900000, "type": "VEC3", "sparse":
           {"count": 1, "indices": {"bufferView": 0, "componentType": 5121},
            "values": {"bufferView": 0}}}],
         "bufferViews": [{"buffer": 0, "byteLength": 12}],
         "buffers": [{"byteLength": 12, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAA"}])")},
  }));
  CAPTURE(name);
  const Outcome taken = run_photile({"info", folder.write(name, text)});
  CHECK(taken.exit_code == bad_input);
  CHECK(taken.kilobytes < most_kilobytes + 2 * static_cast<long>(text.size() >> 10));
}

TEST_CASE("a PNG of a kilobyte that says that it is huge is refused in little memory") {
  using namespace std::string_literals;
  const FileFolder folder;
  // A header of 20,000 x 20,000 pixels of four words, with its checksum, and nothing after it.
  const std::string png =
      "\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\x4e\x20\0\0\x4e\x20\x10\x06\0\0\0"s + "\xb3\xe0\x9a\x7a"s;
  const Outcome taken = run_photile({"compare", folder.write("a.png", png), folder / "a.png"});
  CHECK(taken.exit_code == bad_input);
  CHECK(taken.kilobytes < most_kilobytes);
}

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
  std::ifstream stream(folder / "row.exr", std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(stream), {}};
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
                                                 Catch::Contains("pixels a byte") &&
                                                 Catch::Contains("scale it down"));
    CHECK(taken.kilobytes < most_kilobytes);
  }
}

TEST_CASE("a Radiance picture of nothing but runs is refused in little memory") {
  // 9,000 x 9,000 zeros, in runs of 127 at most: 15.7 pixels a byte.
  constexpr int side = 9'000;
  std::string row = {2, 2, static_cast<char>(side >> 8), static_cast<char>(side & 255)};
  for (int component = 0; component < 4; ++component) {
    for (int left = side; left > 0; left -= 127) {
      row += {static_cast<char>(128 + std::min(left, 127)), 0};
    }
  }
  const FileFolder folder;
  const std::string file = folder.write(
      "a.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 9000 +X 9000\n" + repeated(row, side));
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"compare", file, file},
        std::vector<std::string>{"render", write_box(folder), "-o", folder / "b.exr",
                                 "--environment", file}}) {
    const Outcome taken = run_photile(command);
    CHECK_THAT(last_error(taken, bad_input),
               Catch::Contains("a.hdr: ") && Catch::Contains("pixels a byte"));
    CHECK(taken.kilobytes < most_kilobytes);
  }
}

TEST_CASE("JSON that is nested a million deep is refused in a line") {
  constexpr std::size_t levels = 1'000'000;
  const FileFolder folder;
  const std::string file =
      folder.write("deep.json", std::string(levels, '[') + "0" + std::string(levels, ']'));
  const std::string box = write_box(folder);
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"info", box, "--luminaires", file},
        std::vector<std::string>{"measure", box, "--grid", file}}) {
    CHECK_THAT(last_error(run_photile(command), bad_input),
               Catch::Contains("deep.json: is nested more than"));
  }
  CHECK_THROWS_WITH(view::Moods(file), Catch::Contains("deep.json: is nested more than"));
  // Brackets in texts are none.
  const std::string text = "[{\"name\": \"\\\"" + std::string(levels, '[') + "\"}]";
  CHECK(loading::LuminaireList::parse(text, "texts").entries.size() == 1);
}

// Outputs that cannot be written are refused before the long work, and never left half written.

/// The only line of a render that was refused before it began: no device line came before.
std::string refusal(const std::vector<std::string>& outputs, int exit_code) {
  const FileFolder folder;
  std::vector<std::string> arguments = typed("render", write_box(folder), outputs);
  return only_error(run_photile(arguments), exit_code);
}

TEST_CASE("an output in a folder that does not exist is refused before the work") {
  const std::string option = GENERATE("-o", "--illuminance", "--stats");
  const std::string file = "/nonexistent-folder/out.png";
  CHECK_THAT(refusal({"-o", "/nonexistent-folder/out.png", option, file}, failure),
             Contains("/nonexistent-folder/out.png"));
}

TEST_CASE("an output that is a folder is refused before the work") {
  const FileFolder folder;
  std::filesystem::create_directory(folder / "out.exr");
  CHECK_THAT(refusal({"-o", folder / "out.exr"}, failure), Contains("out.exr"));
}

TEST_CASE("a folder for outputs that cannot be made is refused before the work") {
  const FileFolder folder;
  const std::string scene = write_box(folder), below_a_file = folder / "box.mtl/results";
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"trade", scene, "-o", below_a_file},
        std::vector<std::string>{"measure", scene, "--plane", "1", "--honeybee", below_a_file}}) {
    CHECK_THAT(only_error(run_photile(arguments), failure),
               Contains("box.mtl/results") && Contains("cannot make this folder"));
  }
}

TEST_CASE("statistics to a device that is always full are refused before the work") {
  const FileFolder folder;
  CHECK_THAT(refusal({"-o", folder / "out.exr", "--stats", "/dev/full"}, failure),
             Contains("/dev/full"));
  CHECK(folder.file_count() == 0);
}

TEST_CASE("an output of an unknown format is a usage error") {
  const FileFolder folder;
  CHECK_THAT(refusal({"-o", folder / "out.jpg"}, usage), Contains("out.jpg") && Contains(".exr"));
  CHECK_THAT(refusal({"--luminance", folder / "out.exr"}, usage), Contains(".png"));
}

}  // namespace
}  // namespace photile::test
