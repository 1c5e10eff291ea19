#include "walk/frames.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "photile/defaults.hpp"
#include "photile/errors.hpp"
#include "photile/limits.hpp"
#include "report/sheet.hpp"

namespace photile::walk {

namespace {

/// The position of a number in a name.
struct Placeholder {
  std::size_t length = 0;  ///< 0: none is there
  int width = 1;
  char fill = '0';
};

/// The position that a text begins with. Not by std::regex, whose stack grows with the text.
Placeholder placeholder_at(std::string_view text) {
  const std::size_t hashes = std::min(text.find_first_not_of('#'), text.size());
  if (hashes > 0) return {hashes, static_cast<int>(hashes), '0'};
  if (!text.starts_with('%')) return {};
  Placeholder found{1, 1, ' '};
  if (text.substr(found.length).starts_with('0')) {
    found.fill = '0';
    ++found.length;
  }
  if (found.length < text.size() && text[found.length] >= '1' && text[found.length] <= '9') {
    found.width = text[found.length] - '0';
    ++found.length;
  }
  if (!text.substr(found.length).starts_with('d')) return {};
  ++found.length;
  return found;
}

}  // namespace

FrameNames::FrameNames(const std::string& pattern) {
  // Only in the file's name: a folder may be called C#.
  const std::string name = std::filesystem::path(pattern).filename().string();
  const std::string folder = pattern.substr(0, pattern.size() - name.size());
  int placeholders = 0;
  for (std::size_t begin = 0; begin < name.size();) {
    const Placeholder found = placeholder_at(std::string_view(name).substr(begin));
    if (found.length > 0) {
      ++placeholders;
      before_ = folder + name.substr(0, begin);
      after_ = name.substr(begin + found.length);
      width_ = found.width;
      fill_ = found.fill;
    }
    begin += std::max<std::size_t>(found.length, 1);
  }
  const bool meant_one =
      name.find('%') != std::string::npos || folder.find("##") != std::string::npos;
  if (placeholders > 1 || (placeholders == 0 && meant_one)) {
    throw UsageError(
        fmt::format("{}: needs one field for the frame number, #### or %04d", pattern));
  }
  if (placeholders == 0) {
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

namespace {

constexpr int gap = 4;          ///< pixels
constexpr float paper = 0.05f;  ///< linear grey

/// Means of a plane over pixels [x0, x1) x [y0, y1).
float mean(const std::vector<float>& plane, int width, int x0, int x1, int y0, int y1) {
  double sum = 0;
  for (int y = y0; y < y1; ++y) {
    for (int x = x0; x < x1; ++x) {
      sum +=
          static_cast<double>(plane[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                                    static_cast<std::size_t>(x)]);
    }
  }
  return static_cast<float>(sum / ((x1 - x0) * (y1 - y0)));
}

}  // namespace

int place_on_sheet(int frame, int count, int most) {
  if (count <= most) return frame;
  const auto index = static_cast<int>(std::int64_t{frame} * most / count);
  const bool first = frame == 0 || std::int64_t{frame - 1} * most / count < index;
  return first ? index : -1;
}

ContactSheet::ContactSheet(int frames, int width, int height)
    : columns_(static_cast<int>(std::ceil(std::sqrt(frames)))) {
  const int rows = (frames + columns_ - 1) / columns_;
  const int most = limits::max_image_side / std::max(columns_, rows) - gap;
  width_ = std::clamp(std::min(width, defaults::contact_sheet_width), 1, std::max(1, most));
  height_ = std::clamp(static_cast<int>(std::lround(double(width_) * height / width)), 1,
                       std::max(1, most));
  image_.width = columns_ * (width_ + gap) + gap;
  image_.height = rows * (height_ + gap) + gap;
  for (const char* channel : {"R", "G", "B"}) image_.add(channel).assign(image_.pixels(), paper);
}

void ContactSheet::add(int index, const Image& displayed, const std::string& name) {
  const int left = gap + index % columns_ * (width_ + gap);
  const int top = gap + index / columns_ * (height_ + gap);
  for (std::size_t channel = 0; channel < 3; ++channel) {
    const std::vector<float>& plane = displayed.channels[channel];
    for (int y = 0; y < height_; ++y) {
      const int y0 = y * displayed.height / height_;
      const int y1 = std::max(y0 + 1, (y + 1) * displayed.height / height_);
      for (int x = 0; x < width_; ++x) {
        const int x0 = x * displayed.width / width_;
        const int x1 = std::max(x0 + 1, (x + 1) * displayed.width / width_);
        image_.channels[channel]
                       [static_cast<std::size_t>(top + y) * static_cast<std::size_t>(image_.width) +
                        static_cast<std::size_t>(left + x)] =
            mean(plane, displayed.width, x0, x1, y0, y1);
      }
    }
  }
  if (!name.empty()) write(left, top + height_, name);
}

void ContactSheet::write(int left, int bottom, const std::string& name) {
  constexpr int margin = 6, line = report::Sheet::font_size + 2 * margin;
  report::Font& font = report::Font::dejavu(report::Sheet::font_size);
  const int end = std::min(font.width_of(name) + 2 * margin, width_);
  const auto at = [&](int x, int y) {
    return static_cast<std::size_t>(bottom + y) * static_cast<std::size_t>(image_.width) +
           static_cast<std::size_t>(left + x);
  };
  for (std::vector<float>& plane : image_.channels) {
    for (int y = -std::min(line, height_); y < 0; ++y) {
      for (int x = 0; x < end; ++x) plane[at(x, y)] *= 0.2f;  // white letters show on it
    }
    font.draw(name, [&](int x, int y, float ink) {
      x += margin;
      y -= margin + 3;  // what hangs below the line
      if (x < 0 || x >= end || y < -height_ || y >= 0) return;
      float& value = plane[at(x, y)];
      value += ink * (1 - value);
    });
  }
}

}  // namespace photile::walk
