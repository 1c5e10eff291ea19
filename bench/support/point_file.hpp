// Points that a user brings, as NumPy arrays or as text.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <vector>

namespace photile::bench {

struct PointFile {
  std::vector<glm::vec3> position;  ///< metres
  std::vector<glm::vec3> normal;    ///< unit; empty where the file has three columns
};

/// Reads points of three columns (x, y, z) or six (and a normal, which is made a unit one).
///   .npy   a two-dimensional array of 4- or 8-byte little-endian floats, rows together
///   .csv   a line a point; commas, semicolons or blanks between numbers; empty lines, those that
///          begin with # and a first line of names are skipped
/// Errors: InputError that names the file, the line or row and what was found there, also of files
/// without a point and of other endings.
PointFile read_points(const std::filesystem::path& file);

}  // namespace photile::bench
