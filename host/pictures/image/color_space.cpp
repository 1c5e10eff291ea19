#include "image/color_space.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

#include "image/display.hpp"
#include "image/picture_checks.hpp"
#include "photile/scene.hpp"

namespace photile::image {
namespace {

glm::dvec3 xyz_of(const glm::dvec2& chromaticity) {
  return glm::dvec3(chromaticity.x, chromaticity.y, 1 - chromaticity.x - chromaticity.y) /
         chromaticity.y;
}

/// RGB to XYZ, with Y = 1 for white (SMPTE RP 177).
glm::dmat3 xyz_of_rgb(const Chromaticities& space) {
  const glm::dmat3 primaries(xyz_of(space.red), xyz_of(space.green), xyz_of(space.blue));
  const double volume = glm::determinant(primaries);
  if (!std::isfinite(volume) || std::abs(volume) < 1e-6 || !(space.white.y > 0)) {
    throw DecodeError("its primaries are degenerate; save it in another colour space");
  }
  const glm::dvec3 weights = glm::inverse(primaries) * xyz_of(space.white);
  return {primaries[0] * weights[0], primaries[1] * weights[1], primaries[2] * weights[2]};
}

glm::dmat3 diagonal(const glm::dvec3& values) {
  return {{values.x, 0, 0}, {0, values.y, 0}, {0, 0, values.z}};
}

std::optional<glm::dmat3> unless_identity(const glm::dmat3& matrix, double tolerance) {
  double largest = 0;
  for (int c = 0; c < 3; ++c) {
    for (int r = 0; r < 3; ++r) {
      largest = std::max(largest, std::abs(matrix[c][r] - (c == r ? 1.0 : 0.0)));
    }
  }
  return largest < tolerance ? std::nullopt : std::optional(matrix);
}

}  // namespace

std::optional<glm::dmat3> to_rec709(const Chromaticities& from) {
  const Chromaticities rec709;
  const glm::dmat3 whites = diagonal(xyz_of(rec709.white) / xyz_of(from.white));
  return unless_identity(glm::inverse(xyz_of_rgb(rec709)) * whites * xyz_of_rgb(from), 1e-3);
}

glm::dmat3 rec709_of_xyz() {
  const Chromaticities rec709;
  return glm::inverse(xyz_of_rgb(rec709)) * diagonal(xyz_of(rec709.white));
}

glm::dvec3 converted(const glm::dmat3& to_rec709, const glm::dvec3& color) {
  const glm::dvec3 rgb = to_rec709 * color;
  const double least = std::min({rgb.r, rgb.g, rgb.b});
  if (!(least < 0) || std::min({color.r, color.g, color.b}) < 0) return rgb;
  const double grey = luminance(rgb);
  if (!(grey > 0)) return glm::dvec3(0.0);
  const glm::dvec3 mixed = grey + (rgb - grey) * (grey / (grey - least));
  return glm::max(mixed, glm::dvec3(0.0));
}

ColorSpace gamma_space(double exponent) {
  ColorSpace space;
  space.curves.fill([exponent](double value) { return std::pow(value, exponent); });
  return space;
}

namespace {

/// The parts of an ICC profile. Errors: DecodeError where it ends too early.
class IccProfile {
 public:
  explicit IccProfile(Encoded bytes) : bytes_(bytes) {}

  std::string_view name_at(std::size_t offset) const {
    number_at(bytes_, offset, 4, ByteOrder::big);
    return {reinterpret_cast<const char*>(bytes_.data()) + offset, 4};
  }

  /// Where the data of a tag begin; 0 where there is none.
  std::size_t find(std::string_view tag) const {
    const std::size_t tags = number_at(bytes_, 128, 4, ByteOrder::big);
    for (std::size_t i = 0; i < tags; ++i) {
      const std::size_t entry = 132 + 12 * i;
      if (name_at(entry) == tag) return number_at(bytes_, entry + 4, 4, ByteOrder::big);
    }
    return 0;
  }

  glm::dvec3 xyz(std::string_view tag) const {
    const std::size_t at = find(tag);
    return {fixed(at + 8), fixed(at + 12), fixed(at + 16)};
  }

  ColorSpace::Curve curve(std::string_view tag) const {
    const std::size_t at = find(tag);
    if (name_at(at) == "para") return parametric(at);
    if (name_at(at) != "curv") throw DecodeError("damaged");
    const std::size_t count = number_at(bytes_, at + 8, 4, ByteOrder::big);
    if (count == 0) return [](double value) { return value; };
    if (count == 1) {
      const double exponent = number_at(bytes_, at + 12, 2, ByteOrder::big) / 256.0;
      return [exponent](double value) { return std::pow(value, exponent); };
    }
    std::vector<double> table;
    for (std::size_t i = 0; i < count; ++i) {
      table.push_back(number_at(bytes_, at + 12 + 2 * i, 2, ByteOrder::big) / 65535.0);
    }
    return [table = std::move(table)](double value) {
      const double position = std::clamp(value, 0.0, 1.0) * static_cast<double>(table.size() - 1);
      const auto before = std::min(static_cast<std::size_t>(position), table.size() - 2);
      const double part = position - static_cast<double>(before);
      return table[before] * (1 - part) + table[before + 1] * part;
    };
  }

 private:
  /// An s15Fixed16Number.
  double fixed(std::size_t offset) const {
    return static_cast<std::int32_t>(number_at(bytes_, offset, 4, ByteOrder::big)) / 65536.0;
  }

  /// ISO 15076-1, table 68: Y = (aX + b)^g + e from d on, and cX + f below.
  ColorSpace::Curve parametric(std::size_t at) const {
    const std::uint32_t kind = number_at(bytes_, at + 8, 2, ByteOrder::big);
    constexpr std::array<std::size_t, 5> counts{1, 3, 4, 5, 7};
    if (kind >= counts.size()) throw DecodeError("damaged");
    std::array<double, 7> p{1, 1, 0, 0, 0, 0, 0};  // g a b c d e f
    for (std::size_t i = 0; i < counts[kind]; ++i) p[i] = fixed(at + 12 + 4 * i);
    if (kind == 1 || kind == 2) {
      const double offset = kind == 2 ? std::exchange(p[3], 0.0) : 0.0;
      p[4] = p[1] != 0 ? -p[2] / p[1] : 0.0;
      p[5] = p[6] = offset;
    }
    return [p](double x) {
      return x >= p[4] ? std::pow(std::max(p[1] * x + p[2], 0.0), p[0]) + p[5] : p[3] * x + p[6];
    };
  }

  Encoded bytes_;
};

/// Whether a curve shows no 8-bit value as another one.
bool is_srgb_curve(const ColorSpace::Curve& curve) {
  for (int code = 0; code < 256; ++code) {
    const double value = code / 255.0;
    const double shown = srgb_from_linear(std::clamp(curve(value), 0.0, 1.0));
    if (!(std::abs(shown - value) < 0.5 / 255)) return false;
  }
  return true;
}

ColorSpace space_of(const IccProfile& profile) {
  ColorSpace space;
  const std::string_view kind = profile.name_at(16);
  if (kind == "GRAY" && profile.find("kTRC") != 0) {
    space.curves.fill(profile.curve("kTRC"));
  } else if (kind == "RGB " && profile.find("rXYZ") != 0 && profile.find("gXYZ") != 0 &&
             profile.find("bXYZ") != 0 && profile.find("rTRC") != 0 && profile.find("gTRC") != 0 &&
             profile.find("bTRC") != 0) {
    space.curves = {profile.curve("rTRC"), profile.curve("gTRC"), profile.curve("bTRC")};
    // Profiles have their colours under D50, by Bradford's transform from their own white.
    const glm::dmat3 rec709_of_d50 =
        glm::transpose(glm::dmat3(3.1338561, -1.6168667, -0.4906146,  //
                                  -0.9787684, 1.9161415, 0.0334540,   //
                                  0.0719453, -0.2289914, 1.4052427));
    const glm::dmat3 colorants(profile.xyz("rXYZ"), profile.xyz("gXYZ"), profile.xyz("bXYZ"));
    space.to_rec709 = unless_identity(rec709_of_d50 * colorants, 4e-3);
  } else {
    space.problem =
        fmt::format("its ICC profile, of {}, has no primaries with curves; convert it to sRGB",
                    kind == "RGB " || kind == "GRAY" ? "tables" : "colours other than RGB");
    return space;
  }
  if (std::all_of(space.curves.begin(), space.curves.end(), is_srgb_curve)) space.curves = {};
  if (!space.curves[0] && space.to_rec709) {
    space.curves.fill(linear_from_srgb);
  }
  return space;
}

}  // namespace

ColorSpace icc_space(Encoded profile) {
  try {
    return space_of(IccProfile(profile));
  } catch (const DecodeError&) {
    ColorSpace space;
    space.problem = "its ICC profile is damaged; convert it to sRGB";
    return space;
  }
}

ColorSpace coded_space(int primaries, int transfer, int matrix, bool full_range) {
  ColorSpace space;
  Chromaticities from;
  std::string problem;
  switch (primaries) {
    case 1:  // Rec.709
    case 2:  // unspecified
      break;
    case 9:  // Rec.2020
      from = {{0.708, 0.292}, {0.170, 0.797}, {0.131, 0.046}, from.white};
      break;
    case 12:  // Display P3
      from = {{0.680, 0.320}, {0.265, 0.690}, {0.150, 0.060}, from.white};
      break;
    default:
      problem = fmt::format("primaries {}", primaries);
  }
  switch (transfer) {
    case 2:   // unspecified
    case 13:  // sRGB
      space.curves.fill(linear_from_srgb);
      break;
    case 1:  // Rec.709, Rec.601 and Rec.2020 have one curve
    case 6:
    case 14:
    case 15:
      space.curves.fill([](double value) {
        return value < 0.081 ? value / 4.5 : std::pow((value + 0.099) / 1.099, 1 / 0.45);
      });
      break;
    case 4:
      space = gamma_space(2.2);
      break;
    case 5:
      space = gamma_space(2.8);
      break;
    case 8:
      space = gamma_space(1.0);
      break;
    default:
      problem = fmt::format("transfer curve {}", transfer);
  }
  if (matrix != 0) problem = fmt::format("matrix {}", matrix);
  if (!full_range) problem = "a narrow range";
  if (!problem.empty()) {
    space.problem = "its cICP has " + problem + ", which is not supported; convert it to sRGB";
    return space;
  }
  space.to_rec709 = to_rec709(from);
  if (!space.to_rec709 && is_srgb_curve(space.curves[0])) space.curves = {};
  return space;
}

}  // namespace photile::image
