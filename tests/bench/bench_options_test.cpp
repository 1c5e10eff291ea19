// What every bench understands.
#include <catch2/catch.hpp>

#include "support/bench_record.hpp"

namespace photile::test {

using namespace photile::bench;

TEST_CASE("a quick bench repeats once, or as often as it is told") {
  const auto [arguments, repeats] = GENERATE(table<std::string, int>(
      {{"--quick", 1}, {"--quick --repeats 3", 3}, {"--repeats 3 --quick", 3}, {"", 5}}));
  INFO(arguments);
  BenchOptions options;
  CLI::App command;
  add_options(command, options);
  command.parse(arguments);
  CHECK(options.repeats.most == repeats);
}

}  // namespace photile::test
