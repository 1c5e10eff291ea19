#include "report/plan_drawing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <vector>

#include "common/foreign_text.hpp"
#include "report/plan_lines.hpp"
#include "report/tables.hpp"

namespace photile::report {
namespace {

// Sizes in pixels.
struct Sizes {
  double longer_side, legend_width, bar_width, least_height;
};
constexpr Sizes whole_sizes{0, 110, 22, 200}, small_sizes{190, 75, 14, 130};
constexpr double margin = 20, title_height = 48, foot_height = 40;
/// Beside and below a whole plan: two lines of dimensions.
constexpr double dimension_step = 16, dimensions_room = 2 * dimension_step + 6;
/// A whole plan has a scale of draughtsmen, the largest at which it fits on a page of A4 beside its
/// legend and below its figures.
constexpr double pixels_per_millimetre = 4, widest = 130, highest = 160;  // millimetres

/// N of 1:N for a drawing of so many metres.
double drawing_scale(double width, double height) {
  const double least = 1000 * std::max(width / widest, height / highest);
  return rounded_up(std::max(1.0, least), {1.0, 2.0, 2.5, 3.0, 4.0, 5.0, 7.5});
}

constexpr double title_baseline = 20, title_size = 14;
/// The width of a mean letter in ems, from which the fonts of screens differ little.
constexpr double letter_width = 0.6;
constexpr std::size_t most_numbered_cells = 400;

std::vector<float> illuminances(const measuring::LightValues& light) {
  std::vector<float> values;
  for (const Measured& sensor : light.sensors) values.push_back(static_cast<float>(sensor.value));
  return values;
}

/// One drawing under way.
class Plan {
 public:
  Plan(const measuring::GridValues& values, const measuring::LightValues& light,
       const FalseColour& options, PlanSize size, const PlanSurroundings& surroundings)
      : layout_(*values.grid.layout),
        options_(options),
        surroundings_(surroundings),
        small_(size == PlanSize::small),
        sizes_(small_ ? small_sizes : whole_sizes),
        values_(static_cast<std::size_t>(layout_.columns) * static_cast<std::size_t>(layout_.rows),
                std::numeric_limits<double>::quiet_NaN()),
        scale_(options, rounded_top(automatic_top(illuminances(light)), options.steps)) {
    for (std::size_t i = 0; i < layout_.cells.size(); ++i) {
      values_[layout_.cells[i]] = light.sensors[i].value;
    }
    for (const measuring::BlankPoint& blank : values.grid.blanks) {
      crosses_.push_back(layout_.in_cells(blank.sensor.position));
    }
    for (std::size_t i = 0; i < values.grid.marks.size(); ++i) {
      if (!values.grid.marks[i].empty()) crosses_.push_back(middle_of_cell(layout_.cells[i]));
    }
    const double around = 2 * surroundings.reach;
    const double u = glm::length(layout_.u) + around, v = glm::length(layout_.v) + around;
    drawn_at_ = small_ ? 0 : drawing_scale(u, v);
    per_metre_ =
        small_ ? sizes_.longer_side / std::max(u, v) : 1000 * pixels_per_millimetre / drawn_at_;
    left_ = small_ ? margin : margin + dimensions_room;
    numbered_ = !small_ && values_.size() <= most_numbered_cells;
    width_ = u * per_metre_;
    height_ = v * per_metre_;
    title_ = light.light.empty() ? values.grid.name
             : small_            ? light.light
                                 : values.grid.name + ": " + light.light;
    if (!small_) title_ += fmt::format(", 1:{:g}", drawn_at_);
  }

  std::string draw() {
    const double legend_height = std::max(height_, sizes_.least_height);
    const double title_width = letter_width * title_size * static_cast<double>(title_.size());
    const double width =
        left_ + std::max(width_ + margin + sizes_.legend_width, title_width + margin);
    const double height =
        title_height + legend_height + foot_height + (small_ ? 0 : dimensions_room);
    const double in_page = small_ ? 1 : 1 / pixels_per_millimetre;
    add("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:.0f} {1:.0f}\" "
        "width=\"{6:.10g}{7}\" "
        "height=\"{8:.10g}{7}\" font-family=\"sans-serif\" font-size=\"12\">\n"
        "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n"
        "<text x=\"{2}\" y=\"{3}\" font-size=\"{4}\">{5}</text>\n",
        width, height, margin, title_baseline, title_size, escaped_xml(title_),
        in_page * std::round(width), small_ ? "" : "mm", in_page * std::round(height));
    for (std::size_t cell = 0; cell < values_.size() && numbered_; ++cell) {
      if (!std::isnan(values_[cell])) numbers_.push_back(at(middle_of_cell(cell)));
    }
    if (options_.contours == Contours::bands) add_bands();  // below the cells' numbers
    add_cells();
    if (options_.contours == Contours::none || options_.contours == Contours::lines) add_isolines();
    add_surroundings();
    add_crosses();
    const glm::dvec2 low = at({0, 0}), high = at({layout_.columns, layout_.rows});
    add("<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" fill=\"none\" "
        "stroke=\"#000000\"/>\n",
        low.x, high.y, high.x - low.x, low.y - high.y);
    if (!small_) {
      add_coordinates();
      add_dimensions({0, 0}, {layout_.columns, layout_.rows}, 1);
      if (const auto& room = surroundings_.room) add_dimensions((*room)[0], (*room)[1], 2);
    }
    add_ruler(title_height + legend_height + 14 + (small_ ? 0 : dimensions_room));
    add_legend(left_ + width_ + margin, legend_height);
    add("</svg>\n");
    return std::move(text_);
  }

 private:
  template <class... T>
  void add(fmt::format_string<T...> format, T&&... values) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<T>(values)...);
  }

  /// Pixels of a position in cells.
  glm::dvec2 at(const glm::dvec2& cells) const {
    const glm::dvec2 metres(cells.x / layout_.columns * glm::length(layout_.u),
                            cells.y / layout_.rows * glm::length(layout_.v));
    return {left_ + (metres.x + surroundings_.reach) * per_metre_,
            title_height + height_ - (metres.y + surroundings_.reach) * per_metre_};
  }

  /// In cells.
  glm::dvec2 middle_of_cell(std::size_t cell) const {
    const auto columns = static_cast<std::size_t>(layout_.columns);
    return {static_cast<double>(cell % columns) + 0.5, static_cast<double>(cell / columns) + 0.5};
  }

  void add_cells() {
    const double w = glm::length(layout_.u) * per_metre_ / layout_.columns;
    const double h = glm::length(layout_.v) * per_metre_ / layout_.rows;
    for (std::size_t cell = 0; cell < values_.size(); ++cell) {
      if (std::isnan(values_[cell])) continue;
      const glm::dvec2 middle = middle_of_cell(cell);
      const glm::dvec2 corner = at(middle + glm::dvec2(-0.5, 0.5));
      if (is_filled()) {
        add("<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" fill=\"{}\" "
            "shape-rendering=\"crispEdges\"/>\n",
            corner.x, corner.y, w, h, scale_.hex(values_[cell]));
      }
      if (numbered_) add_label(at(middle), values_[cell], 9, "normal");
    }
  }

  /// Where points are not measured, or doubtful.
  void add_crosses() {
    if (crosses_.empty()) return;
    const double cell = glm::length(layout_.u) * per_metre_ / layout_.columns;
    const double arm = std::clamp(0.3 * cell, 1.5, 8.0);
    add("<path stroke=\"#000000\" stroke-width=\"{}\" fill=\"none\" class=\"crosses\" d=\"",
        small_ ? 0.6 : 1.0);
    for (const glm::dvec2& cross : crosses_) {
      const glm::dvec2 place = at(cross);
      add("M{0:.2f} {1:.2f}l{4:.2f} {4:.2f}M{0:.2f} {3:.2f}L{2:.2f} {1:.2f}", place.x - arm,
          place.y - arm, place.x + arm, place.y + arm, 2 * arm);
    }
    add("\"/>\n");
  }

  /// A number that is legible on any colour. Its pale border is a text of its own: programs that
  /// print do not all know paint-order.
  void add_label(const glm::dvec2& middle, double value, int size, const char* weight) {
    add("<text x=\"{0:.2f}\" y=\"{1:.2f}\" style=\"font-size:{2}px\" font-weight=\"{3}\" "
        "text-anchor=\"middle\" stroke=\"#ffffff\" stroke-width=\"2\" stroke-opacity=\"0.7\" "
        "fill=\"none\">{4}</text>\n"
        "<text x=\"{0:.2f}\" y=\"{1:.2f}\" font-size=\"{2}\" font-weight=\"{3}\" "
        "text-anchor=\"middle\">{4}</text>\n",
        middle.x, middle.y + 0.35 * size, size, weight, number_text(value, 3));
  }

  /// The value of a level at that of the positions which is farthest from other numbers, or far
  /// enough and nearest to the middle one. None where there is no room: the legend has it.
  void add_level(const std::vector<glm::dvec2>& places, double level) {
    if (small_) return;
    constexpr double far_enough = 30, too_near = 12;
    const auto room_at = [&](const glm::dvec2& place) {
      double room = far_enough;
      for (const glm::dvec2& number : numbers_) {
        room = std::min(room, glm::length(place - number));
      }
      return room;
    };
    const std::size_t middle = places.size() / 2;
    glm::dvec2 best = places[middle];
    double most = room_at(best);
    for (std::size_t away = 1; away <= middle; ++away) {
      for (const std::size_t i : {middle - away, std::min(middle + away, places.size() - 1)}) {
        const double room = room_at(places[i]);
        if (room <= most) continue;
        most = room;
        best = places[i];
      }
    }
    if (most < too_near) return;
    numbers_.push_back(best);
    add_label(best, level, 11, "bold");
  }

  static glm::dvec2 middle_of(const Polygon& polygon) {
    glm::dvec2 sum(0.0);
    for (const glm::dvec2& corner : polygon) sum += corner;
    return sum / static_cast<double>(polygon.size());
  }

  bool is_filled() const {
    return options_.contours == Contours::none || options_.contours == Contours::steps;
  }

  /// The levels of bands are numbered as isolines are.
  void add_bands() {
    const std::vector<double> levels = scale_.levels();
    const auto bands = scale_.bands();
    for (std::size_t i = 0; i < bands.size(); ++i) {
      const auto polygons =
          isoband(values_, layout_.columns, layout_.rows, bands[i][0], bands[i][1]);
      if (polygons.empty()) continue;
      const std::string colour = scale_.hex(levels[i]);
      // The thin stroke closes the seams between polygons.
      add("<path fill=\"{0}\" stroke=\"{0}\" stroke-width=\"0.3\" d=\"", colour);
      for (const Polygon& polygon : polygons) {
        for (std::size_t corner = 0; corner < polygon.size(); ++corner) {
          const glm::dvec2 place = at(polygon[corner]);
          add("{}{:.2f} {:.2f}", corner == 0 ? "M" : "L", place.x, place.y);
        }
        add("Z");
      }
      add("\"/>\n");
      std::vector<glm::dvec2> middles;
      for (const Polygon& polygon : polygons) middles.push_back(at(middle_of(polygon)));
      add_level(middles, levels[i]);
    }
  }

  /// A plan in colours has isolines at the steps of the standard; a plan of isolines alone has them
  /// as falsecolor does.
  std::vector<double> isoline_levels() const {
    if (options_.contours == Contours::lines) return scale_.levels();
    double low = std::numeric_limits<double>::infinity(), high = 0;
    for (const double value : values_) {
      if (std::isnan(value)) continue;
      low = std::min(low, value);
      high = std::max(high, value);
    }
    return illuminance_steps(low, high);
  }

  void add_isolines() {
    const FineValues fine = refined(values_, layout_.columns, layout_.rows);
    for (const double level : isoline_levels()) {
      auto segments = isoline(fine.values, fine.columns, fine.rows, level);
      for (auto& segment : segments) {
        for (glm::dvec2& end : segment) end = fine.in_cells(end);
      }
      if (segments.empty()) continue;
      const std::string colour =
          options_.contours == Contours::lines ? scale_.hex(level) : "#000000";
      add_segments(segments, colour.c_str(), 1.5);
      std::vector<glm::dvec2> middles;
      for (const auto& [a, b] : segments) middles.push_back(at(0.5 * (a + b)));
      add_level(middles, level);
    }
  }

  void add_segments(const std::vector<Segment>& segments, const char* colour, double width) {
    if (segments.empty()) return;
    add("<path fill=\"none\" stroke=\"{}\" stroke-width=\"{}\" d=\"", colour, width);
    for (const Segment& segment : segments) {
      const glm::dvec2 a = at(segment[0]), b = at(segment[1]);
      add("M{:.2f} {:.2f}L{:.2f} {:.2f}", a.x, a.y, b.x, b.y);
    }
    add("\"/>\n");
  }

  /// Lamps are circles with their numbers in the schedule.
  void add_surroundings() {
    add_segments(surroundings_.furniture, "#707070", 0.7);
    add_segments(surroundings_.walls, "#000000", small_ ? 1.0 : 2.0);
    if (small_) return;
    constexpr double radius = 7;
    for (const LampMark& lamp : surroundings_.lamps) {
      const glm::dvec2 place = at(lamp.place);
      add("<circle cx=\"{0:.2f}\" cy=\"{1:.2f}\" r=\"{2}\" fill=\"#ffffff\" stroke=\"#000000\"/>\n"
          "<text x=\"{0:.2f}\" y=\"{3:.2f}\" font-size=\"10\" text-anchor=\"middle\">{4}</text>\n",
          place.x, place.y, radius, place.y + 3, lamp.number);
    }
  }

  /// Writes the coordinates of two corners, in the scene's world.
  void add_coordinates() {
    const auto write = [&](const glm::dvec2& place, const char* anchor, const glm::dvec3& world) {
      add("<text x=\"{:.2f}\" y=\"{:.2f}\" font-size=\"8\" text-anchor=\"{}\">"
          "({:.2f}, {:.2f}, {:.2f}) m</text>\n",
          place.x, place.y, anchor, world.x, world.y, world.z);
    };
    const double outside = surroundings_.reach > 0 ? 11 : -4;
    write(at({0, 0}) + glm::dvec2(0, outside), "start", layout_.origin);
    write(at({layout_.columns, layout_.rows}) - glm::dvec2(0, 4), "end",
          layout_.origin + layout_.u + layout_.v);
  }

  /// Metres between two corners, below the plan and left of it, in the row `row` from it on.
  void add_dimensions(const glm::dvec2& low, const glm::dvec2& high, int row) {
    const glm::dvec2 a = at(low), b = at(high);
    constexpr double tick = 3;
    const double y = title_height + height_ + row * dimension_step;
    const double x = left_ - row * dimension_step;
    const double right = left_ + width_, top = title_height, bottom = title_height + height_;
    if (a.x < left_ - 1 || b.x > right + 1 || b.y < top - 1 || a.y > bottom + 1) return;  // beyond
    add("<path stroke=\"#000000\" stroke-width=\"0.7\" fill=\"none\" d=\""
        "M{0:.2f} {2:.2f}H{1:.2f}M{0:.2f} {3:.2f}v{4}M{1:.2f} {3:.2f}v{4}"
        "M{5:.2f} {6:.2f}V{7:.2f}M{8:.2f} {6:.2f}h{4}M{8:.2f} {7:.2f}h{4}\"/>\n",
        a.x, b.x, y, y - tick, 2 * tick, x, a.y, b.y, x - tick);
    add("<text x=\"{:.2f}\" y=\"{:.2f}\" font-size=\"10\" text-anchor=\"middle\">{:.2f}</text>\n",
        0.5 * (a.x + b.x), y - 2, (b.x - a.x) / per_metre_);
    add("<text x=\"{0:.2f}\" y=\"{1:.2f}\" font-size=\"10\" text-anchor=\"middle\" "
        "transform=\"rotate(-90 {0:.2f} {1:.2f})\">{2:.2f}</text>\n",
        x - 2, 0.5 * (a.y + b.y), (a.y - b.y) / per_metre_);
  }

  /// 1, 2 or 5 times a power of ten, a quarter of the plan's width at most.
  void add_ruler(double y) {
    const double most = width_ / per_metre_ / 4;
    const double power = std::pow(10, std::floor(std::log10(most)));
    const double metres = most >= 5 * power ? 5 * power : most >= 2 * power ? 2 * power : power;
    const double end = left_ + metres * per_metre_;
    add("<path stroke=\"#000000\" stroke-width=\"2\" d=\"M{0:.2f} {2:.2f}H{1:.2f}\"/>\n"
        "<text x=\"{3:.2f}\" y=\"{4:.2f}\">{5:g} m</text>\n",
        left_, end, y, end + 6, y + 4, metres);
  }

  void add_legend(double x, double height) {
    add("<text x=\"{:.2f}\" y=\"{}\">{}</text>\n", x, title_height - 7,
        escaped_xml(options_.label));
    const double step = height / options_.steps;
    for (int i = 0; i < options_.steps; ++i) {
      const double value = scale_.value_at((i + 0.5) / options_.steps);
      const double y = title_height + height - (i + 1) * step;
      add("<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{}\" height=\"{:.2f}\" fill=\"{}\"/>\n"
          "<text x=\"{:.2f}\" y=\"{:.2f}\">{}</text>\n",
          x, y, sizes_.bar_width, step, scale_.hex(value), x + sizes_.bar_width + 6,
          y + 0.5 * step + 4, number_text(value, 4));
    }
  }

  const measuring::PlaneLayout& layout_;
  const FalseColour& options_;
  const PlanSurroundings& surroundings_;
  const bool small_;
  const Sizes sizes_;
  std::vector<double> values_;  ///< per cell; NaN without a sensor
  ColourScale scale_;
  std::string title_, text_;
  double per_metre_ = 0, width_ = 0, height_ = 0, left_ = 0;  ///< pixels
  double drawn_at_ = 0;                                       ///< N of 1:N; 0 of a small plan
  bool numbered_ = false;                                     ///< whether cells have their values
  std::vector<glm::dvec2> crosses_;                           ///< in cells
  std::vector<glm::dvec2> numbers_;                           ///< positions of them, and of levels
};

}  // namespace

std::string plan_svg(const measuring::GridValues& values, const measuring::LightValues& light,
                     const FalseColour& options, PlanSize size,
                     const PlanSurroundings& surroundings) {
  return Plan(values, light, options, size, surroundings).draw();
}

}  // namespace photile::report
