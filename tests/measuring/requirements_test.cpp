// What standards require, and whether a measurement has it.
#include "measuring/requirements.hpp"

#include <catch2/catch.hpp>

#include "photile/errors.hpp"

namespace photile::test {
namespace {

using namespace photile::measuring;
using Catch::Contains;

GridValues grid(GridRole role, const std::vector<float>& lux, float noise = 0) {
  GridValues values;
  values.grid.name = "plane";
  values.grid.role = role;
  values.grid.sensors.resize(lux.size());
  std::vector<std::vector<float>> repeats(2, lux);
  for (float& value : repeats[0]) value += noise;
  for (float& value : repeats[1]) value -= noise;
  values.lights.push_back({"", means_of(repeats), statistics_of(repeats, 0, lux.size())});
  return values;
}

}  // namespace

TEST_CASE("a desk needs 500 lux with a uniformity of 0.60 by EN 12464-1") {
  const Requirement desk = parse_requirement("office-desk");
  CHECK(desk.reference == "EN 12464-1:2021, table 34, required values");
  const auto good = judge(grid(GridRole::task, {400, 600, 700}), desk);
  REQUIRE(good.size() == 2);
  CHECK(good[0].figure == "Em");
  CHECK(good[0].required == 500);
  CHECK(good[0].met());
  CHECK(good[1].measured.value == Approx(400 / (1700.0 / 3)));
  CHECK(good[1].met());
  const auto dark = judge(grid(GridRole::task, {200, 300, 700}), desk);
  CHECK_FALSE(dark[0].met());
  CHECK_FALSE(dark[1].met());
  CHECK_THAT(judgement_text(dark[0]), Contains("NOT MET") && Contains("500"));
}

TEST_CASE("walls, ceilings, cylinders and surroundings have requirements of their own") {
  const Requirement desk = parse_requirement("office-desk");
  const std::vector<float> even{200, 200};
  CHECK(judge(grid(GridRole::wall, even), desk)[0].required == 150);
  CHECK(judge(grid(GridRole::wall, even), desk)[1].required == 0.10);
  CHECK(judge(grid(GridRole::ceiling, even), desk)[0].required == 100);
  CHECK(judge(grid(GridRole::cylindrical, even), desk)[0].required == 150);
  CHECK(judge(grid(GridRole::surroundings, even), desk)[0].required == 300);
  CHECK(judge(grid(GridRole::surroundings, even), desk)[1].required == 0.40);
  CHECK(judge(grid(GridRole::other, even), desk).empty());
  CHECK(mean_of_surroundings(750) == 500);
  CHECK(mean_of_surroundings(300) == 200);
  CHECK(mean_of_surroundings(200) == 150);
  CHECK(mean_of_surroundings(100) == 100);
}

TEST_CASE("rows that no source confirms say so, and the glare of observers is judged beside them") {
  CHECK_THAT(parse_requirement("archive").reference, Contains("not confirmed"));
  const Requirement desk = parse_requirement("office-desk");
  const Measurement measurement{grid(GridRole::task, {600, 600})};
  CHECK_THAT(requirement_lines(measurement, desk)[3], Contains("see photile glare"));
  const Judgement dazzled{"desk 2", "UGR", desk.glare, {22.4, 0.1}, true};
  const auto lines = requirement_lines(measurement, desk, dazzled);
  CHECK_THAT(lines[3], Contains("desk 2: UGR 22.4, at most 19: NOT MET"));
}

TEST_CASE("within two standard errors of the limit a judgement is doubtful") {
  const Requirement own = parse_requirement("Em=500");
  CHECK(judge(grid(GridRole::task, {505, 505}, 10), own)[0].doubtful());
  CHECK_FALSE(judge(grid(GridRole::task, {540, 540}, 10), own)[0].doubtful());
  CHECK_THAT(judgement_text(judge(grid(GridRole::task, {505, 505}, 10), own)[0]),
             Contains("met, within two standard errors"));
}

TEST_CASE("requirements of one's own are values by name, and others are refused with the list") {
  const Requirement own =
      parse_requirement("Em=320,Uo=0.5,UGR=22,Ez=75,Ewall=60,Eceiling=40,Ra=90");
  CHECK(own.mean == 320);
  CHECK(own.uniformity == 0.5);
  CHECK(own.glare == 22);
  CHECK(own.cylindrical == 75);
  CHECK(own.wall == 60);
  CHECK(own.ceiling == 40);
  CHECK(own.rendering == 90);
  for (const char* text : {"desk", "Em", "Em=", "Em=-5", "Em=500,Xy=3", "Em=many"}) {
    CHECK_THROWS_WITH(parse_requirement(text), Contains(text) && Contains("office-desk"));
  }
}

TEST_CASE("each known row is complete, and its name is its own") {
  for (const Requirement& row : known_requirements()) {
    CAPTURE(row.name);
    CHECK(row.mean > 0);
    CHECK(row.uniformity >= 0.4);
    CHECK(row.glare >= 16);
    CHECK(row.wall >= row.ceiling);
    CHECK(parse_requirement(row.name).what == row.what);
  }
}

}  // namespace photile::test
