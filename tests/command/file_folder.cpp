#include "file_folder.hpp"

#include "file_bytes.hpp"

namespace photile::test {

std::string FileFolder::write(const std::string& name, const std::string& text) const {
  put(path / name, text);
  return *this / name;
}

std::string FileFolder::read(const std::string& name) const { return bytes_of(path / name); }

std::size_t FileFolder::file_count() const {
  const auto begin = std::filesystem::directory_iterator(path);
  return static_cast<std::size_t>(std::distance(begin, {}));
}

}  // namespace photile::test
