#include "box_scene.hpp"

#include <utility>
#include <vector>

#include "weather_text.hpp"

namespace photile::test {

std::string box_mtl() {
  return "newmtl wall\nKd 0.7 0.6 0.5\n"
         "newmtl red_lamp\nKd 0 0 0\nKe 20 5 5\n"
         "newmtl blue_lamp\nKd 0 0 0\nKe 5 5 20\n";
}

std::string box_obj() {
  return "mtllib box.mtl\n"
         "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\n"
         "v -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\n"
         "o walls\nusemtl wall\n"
         "f 1 2 3 4\nf 8 7 6 5\nf 1 4 8 5\nf 2 6 7 3\nf 4 3 7 8\nf 1 5 6 2\n"
         // The lamps shine down: counter-clockwise as seen from below.
         "v -0.8 0.99 -0.2\nv -0.4 0.99 -0.2\nv -0.4 0.99 0.2\nv -0.8 0.99 0.2\n"
         "o left\nusemtl red_lamp\nf 9 10 11 12\n"
         "v 0.4 0.99 -0.2\nv 0.8 0.99 -0.2\nv 0.8 0.99 0.2\nv 0.4 0.99 0.2\n"
         "o right\nusemtl blue_lamp\nf 13 14 15 16\n";
}

std::string open_box_obj() {
  std::string obj = box_obj();
  const std::string wall = "f 1 4 8 5\n";
  obj.erase(obj.find(wall), wall.size());
  return obj;
}

std::string write_open_box(const FileFolder& folder) {
  folder.write("box.mtl", box_mtl());
  return folder.write("open.obj", open_box_obj());
}

std::string write_weather(const FileFolder& folder) {
  const auto by_day = [](int lux) {
    return [lux](int, int, int hour) { return hour > 8 && hour < 17 ? lux : 0; };
  };
  return folder.write("year.epw", weather_text(by_day(400), by_day(150)));
}

std::string write_box(const FileFolder& folder) {
  folder.write("box.mtl", box_mtl());
  return folder.write("box.obj", box_obj());
}

Run small_render(const FileFolder& folder) {
  return {.arguments = {"render", write_box(folder), "-o", folder / "out.png", "--photons", "20k",
                        "--size", "16x12", "--quality", "draft"}};
}

std::string filled(std::string command, const FileFolder& folder) {
  const std::vector<std::pair<std::string, std::string>> words{
      {"DISK", folder / "disk"},
      {"SCENE", folder / "box.obj"},
      {"LARGE", folder / "large.exr"},
      {"MANY", folder / "many.pts"},
      {"PATH", folder / "path.json"},
      {"NOWHERE", folder / "other"},
      {"DRAFT", "--quality draft -q --photons 5k"},
      {"POINTS", "-q --photons 5k --rays 1 --repeats 2 --points"}};
  for (const auto& [word, meaning] : words) {
    for (std::size_t at = 0; (at = command.find(word, at)) != std::string::npos;
         at += meaning.size()) {
      command.replace(at, word.size(), meaning);
    }
  }
  return command;
}

}  // namespace photile::test
