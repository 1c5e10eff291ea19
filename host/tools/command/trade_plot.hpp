// The trade between time and error as a picture.
#pragma once

#include <span>
#include <string>

#include "tools/trade/trade.hpp"

namespace photile::app {

/// An SVG of relative error against time, both logarithmic: on the left to the first picture, with
/// the front of the points that no other beats; on the right of each further frame.
std::string trade_plot(std::span<const TradePoint> points, const std::string& title);

}  // namespace photile::app
