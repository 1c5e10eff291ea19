#include "walk/frame_names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <string_view>

#include "photile/errors.hpp"

namespace photile::walk {

namespace {

/// Of a number in a name.
struct Place {
  std::size_t length = 0;  ///< 0: none is there
  int width = 1;
  char fill = '0';
};

/// The place that a text begins with. Not by std::regex, whose stack grows with the text.
Place place_at(std::string_view text) {
  const std::size_t hashes = std::min(text.find_first_not_of('#'), text.size());
  if (hashes > 0) return {hashes, static_cast<int>(hashes), '0'};
  if (!text.starts_with('%')) return {};
  Place place{1, 1, ' '};
  if (text.substr(place.length).starts_with('0')) {
    place.fill = '0';
    ++place.length;
  }
  if (place.length < text.size() && text[place.length] >= '1' && text[place.length] <= '9') {
    place.width = text[place.length] - '0';
    ++place.length;
  }
  if (!text.substr(place.length).starts_with('d')) return {};
  ++place.length;
  return place;
}

}  // namespace

FrameNames::FrameNames(const std::string& pattern) {
  // Only the name: a folder may be called C#.
  const std::string name = std::filesystem::path(pattern).filename().string();
  const std::string folder = pattern.substr(0, pattern.size() - name.size());
  int places = 0;
  for (std::size_t begin = 0; begin < name.size();) {
    const Place place = place_at(std::string_view(name).substr(begin));
    if (place.length > 0) {
      ++places;
      before_ = folder + name.substr(0, begin);
      after_ = name.substr(begin + place.length);
      width_ = place.width;
      fill_ = place.fill;
    }
    begin += std::max<std::size_t>(place.length, 1);
  }
  const bool meant_one =
      name.find('%') != std::string::npos || folder.find("##") != std::string::npos;
  if (places > 1 || (places == 0 && meant_one)) {
    throw UsageError(
        fmt::format("{}: needs one place for the number of a frame, #### or %04d", pattern));
  }
  if (places == 0) {
    const std::filesystem::path path(name);
    before_ = folder + path.stem().string() + ".";
    after_ = path.extension().string();
    width_ = 4;
    fill_ = '0';
  }
}

std::filesystem::path FrameNames::of(int frame) const {
  const std::string digits = std::to_string(frame);
  const auto width = static_cast<std::size_t>(width_);
  const std::string padding(digits.size() < width ? width - digits.size() : 0, fill_);
  return before_ + padding + digits + after_;
}

namespace {

/// Takes a number of digits alone off the front.
std::optional<int> take_number(std::string_view& text) {
  int value = 0;
  if (text.empty() || text.front() == '-') return std::nullopt;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc()) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return value;
}

}  // namespace

std::optional<FrameRange> parse_frame_range(std::string_view text) {
  const auto number_after = [&](char sign, int otherwise) -> std::optional<int> {
    if (text.empty() || text.front() != sign) return otherwise;
    text.remove_prefix(1);
    return take_number(text);
  };
  const auto first = take_number(text);
  if (!first) return std::nullopt;
  const auto last = number_after('-', *first);
  const auto step = number_after('x', 1);
  if (!last || !step || !text.empty() || *last < *first || *step < 1) return std::nullopt;
  return FrameRange{*first, *last, *step};
}

}  // namespace photile::walk
