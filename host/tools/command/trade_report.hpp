// What `photile trade` writes and prints.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "tools/trade/trade.hpp"

namespace photile::app {

/// One object per rendering. Lengths in metres, times in seconds.
nlohmann::ordered_json trade_json(std::span<const TradePoint> points);

/// The same as one row per rendering, with a header; numbers with points as decimal signs.
std::string trade_csv(std::span<const TradePoint> points);

/// For errors of 10, 5, 2 and 1%: the fastest settings, their time and memory.
std::vector<std::string> trade_table(std::span<const TradePoint> points);

}  // namespace photile::app
