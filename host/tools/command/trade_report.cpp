#include "tools/command/trade_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "tools/command/number_format.hpp"
#include "tools/command/setting_options.hpp"

namespace photile::app {
namespace {

constexpr std::array wanted_errors{0.10, 0.05, 0.02, 0.01};

const TradePoint* most_right(std::span<const TradePoint> points) {
  const auto least =
      std::min_element(points.begin(), points.end(), [](const TradePoint& a, const TradePoint& b) {
        return a.error.relative_mse < b.error.relative_mse;
      });
  return least == points.end() ? nullptr : &*least;
}

std::string trade_row(const std::string& error, const std::string& first, const std::string& frame,
                      const std::string& memory, const std::string& settings) {
  return fmt::format("{:>6}{:>15}{:>13}{:>12}  {}", error, first, frame, memory, settings);
}

std::string point_row(const std::string& error, const TradePoint& point) {
  return trade_row(error, format_seconds(point.first_picture_seconds),
                   fmt::format("{:.0f} ms", 1e3 * point.frame_seconds),
                   format_bytes(point.host_bytes + point.device_bytes),
                   options_text(point.parameters));
}

}  // namespace

nlohmann::ordered_json trade_json(std::span<const TradePoint> points) {
  auto list = nlohmann::ordered_json::array();
  for (const TradePoint& p : points) {
    nlohmann::ordered_json row{{"varied", p.varied}};
    row.update(settings_json(p.used, true));
    row.update({{"photons_stored", p.stored_photons},
                {"relative_error", p.error.relative_error()},
                {"relative_mse", p.error.relative_mse},
                {"mean_ratio", p.error.mean_ratio},
                {"worst_region", p.error.worst_region},
                {"psnr", p.error.psnr},
                {"first_picture_seconds", p.first_picture_seconds},
                {"frame_seconds", p.frame_seconds},
                {"host_bytes", p.host_bytes},
                {"device_bytes", p.device_bytes},
                {"on_front", p.on_front}});
    list.push_back(std::move(row));
  }
  return list;
}

std::string trade_csv(std::span<const TradePoint> points) {
  std::string header, rows;
  for (const auto& point : trade_json(points)) {
    std::string row;
    header.clear();
    for (const auto& [name, value] : point.items()) {
      const char* comma = header.empty() ? "" : ",";
      header += fmt::format("{}{}", comma, name);
      row +=
          fmt::format("{}{}", comma, value.is_string() ? value.get<std::string>() : value.dump());
    }
    rows += row + "\n";
  }
  return header + "\n" + rows;
}

std::vector<std::string> trade_table(std::span<const TradePoint> points) {
  std::vector<std::string> lines{
      trade_row("error", "first picture", "each frame", "memory", "fastest settings")};
  for (const double wanted : wanted_errors) {
    const TradePoint* fastest = fastest_within(points, wanted);
    const std::string error = fmt::format("{:.0f}%", 100 * wanted);
    lines.push_back(fastest ? point_row(error, *fastest)
                            : trade_row(error, "-", "-", "-", "none of those tried"));
  }
  if (const TradePoint* best = most_right(points)) {
    lines.push_back(point_row(fmt::format("{:.1f}%", 100 * best->error.relative_error()), *best) +
                    "  (least error)");
  }
  return lines;
}

}  // namespace photile::app
