#include "file_folder.hpp"

#include <fstream>
#include <iterator>

namespace photile::test {

std::string FileFolder::write(const std::string& name, const std::string& text) const {
  std::ofstream(path / name, std::ios::binary) << text;
  return *this / name;
}

std::string FileFolder::read(const std::string& name) const {
  std::ifstream file(path / name, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::size_t FileFolder::file_count() const {
  const auto begin = std::filesystem::directory_iterator(path);
  return static_cast<std::size_t>(std::distance(begin, {}));
}

}  // namespace photile::test
