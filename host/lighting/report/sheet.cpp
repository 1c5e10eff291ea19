#include "report/sheet.hpp"

#include <ft2build.h>
#include FT_FREETYPE_H

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "image/display.hpp"

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

Sheet::Sheet(int width, int height) {
  image_.width = width;
  image_.height = height;
  for (const char* channel : {"R", "G", "B"}) image_.add(channel).assign(image_.pixels(), 1.0f);
}

std::size_t Sheet::index(int x, int y) const {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(image_.width) +
         static_cast<std::size_t>(x);
}

void Sheet::set(int x, int y, const std::array<float, 3>& linear) {
  for (std::size_t c = 0; c < 3; ++c) image_.channels[c][index(x, y)] = linear[c];
}

void Sheet::set(int x, int y, const std::array<std::uint8_t, 3>& srgb) {
  std::array<float, 3> linear{};
  for (std::size_t c = 0; c < 3; ++c) {
    linear[c] = static_cast<float>(image::linear_from_srgb(srgb[c] / 255.0));
  }
  set(x, y, linear);
}

void Sheet::write(int x, int y, int end, const std::string& text) {
  const int right = std::min(end, image_.width);
  Font::dejavu(font_size).draw(text, [&](int u, int v, float ink) {
    u += x;
    v += y;
    if (u < std::max(x, 0) || u >= right || v < 0 || v >= image_.height) return;
    for (auto& channel : image_.channels) channel[index(u, v)] *= 1 - ink;
  });
}

int Sheet::width_of(const std::string& text) { return Font::dejavu(font_size).width_of(text); }

Image Sheet::take() { return std::move(image_); }

}  // namespace photile::report
