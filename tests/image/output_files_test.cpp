#include <sys/stat.h>
#include <sys/wait.h>

#include <cstring>

#include "common/files.hpp"
#include "file_limits.hpp"
#include "flat_picture.hpp"
#include "held_to_permissions.hpp"
#include "picture_support.hpp"

namespace photile::test {

namespace fs = std::filesystem;

namespace {

Image noise(int width, int height) {
  Image image = flat_picture(width, height);
  std::mt19937 engine(3);
  std::uniform_real_distribution<float> value(0.0f, 1.0f);
  for (std::vector<float>& channel : image.channels) {
    for (float& pixel : channel) pixel = value(engine);
  }
  return image;
}

using Writer = void (*)(const fs::path&, const Image&);

std::string refusal(Writer write, const fs::path& file) {
  const std::string message = message_of<OutputError>([&] { write(file, noise(64, 64)); });
  CHECK(message.find(file.string()) != std::string::npos);
  return message;
}

}  // namespace

TEST_CASE("a device is refused as an output and stays the device it was") {
  for (const Writer write : {Writer{write_exr}, Writer{write_png}}) {
    CHECK(refusal(write, "/dev/full").find("not a regular file") != std::string::npos);
    struct stat status {};
    REQUIRE(::stat("/dev/full", &status) == 0);
    CHECK(S_ISCHR(status.st_mode));
  }
}

TEST_CASE("a file that is replaced keeps who may read it") {
  const TemporaryFolder folder;
  for (const mode_t mode : {mode_t{0600}, mode_t{0640}, mode_t{0444}, mode_t{0755}}) {
    write_file(folder / "a.txt", "old");
    fs::permissions(folder / "a.txt", fs::perms{mode});
    write_file(folder / "a.txt", "new");
    CHECK(fs::status(folder / "a.txt").permissions() == fs::perms{mode});
  }
}

TEST_CASE("a run removes what killed runs left in the folder, and nothing that is in use") {
  const TemporaryFolder folder;
  // Files that no process holds; the last two names are not of photile's.
  for (const char* name : {".photile.0123456789abcdef", ".photile.00000000ffffffff"}) {
    put(folder / name, "half");
  }
  for (const char* name : {".photile.0123456789abcdeg", ".photile.0123456789abcdef0",
                           "photile.0123456789abcdef", ".photile.7"}) {
    put(folder / name, "mine");
  }
  // A child that writes.
  int ready[2], done[2];
  REQUIRE(::pipe(ready) == 0);
  REQUIRE(::pipe(done) == 0);
  const pid_t child = ::fork();
  if (child == 0) {
    char byte = 0;
    try {
      OutputFile output(folder / "c.exr");
      output.write("whole", 5);
      if (::write(ready[1], "r", 1) != 1 || ::read(done[0], &byte, 1) != 1) ::_exit(2);
      output.commit();
    } catch (const std::exception&) {
      ::_exit(1);
    }
    ::_exit(0);
  }
  char byte = 0;
  REQUIRE(::read(ready[0], &byte, 1) == 1);
  write_exr(folder / "a.exr", noise(4, 4));
  CHECK_FALSE(fs::exists(folder / ".photile.0123456789abcdef"));
  CHECK_FALSE(fs::exists(folder / ".photile.00000000ffffffff"));
  CHECK(files_in(folder.path) == 6);  // a.exr, the child's and the four others
  REQUIRE(::write(done[1], "d", 1) == 1);
  int status = -1;
  REQUIRE(::waitpid(child, &status, 0) == child);
  CHECK(status == 0);
  CHECK(bytes_of(folder / "c.exr") == "whole");
  for (const int end : {ready[0], ready[1], done[0], done[1]}) ::close(end);
}

TEST_CASE("a name of the longest length is written") {
  const TemporaryFolder folder;
  const std::string longest = std::string(251, 'a') + ".exr";
  write_exr(folder / longest, noise(4, 4));
  CHECK(read_image(folder / longest).width == 4);
  CHECK_THAT(refusal(write_exr, folder / ("a" + longest)), Catch::Contains("shorter"));
}

TEST_CASE("temporary files of one output do not meet, whatever the process numbers are") {
  const TemporaryFolder folder;
  OutputFile first(folder / "a.txt"), second(folder / "a.txt");
  first.write("first", 5);
  second.write("second", 6);
  first.commit();
  CHECK(bytes_of(folder / "a.txt") == "first");
  second.commit();
  CHECK(bytes_of(folder / "a.txt") == "second");
}

TEST_CASE("a symbolic link to what does not exist is followed, or refused and kept") {
  const TemporaryFolder folder;
  fs::create_symlink("there.exr", folder / "to_file.exr");
  fs::create_symlink("nowhere/a.exr", folder / "to_nowhere.exr");
  write_exr(folder / "to_file.exr", noise(4, 4));
  CHECK(fs::is_symlink(folder / "to_file.exr"));
  CHECK(read_image(folder / "there.exr").width == 4);
  fs::create_symlink("to_itself.exr", folder / "to_itself.exr");
  for (const char* name : {"to_nowhere.exr", "to_itself.exr"}) {
    refusal(write_exr, folder / name);
    CHECK(fs::is_symlink(folder / name));
  }
}

TEST_CASE("a folder that is missing, is a file, or cannot be written is refused by name") {
  const TemporaryFolder folder;
  put(folder / "file", "x");
  for (const Writer write : {Writer{write_exr}, Writer{write_png}}) {
    refusal(write, folder / "missing/a.exr");
    refusal(write, folder / "file/a.exr");
    refusal(write, folder.path);          // a folder itself
    refusal(write, "/proc/photile.exr");  // not even root can
  }
  fs::create_directory(folder / "locked");
  REQUIRE(::chmod((folder / "locked").c_str(), 0555) == 0);
  const HeldToPermissions held;
  refusal(write_exr, folder / "locked/a.exr");
}

TEST_CASE("a write that runs out of space is an error, leaves no file and keeps an earlier one") {
  const TemporaryFolder folder;
  for (const Writer write : {Writer{write_exr}, Writer{write_png}}) {
    {
      const FileSizeLimit limit(4096);
      refusal(write, folder / "new");
    }
    CHECK(files_in(folder.path) == 0);
    write(folder / "kept", noise(8, 8));
    const std::string before = bytes_of(folder / "kept");
    {
      const FileSizeLimit limit(4096);
      const std::string message = refusal(write, folder / "kept");
      CHECK(message.find(std::strerror(EFBIG)) != std::string::npos);
    }
    CHECK(bytes_of(folder / "kept") == before);
    CHECK(files_in(folder.path) == 1);
    fs::remove(folder / "kept");
  }
}

TEST_CASE("every limit of the space gives an error or the whole file, nothing between") {
  const TemporaryFolder folder;
  const Image picture = noise(16, 16);
  write_exr(folder / "a.exr", picture);
  const std::string whole = bytes_of(folder / "a.exr");
  fs::remove(folder / "a.exr");
  for (std::size_t bytes = 0; bytes <= whole.size(); bytes += 97) {
    {
      const FileSizeLimit limit(bytes);
      CHECK_THROWS_AS(write_exr(folder / "a.exr", picture), OutputError);
    }
    CHECK(files_in(folder.path) == 0);
  }
  {
    const FileSizeLimit limit(whole.size());
    write_exr(folder / "a.exr", picture);
  }
  CHECK(bytes_of(folder / "a.exr") == whole);
}

TEST_CASE("a finished file replaces an earlier one, alone in its folder, and follows a link") {
  const TemporaryFolder folder;
  put(folder / "a.exr", "old");
  fs::create_symlink("a.exr", folder / "link.exr");
  write_exr(folder / "link.exr", noise(4, 4));
  CHECK(fs::is_symlink(folder / "link.exr"));
  CHECK(read_image(folder / "a.exr").width == 4);
  CHECK(files_in(folder.path) == 2);
}

TEST_CASE("a picture without pixels or without R, G, B cannot be written") {
  const TemporaryFolder folder;
  CHECK_THROWS_AS(write_exr(folder / "a.exr", Image{}), OutputError);
  CHECK_THROWS_AS(write_png(folder / "a.png", flat_picture(1, 1, 0, {"Y"})), OutputError);
  CHECK(files_in(folder.path) == 0);
}

}  // namespace photile::test
