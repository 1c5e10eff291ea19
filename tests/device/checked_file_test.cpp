#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "device/kernel_store.hpp"
#include "file_bytes.hpp"
#include "temporary_folder.hpp"

namespace photile::test {
namespace {

namespace fs = std::filesystem;
using photile::device::CacheKey;
using photile::device::checked_file_header_bytes;
using photile::device::read_checked_file;
using photile::device::write_checked_file;

const CacheKey key = photile::device::hash("the key");
const std::string payload("binary \0 payload \xff", 18);

std::size_t files_in(const fs::path& folder) {
  return static_cast<std::size_t>(
      std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

}  // namespace

TEST_CASE("a checked file reads back, also an empty one, and leaves no temporary") {
  const TemporaryFolder folder;
  const auto file = folder.path / "entry";
  for (const std::string& text : {payload, std::string()}) {
    REQUIRE(write_checked_file(file, key, text).empty());
    const auto read = read_checked_file(file, key);
    REQUIRE(read.payload);
    CHECK(*read.payload == text);
    CHECK(files_in(folder.path) == 1);
  }
}

TEST_CASE("a missing checked file is a silent miss") {
  const TemporaryFolder folder;
  const auto read = read_checked_file(folder.path / "none", key);
  CHECK_FALSE(read.payload);
  CHECK(read.problem.empty());
}

TEST_CASE("every flipped bit of a checked file is a miss with a reason") {
  const TemporaryFolder folder;
  const auto file = folder.path / "entry";
  REQUIRE(write_checked_file(file, key, payload).empty());
  const auto good = bytes_of(file);
  REQUIRE(good.size() == checked_file_header_bytes + payload.size());
  for (std::size_t bit = 0; bit < good.size() * 8; ++bit) {
    auto bad = good;
    bad[bit / 8] = static_cast<char>(bad[bit / 8] ^ (1 << bit % 8));
    put(file, bad);
    const auto read = read_checked_file(file, key);
    INFO("bit " << bit);
    REQUIRE_FALSE(read.payload);
    REQUIRE_FALSE(read.problem.empty());
  }
}

TEST_CASE("every truncation of a checked file, and bytes beyond it, are a miss with a reason") {
  const TemporaryFolder folder;
  const auto file = folder.path / "entry";
  REQUIRE(write_checked_file(file, key, payload).empty());
  const auto good = bytes_of(file);
  for (std::size_t length = 0; length < good.size(); ++length) {
    put(file, good.substr(0, length));
    const auto read = read_checked_file(file, key);
    INFO("length " << length);
    REQUIRE_FALSE(read.payload);
    REQUIRE_FALSE(read.problem.empty());
  }
  put(file, good + "x");
  CHECK_FALSE(read_checked_file(file, key).payload);
}

TEST_CASE("a checked file of another key is a miss") {
  const TemporaryFolder folder;
  const auto file = folder.path / "entry";
  REQUIRE(write_checked_file(file, key, payload).empty());
  CHECK_FALSE(read_checked_file(file, photile::device::hash("another")).payload);
}

TEST_CASE("a folder or a FIFO in place of a checked file is a miss and does not hang") {
  const TemporaryFolder folder;
  fs::create_directory(folder.path / "folder");
  CHECK_FALSE(read_checked_file(folder.path / "folder", key).payload);
  REQUIRE(::mkfifo((folder.path / "fifo").c_str(), 0600) == 0);
  CHECK_FALSE(read_checked_file(folder.path / "fifo", key).payload);
}

TEST_CASE("a checked file that cannot be written says why and leaves nothing") {
  const TemporaryFolder folder;
  CHECK_FALSE(write_checked_file(folder.path / "no" / "entry", key, payload).empty());
  fs::create_directory(folder.path / "taken");
  put(folder.path / "taken" / "inside", "x");
  CHECK_FALSE(write_checked_file(folder.path / "taken", key, payload).empty());
  CHECK(files_in(folder.path) == 1);
}

}  // namespace photile::test
