// Counts and sizes as typed.
#include "command/validators.hpp"

#include <catch2/catch.hpp>
#include <limits>

namespace photile::test {

using namespace app;

TEST_CASE("counts are read with exponents and suffixes") {
  CHECK(parse_count("0") == 0u);
  CHECK(parse_count("500000") == 500'000u);
  CHECK(parse_count("1e6") == 1'000'000u);
  CHECK(parse_count("4M") == 4'000'000u);
  CHECK(parse_count("1.1M") == 1'100'000u);
  CHECK(parse_count("200k") == 200'000u);
  CHECK(parse_count("2G") == 2'000'000'000u);
}

TEST_CASE("counts of 64 bits keep every digit") {
  CHECK(parse_count("18446744073709551615") == std::numeric_limits<std::uint64_t>::max());
  CHECK(parse_count("9007199254740993") == 9'007'199'254'740'993u);
}

TEST_CASE("what is no whole number is no count") {
  const std::string text = GENERATE("", "k", "-1", "1.5", "1e-3", "nan", "inf", "1e30", "12x",
                                    " 12", "0x10", "1kk", "18446744073709551616");
  INFO(text);
  CHECK_FALSE(parse_count(text).has_value());
}

TEST_CASE("sizes are read as width x height") {
  const auto size = parse_size("640x480");
  REQUIRE(size.has_value());
  CHECK(size->width == 640);
  CHECK(size->height == 480);
}

TEST_CASE("what is no size is none") {
  const std::string text = GENERATE("", "x", "640", "640x", "x480", "6.4x3", "1x2x3", "640X480");
  INFO(text);
  CHECK_FALSE(parse_size(text).has_value());
}

TEST_CASE("shares are read as percentages and as numbers") {
  CHECK(*parse_share("2%") == Approx(0.02));
  CHECK(*parse_share("0.02") == Approx(0.02));
  CHECK(*parse_share("12.5%") == Approx(0.125));
  const std::string text = GENERATE("", "%", "0", "0%", "-1%", "nan", "inf%", "2 %", "2%%");
  INFO(text);
  CHECK_FALSE(parse_share(text).has_value());
}

TEST_CASE("times are read with their units") {
  CHECK(*parse_duration("33ms") == Approx(0.033));
  CHECK(*parse_duration("1.5s") == Approx(1.5));
  CHECK(*parse_duration("2min") == Approx(120));
  const std::string text = GENERATE("", "s", "33", "-1s", "0ms", "nan s", "1h", "1s1");
  INFO(text);
  CHECK_FALSE(parse_duration(text).has_value());
}

}  // namespace photile::test
