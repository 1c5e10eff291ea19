#include "tools/command/trade_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "common/xml_text.hpp"

namespace photile::app {
namespace {

// Sizes in pixels.
constexpr double panel_width = 420, panel_height = 360, margin_left = 60, margin_top = 50,
                 margin_bottom = 50, gap = 80, legend_width = 190;

struct Series {
  const char* varied;
  const char* colour;  ///< of Okabe and Ito, told apart by all eyes
};
constexpr std::array series{Series{"photons and neighbours", "#0072b2"},
                            Series{"nothing", "#000000"},
                            Series{"own neighbours", "#b8a000"},
                            Series{"samples", "#e69f00"},
                            Series{"radius", "#009e73"},
                            Series{"angle", "#cc79a7"},
                            Series{"cell", "#56b4e9"},
                            Series{"area", "#882255"},
                            Series{"kernel", "#332288"},
                            Series{"direct rays", "#aa4499"},
                            Series{"final gather", "#117733"},
                            Series{"maps", "#d55e00"},
                            Series{"structure", "#999999"}};

const char* colour_of(const std::string& varied) {
  for (const Series& entry : series) {
    if (varied == entry.varied) return entry.colour;
  }
  return "#000000";
}

/// A logarithmic axis of whole decades around its values, on [begin, end] pixels.
class Axis {
 public:
  Axis(const std::vector<double>& values, double begin, double end) : begin_(begin), end_(end) {
    double least = std::numeric_limits<double>::infinity(), most = 0;
    for (const double value : values) {
      if (!(value > 0) || !std::isfinite(value)) continue;
      least = std::min(least, value);
      most = std::max(most, value);
    }
    if (most == 0) least = most = 1;
    first_ = static_cast<int>(std::floor(std::log10(least) - 1e-9));
    last_ = std::max(first_ + 1, static_cast<int>(std::ceil(std::log10(most) + 1e-9)));
  }

  double at(double value) const {
    const double share = (std::log10(std::max(value, 1e-30)) - first_) / (last_ - first_);
    return begin_ + std::clamp(share, 0.0, 1.0) * (end_ - begin_);
  }
  int first() const { return first_; }  ///< decade
  int last() const { return last_; }

 private:
  double begin_, end_;
  int first_ = 0, last_ = 1;
};

std::string text(double x, double y, const std::string& content, const char* anchor = "middle") {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n", x, y, anchor,
                     escaped_xml(content));
}

std::string line(double x1, double y1, double x2, double y2, const char* colour) {
  return fmt::format(
      "<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"{}\"/>\n", x1, y1, x2,
      y2, colour);
}

std::string seconds_label(int decade) {
  return decade < 0 ? fmt::format("{:.3g} ms", 1e3 * std::pow(10, decade))
                    : fmt::format("{:.3g} s", std::pow(10, decade));
}

struct Panel {
  std::string title;
  double TradePoint::*seconds;
  bool with_front;
};

std::string grid(const Axis& time, const Axis& error, double left, double top) {
  std::string svg;
  for (int decade = time.first(); decade <= time.last(); ++decade) {
    const double x = time.at(std::pow(10, decade));
    svg += line(x, top, x, top + panel_height, "#dddddd");
    svg += text(x, top + panel_height + 18, seconds_label(decade));
  }
  for (int decade = error.first(); decade <= error.last(); ++decade) {
    for (const int step : {1, 2, 5}) {
      const double value = step * std::pow(10, decade);
      if (decade == error.last() && step > 1) continue;
      const double y = error.at(value);
      svg += line(left, y, left + panel_width, y, step == 1 ? "#dddddd" : "#f0f0f0");
      svg += text(left - 6, y + 4, fmt::format("{:.3g}%", 100 * value), "end");
    }
  }
  return svg;
}

std::string front(std::span<const TradePoint> points, const Panel& panel, const Axis& time,
                  const Axis& error) {
  std::vector<const TradePoint*> on_front;
  for (const TradePoint& point : points) {
    if (point.on_front) on_front.push_back(&point);
  }
  std::sort(on_front.begin(), on_front.end(), [&](const TradePoint* a, const TradePoint* b) {
    return a->*panel.seconds < b->*panel.seconds;
  });
  std::string path;
  for (const TradePoint* point : on_front) {
    path += fmt::format("{:.1f},{:.1f} ", time.at(point->*panel.seconds),
                        error.at(point->error.relative_error()));
  }
  return fmt::format("<polyline points=\"{}\" fill=\"none\" stroke=\"#0072b2\"/>\n", path);
}

std::string panel_svg(std::span<const TradePoint> points, const Panel& panel, double left) {
  std::vector<double> times, errors;
  for (const TradePoint& point : points) {
    times.push_back(point.*panel.seconds);
    errors.push_back(point.error.relative_error());
  }
  const Axis time(times, left, left + panel_width);
  const Axis error(errors, margin_top + panel_height, margin_top);
  std::string svg = grid(time, error, left, margin_top);
  svg += text(left + panel_width / 2, margin_top - 10, panel.title);
  if (panel.with_front) svg += front(points, panel, time, error);
  for (const TradePoint& point : points) {
    svg += fmt::format(
        "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\" fill=\"{}\"><title>{}</title></circle>\n",
        time.at(point.*panel.seconds), error.at(point.error.relative_error()),
        point.on_front ? 5 : 3.5, colour_of(point.varied),
        escaped_xml(fmt::format(
            "{}: {} photons, k {}, {} samples: {:.2f}%", point.varied,
            point.parameters.photons.emitted_photons, point.parameters.neighbours,
            point.parameters.film.samples_per_pixel, 100 * point.error.relative_error())));
  }
  return svg;
}

std::string legend(double left) {
  std::string svg = text(left, margin_top + 4, "varied", "start");
  double y = margin_top + 24;
  for (const Series& entry : series) {
    svg += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4\" fill=\"{}\"/>\n", left + 4,
                       y - 4, entry.colour);
    svg += text(left + 16, y, entry.varied, "start");
    y += 20;
  }
  return svg + text(left, y + 10, "line: no other is", "start") +
         text(left, y + 26, "faster and more right", "start");
}

}  // namespace

std::string trade_plot(std::span<const TradePoint> points, const std::string& title) {
  const double second = margin_left + panel_width + gap;
  const double width = second + panel_width + 20 + legend_width;
  const double height = margin_top + panel_height + margin_bottom;
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} "
      "{1}\" font-family=\"sans-serif\" font-size=\"12\">\n"
      "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n",
      width, height);
  svg += text(width / 2, 20, title + ": root mean square relative error against time");
  svg += panel_svg(points, {"time to the first picture", &TradePoint::first_picture_seconds, true},
                   margin_left);
  svg +=
      panel_svg(points, {"time of each further frame", &TradePoint::frame_seconds, false}, second);
  svg += legend(second + panel_width + 20);
  return svg + "</svg>\n";
}

}  // namespace photile::app
