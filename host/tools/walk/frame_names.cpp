#include "tools/walk/frame_names.hpp"

#include <fmt/format.h>

#include <regex>

#include "photile/errors.hpp"

namespace photile::walk {

FrameNames::FrameNames(const std::string& pattern) {
  // Only the name: a folder may be called C#.
  const std::string name = std::filesystem::path(pattern).filename().string();
  const std::string folder = pattern.substr(0, pattern.size() - name.size());
  static const std::regex place("#+|%(0?)([1-9]?)d");
  const std::sregex_iterator first(name.begin(), name.end(), place), none;
  if (first == none || std::next(first) != none) {
    throw UsageError(
        fmt::format("{}: needs one place for the number of a frame, #### or %04d", pattern));
  }
  const std::smatch& found = *first;
  const bool hashes = found.str().front() == '#';
  before_ = folder + found.prefix().str();
  after_ = found.suffix().str();
  fill_ = hashes || found[1].length() > 0 ? '0' : ' ';
  width_ = hashes ? static_cast<int>(found.length())
                  : (found[2].length() > 0 ? std::stoi(found[2].str()) : 1);
}

std::filesystem::path FrameNames::of(int frame) const {
  const std::string digits = std::to_string(frame);
  const auto width = static_cast<std::size_t>(width_);
  const std::string padding(digits.size() < width ? width - digits.size() : 0, fill_);
  return before_ + padding + digits + after_;
}

}  // namespace photile::walk
