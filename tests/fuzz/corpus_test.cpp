// The corpus that fuzzing has gathered, and every input that was once a finding, read once.
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "targets.hpp"

namespace photile::test {
namespace {

constexpr long most_kilobytes = 256 << 10;  ///< that a file may take

/// The most address space that the process has had: memory counts that is asked for and not
/// touched.
long peak_kilobytes() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with("VmPeak:")) return std::stol(line.substr(7));
  }
  return 0;
}

}  // namespace

TEST_CASE("readers take or refuse every file of the corpus, in a line") {
  for (const auto& [name, target] : fuzz_targets()) {
    int accepted = 0, refused = 0;
    for (const auto& entry :
         std::filesystem::directory_iterator(std::filesystem::path(PHOTILE_CORPUS) / name)) {
      std::ifstream stream(entry.path(), std::ios::binary);
      const std::vector<char> bytes{std::istreambuf_iterator<char>(stream),
                                    std::istreambuf_iterator<char>()};
      CAPTURE(entry.path());
      bool taken = false;
      const long before = peak_kilobytes();
      CHECK_NOTHROW(
          taken = target({reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()}));
      ++(taken ? accepted : refused);
      CHECK(peak_kilobytes() - before < most_kilobytes);
    }
    CAPTURE(name);
    CHECK(accepted > 0);
    CHECK(refused > 0);
  }
}

}  // namespace photile::test
