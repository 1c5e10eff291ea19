// Points that a user brings: what files hold, and what is said of those that hold something else.
#include "support/point_file.hpp"

#include <catch2/catch.hpp>
#include <cstring>
#include <fstream>

#include "photile/errors.hpp"
#include "temporary_folder.hpp"

namespace photile::test {
namespace {

using bench::PointFile;
using bench::read_points;
using Catch::Contains;

std::filesystem::path written(const TemporaryFolder& folder, const std::string& name,
                              const std::string& content) {
  std::ofstream(folder.path / name, std::ios::binary) << content;
  return folder.path / name;
}

/// Writes an array as numpy.save does, by the format's description (NEP 1).
template <class Number>
std::string npy(const std::string& type, const std::string& order, const std::string& shape,
                const std::vector<Number>& numbers) {
  std::string header =
      "{'descr': '" + type + "', 'fortran_order': " + order + ", 'shape': " + shape + ", }";
  header.append(63 - (10 + header.size()) % 64, ' ');
  header += '\n';
  std::string content("\x93NUMPY\x01\x00", 8);
  content += static_cast<char>(header.size() % 256);
  content += static_cast<char>(header.size() / 256);
  content += header;
  content.append(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(Number));
  return content;
}

}  // namespace

TEST_CASE(
    "points of text and of both widths of NumPy's floats are read, with normals and without") {
  const TemporaryFolder folder;
  const PointFile text =
      read_points(written(folder, "a.csv", "x,y,z\n# a comment\n1, 2.5,-3e-2\n\n4;5;6\r\n7\t8 9"));
  CHECK(text.position == std::vector<glm::vec3>{{1, 2.5f, -0.03f}, {4, 5, 6}, {7, 8, 9}});
  CHECK(text.normal.empty());
  const PointFile single = read_points(
      written(folder, "a.npy", npy<float>("<f4", "False", "(2, 3)", {1, 2, 3, 0.1f, 0.2f, 0.3f})));
  CHECK(single.position == std::vector<glm::vec3>{{1, 2, 3}, {0.1f, 0.2f, 0.3f}});
  const PointFile twice = read_points(
      written(folder, "b.npy", npy<double>("<f8", "False", "(1, 6)", {1, 2, 3, 0, 0, -2})));
  CHECK(twice.position == std::vector<glm::vec3>{{1, 2, 3}});
  CHECK(twice.normal == std::vector<glm::vec3>{{0, 0, -1}});
}

TEST_CASE("files that hold no points are refused with what was found there") {
  const TemporaryFolder folder;
  const auto [name, content, message] = GENERATE(table<std::string, std::string, std::string>({
      {"a.csv", "", "holds no point"},
      {"a.csv", "x,y,z\n", "holds no point"},
      {"a.csv", "1,2,3\n1,2\n", "line 2 has 2 numbers"},
      {"a.csv", "1,2,3\nnone\n", "line 2: 'none'"},
      {"a.csv", "1,2,3\n1,2,3,0,0,1\n", "line 2 has 6 numbers, those before had 3"},
      {"a.csv", "1,2,inf\n", "line 1 has a number that is not finite"},
      {"a.csv", "1,2,3,0,0,0\n", "line 1 has a normal of no length"},
      {"a.txt", "1,2,3\n", "neither .npy nor .csv"},
      {"a.npy", "1,2,3\n", "is no NumPy array"},
      {"a.npy", npy<float>("<f4", "True", "(1, 3)", {1, 2, 3}), "columns one after the other"},
      {"a.npy", npy<int>("<i4", "False", "(1, 3)", {1, 2, 3}), "elements of type"},
      {"a.npy", npy<float>("<f4", "False", "(3,)", {1, 2, 3}), "has the shape"},
      {"a.npy", npy<float>("<f4", "False", "(1, 4)", {1, 2, 3, 4}), "has the shape"},
      {"a.npy", npy<float>("<f4", "False", "(2, 3)", {1, 2, 3}), "12 bytes for 2 rows"},
      {"a.npy", npy<float>("<f4", "False", "(0, 3)", {}), "holds no point"},
      {"a.npy", std::string("\x93NUMPY\x01\x00\xff\xff{'descr'", 18), "within its header"},
  }));
  CAPTURE(name, message);
  const auto file = written(folder, name, content);
  CHECK_THROWS_WITH(read_points(file), Contains(file.string()) && Contains(message));
  CHECK_THROWS_WITH(read_points(folder.path / "missing.npy"), Contains("no such file"));
}

}  // namespace photile::test
