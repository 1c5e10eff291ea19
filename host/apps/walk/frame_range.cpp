#include "walk/frame_range.hpp"

#include <charconv>

namespace photile::walk {
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
