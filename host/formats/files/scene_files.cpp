#include "files/scene_files.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

#include "common/files.hpp"
#include "photile/errors.hpp"

namespace photile::files {

namespace {

constexpr std::size_t names_listed = 5;

}  // namespace

void Warnings::add(const std::string& message) { add("", "", message); }

void Warnings::add(const std::string& kind, const std::string& name, const std::string& message) {
  const auto [known, is_new] = index_.try_emplace({kind, message}, entries_.size());
  if (is_new) entries_.push_back({kind, message, {}, {}});
  Entry& entry = entries_[known->second];
  if (entry.names.insert(name).second && entry.first_names.size() < names_listed) {
    entry.first_names.push_back(name);
  }
}

std::vector<std::string> Warnings::lines() const {
  std::vector<std::string> lines;
  for (const Entry& entry : entries_) {
    if (entry.kind.empty()) {
      lines.push_back(one_line(entry.message));
      continue;
    }
    std::string line = entry.kind;
    const std::size_t listed = entry.first_names.size();
    for (std::size_t i = 0; i < listed; ++i) {
      line += fmt::format("{} '{}'", i == 0 ? "" : ",", entry.first_names[i]);
    }
    if (entry.names.size() > listed)
      line += fmt::format(" and {} more", entry.names.size() - listed);
    lines.push_back(one_line(line + ": " + entry.message));
  }
  return lines;
}

namespace {

class FileDescriptor {
 public:
  explicit FileDescriptor(int value) : value_(value) {}
  ~FileDescriptor() {
    if (value_ >= 0) ::close(value_);
  }
  FileDescriptor(const FileDescriptor&) = delete;
  FileDescriptor& operator=(const FileDescriptor&) = delete;
  int value() const { return value_; }

 private:
  int value_;
};

[[noreturn]] void throw_system_error() {
  throw ResourceError(std::generic_category().message(errno));
}

}  // namespace

std::vector<unsigned char> read_regular_file(const std::filesystem::path& file,
                                             std::uint64_t max_bytes) {
  // Opening a named pipe for reading would wait for a writer for ever, hence O_NONBLOCK.
  const FileDescriptor descriptor(::open(file.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
  if (descriptor.value() < 0) throw_system_error();
  struct stat status {};
  if (::fstat(descriptor.value(), &status) != 0) throw_system_error();
  if (!S_ISREG(status.st_mode)) throw ResourceError("it is not a regular file");
  const auto size = static_cast<std::uint64_t>(status.st_size);
  if (size > max_bytes) {
    throw ResourceError(fmt::format("it has {} bytes; the limit is {}", size, max_bytes));
  }
  note_input(file);
  std::vector<unsigned char> bytes(size);
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t count = ::read(descriptor.value(), bytes.data() + done, bytes.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw_system_error();
    if (count == 0) throw ResourceError("the file shrank while it was read");
    done += static_cast<std::size_t>(count);
  }
  return bytes;
}

SceneFolder::SceneFolder(std::filesystem::path scene_file, bool allow_outside)
    : scene_file_(std::move(scene_file)), allow_outside_(allow_outside) {}

std::vector<unsigned char> SceneFolder::read_scene_file() const {
  try {
    std::vector<unsigned char> bytes = read_regular_file(scene_file_, limits::max_file_bytes);
    if (bytes.empty()) throw ResourceError("the file is empty");
    return bytes;
  } catch (const ResourceError& error) {
    throw InputError(fmt::format("{}: cannot read the scene: {}; give an .obj, .gltf or .glb file",
                                 scene_file_.string(), error.what()));
  }
}

std::filesystem::path SceneFolder::resolve(const std::string& name) const {
  if (name.empty()) throw ResourceError("the name is empty");
  if (name.find('\0') != std::string::npos) throw ResourceError("the name contains a NUL byte");
  if (name.find("://") != std::string::npos) {
    throw ResourceError("URLs are not fetched; save the file in the scene's folder");
  }
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::path parent = scene_file_.has_parent_path() ? scene_file_.parent_path() : fs::path(".");
  const fs::path folder = fs::canonical(parent, error);
  if (error) throw ResourceError(error.message());
  const fs::path target = fs::canonical(folder / name, error);
  const fs::path lexical = (folder / name).lexically_normal();
  const auto inside = [&](const fs::path& path) {
    return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first ==
           folder.end();
  };
  // A missing file outside must not be told from an existing one.
  if (!allow_outside_ && (!inside(lexical) || (!error && !inside(target)))) {
    throw ResourceError(
        "it lies outside the scene's folder; move it there, or give --set allow_outside=on");
  }
  if (error) throw ResourceError(error.message());
  return target;
}

bool SceneFolder::holds(const std::string& name) const {
  try {
    return std::filesystem::is_regular_file(resolve(name));
  } catch (const ResourceError&) {
    return false;
  }
}

std::vector<unsigned char> SceneFolder::read(const std::string& name, std::uint64_t most) {
  try {
    std::vector<unsigned char> bytes = read_regular_file(
        resolve(name), std::min(most, limits::max_external_bytes - external_bytes_));
    external_bytes_ += bytes.size();
    return bytes;
  } catch (const ResourceError& error) {
    std::string shown = name;
    std::replace(shown.begin(), shown.end(), '\0', '?');  // an exception's text ends there
    throw ResourceError(fmt::format("'{}': {}", shortened(shown, longest_quote), error.what()));
  }
}

}  // namespace photile::files
