#include <catch2/catch.hpp>

#include "tools/trade/trade.hpp"

namespace photile::test {
namespace {

TradePoint point(double seconds, double relative_error) {
  TradePoint result;
  result.first_picture_seconds = seconds;
  result.error.relative_mse = relative_error * relative_error;
  return result;
}

}  // namespace

TEST_CASE("the front of a trade holds the points that no other beats in both") {
  std::vector<TradePoint> points{point(1, 0.10), point(2, 0.12), point(3, 0.05),
                                 point(3, 0.06), point(4, 0.05), point(0.5, 0.3)};
  mark_front(points);
  CHECK(points[0].on_front);
  CHECK_FALSE(points[1].on_front);  // slower and worse than the first
  CHECK(points[2].on_front);
  CHECK_FALSE(points[3].on_front);  // as fast as the third, and worse
  CHECK_FALSE(points[4].on_front);  // as right as the third, and slower
  CHECK(points[5].on_front);        // the fastest of all
}

TEST_CASE("the fastest settings within an error are found, or none") {
  const std::vector<TradePoint> points{point(1, 0.10), point(3, 0.05), point(2, 0.07)};
  CHECK(fastest_within(points, 0.5) == &points[0]);
  CHECK(fastest_within(points, 0.08) == &points[2]);
  CHECK(fastest_within(points, 0.05) == &points[1]);
  CHECK(fastest_within(points, 0.04) == nullptr);
}

}  // namespace photile::test
