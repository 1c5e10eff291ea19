// OBJ and MTL texts damaged at random, with fixed seeds.
#include <array>
#include <catch2/catch.hpp>
#include <random>
#include <string_view>

#include "damaged_files.hpp"

namespace photile::test {
namespace {

/// A text with something of everything that is read.
const std::string sound_obj =
    "mtllib fuzz.mtl\no room\n" + unit_square +
    "vn 0 0 1\nvn 0.1 0 1\nv 0 0 2 1\nv 1 0 2 0.5 0.5 0.5\nv 1 1 2\nv 0.5 0.5 2.5\nv 0 1 2\n"
    "usemtl wall\nf 1/1/1 2/2/1 3/3/2 4/4/2\ng lamps upper\nusemtl lamp\ns 1\n"
    "f 5 6 7 8 9\nf -5//-1 -4//-2 \\\n -3//-1\nusemtl glass\nf 1/1 2/2 7/3\nl 1 2\np 3\n"
    "usemtl shiny\nf 1 4 9 5\nusemtl nowhere\nf 2 3 7\n";

const std::string sound_mtl =
    "newmtl lamp\nKd 0 0 0\nKe 2 2 2\nmap_Ke -s 1 1 1 -o 0 0 0 absent.png\n\nnewmtl wall\n"
    "Kd 0.5 0.25 0.125\nmap_Kd -clamp on -bm 0.2 absent.png\nmap_bump -imfchan r -mm 0 1 b.png\n"
    "newmtl glass\nd 0.2\nNi 1.5\nTf 0.9 0.9 0.9\nillum 4\nTr 0.8\n"
    "newmtl shiny\nKs 0.5 0.5 0.5\nNs 200\nillum 2\nPr 0.3\nPm 0.1\nnorm -texres 4 n.png\n";

TEST_CASE("the OBJ and MTL texts that are damaged below are sound", "[fuzz]") {
  const SceneFolderOnDisk folder;
  folder.write("fuzz.mtl", sound_mtl);
  const Scene scene = load_scene(folder.write("fuzz.obj", sound_obj));
  check_invariants(scene);
  CHECK(scene.triangle_count() == 2 + 3 + 1 + 1 + 2 + 1);
  CHECK(scene.materials.size() == 5);
}

TEST_CASE("an OBJ or MTL text cut anywhere is read or refused", "[fuzz]") {
  DamagedFiles files;
  files.write("fuzz.mtl", sound_mtl);
  for (std::size_t length = 0; length < sound_obj.size(); ++length) {
    files.load("fuzz.obj", sound_obj.substr(0, length));
  }
  for (std::size_t length = 0; length < sound_mtl.size(); ++length) {
    files.write("fuzz.mtl", sound_mtl.substr(0, length));
    files.load("fuzz.obj", sound_obj);
  }
  CHECK(files.loaded > 300);
  CHECK(files.refused > 100);
}

TEST_CASE("OBJ and MTL texts with bytes or words replaced at random are read or refused",
          "[fuzz]") {
  constexpr std::array<std::string_view, 22> words{"f",
                                                   "v",
                                                   "usemtl",
                                                   "newmtl",
                                                   "map_Kd",
                                                   "-1",
                                                   "0",
                                                   "4294967295",
                                                   "1e999",
                                                   "nan",
                                                   "-inf",
                                                   "//",
                                                   "1/2/3/4",
                                                   "-2147483648",
                                                   "-o",
                                                   "-mm",
                                                   "\\\n",
                                                   "\r",
                                                   "#",
                                                   "refl -type sphere",
                                                   "mtllib fuzz.obj",
                                                   "Ke 1e30 -1 nan"};
  std::mt19937 random(13);
  DamagedFiles files;
  const auto damaged = [&](std::string text) {
    if (random() % 2 == 0) return with_replaced_bytes(std::move(text), random);
    for (unsigned changes = 1 + random() % 3; changes > 0; --changes) {
      const std::size_t begin = random() % text.size();
      const std::size_t end = std::min(text.find_first_of(" \n/", begin), text.size());
      text.replace(begin, end - begin, words[random() % words.size()]);
    }
    return text;
  };
  for (int trial = 0; trial < 2'000; ++trial) {
    files.write("fuzz.mtl", trial % 2 == 0 ? sound_mtl : damaged(sound_mtl));
    files.load("fuzz.obj", trial % 3 == 0 ? sound_obj : damaged(sound_obj));
  }
  CHECK(files.loaded > 500);
  CHECK(files.refused > 200);
}

}  // namespace
}  // namespace photile::test
