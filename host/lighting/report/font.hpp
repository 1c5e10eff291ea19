// Letters of an installed font, drawn by FreeType.
#pragma once

#include <functional>
#include <memory>
#include <string>

namespace photile::report {

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

}  // namespace photile::report
