#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "common/foreign_text.hpp"
#include "files/scene_files.hpp"
#include "photile/limits.hpp"
#include "photometry/photometric_file.hpp"

namespace photile::photometry {
namespace {

enum class Photometry { type_c = 1, type_b = 2, type_a = 3 };

/// The content of the TILT= line; `next` is the line after it.
struct Tilt {
  std::string value;  ///< in lower case
  std::size_t next;
};

Tilt find_tilt(const std::vector<std::string_view>& lines) {
  for (std::size_t i = 0; i < lines.size(); ++i) {
    std::string_view line = trimmed(lines[i]);
    if (lower(line.substr(0, 4)) != "tilt") continue;
    line = trimmed(line.substr(4));
    if (line.starts_with('=')) return {lower(trimmed(line.substr(1))), i + 1};
  }
  throw files::ResourceError("no line starts with TILT=, so this is not an LM-63 file");
}

/// The content of the keywords before the TILT= line. [MORE] continues the one before it; colours
/// have no keyword of the standard, so makers write their own, or name the lamp by them.
LuminaireData data_of(const std::vector<std::string_view>& lines, std::size_t end) {
  std::map<std::string, std::string> values;
  std::string keyword;
  for (std::size_t i = 0; i < end; ++i) {
    const std::string_view line = trimmed(lines[i]);
    const std::size_t close = line.find(']');
    if (!line.starts_with('[') || close == std::string_view::npos) continue;
    const std::string value = one_line(trimmed(line.substr(close + 1)));
    if (const std::string name = lower(line.substr(1, close - 1)); name != "more") {
      keyword = name;
      values[keyword] = value;
    } else {
      values[keyword] += " " + value;
    }
  }
  LuminaireData data{values["manufac"], values["lumcat"], values["luminaire"],
                     values["lamp"].empty() ? values["lampcat"] : values["lamp"]};
  for (const auto& field : values) {
    const std::string &name = field.first, &value = field.second;
    const auto names = [&](std::string_view word) { return name.find(word) != std::string::npos; };
    if (names("cct") || names("colortemp") || names("color temp")) {
      data.kelvin = kelvin_in(value);
      data.highest_kelvin = highest_kelvin_in(value);
    }
    const bool of_rendering = names("cri") && !names("descri") && !names("r9");
    if (of_rendering || name == "ra" || name == "_ra") data.rendering = rendering_in(value);
  }
  const std::string& lamp = data.source;
  const auto said = [&](std::string_view word) {
    return std::min(lower(lamp).find(word), lamp.size());
  };
  // In the lamp's name four digits are kelvin where a K follows, since they may be lumens.
  for (std::size_t k = said("k"); k < lamp.size() && data.kelvin == 0;
       k = std::min(lower(lamp).find('k', k + 1), lamp.size())) {
    const std::string before(trimmed(std::string_view(lamp).substr(0, k)));
    if (before.size() >= 4) data.kelvin = kelvin_in(before.substr(before.size() - 4));
  }
  if (data.rendering == 0 && said("cri") < lamp.size()) {
    const std::size_t cri = said("cri");
    data.rendering = rendering_in(std::string_view(lamp).substr(cri));
    if (data.rendering == 0 && cri >= 3) data.rendering = rendering_in(lamp.substr(cri - 3, 3));
  }
  return data;
}

void skip_tilt(const Tilt& tilt, const std::string& name, NumberReader& reader,
               files::Warnings& warnings) {
  if (tilt.value == "none") return;
  if (tilt.value != "include") {
    warnings.add("photometric file", name,
                 "its tilt file is not read; the lamp is taken as not tilted");
    return;
  }
  reader.number("lamp-to-luminaire geometry");
  const std::size_t count =
      reader.count("number of tilt angles", 0, limits::max_photometric_angles);
  reader.numbers("tilt angle", count);
  const std::vector<double> factors = reader.numbers("tilt factor", count);
  if (std::any_of(factors.begin(), factors.end(), [](double factor) { return factor != 1.0; })) {
    warnings.add("photometric file", name,
                 "its tilt factors are ignored; the lamp is taken as not tilted");
  }
}

double positive(const std::string& what, NumberReader& reader) {
  const double value = reader.number(what);
  if (!(value > 0.0)) {
    throw files::ResourceError(
        fmt::format("{}: the {} is {}, not above 0", reader.place(), what, value));
  }
  return value;
}

std::vector<double> angles(const std::string& what, std::size_t count, double lowest,
                           double highest, NumberReader& reader) {
  std::vector<double> values = reader.numbers(what, count);
  for (std::size_t i = 0; i < count; ++i) {
    const bool ascends = i == 0 || values[i] - values[i - 1] >= least_angle_step;
    if (values[i] < lowest || values[i] > highest || !ascends) {
      throw files::ResourceError(fmt::format(
          "{} {} of {} is {}; angles must ascend from {} to {} degrees, by at least {:g}", what,
          i + 1, count, values[i], lowest, highest, least_angle_step));
    }
  }
  return values;
}

/// The candela values as the file orders them: for each horizontal angle all vertical ones.
struct Web {
  std::vector<double> vertical, horizontal;  ///< degrees
  std::vector<float> candela;

  float at(std::size_t h, std::size_t v) const { return candela[h * vertical.size() + v]; }
};

Web read_web(std::size_t vertical, std::size_t horizontal, Photometry type, double factor,
             NumberReader& reader) {
  const bool polar = type == Photometry::type_c;
  Web web;
  web.vertical =
      angles("vertical angle", vertical, polar ? 0.0 : -90.0, polar ? 180.0 : 90.0, reader);
  web.horizontal =
      angles("horizontal angle", horizontal, polar ? -360.0 : -90.0, polar ? 720.0 : 90.0, reader);
  for (std::size_t i = 0; i < vertical * horizontal; ++i) {
    const std::string what = "candela value";
    const double value = factor * reader.number(what);
    if (!(value >= 0.0) || !std::isfinite(static_cast<float>(value))) {
      throw files::ResourceError(fmt::format("{}: {} {} of {} is {} cd, which is not possible",
                                             reader.place(), what, i + 1, vertical * horizontal,
                                             value));
    }
    web.candela.push_back(static_cast<float>(value));
  }
  return web;
}

IntensityDistribution type_c(const std::string& name, const Web& web) {
  std::vector<double> azimuth;
  std::vector<float> intensity;
  for (const MeasuredPlane& plane : planes_all_around(web.horizontal)) {
    azimuth.push_back(plane.azimuth);
    for (std::size_t v = 0; v < web.vertical.size(); ++v) {
      intensity.push_back(web.at(plane.measured, v));
    }
  }
  return {name, PhotometricAxes{}, web.vertical, azimuth, std::move(intensity)};
}

/// An angle of types A and B, from -90 to 90 degrees, and its index in the file. A lamp measured
/// from 0 on is symmetric.
std::vector<MeasuredPlane> on_both_sides(const std::vector<double>& measured) {
  std::vector<MeasuredPlane> angles;
  for (std::size_t i = measured.size(); measured.front() == 0.0 && i-- > 1;) {
    angles.push_back({-measured[i], i});
  }
  for (std::size_t i = 0; i < measured.size(); ++i) angles.push_back({measured[i], i});
  return angles;
}

/// Types A and B are the same spherical coordinates as type C about another pole: the polar angle
/// is 90 degrees less the vertical angle of type A, whose pole points up, or less the horizontal
/// angle of type B, whose pole points to the right, as seen from the lamp (IES LM-75).
IntensityDistribution type_a_or_b(const std::string& name, const Web& web, Photometry type) {
  const glm::dvec3 forward(0, 0, -1), up(1, 0, 0), right(0, -1, 0);
  const bool a = type == Photometry::type_a;
  const PhotometricAxes axes =
      a ? PhotometricAxes{up, forward, right} : PhotometricAxes{right, forward, up};
  std::vector<MeasuredPlane> rows = on_both_sides(a ? web.vertical : web.horizontal);
  std::reverse(rows.begin(), rows.end());  // polar angles ascend
  std::vector<double> polar, azimuth;
  for (const MeasuredPlane& row : rows) polar.push_back(90.0 - row.azimuth);
  std::vector<float> intensity;
  for (const MeasuredPlane& column : on_both_sides(a ? web.horizontal : web.vertical)) {
    azimuth.push_back(column.azimuth);
    for (const MeasuredPlane& row : rows) {
      intensity.push_back(a ? web.at(column.measured, row.measured)
                            : web.at(row.measured, column.measured));
    }
  }
  return {name, axes, polar, azimuth, std::move(intensity)};
}

/// Width (across the photometric horizontal), length (along it) and height, as the edition of the
/// file marks shapes by minus signs. From 2002 on two of them mark the plane of a round section,
/// whose third extent is a cylinder's or 0, and three an ellipsoid. In 1995 a minus of width or
/// length makes the plan round, one of the height beside it an ellipsoid, and one of the height
/// alone a tube. In 1986 and 1991 a minus of the width makes the plan round, and is that of an
/// ellipsoid where width, length and height differ from 0. Until 1995 a diameter stands once, and
/// is 0 in the other place. What an edition does not define is read as in another edition.
LuminousOpening opening_of(const std::vector<double>& size, bool feet, Photometry type,
                           int edition) {
  using Shape = LuminousOpening::Shape;
  const double metres = feet ? 0.3048 : 1.0;
  const bool round_width = size[0] < 0, round_length = size[1] < 0, round_height = size[2] < 0;
  double width = metres * std::abs(size[0]), length = metres * std::abs(size[1]),
         height = metres * std::abs(size[2]);
  Shape shape = Shape::box;
  const int minus_signs = int{round_width} + int{round_length} + int{round_height};
  const bool in_new_way = edition >= 2002 || (round_width && round_length);
  if (minus_signs == 3) {
    shape = Shape::ellipsoid;
  } else if (minus_signs == 2 && in_new_way) {
    shape = !round_height ? Shape::upright_cylinder
            : round_width ? Shape::cylinder_along_x
                          : Shape::cylinder_along_y;
  } else if (round_width || round_length) {
    const bool ellipsoid_of_1986 = edition < 1995 && width > 0 && length > 0 && height > 0;
    shape = round_height || ellipsoid_of_1986 ? Shape::ellipsoid : Shape::upright_cylinder;
    if (width == 0) width = length;
    if (length == 0) length = width;
  } else if (round_height && width == 0 && length > 0) {
    shape = Shape::cylinder_along_x;
    width = height;
  } else if (round_height && length == 0 && width > 0) {
    shape = Shape::cylinder_along_y;
    length = height;
  }
  // The photometric horizontal of type A is where the luminaire is aimed, and its height is
  // vertical. A flat opening would otherwise lie edge-on in its own beam; it is turned to face it.
  if (type == Photometry::type_a && height > 0) {
    std::swap(length, height);
    if (shape == Shape::upright_cylinder) {
      shape = Shape::cylinder_along_x;
    } else if (shape == Shape::cylinder_along_x) {
      shape = Shape::upright_cylinder;
    }
  }
  return {.x = length, .y = width, .heights = {height, height, height, height}, .shape = shape};
}

constexpr int first_edition = 1986;

/// The edition of LM-63 that a line before TILT= names, however it is spelt: "IESNA91",
/// "IESNA:LM-63-2002", "IES: lm-63-19". Without one, the first.
int edition_of(const std::vector<std::string_view>& lines, std::size_t end) {
  constexpr int unnamed = 9999;  // "LM-63" alone is not the first edition, whose files name none
  for (std::size_t i = 0; i < end; ++i) {
    std::string line = lower(trimmed(lines[i]));
    if (line.starts_with('[')) continue;
    std::erase_if(line,
                  [](char c) { return std::string_view(" \t:-_/").find(c) < std::string::npos; });
    const std::size_t number = line.find("lm63");
    const bool named = number != std::string::npos;
    std::string_view rest = line;
    rest.remove_prefix(named ? number + 4 : rest.starts_with("iesna") ? 5 : rest.size());
    const auto year = parse_number<int>(rest.substr(0, rest.find_first_not_of("0123456789")));
    if (year) return *year >= 100 ? *year : *year + (*year < first_edition % 100 ? 2000 : 1900);
    if (named) return unnamed;
  }
  return first_edition;
}

}  // namespace

IntensityDistribution read_ies(const std::string& name, std::string_view text,
                               files::Warnings& warnings) {
  const std::vector<std::string_view> lines = lines_of(text);
  const Tilt tilt = find_tilt(lines);
  NumberReader reader(lines, tilt.next);
  skip_tilt(tilt, name, reader, warnings);
  reader.number("number of lamps");
  reader.number("lumens per lamp");
  double factor = positive("candela multiplier", reader);
  const std::size_t vertical =
      reader.count("number of vertical angles", 2, limits::max_photometric_angles);
  const std::size_t horizontal =
      reader.count("number of horizontal angles", 1, limits::max_photometric_angles);
  const auto type = static_cast<Photometry>(reader.count("photometric type", 1, 3));
  const bool feet = reader.count("type of units", 1, 2) == 1;
  const int edition = edition_of(lines, tilt.next - 1);
  const LuminousOpening opening =
      opening_of(reader.numbers("size of the luminous opening", 3), feet, type, edition);
  factor *= positive("ballast factor", reader);
  // From 1995 on the place is reserved, and in 2019 it tells how the file was made.
  const double next = reader.number("ballast-lamp photometric factor");
  if (edition < 1995 && next > 0.0) {
    factor *= next;
    if (edition == first_edition && next != 1.0) {
      warnings.add("photometric file", name,
                   fmt::format("its ballast-lamp photometric factor of {:g} is applied, as no line "
                               "before TILT= names LM-63 of 1995 or later",
                               next));
    }
  }
  LuminaireData data = data_of(lines, tilt.next - 1);
  data.watts = reader.number("input watts");
  if (vertical * horizontal > limits::max_photometric_values) {
    throw files::ResourceError(
        fmt::format("{} vertical x {} horizontal angles; the limit is {} values", vertical,
                    horizontal, limits::max_photometric_values));
  }
  if (type != Photometry::type_c && horizontal < 2) {
    throw files::ResourceError(
        "a file of photometric type A or B has at least 2 horizontal angles");
  }
  const Web web = read_web(vertical, horizontal, type, factor, reader);
  IntensityDistribution distribution =
      type == Photometry::type_c ? type_c(name, web) : type_a_or_b(name, web, type);
  distribution.set_opening(opening);
  distribution.set_data(std::move(data));
  return distribution;
}

}  // namespace photile::photometry
