// Luminous openings of photometric files, against the outlines of the bodies that they describe,
// and the editions of LM-63 that describe them.
#include <catch2/catch.hpp>
#include <cmath>
#include <glm/glm.hpp>
#include <numbers>

#include "files/scene_files.hpp"
#include "photometric_texts.hpp"
#include "photometry/photometric_file.hpp"

namespace photile::test {
namespace {

using std::numbers::pi;

/// Half of what the parts of a closed convex surface cover, as seen from far away. `place` maps the
/// unit square onto it.
double outline(const std::function<glm::dvec3(double, double)>& place, const glm::dvec3& d) {
  constexpr int steps = 256;
  double sum = 0;
  for (int i = 0; i < steps; ++i) {
    for (int j = 0; j < steps; ++j) {
      const auto corner = [&](int a, int b) {
        return place((i + a) / double(steps), (j + b) / double(steps));
      };
      sum += 0.5 * std::abs(glm::dot(
                       d, glm::cross(corner(1, 1) - corner(0, 0), corner(0, 1) - corner(1, 0))));
    }
  }
  return 0.5 * sum;
}

/// m2 of bodies, by the sizes of the boxes around them.
using Body = std::function<double(const glm::dvec3& size, const glm::dvec3& d)>;

double box(const glm::dvec3& size, const glm::dvec3& d) {
  return size.y * size.z * std::abs(d.x) + size.x * size.z * std::abs(d.y) +
         size.x * size.y * std::abs(d.z);
}

double ellipsoid(const glm::dvec3& size, const glm::dvec3& d) {
  return outline(
      [&](double u, double v) {
        const double polar = pi * u, azimuth = 2 * pi * v;
        return 0.5 * size *
               glm::dvec3(std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth),
                          std::cos(polar));
      },
      d);
}

/// Its side, and its two ends.
template <int axis>
double cylinder(const glm::dvec3& size, const glm::dvec3& d) {
  constexpr int first = (axis + 1) % 3, second = (axis + 2) % 3;
  const double side = outline(
      [&](double u, double v) {
        glm::dvec3 place(0.0);
        place[axis] = size[axis] * (u - 0.5);
        place[first] = 0.5 * size[first] * std::cos(2 * pi * v);
        place[second] = 0.5 * size[second] * std::sin(2 * pi * v);
        return place;
      },
      d);
  return side + 0.25 * pi * size[first] * size[second] * std::abs(d[axis]);
}
const Body along_x = cylinder<0>, along_y = cylinder<1>, upright = cylinder<2>;

std::vector<glm::dvec3> directions() {
  std::vector<glm::dvec3> all{{0, 0, -1}, {1, 0, 0}, {0, 1, 0}};
  for (const auto& d : {glm::dvec3(1, 2, -3), {-2, 1, -1}, {3, -1, 2}, {-1, -2, 0.1}}) {
    all.push_back(glm::normalize(d));
  }
  return all;
}

IntensityDistribution read(const IesText& file) {
  files::Warnings warnings;
  return photometry::read_ies("lamp.ies", file.str(), warnings);
}

/// The body of an opening, its size along x (azimuth 0, the length), y (the width) and z.
struct Opening {
  const char* edition;
  const char* text;  ///< width, length, height
  Body body;
  glm::dvec3 size;
};

void check(const IntensityDistribution& lamp, const Opening& opening) {
  for (const glm::dvec3& d : directions()) {
    CAPTURE(opening.edition, opening.text, d.x, d.y, d.z);
    CHECK(lamp.opening().projected_area(d) ==
          Approx(opening.body(opening.size, d)).epsilon(1e-3).margin(1e-9));
  }
}

const std::string first = "", in_1991 = "IESNA91\n", in_1995 = "IESNA:LM-63-1995\n",
                  in_2002 = "IESNA:LM-63-2002\n", in_2019 = "IES:LM-63-2019\n";

}  // namespace

TEST_CASE("an opening of LM-63 has the outline of its body, in every edition", "[ies]") {
  const auto of = [](const std::vector<std::string>& editions, const std::vector<Opening>& rows) {
    for (const std::string& edition : editions) {
      for (Opening row : rows) {
        row.edition = edition.c_str();
        IesText file;
        file.first_line = edition;
        file.opening = row.text;
        check(read(file), row);
      }
    }
  };
  const auto point = [](const glm::dvec3&, const glm::dvec3&) { return 0.0; };
  of({first, in_1991, in_1995, in_2002, in_2019}, {{"", "0 0 0", point, {}},
                                                   {"", "0.3 1.2 0", box, {1.2, 0.3, 0}},
                                                   {"", "0.3 1.2 0.1", box, {1.2, 0.3, 0.1}},
                                                   {"", "0.3 0 0.2", box, {0, 0.3, 0.2}},
                                                   {"", "0 0.3 0.2", box, {0.3, 0, 0.2}},
                                                   {"", "-0.2 0 0", upright, {0.2, 0.2, 0}},
                                                   {"", "-0.2 0 0.5", upright, {0.2, 0.2, 0.5}},
                                                   {"", "-0.2 0.6 0", upright, {0.6, 0.2, 0}},
                                                   {"", "-0.2 -0.2 0", upright, {0.2, 0.2, 0}}});
  of({first, in_1991}, {{"", "-0.2 0.6 0.4", ellipsoid, {0.6, 0.2, 0.4}}});
  of({in_1995}, {{"", "-0.3 0 -0.3", ellipsoid, {0.3, 0.3, 0.3}},
                 {"", "0 1.2 -0.1", along_x, {1.2, 0.1, 0.1}},
                 {"", "1.2 0 -0.1", along_y, {0.1, 1.2, 0.1}},
                 {"", "-0.2 0.6 0.4", upright, {0.6, 0.2, 0.4}},
                 {"", "0.6 -0.2 0.4", upright, {0.2, 0.6, 0.4}},
                 {"", "-0.2 0.6 -0.4", ellipsoid, {0.6, 0.2, 0.4}},
                 {"", "0.6 -0.2 -0.4", ellipsoid, {0.2, 0.6, 0.4}}});
  of({in_2002, in_2019}, {{"", "-0.2 -0.6 0", upright, {0.6, 0.2, 0}},
                          {"", "-0.2 -0.2 0.5", upright, {0.2, 0.2, 0.5}},
                          {"", "-0.2 -0.6 0.5", upright, {0.6, 0.2, 0.5}},
                          {"", "-0.3 -0.3 -0.3", ellipsoid, {0.3, 0.3, 0.3}},
                          {"", "-0.2 -0.6 -0.4", ellipsoid, {0.6, 0.2, 0.4}},
                          {"", "-0.1 1.2 -0.1", along_x, {1.2, 0.1, 0.1}},
                          {"", "-0.2 1.2 -0.1", along_x, {1.2, 0.2, 0.1}},
                          {"", "1.2 -0.1 -0.1", along_y, {0.1, 1.2, 0.1}},
                          {"", "1.2 -0.2 -0.1", along_y, {0.2, 1.2, 0.1}},
                          {"", "-0.3 0 -0.3", along_x, {0, 0.3, 0.3}},
                          {"", "-0.3 0 -0.4", along_x, {0, 0.3, 0.4}},
                          // as in 1995
                          {"", "0 1.2 -0.1", along_x, {1.2, 0.1, 0.1}}});
}

TEST_CASE("openings are in feet where the file says so", "[ies]") {
  IesText file;
  file.units = 1;
  file.opening = "0.3 1.2 0.1";
  check(read(file), {"feet", "0.3 1.2 0.1", box, 0.3048 * glm::dvec3(1.2, 0.3, 0.1)});
}

TEST_CASE("types A and B have openings, too, around the direction that they are aimed in",
          "[ies]") {
  IesText file;
  file.vertical = file.horizontal = angles(-90, 90, 2);
  const auto rows = [&](int type, const std::vector<Opening>& openings) {
    file.type = type;
    for (const Opening& opening : openings) {
      file.opening = opening.text;
      check(read(file), opening);
    }
  };
  // The horizontal of B is what lies above the aim, its zero the aim, as of C.
  rows(2, {{"B", "0.3 0.6 0", box, {0.6, 0.3, 0}},
           {"B", "0.3 0.6 0.1", box, {0.6, 0.3, 0.1}},
           {"B", "-0.3 -0.3 0", upright, {0.3, 0.3, 0}},
           {"B", "-0.1 1.2 -0.1", along_x, {1.2, 0.1, 0.1}}});
  // The horizontal of A is the aim; its height is vertical.
  rows(3, {{"A", "0.3 0 0.6", box, {0.6, 0.3, 0}},
           {"A", "0.3 0.1 0.6", box, {0.6, 0.3, 0.1}},
           {"A", "-0.3 0 -0.3", upright, {0.3, 0.3, 0}},
           {"A", "-0.1 1.2 -0.1", upright, {0.1, 0.1, 1.2}},
           {"A", "-0.1 -0.1 1.2", along_x, {1.2, 0.1, 0.1}},
           {"A", "1.2 -0.1 -0.1", along_y, {0.1, 1.2, 0.1}},
           {"A", "0.3 0.6 0", box, {0.6, 0.3, 0}}});
}

TEST_CASE(
    "openings of EULUMDAT are millimetres: length along C90, width 0 of round ones, a height "
    "for each side") {
  const auto read = [](const EulumdatText& file) {
    files::Warnings warnings;
    return photometry::read_eulumdat("lamp.ldt", file.str(), warnings);
  };
  EulumdatText file;
  file.sizes = {1300, 400, 80, 1200, 300, 40, 40, 40, 40};
  check(read(file), {"LDT", "", box, {0.3, 1.2, 0.04}});
  file.sizes = {250, 0, 80, 200, 0, 30, 30, 30, 30};
  check(read(file), {"LDT", "", upright, {0.2, 0.2, 0.03}});
  // Heights towards C0, C90, C180 and C270: each seen from its own side.
  for (const double width : {300.0, 0.0}) {
    file.sizes = {1300, 400, 80, 1200, width, 10, 20, 30, 40};
    const LuminousOpening opening = read(file).opening();
    const double across = width > 0 ? 0.3 : 1.2;
    CHECK(opening.projected_area({1, 0, 0}) == Approx(1.2 * 0.01));
    CHECK(opening.projected_area({0, 1, 0}) == Approx(across * 0.02));
    CHECK(opening.projected_area({-1, 0, 0}) == Approx(1.2 * 0.03));
    CHECK(opening.projected_area({0, -1, 0}) == Approx(across * 0.04));
  }
  CHECK_FALSE(read(EulumdatText{}).opening().stated());
}

TEST_CASE("the ballast-lamp factor counts in files before 1995, however later ones spell it",
          "[ies]") {
  IesText file;
  file.ballast = "1 1.10000 60";  // in 2019: a test at an accredited laboratory
  const auto& [head, factor, warned] = GENERATE(table<std::string, double, bool>({
      {"", 1.1, true},
      {"A lamp of long ago\n", 1.1, true},
      {"IES:LM-63-1986\n", 1.1, true},
      {"IESNA91\n", 1.1, false},
      {"iesna91 \n", 1.1, false},
      {"IESNA:LM-63-1991\n", 1.1, false},
      {"IESNA:LM-63-1995\n", 1, false},
      {"IESNA:LM-63-2002\n", 1, false},
      {"IES:LM-63-2019\n", 1, false},
      {"IES: LM-63-2019\n", 1, false},
      {" ies:lm-63-2019 \r\n", 1, false},
      {"\nIES:LM-63-2019\n", 1, false},
      {"\xEF\xBB\xBFIES:LM-63-2019\n", 1, false},
      {"IES LM 63 - 19\n", 1, false},
      {"ANSI/IES LM-63-02 (R2008)\n", 1, false},
      {"IESNA-LM63-95\n", 1, false},
      {"IESNA:LM-63\n", 1, false},
      {"[MANUFAC] maker\nIESNA:LM-63-2002\n", 1, false},
      {"[TEST] by IES LM-63-2019\n", 1.1, true},  // a keyword names no format
  }));
  CAPTURE(head);
  file.first_line = head;
  files::Warnings warnings;
  const auto lamp = photometry::read_ies("lamp.ies", file.str(), warnings);
  CHECK(lamp.intensity({0, 0, -1}) == Approx(100 * factor));
  CHECK(warnings.lines().empty() != warned);
}

}  // namespace photile::test
