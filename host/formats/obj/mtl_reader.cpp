#include "obj/mtl_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

#include "common/ascii_text.hpp"
#include "image/color_space.hpp"
#include "obj/obj_reader.hpp"
#include "photile/errors.hpp"

namespace photile::obj {
namespace {

using Words = std::vector<std::string_view>;

/// The range of a number, ends included.
struct Range {
  double least, most;
};
constexpr Range fraction{0, 1}, positive{0, std::numeric_limits<double>::max()};

struct ColorStatement {
  std::string_view keyword;
  std::optional<glm::dvec3> MtlMaterial::*color;
  Range range;
};
constexpr std::array color_statements{
    ColorStatement{"kd", &MtlMaterial::Kd, fraction},
    ColorStatement{"ks", &MtlMaterial::Ks, fraction},
    ColorStatement{"ke", &MtlMaterial::Ke, positive},
    ColorStatement{"tf", &MtlMaterial::Tf, fraction},
    ColorStatement{"kt", &MtlMaterial::Tf, fraction},
};

struct NumberStatement {
  std::string_view keyword;
  std::optional<double> MtlMaterial::*number;
  Range range;
};
constexpr std::array number_statements{
    NumberStatement{"ns", &MtlMaterial::Ns, positive},
    NumberStatement{"ni", &MtlMaterial::Ni, positive},
    NumberStatement{"pr", &MtlMaterial::Pr, fraction},
    NumberStatement{"pm", &MtlMaterial::Pm, fraction},
};

struct MapStatement {
  std::string_view keyword;
  std::string MtlMaterial::*file;
};
constexpr std::array map_statements{
    MapStatement{"map_kd", &MtlMaterial::map_Kd},
    MapStatement{"map_ke", &MtlMaterial::map_Ke},
    MapStatement{"map_d", &MtlMaterial::map_d},
    MapStatement{"norm", &MtlMaterial::norm},
};

/// Statements that do not concern the light that photile traces, and those of pictures that it does
/// not read.
constexpr std::array<std::string_view, 4> without_light{"ka", "map_ka", "sharpness", "map_aat"};
constexpr std::array<std::string_view, 13> ignored_maps{
    "map_ks", "map_ns", "bump",   "map_bump", "disp",   "map_disp", "refl",
    "decal",  "map_pr", "map_pm", "map_ps",   "map_tr", "map_norm"};
constexpr std::array<std::string_view, 5> ignored_lobes{"ps", "pc", "pcr", "aniso", "anisor"};

template <class List>
bool lists(const List& list, std::string_view keyword) {
  return std::find(list.begin(), list.end(), keyword) != list.end();
}

template <class List>
const auto* statement_of(const List& statements, std::string_view keyword) {
  const auto found = std::find_if(statements.begin(), statements.end(),
                                  [&](const auto& each) { return each.keyword == keyword; });
  return found == statements.end() ? nullptr : &*found;
}

class MtlReader {
 public:
  MtlReader(const std::string& library, reading::ImportContext& context)
      : library_(library), context_(context) {}

  std::vector<MtlMaterial> read(std::string_view text) {
    for (const std::string_view line : lines_of(text)) {
      ++line_;
      context_.check_cancelled();
      take(line);
    }
    return std::move(materials_);
  }

 private:
  [[noreturn]] void refuse(const std::string& what) const {
    throw InputError(fmt::format("{}: {}, line {}: {}", context_.folder.scene_file().string(),
                                 library_, line_, what));
  }

  void warn(const std::string& what) {
    context_.warnings.add(fmt::format("{}, line {}: {}", library_, line_, what));
  }

  void warn_of_material(const std::string& what) {
    context_.warnings.add("material", materials_.back().name, what);
  }

  void take(std::string_view line) {
    statement_ = trimmed(line);
    std::string_view rest = statement_;
    const std::string_view spelled = take_word(rest);
    const std::string keyword = lower(spelled);
    if (keyword.empty() || keyword[0] == '#') return;
    if (keyword == "newmtl") return begin_material(trimmed(rest));
    if (materials_.empty()) return warn(fmt::format("{} before any newmtl is ignored", spelled));
    if (lists(without_light, keyword)) return;
    if (const auto* map = statement_of(map_statements, keyword)) return take_map(*map, rest);
    if (lists(ignored_maps, keyword)) {
      return warn_of_material(fmt::format("texture {} is ignored; its factor is used", spelled));
    }
    // Text after a # on a line of numbers is a comment, too.
    const Words words = words_of(rest.substr(0, rest.find('#')));
    if (const auto* color = statement_of(color_statements, keyword)) {
      materials_.back().*color->color = color_of(words, color->range);
    } else if (const auto* number = statement_of(number_statements, keyword)) {
      materials_.back().*number->number = only_number(words, number->range);
    } else if (keyword == "d" || keyword == "tr") {
      take_dissolve(words, keyword == "d");
    } else if (keyword == "illum") {
      take_illumination_model(words);
    } else if (lists(ignored_lobes, keyword)) {
      if (words.empty() || parse_signed(words[0]) != 0.0) {
        warn_of_material("sheen, clear coat and anisotropy are ignored");
      }
    } else {
      warn_of_material(fmt::format("statement '{}' is not understood; ignored", spelled));
    }
  }

  static Words words_of(std::string_view rest) {
    Words words;
    for (std::string_view word = take_word(rest); !word.empty(); word = take_word(rest)) {
      words.push_back(word);
    }
    return words;
  }

  void begin_material(std::string_view name) {
    materials_.emplace_back().name = name;
    has_d_ = false;
  }

  double number(std::string_view word, const Range& range) const {
    const auto value = parse_signed(word);
    if (!value) {
      refuse(fmt::format("'{}': '{}' is not a number{}", statement_, word,
                         word.find(',') == std::string_view::npos
                             ? "; correct the line"
                             : "; write it with a decimal point"));
    }
    constexpr double rounding = 1e-4;  // 1.000001 is 1
    if (*value < range.least - rounding || *value > range.most + rounding) {
      refuse(fmt::format("'{}': {:g} is not {}; correct the line", statement_, *value,
                         range.most == positive.most
                             ? "0 or more"
                             : fmt::format("between 0 and {:g}", range.most)));
    }
    return std::clamp(*value, range.least, range.most);
  }

  double only_number(const Words& words, const Range& range) const {
    if (words.size() != 1) {
      refuse(
          fmt::format("'{}' has {} numbers, not one; correct the line", statement_, words.size()));
    }
    return number(words[0], range);
  }

  /// One number stands for all three channels. Values of `xyz` are those of CIE.
  glm::dvec3 color_of(Words words, const Range& range) {
    if (!words.empty() && lower(words[0]) == "spectral") {
      refuse(fmt::format("'{}': spectral curves are not supported; give red, green and blue",
                         statement_));
    }
    const bool is_xyz = !words.empty() && lower(words[0]) == "xyz";
    if (is_xyz) words.erase(words.begin());
    if (words.size() != 1 && words.size() != 3) {
      refuse(fmt::format("'{}' has {} numbers; give one, or red, green and blue", statement_,
                         words.size()));
    }
    glm::dvec3 color;
    for (int i = 0; i < 3; ++i) {
      color[i] = number(words[words.size() == 1 ? 0 : static_cast<std::size_t>(i)], positive);
    }
    if (is_xyz) color = image::converted(image::rec709_of_xyz(), color);
    const glm::dvec3 within = glm::min(color, glm::dvec3(range.most));
    if (glm::length(color - within) > 1e-4) {
      warn(fmt::format("'{}' exceeds 1; 1 is used", statement_));
    }
    return within;
  }

  /// d, or Tr, which is not of the format: 1 - d. d counts where a material has both.
  void take_dissolve(Words words, bool is_d) {
    MtlMaterial& material = materials_.back();
    if (!words.empty() && words[0] == "-halo") {
      words.erase(words.begin());
      warn_of_material("the -halo of its d is ignored");
    }
    const double value = only_number(words, fraction);
    const double d = is_d ? value : 1 - value;
    if (!is_d && has_d_) {
      // Some programs write Tr as they would write d.
      if (material.d != d && material.d != value) warn_of_material("d is used, Tr is ignored");
      return;
    }
    has_d_ |= is_d;
    material.d = d;
  }

  void take_illumination_model(const Words& words) {
    const double value = only_number(words, {0, 10});
    if (value != std::floor(value))
      refuse(fmt::format("'{}': there is no such illumination model; give 0 to 10", statement_));
    materials_.back().illum = static_cast<int>(value);
  }

  /// Options come before the file, whose name may have blanks.
  void take_map(const MapStatement& map, std::string_view rest) {
    MtlMaterial& material = materials_.back();
    for (;;) {
      std::string_view after = rest;
      const std::string_view option = take_word(after);
      if (option.empty() || option[0] != '-' || !take_option(map, option, after)) break;
      rest = after;
    }
    std::string_view name = trimmed(rest);
    if (name.size() > 1 && name.front() == '"' && name.back() == '"') {
      name = name.substr(1, name.size() - 2);
    }
    if (name.empty())
      refuse(fmt::format("'{}' names no file; name one, or remove the line", statement_));
    material.*map.file = name;
  }

  /// Takes the values of an option off `rest`; false where it is none.
  bool take_option(const MapStatement& map, std::string_view option, std::string_view& rest) {
    struct Option {
      std::string_view name;
      int least, most;   ///< values
      double unchanged;  ///< of all of them; NaN: words, which change nothing here
    };
    constexpr double words = std::numeric_limits<double>::quiet_NaN();
    constexpr std::array options{
        Option{"-s", 1, 3, 1},          Option{"-o", 1, 3, 0},
        Option{"-t", 1, 3, 0},          Option{"-mm", 2, 2, 0},
        Option{"-bm", 1, 1, 1},         Option{"-boost", 1, 1, words},
        Option{"-blendu", 1, 1, words}, Option{"-blendv", 1, 1, words},
        Option{"-texres", 1, 1, words}, Option{"-clamp", 1, 1, words},
        Option{"-cc", 1, 1, words},     Option{"-imfchan", 1, 1, words},
    };
    const auto* found = std::find_if(options.begin(), options.end(), [&](const Option& each) {
      return each.name == lower(option);
    });
    if (found == options.end()) return false;
    std::vector<double> values;
    std::string_view value;
    for (int i = 0; i < found->most; ++i) {
      std::string_view after = rest;
      value = take_word(after);
      const bool is_number = found->unchanged == found->unchanged;
      const auto read = parse_signed(value);
      if (is_number && !read) {
        if (i >= found->least) break;  // the file
        refuse(fmt::format("'{}': {} needs {} numbers; correct the line", statement_, option,
                           found->least));
      }
      if (is_number) values.push_back(*read);
      rest = after;
    }
    if (found->name == "-mm") {
      if (values[0] != 0 || values[1] != 1) {
        refuse(fmt::format("'{}': -mm is not supported; change the picture, and remove -mm",
                           statement_));
      }
    } else if (found->name == "-bm") {
      if (map.keyword == "norm") materials_.back().norm_scale = values[0];
    } else if (std::any_of(values.begin(), values.end(),
                           [&](double each) { return each != found->unchanged; }) ||
               (found->name == "-clamp" && lower(value) == "on") ||
               (found->name == "-cc" && lower(value) == "on") || found->name == "-imfchan") {
      warn_of_material(fmt::format("{} of its {} is ignored", option, map.keyword));
    }
    return true;
  }

  const std::string& library_;
  reading::ImportContext& context_;
  std::size_t line_ = 0;
  std::string_view statement_;  ///< of that line
  std::vector<MtlMaterial> materials_;
  bool has_d_ = false;  ///< the last of them
};

}  // namespace

std::vector<MtlMaterial> read_mtl(const std::string& library, std::string text,
                                  reading::ImportContext& context) {
  join_continued_lines(text);
  return MtlReader(library, context).read(text);
}

}  // namespace photile::obj
