#include "image/picture_metadata.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "common/ascii_text.hpp"
#include "image/picture_checks.hpp"

namespace photile::image {
namespace {

using Bytes = std::vector<unsigned char>;

std::string_view text_of(Encoded bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

Encoded part_of(Encoded bytes, std::size_t begin, std::size_t count) {
  if (begin > bytes.size() || count > bytes.size() - begin) {
    throw DecodeError("the file ends too early");
  }
  return bytes.subspan(begin, count);
}

ByteOrder order_of(Encoded tiff) {
  return number_at(tiff, 0, 1) == 'M' ? ByteOrder::big : ByteOrder::little;
}

constexpr std::uint32_t orientation_tag = 274;

/// The first number of an entry; `otherwise` where there is none.
std::uint32_t tiff_number(Encoded tiff, std::uint32_t tag, std::uint32_t otherwise) {
  const std::optional<std::size_t> entry = tiff_entry(tiff, tag);
  if (!entry) return otherwise;
  constexpr std::uint32_t short_type = 3;
  const bool is_short = number_at(tiff, *entry + 2, 2, order_of(tiff)) == short_type;
  return number_at(tiff, *entry + 8, is_short ? 2 : 4, order_of(tiff));
}

Orientation orientation_of(Encoded tiff) {
  const std::uint32_t orientation = tiff_number(tiff, orientation_tag, upright);
  return orientation >= 1 && orientation <= 8 ? static_cast<Orientation>(orientation) : upright;
}

/// Of EXIF within another format. It is often cut or damaged by other programs; what it says is
/// lost then.
void take_exif(Encoded tiff, PictureMetadata& metadata) {
  constexpr std::uint32_t exif_directory = 34665, color_space = 0xA001, adobe_rgb = 2;
  try {
    metadata.orientation = orientation_of(tiff);
    const std::uint32_t directory = tiff_number(tiff, exif_directory, 0);
    const std::size_t entries = directory ? number_at(tiff, directory, 2, order_of(tiff)) : 0;
    for (std::size_t i = 0; i < entries; ++i) {
      const std::size_t entry = directory + 2 + 12 * i;
      if (number_at(tiff, entry, 2, order_of(tiff)) != color_space) continue;
      if (number_at(tiff, entry + 8, 2, order_of(tiff)) != adobe_rgb) continue;
      metadata.color = gamma_space(563.0 / 256);
      metadata.color.to_rec709 = to_rec709({.green = {0.21, 0.71}});
    }
  } catch (const DecodeError&) {
  }
}

/// The profile in a PNG's iCCP: behind a name, deflated.
Bytes inflated(Encoded chunk) {
  const std::size_t name = text_of(chunk).find('\0');
  Bytes profile;
  if (name == std::string_view::npos || name + 2 > chunk.size()) return profile;
  z_stream stream{};
  if (inflateInit(&stream) != Z_OK) throw std::bad_alloc();
  stream.next_in = const_cast<Bytef*>(chunk.data() + name + 2);
  stream.avail_in = static_cast<uInt>(chunk.size() - name - 2);
  constexpr std::size_t most_bytes = 16 << 20;  // profiles of tables have one
  std::array<Bytef, 1 << 14> out;
  int status = Z_OK;
  while (status == Z_OK && profile.size() < most_bytes) {
    stream.next_out = out.data();
    stream.avail_out = static_cast<uInt>(out.size());
    status = inflate(&stream, Z_NO_FLUSH);
    profile.insert(profile.end(), out.data(), stream.next_out);
  }
  inflateEnd(&stream);
  return profile;
}

/// The chunks of a PNG (Third Edition, 4.3): of those for colours cICP counts before iCCP, that
/// before sRGB, and that before gAMA and cHRM.
PictureMetadata png_metadata(Encoded png) {
  constexpr std::size_t frame = 12;  // length, type and checksum
  PictureMetadata metadata;
  std::optional<ColorSpace> coded, profile, srgb, plain;
  for (std::size_t offset = 8; offset + frame <= png.size();) {
    const std::size_t length = number_at(png, offset, 4, ByteOrder::big);
    const std::string_view type = text_of(part_of(png, offset + 4, 4));
    if (type == "IDAT" || type == "IEND") break;
    const Encoded chunk = part_of(png, offset + 8, length);
    const auto number = [&](std::size_t i) {
      return number_at(chunk, 4 * i, 4, ByteOrder::big) / 100'000.0;
    };
    if (type == "cICP" && length == 4) {
      coded = coded_space(chunk[0], chunk[1], chunk[2], chunk[3] == 1);
    } else if (type == "iCCP") {
      profile = icc_space(inflated(chunk));
    } else if (type == "sRGB") {
      srgb.emplace();
    } else if (type == "gAMA" && number(0) > 0) {
      if (!plain) plain.emplace();
      plain->curves = gamma_space(1 / number(0)).curves;
    } else if (type == "cHRM") {
      if (!plain) plain.emplace();
      try {
        plain->to_rec709 = to_rec709({{number(2), number(3)},
                                      {number(4), number(5)},
                                      {number(6), number(7)},
                                      {number(0), number(1)}});
      } catch (const DecodeError& error) {
        plain->problem = error.what();
      }
    } else if (type == "eXIf") {
      take_exif(chunk, metadata);
    }
    offset += length + frame;
  }
  for (const auto* const space : {&coded, &profile, &srgb, &plain}) {
    if (!*space) continue;
    metadata.color = **space;
    break;
  }
  return metadata;
}

/// The segments of a JPEG before its pixels: EXIF, and a profile that may be in several of them.
PictureMetadata jpeg_metadata(Encoded jpeg) {
  using namespace std::string_view_literals;
  constexpr std::string_view exif = "Exif\0\0"sv, icc = "ICC_PROFILE\0"sv;
  PictureMetadata metadata;
  std::vector<std::pair<std::uint32_t, Encoded>> profile;  // each with its number
  for (std::size_t offset = 2; offset + 4 <= jpeg.size() && jpeg[offset] == 0xFF;) {
    const unsigned marker = jpeg[offset + 1];
    if (marker == 0xFF) {  // a fill byte
      ++offset;
      continue;
    }
    if (marker == 0xDA || marker == 0xD9) break;
    const std::size_t length = number_at(jpeg, offset + 2, 2, ByteOrder::big);
    if (length < 2 || length > jpeg.size() - offset - 2) break;  // its reader says so
    const Encoded segment = jpeg.subspan(offset + 4, length - 2);
    if (marker == 0xE1 && text_of(segment).starts_with(exif)) {
      take_exif(segment.subspan(exif.size()), metadata);
    } else if (marker == 0xE2 && text_of(segment).starts_with(icc) &&
               segment.size() > icc.size() + 2) {
      profile.emplace_back(segment[icc.size()], segment.subspan(icc.size() + 2));
    }
    offset += 2 + length;
  }
  std::stable_sort(profile.begin(), profile.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  Bytes whole;
  for (const auto& [number, bytes] : profile) whole.insert(whole.end(), bytes.begin(), bytes.end());
  if (!whole.empty()) metadata.color = icc_space(whole);
  return metadata;
}

PictureMetadata webp_metadata(Encoded webp) {
  PictureMetadata metadata;
  for (std::size_t offset = 12; offset + 8 <= webp.size();) {
    const std::string_view type = text_of(webp.subspan(offset, 4));
    const std::size_t length =
        std::min<std::size_t>(number_at(webp, offset + 4, 4), webp.size() - offset - 8);
    Encoded chunk = webp.subspan(offset + 8, length);
    if (type == "ICCP") metadata.color = icc_space(chunk);
    if (type == "EXIF") {
      if (text_of(chunk).starts_with("Exif"))
        chunk = chunk.subspan(std::min<std::size_t>(6, length));
      take_exif(chunk, metadata);
    }
    offset += 8 + length + length % 2;
  }
  return metadata;
}

/// Photometric interpretations whose values are no light that OpenImageIO would know.
std::string unread_values(std::uint32_t photometric) {
  switch (photometric) {
    case 8:
    case 9:
    case 10:
      return "L*a*b*";
    case 32844:
    case 32845:
      return "LogLuv";
    default:
      return {};
  }
}

PictureMetadata tiff_metadata(Encoded tiff) {
  constexpr std::uint32_t photometric = 262, transfer_function = 301, white_point = 318,
                          primaries = 319, icc_profile = 34675;
  PictureMetadata metadata;
  metadata.orientation = orientation_of(tiff);
  const std::string unread = unread_values(tiff_number(tiff, photometric, 2));
  if (!unread.empty())
    throw DecodeError("its colours in " + unread + " are not supported; save it in RGB");
  const auto data_of = [&](std::size_t entry) {
    return number_at(tiff, entry + 8, 4, order_of(tiff));
  };
  if (const auto entry = tiff_entry(tiff, icc_profile)) {
    const std::uint32_t count = number_at(tiff, *entry + 4, 4, order_of(tiff));
    metadata.color = icc_space(part_of(tiff, data_of(*entry), count));
    return metadata;
  }
  const auto rationals = [&](std::size_t entry, std::size_t i) {
    const std::size_t at = data_of(entry) + 8 * i;
    const double divisor = number_at(tiff, at + 4, 4, order_of(tiff));
    return number_at(tiff, at, 4, order_of(tiff)) / std::max(divisor, 1.0);
  };
  if (const auto entry = tiff_entry(tiff, primaries)) {
    const auto pair = [&](std::size_t i) {
      return glm::dvec2(rationals(*entry, 2 * i), rationals(*entry, 2 * i + 1));
    };
    Chromaticities from{pair(0), pair(1), pair(2), Chromaticities().white};
    if (const auto white = tiff_entry(tiff, white_point)) {
      from.white = {rationals(*white, 0), rationals(*white, 1)};
    }
    metadata.color.to_rec709 = to_rec709(from);
  }
  if (tiff_entry(tiff, transfer_function)) {
    metadata.color.problem = "its TransferFunction is not supported; convert it to sRGB";
  }
  return metadata;
}

/// A bitmap with a header of version 4 or 5 may state its own colour space.
PictureMetadata bmp_metadata(Encoded bmp) {
  PictureMetadata metadata;
  constexpr std::size_t version_4 = 108, space_offset = 14 + 56;
  if (number_at(bmp, 14, 4) < version_4) return metadata;
  const std::string_view space = text_of(part_of(bmp, space_offset, 4));
  if (space == "DEBM" || space == "KNIL") {  // 'MBED', 'LINK' as numbers
    metadata.color.problem = "profiles of BMP are not supported; convert it to sRGB";
  }
  return metadata;
}

/// Positive numbers behind the `=` of a header's line.
template <std::size_t count>
std::array<double, count> numbers_behind(std::string_view line) {
  std::array<double, count> numbers{};
  std::string_view rest = line.substr(line.find('=') + 1);
  for (double& number : numbers) {
    rest.remove_prefix(std::min(rest.find_first_not_of(" \t"), rest.size()));
    const std::string_view word = rest.substr(0, rest.find_first_of(" \t"));
    rest.remove_prefix(word.size());
    const auto value = parse_signed(trimmed(word));
    if (!value || !(*value > 0)) {
      throw DecodeError(fmt::format("header line '{}' does not have {} numbers above 0; correct it",
                                    trimmed(line), count));
    }
    number = *value;
  }
  return numbers;
}

/// A line of a Radiance header that scales its pixels, or says what they are.
void take_variable(std::string_view line, std::string& format, PictureMetadata& metadata) {
  if (line.starts_with("FORMAT=")) {
    format = trimmed(line.substr(7));
  } else if (line.starts_with("EXPOSURE=")) {
    metadata.scale /= numbers_behind<1>(line)[0];
  } else if (line.starts_with("COLORCORR=")) {
    const auto factors = numbers_behind<3>(line);
    metadata.scale /= glm::dvec3(factors[0], factors[1], factors[2]);
  } else if (line.starts_with("PRIMARIES=")) {
    const auto xy = numbers_behind<8>(line);
    metadata.color.to_rec709 =
        to_rec709({{xy[0], xy[1]}, {xy[2], xy[3]}, {xy[4], xy[5]}, {xy[6], xy[7]}});
  } else if (line.starts_with("GAMMA=")) {
    if (numbers_behind<1>(line)[0] != 1) {
      throw DecodeError("a GAMMA other than 1 is not supported; save it linear");
    }
  } else if (line.starts_with("VIEW=")) {
    const std::size_t type = line.find("-vt");
    const char letter =
        type == std::string_view::npos || type + 3 >= line.size() ? 'v' : line[type + 3];
    metadata.projection = fmt::format("a view of Radiance's type -vt{}", letter);
  }
}

/// A resolution string such as "-Y 512 +X 1024": the axis of rows comes first. Y points up.
void take_resolution(std::string_view line, RadianceHeader& header) {
  std::array<std::string_view, 4> words;
  for (std::string_view& word : words) {
    line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
    word = line.substr(0, line.find_first_of(" \t\r"));
    line.remove_prefix(word.size());
  }
  const auto axis = [](std::string_view word) {
    return word.size() == 2 && (word[0] == '+' || word[0] == '-') ? word[1] : ' ';
  };
  const auto rows = parse_number<std::uint32_t>(words[1]),
             columns = parse_number<std::uint32_t>(words[3]);
  const bool by_rows = axis(words[0]) == 'Y' && axis(words[2]) == 'X';
  const bool by_columns = axis(words[0]) == 'X' && axis(words[2]) == 'Y';
  if (!trimmed(line).empty() || !rows || !columns || !(by_rows || by_columns)) {
    throw DecodeError("the size is damaged");
  }
  header.rows = *rows;
  header.columns = *columns;
  const bool from_top = words[by_rows ? 0 : 2][0] == '-',
             from_left = words[by_rows ? 2 : 0][0] == '+';
  header.metadata.orientation = by_rows ? (from_top ? (from_left ? 1 : 2) : (from_left ? 4 : 3))
                                        : (from_top ? (from_left ? 5 : 6) : (from_left ? 8 : 7));
}

}  // namespace

std::optional<std::size_t> tiff_entry(Encoded tiff, std::uint32_t tag) {
  const ByteOrder order = order_of(tiff);
  const std::size_t directory = number_at(tiff, 4, 4, order);
  const std::size_t entries = number_at(tiff, directory, 2, order);
  for (std::size_t i = 0; i < entries; ++i) {
    const std::size_t entry = directory + 2 + 12 * i;
    if (number_at(tiff, entry, 2, order) == tag) return entry;
  }
  return std::nullopt;
}

RadianceHeader read_radiance_header(Encoded bytes) {
  RadianceHeader header;
  const std::string_view text = text_of(bytes);
  const auto line = [&] {
    const std::size_t end = text.find('\n', header.end);
    if (end == std::string_view::npos) throw DecodeError("the header is damaged");
    const std::string_view found = text.substr(header.end, end - header.end);
    header.end = end + 1;
    return found;
  };
  std::string format;
  PictureMetadata& metadata = header.metadata;
  for (std::string_view found = line(); !trimmed(found).empty(); found = line()) {
    take_variable(found, format, metadata);
  }
  if (format == "32-bit_rle_xyze") {  // in cd/m2
    metadata.color.to_rec709 = rec709_of_xyz();
    metadata.white_luminance = 1;
  } else if (format != "32-bit_rle_rgbe") {
    throw DecodeError(
        "is not of the format 32-bit_rle_rgbe or 32-bit_rle_xyze; convert it with ra_rgbe");
  }
  if (!std::isfinite(metadata.scale.x + metadata.scale.y + metadata.scale.z)) {
    throw DecodeError("the product of its exposures is not a number; correct its lines EXPOSURE=");
  }
  take_resolution(line(), header);
  return header;
}

PictureMetadata read_metadata(std::string_view reader, Encoded bytes) {
  if (reader == "png") return png_metadata(bytes);
  if (reader == "jpeg") return jpeg_metadata(bytes);
  if (reader == "webp") return webp_metadata(bytes);
  if (reader == "tiff") return tiff_metadata(bytes);
  if (reader == "bmp") return bmp_metadata(bytes);
  if (reader == "hdr") return read_radiance_header(bytes).metadata;
  return {};
}

}  // namespace photile::image
