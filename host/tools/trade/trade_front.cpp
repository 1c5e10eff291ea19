#include <algorithm>
#include <limits>

#include "tools/trade/trade.hpp"

namespace photile {

void mark_front(std::span<TradePoint> points) {
  std::vector<TradePoint*> by_time;
  for (TradePoint& point : points) by_time.push_back(&point);
  std::sort(by_time.begin(), by_time.end(), [](const TradePoint* a, const TradePoint* b) {
    return a->first_picture_seconds != b->first_picture_seconds
               ? a->first_picture_seconds < b->first_picture_seconds
               : a->error.relative_mse < b->error.relative_mse;
  });
  double least = std::numeric_limits<double>::infinity();
  for (TradePoint* point : by_time) {
    point->on_front = point->error.relative_mse < least;
    if (point->on_front) least = point->error.relative_mse;
  }
}

const TradePoint* fastest_within(std::span<const TradePoint> points, double error) {
  const TradePoint* fastest = nullptr;
  for (const TradePoint& point : points) {
    if (!(point.error.relative_error() <= error)) continue;
    if (!fastest || point.first_picture_seconds < fastest->first_picture_seconds) {
      fastest = &point;
    }
  }
  return fastest;
}

}  // namespace photile
