// The corpus that fuzzing has gathered, and every input that was once a finding, read once.
#include <malloc.h>

#include <catch2/catch.hpp>
#include <vector>

#include "file_bytes.hpp"
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

/// Inputs that a reader took and refused.
struct Verdicts {
  int accepted = 0, refused = 0;
  int inputs() const { return accepted + refused; }
};

/// Gives every file of a folder to the reader.
void read_folder(const std::filesystem::path& folder, FuzzTarget target, Verdicts& verdicts) {
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string bytes = bytes_of(entry.path());
    CAPTURE(entry.path());
    bool taken = false;
    const long before = peak_kilobytes();
    CHECK_NOTHROW(taken =
                      target({reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()}));
    ++(taken ? verdicts.accepted : verdicts.refused);
    CHECK(peak_kilobytes() - before < most_kilobytes);
  }
}

/// The number of inputs in each target's archive, as minimise.sh wrote it.
std::map<std::string, int> archived_inputs() {
  std::ifstream stream(std::filesystem::path(PHOTILE_FUZZ_FOLDER) / "archived_inputs.txt");
  std::map<std::string, int> counts;
  std::string target;
  for (int count = 0; stream >> target >> count;) counts[target] = count;
  return counts;
}

}  // namespace

TEST_CASE("readers take or refuse every file of the corpus, in a line") {
  // Any picture loads OpenImageIO, whose libraries are no memory of a file.
  const std::vector<unsigned char> gif{'G', 'I', 'F', '8', '9', 'a', 1, 0, 1, 0};
  fuzz_targets().at("texture")(gif);
  // Each thread's first allocation would otherwise reserve 128 MB of addresses for itself,
  // whichever input is being read. AddressSanitizer's allocator refuses this setting.
  ::mallopt(M_ARENA_MAX, 1);
  const std::map<std::string, int> archived = archived_inputs();
  CHECK(archived.size() == fuzz_targets().size());
  for (const auto& [name, target] : fuzz_targets()) {
    CAPTURE(name);
    Verdicts verdicts;
    read_folder(std::filesystem::path(PHOTILE_UNPACKED_CORPUS) / name, target, verdicts);
    CHECK(verdicts.inputs() == archived.at(std::string(name)));
    // Seeds and findings, which have names.
    read_folder(std::filesystem::path(PHOTILE_FUZZ_FOLDER) / "corpus" / name, target, verdicts);
    CHECK(verdicts.inputs() > archived.at(std::string(name)));
    CHECK(verdicts.accepted > 0);
    CHECK(verdicts.refused > 0);
  }
}

}  // namespace photile::test
