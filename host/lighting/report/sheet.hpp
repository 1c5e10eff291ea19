// A sheet of paper on which pictures, legends and words are put together.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "photile/image.hpp"

namespace photile::report {

/// Letters of an installed font, drawn by FreeType.
class Font {
 public:
  /// DejaVu Sans, of which a process keeps one size: pixels. Without it nothing is drawn.
  static Font& dejavu(int size);

  ~Font();
  Font(const Font&) = delete;
  Font& operator=(const Font&) = delete;

  /// Calls pixel(x, y, ink) for each pixel with ink, in (0, 1], of UTF-8 text; (0, 0) is the left
  /// end of the baseline.
  void draw(const std::string& text, const std::function<void(int, int, float)>& pixel);

  /// Pixels from the first to the last column with ink; 0 without ink.
  int width_of(const std::string& text);

 private:
  explicit Font(int size);

  struct Face;
  std::unique_ptr<Face> face_;  ///< null without the font
};

/// Pixels between the parts of a sheet, of its title, and of the bar of a legend.
inline constexpr int gap = 12, title_height = 24, bar_width = 20;

/// White, of display-referred linear values. Positions are pixels from its top left corner.
class Sheet {
 public:
  static constexpr int font_size = 14;  ///< pixels

  Sheet(int width, int height);

  void set(int x, int y, const std::array<float, 3>& linear);
  void set(int x, int y, const std::array<std::uint8_t, 3>& srgb);

  /// Black text from x to `end` at most, its baseline at y. Nothing without the font.
  void write(int x, int y, int end, const std::string& text);

  /// Pixels that a text is wide; 0 without the font.
  static int width_of(const std::string& text);
  /// Whether the font, DejaVu Sans, is installed.
  static bool has_font() { return width_of("0") > 0; }

  /// The sheet's R, G, B, as write_png takes them; leaves it empty.
  Image take();

 private:
  std::size_t index(int x, int y) const;

  Image image_;
};

}  // namespace photile::report
