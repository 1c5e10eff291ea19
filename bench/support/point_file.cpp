#include "support/point_file.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>

#include "common/files.hpp"
#include "photile/errors.hpp"

namespace photile::bench {
namespace {

using std::filesystem::path;

/// Points from rows of numbers.
class Points {
 public:
  explicit Points(const path& file) : file_(file) {}

  /// Errors: InputError, which calls the row `place`.
  void add(const std::vector<double>& row, const std::string& place) {
    if (row.size() != 3 && row.size() != 6) {
      throw InputError(fmt::format("{}: {} has {} numbers; a point has 3, or 6 with its normal",
                                   file_.string(), place, row.size()));
    }
    for (const double number : row) {
      if (!std::isfinite(number)) {
        throw InputError(
            fmt::format("{}: {} has a number that is not finite", file_.string(), place));
      }
    }
    if (!points_.position.empty() && (row.size() == 6) != !points_.normal.empty()) {
      throw InputError(fmt::format("{}: {} has {} numbers, those before had {}", file_.string(),
                                   place, row.size(), row.size() == 6 ? 3 : 6));
    }
    points_.position.emplace_back(row[0], row[1], row[2]);
    if (row.size() == 3) return;
    const glm::dvec3 normal(row[3], row[4], row[5]);
    if (!(glm::length(normal) > 0)) {
      throw InputError(fmt::format("{}: {} has a normal of no length", file_.string(), place));
    }
    points_.normal.emplace_back(glm::normalize(normal));
  }

  PointFile take() {
    if (points_.position.empty()) throw InputError(file_.string() + ": holds no point");
    return std::move(points_);
  }

 private:
  const path& file_;
  PointFile points_;
};

/// The numbers of a line, or nothing where something else stands in it.
std::optional<std::vector<double>> numbers_in(std::string_view line) {
  constexpr std::string_view separators = " \t,;\r";
  std::vector<double> numbers;
  for (;;) {
    const std::size_t begin = line.find_first_not_of(separators);
    if (begin == std::string_view::npos) return numbers;
    const std::size_t end = std::min(line.find_first_of(separators, begin), line.size());
    double number = 0;
    const auto [rest, error] = std::from_chars(line.data() + begin, line.data() + end, number);
    if (error != std::errc() || rest != line.data() + end) return std::nullopt;
    numbers.push_back(number);
    line.remove_prefix(end);
  }
}

PointFile read_csv(const path& file) {
  std::ifstream stream(file);
  Points points(file);
  std::string line;
  for (std::size_t number = 1; std::getline(stream, line); ++number) {
    if (line.starts_with('#')) continue;
    const auto row = numbers_in(line);
    if (row && row->empty()) continue;
    if (!row && number == 1) continue;  // names of columns
    if (!row) {
      throw InputError(fmt::format("{}: line {}: '{}' is no list of numbers", file.string(), number,
                                   line.substr(0, 60)));
    }
    points.add(*row, fmt::format("line {}", number));
  }
  return points.take();
}

/// What stands behind a key of the header's dictionary, up to the next comma outside of brackets.
std::string_view entry(std::string_view header, std::string_view key) {
  const std::size_t found = header.find(key);
  if (found == std::string_view::npos) return {};
  header.remove_prefix(found + key.size());
  const std::size_t end = header.find(header.find('(') < header.find(',') ? ')' : ',');
  return header.substr(0, end);
}

/// The two sizes of "(rows, columns"; nothing for other shapes.
std::optional<std::pair<std::size_t, std::size_t>> shape_of(std::string_view text) {
  const std::size_t open = text.find('(');
  if (open == std::string_view::npos) return std::nullopt;
  const auto sizes = numbers_in(text.substr(open + 1));
  if (!sizes || sizes->size() != 2) return std::nullopt;
  return std::pair(static_cast<std::size_t>((*sizes)[0]), static_cast<std::size_t>((*sizes)[1]));
}

/// The format of NEP 1, "A Simple File Format for NumPy Arrays".
PointFile read_npy(const path& file) {
  std::ifstream stream(file, std::ios::binary);
  const std::string content{std::istreambuf_iterator<char>(stream), {}};
  const auto refuse = [&](const std::string& what) -> InputError {
    return InputError(
        fmt::format("{}: {}; give an array of n x 3 or n x 6 floats, saved by "
                    "numpy.save",
                    file.string(), what));
  };
  if (!content.starts_with("\x93NUMPY") || content.size() < 12) throw refuse("is no NumPy array");
  const auto byte = [&](std::size_t i) {
    return static_cast<std::size_t>(static_cast<unsigned char>(content[i]));
  };
  const bool long_header = byte(6) > 1;
  std::size_t header_size = byte(8) | byte(9) << 8;
  if (long_header) header_size |= byte(10) << 16 | byte(11) << 24;
  const std::size_t begin = long_header ? 12 : 10;
  if (begin + header_size > content.size()) throw refuse("ends within its header");
  const std::string_view header = std::string_view(content).substr(begin, header_size);
  const std::string_view type = entry(header, "'descr':");
  const bool single = type.find("<f4") != std::string_view::npos;
  if (!single && type.find("<f8") == std::string_view::npos) {
    throw refuse(fmt::format("holds elements of type{}", type));
  }
  if (entry(header, "'fortran_order':").find("True") != std::string_view::npos) {
    throw refuse("holds columns one after the other");
  }
  const auto shape = shape_of(entry(header, "'shape':"));
  if (!shape || (shape->second != 3 && shape->second != 6)) {
    throw refuse(fmt::format("has the shape{})", entry(header, "'shape':")));
  }
  const auto [rows, columns] = *shape;
  const std::string_view data = std::string_view(content).substr(begin + header_size);
  const std::size_t element = single ? 4 : 8;
  if (data.size() / element / columns != rows || data.size() != rows * columns * element) {
    throw refuse(fmt::format("has {} bytes for {} rows of {}", data.size(), rows, columns));
  }
  const auto number = [&](std::size_t i) {
    float narrow = 0;
    double wide = 0;
    if (single) {
      std::memcpy(&narrow, data.data() + 4 * i, 4);
      return static_cast<double>(narrow);
    }
    std::memcpy(&wide, data.data() + 8 * i, 8);
    return wide;
  };
  Points points(file);
  std::vector<double> row(columns);
  for (std::size_t i = 0; i < rows; ++i) {
    for (std::size_t j = 0; j < columns; ++j) row[j] = number(i * columns + j);
    points.add(row, fmt::format("row {}", i));
  }
  return points.take();
}

}  // namespace

PointFile read_points(const path& file) {
  const std::string problem = why_no_regular_file(file);
  if (!problem.empty()) throw InputError(file.string() + ": " + problem);
  if (file.extension() == ".npy") return read_npy(file);
  if (file.extension() == ".csv") return read_csv(file);
  throw InputError(fmt::format("{}: the ending says neither .npy nor .csv", file.string()));
}

}  // namespace photile::bench
