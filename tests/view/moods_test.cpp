// Named moods and their file.
#include "view/moods.hpp"

#include <catch2/catch.hpp>
#include <fstream>

#include "file_bytes.hpp"
#include "photile/errors.hpp"
#include "temporary_folder.hpp"
#include "two_lights.hpp"

namespace photile::test {

using Catch::Contains;
using view::LightBoard;
using view::Moods;

namespace {

LightMix lamps() { return test::two_lights("ceiling", 100, "floor lamp", 300); }

}  // namespace

TEST_CASE("a mood comes back from its file as it was kept") {
  const TemporaryFolder folder;
  const auto file = folder.path / "room.moods.json";
  LightBoard board(lamps());
  board.controls()[0].on = false;
  board.controls()[1].power = 42.5;
  board.controls()[1].color = glm::vec3(1, 204 / 255.0f, 0);
  Moods(file).keep("evening", board);
  board.controls()[1].color.reset();
  board.controls()[1].kelvin = 2700;
  Moods(file).keep("warm", board);

  LightBoard other(lamps());
  const Moods read(file);
  CHECK(read.names() == std::vector<std::string>{"evening", "warm"});
  read.apply("warm", other);
  CHECK(other.controls()[1].kelvin == 2700);
  CHECK_FALSE(other.controls()[1].color);
  read.apply("evening", other);
  CHECK(other.controls()[1].kelvin == 0);
  CHECK_FALSE(other.controls()[0].on);
  CHECK(other.controls()[0].power == 100);
  CHECK(other.controls()[1].power == 42.5);
  REQUIRE(other.controls()[1].color);
  CHECK(view::hex_of(*other.controls()[1].color) == "#ffcc00");
}

TEST_CASE("the moods of a scene lie beside it") {
  CHECK(Moods::file_of("rooms/hall.gltf") == "rooms/hall.moods.json");
}

TEST_CASE("a file has powers of four digits, and a mood is what --light would say") {
  const TemporaryFolder folder;
  const auto file = folder.path / "room.moods.json";
  LightBoard board(lamps());
  board.controls()[0].power = 199.98374;
  board.controls()[1].on = false;
  board.controls()[0].kelvin = 2699.7;
  Moods(file).keep("evening", board);
  CHECK_THAT(bytes_of(file), Contains("200.0") && !Contains("199.98") && Contains("2700"));
  const auto changes = Moods(file).changes("evening", lamps());
  REQUIRE(changes.size() == 3);
  CHECK(changes[0].value == "200lm");
  CHECK(changes[1].value == "2700K");
  CHECK(changes[2].name == "floor lamp");
  CHECK(changes[2].value == "off");
  CHECK_THROWS_WITH(Moods(file).changes("day", lamps()), Contains("'evening'"));
}

TEST_CASE("removing one mood keeps the others") {
  const TemporaryFolder folder;
  const auto file = folder.path / "room.moods.json";
  Moods moods(file);
  moods.keep("day", LightBoard(lamps()));
  moods.keep("night", LightBoard(lamps()));
  moods.remove("day");
  CHECK(Moods(file).names() == std::vector<std::string>{"night"});
}

TEST_CASE("a light that is not there is told with those there are, the likest first") {
  const TemporaryFolder folder;
  const auto file = folder.path / "room.moods.json";
  std::ofstream(file) << R"({"photile_moods": 1, "moods": {
      "x": {"ceiling": {"power": 5}, "floor_lamps": {"power": 1}}, "y": {"ceiling": {"power": 7}}}})";
  const Moods moods(file);
  CHECK_THROWS_WITH(moods.changes("x", lamps()), Contains("mood 'x'") &&
                                                     Contains("'floor_lamps'") &&
                                                     Contains("are 'floor lamp', 'ceiling'"));
  CHECK_THROWS_AS(moods.changes("x", lamps()), UsageError);
  CHECK(moods.changes("y", lamps()).size() == 1);  // the other mood is none of its business
  LightBoard board(lamps());
  CHECK_THROWS_WITH(moods.apply("x", board), Contains("'floor_lamps'"));
  CHECK(board.controls()[0].power == 5);  // the board has what could be set
}

TEST_CASE("a mood in watts sets lamps in lumens") {
  const TemporaryFolder folder;
  const auto file = folder.path / "room.moods.json";
  std::ofstream(file)
      << R"({"photile_moods": 1, "moods": {"x": {"ceiling": {"power": 2, "unit": "W"}}}})";
  LightMix mix = lamps();
  mix.lumen_per_watt = 179;
  LightBoard board(mix);
  Moods(file).apply("x", board);
  CHECK(board.controls()[0].power == Approx(358));
  change_lights(mix, Moods(file).changes("x", mix));
  CHECK(mix.lights[0].power == Approx(358));
}

TEST_CASE("a mood may switch a light or warm it without naming its power") {
  const TemporaryFolder folder;
  const auto file = folder.path / "room.moods.json";
  std::ofstream(file) << R"({"photile_moods": 1, "moods": {
      "x": {"ceiling": {"on": false}, "floor lamp": {"kelvin": 2700}}}})";
  Moods moods(file);
  const auto changes = moods.changes("x", lamps());
  REQUIRE(changes.size() == 2);
  CHECK(changes[0].value == "off");
  CHECK(changes[1].value == "2700K");
  LightBoard board(lamps());
  const double before = board.controls()[0].power;
  moods.apply("x", board);
  CHECK_FALSE(board.controls()[0].on);
  CHECK(board.controls()[0].power == before);
  moods.keep("y", board);  // writes what was read, too
  CHECK(Moods(file).changes("x", lamps()).size() == 2);
}

TEST_CASE("a mood that cannot be written leaves the moods as they were") {
  Moods moods("/nonexistent-folder/room.moods.json");
  CHECK_THROWS_AS(moods.keep("day", LightBoard(lamps())), OutputError);
  CHECK(moods.names().empty());
}

}  // namespace photile::test
