#include "device/pocl_pack.hpp"

#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace photile::device {
namespace {

namespace fs = std::filesystem;

void append_field(std::string& text, std::string_view field) {
  const std::uint64_t length = field.size();
  text.append(reinterpret_cast<const char*>(&length), sizeof length);
  text.append(field);
}

std::string_view take_field(std::string_view& text) {
  std::uint64_t length = 0;
  if (text.size() < sizeof length) throw std::runtime_error("pack ends in a length");
  std::memcpy(&length, text.data(), sizeof length);
  text.remove_prefix(sizeof length);
  if (text.size() < length) throw std::runtime_error("pack ends in a field");
  const auto field = text.substr(0, length);
  text.remove_prefix(length);
  return field;
}

bool stays_below_root(const fs::path& path) {
  if (path.empty() || path.is_absolute()) return false;
  for (const auto& part : path) {
    if (part == "..") return false;
  }
  return true;
}

std::string read_file(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(file), {}};
  if (!file.good() && !file.eof()) {
    throw fs::filesystem_error("cannot read", path, std::make_error_code(std::errc::io_error));
  }
  return text;
}

}  // namespace

PackedFiles collect_files(const fs::path& root, const std::set<std::string>& folders) {
  PackedFiles files;
  for (const auto& folder : folders) {
    for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
      const auto name = entry.path().filename().string();
      // Dates of use and leftovers of the compiler are of no use to a later run.
      const bool useful = name == "program.bc" || name == "build.log" || name.ends_with(".so");
      if (entry.is_regular_file() && useful) {
        files.emplace(fs::relative(entry.path(), root).string(), read_file(entry.path()));
      }
    }
  }
  return files;
}

void restore_files(const fs::path& root, const PackedFiles& files) {
  for (const auto& [name, text] : files) {
    const auto path = root / name;
    if (fs::exists(path)) continue;
    fs::create_directories(path.parent_path());
    std::ofstream file(path, std::ios::binary);
    file << text;
    file.close();
    if (!file) {
      // PoCL ends the process on a truncated file.
      fs::remove(path);
      throw std::runtime_error("cannot write '" + path.string() + "'");
    }
  }
}

std::string pack(const PackedFiles& files) {
  std::string text;
  for (const auto& [name, content] : files) {
    append_field(text, name);
    append_field(text, content);
  }
  return text;
}

PackedFiles unpack(std::string_view text) {
  PackedFiles files;
  while (!text.empty()) {
    const std::string name(take_field(text));
    if (!stays_below_root(name)) throw std::runtime_error("pack names '" + name + "'");
    files.emplace(name, take_field(text));
  }
  return files;
}

std::set<std::string> program_folders(const fs::path& root) {
  std::set<std::string> found;
  for (const auto& group : fs::directory_iterator(root)) {
    if (!group.is_directory()) continue;
    for (const auto& program : fs::directory_iterator(group.path())) {
      if (program.is_directory()) {
        found.insert((group.path().filename() / program.path().filename()).string());
      }
    }
  }
  return found;
}

std::set<std::string> program_folders(const PackedFiles& files) {
  std::set<std::string> found;
  for (const auto& [name, text] : files) {
    const fs::path path(name);
    auto part = path.begin();
    const auto group = *part++;
    if (part != path.end()) found.insert((group / *part).string());
  }
  return found;
}

}  // namespace photile::device
