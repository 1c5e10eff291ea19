#include "report/font.hpp"

#include <ft2build.h>
#include FT_FREETYPE_H

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <mutex>
#include <optional>
#include <vector>

namespace photile::report {
namespace {

namespace fs = std::filesystem;

/// The file of that name below the folders in which fonts are kept.
std::optional<fs::path> find_font(const char* file) {
  std::vector<fs::path> folders{"/usr/share/fonts", "/usr/local/share/fonts"};
  if (const char* home = std::getenv("HOME")) {
    folders.push_back(fs::path(home) / ".local/share/fonts");
    folders.push_back(fs::path(home) / ".fonts");
  }
  for (const fs::path& folder : folders) {
    std::error_code error;
    const auto options = fs::directory_options::skip_permission_denied;
    for (fs::recursive_directory_iterator i(folder, options, error), end; !error && i != end;
         i.increment(error)) {
      if (i->path().filename() == file) return i->path();
    }
  }
  return std::nullopt;
}

/// The code points of UTF-8; bytes that are none stand for themselves.
std::vector<std::uint32_t> code_points(const std::string& text) {
  std::vector<std::uint32_t> result;
  for (std::size_t i = 0; i < text.size();) {
    const auto first = static_cast<unsigned char>(text[i++]);
    const int more = first >= 0xF0 ? 3 : first >= 0xE0 ? 2 : first >= 0xC0 ? 1 : 0;
    std::uint32_t point = more == 0 ? first : first & (0x3Fu >> more);
    for (int n = 0; n < more && i < text.size(); ++n) {
      point = point << 6 | (static_cast<unsigned char>(text[i++]) & 0x3Fu);
    }
    result.push_back(point);
  }
  return result;
}

}  // namespace

struct Font::Face {
  std::mutex used;  // FreeType draws one letter of a face at a time
  FT_Library library = nullptr;
  FT_Face face = nullptr;

  bool open(const fs::path& file, int size) {
    return FT_Init_FreeType(&library) == 0 && FT_New_Face(library, file.c_str(), 0, &face) == 0 &&
           FT_Set_Pixel_Sizes(face, 0, static_cast<FT_UInt>(size)) == 0;
  }
  ~Face() {
    if (face != nullptr) FT_Done_Face(face);
    if (library != nullptr) FT_Done_FreeType(library);
  }
};

Font& Font::dejavu(int size) {
  static Font font(size);
  return font;
}

Font::Font(int size) {
  const std::optional<fs::path> file = find_font("DejaVuSans.ttf");
  if (!file) return;
  face_ = std::make_unique<Face>();
  if (!face_->open(*file, size)) face_.reset();
}

Font::~Font() = default;

void Font::draw(const std::string& text, const std::function<void(int, int, float)>& pixel) {
  if (!face_) return;
  const std::lock_guard lock(face_->used);
  int pen = 0;
  for (const std::uint32_t point : code_points(text)) {
    if (FT_Load_Char(face_->face, point, FT_LOAD_RENDER) != 0) continue;
    const FT_GlyphSlot letter = face_->face->glyph;
    const FT_Bitmap& ink = letter->bitmap;
    for (int y = 0; y < static_cast<int>(ink.rows); ++y) {
      for (int x = 0; x < static_cast<int>(ink.width); ++x) {
        const unsigned char value = ink.buffer[y * ink.pitch + x];
        if (value == 0) continue;
        pixel(pen + letter->bitmap_left + x, y - letter->bitmap_top,
              static_cast<float>(value) / 255);
      }
    }
    pen += static_cast<int>(letter->advance.x >> 6);
  }
}

int Font::width_of(const std::string& text) {
  int first = 0, end = 0;
  draw(text, [&](int x, int, float) {
    first = end == 0 ? x : std::min(first, x);
    end = std::max(end, x + 1);
  });
  return end - first;
}

}  // namespace photile::report
