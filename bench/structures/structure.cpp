#include "structures/structure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "device/program_source.hpp"
#include "photile/errors.hpp"

namespace photile::structures {
namespace {

/// Ascending by name.
std::vector<Structure>& registered() {
  static std::vector<Structure> structures;
  return structures;
}

const Registration grid({.name = "uniform-grid"});

/// Each photon of the map, by the kernels of grids: one cell takes as many as there are.
const Registration brute_force({.name = "brute-force", .photons_per_cell = 1e12f});

/// The library has no kernels but those it uses: these become known to it.
void register_kernels() {
  const std::filesystem::path root = std::filesystem::path(PHOTILE_SOURCE_DIR) / "kernels";
  for (const auto& record : std::filesystem::directory_iterator(root / "structures")) {
    std::ifstream file(record.path(), std::ios::binary);
    device::register_kernel_source(std::filesystem::relative(record.path(), root).string(),
                                   {std::istreambuf_iterator<char>(file), {}});
  }
}

}  // namespace

std::string Structure::kernel_file() const {
  std::string file = kernel.empty() ? name : kernel;
  std::replace(file.begin(), file.end(), '-', '_');
  return "structures/" + file + ".cl";
}

Registration::Registration(Structure structure) {
  std::vector<Structure>& all = registered();
  const auto place = std::find_if(
      all.begin(), all.end(), [&](const Structure& other) { return other.name > structure.name; });
  all.insert(place, std::move(structure));
}

std::span<const Structure> all() {
  static const bool have_kernels = (register_kernels(), true);
  static_cast<void>(have_kernels);
  return registered();
}

const Structure& named(std::string_view name) {
  std::string names;
  for (const Structure& structure : all()) {
    if (structure.name == name) return structure;
    names += (names.empty() ? "" : ", ") + structure.name;
  }
  throw UsageError(fmt::format("there is no structure '{}'; there are {}", name, names));
}

}  // namespace photile::structures
