// Numbers as people read them, at the borders between units.
#include <catch2/catch.hpp>
#include <limits>

#include "command/terminal_progress.hpp"

namespace photile::test {

using namespace app;

TEST_CASE("counts take a suffix from a thousand on") {
  CHECK(format_count(0) == "0");
  CHECK(format_count(999) == "999");
  CHECK(format_count(1000) == "1.0k");
  CHECK(format_count(999.4) == "999");
  CHECK(format_count(999.6) == "1.0k");
  CHECK(format_count(0.5) == "0.5");
  CHECK(format_count(999'960) == "1.0M");
  CHECK(format_count(1.94e6) == "1.9M");
  CHECK(format_count(2.5e9) == "2.5G");
}

TEST_CASE("bytes take binary units") {
  CHECK(format_bytes(0) == "0 B");
  CHECK(format_bytes(1023) == "1023 B");
  CHECK(format_bytes(1024) == "1.0 KiB");
  CHECK(format_bytes(3ull << 29) == "1.5 GiB");
}

TEST_CASE("seconds turn into minutes and hours") {
  CHECK(format_seconds(0.123) == "0.12 s");
  CHECK(format_seconds(9.999) == "10.0 s");
  CHECK(format_seconds(59.99) == "1 min 00 s");
  CHECK(format_seconds(125) == "2 min 05 s");
  CHECK(format_seconds(3720) == "1 h 02 min");
  CHECK(format_seconds(std::numeric_limits<double>::infinity()) == "?");
}

TEST_CASE("numbers of five digits and more are grouped, not powers of ten") {
  CHECK(format_number(0.58571, 4) == "0.5857");
  CHECK(format_number(9999, 4) == "9999");
  CHECK(format_number(11'990, 4) == "11,990");
  CHECK(format_number(-702'234.4, 4) == "-702,234");
  CHECK(format_number(1'000'000, 4) == "1,000,000");
  CHECK(format_number(1e12, 4) == "1e+12");
  CHECK(format_number(-1234.5, 4) == "-1234");
}

TEST_CASE("a power is given in its own unit first") {
  CHECK(format_power_in_both(683, PowerUnit::lumen, 683) == "683 lm (1 W)");
  CHECK(format_power_in_both(2, PowerUnit::watt, 179) == "2 W (358 lm)");
}

}  // namespace photile::test
