#include "command_run.hpp"

#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <sstream>
#include <stdexcept>

#include "command/command_line.hpp"

namespace photile::test {
namespace {

/// What is written to a descriptor while this lives.
class Captured {
 public:
  explicit Captured(int descriptor) : descriptor_(descriptor), before_(::dup(descriptor)) {
    if (file_ == nullptr || before_ < 0 || ::dup2(::fileno(file_), descriptor) < 0) {
      throw std::runtime_error("cannot capture what the command prints");
    }
  }
  ~Captured() {
    ::dup2(before_, descriptor_);
    ::close(before_);
    std::fclose(file_);
  }
  Captured(const Captured&) = delete;
  Captured& operator=(const Captured&) = delete;

  std::string text() const {
    std::string all;
    char bytes[4096];
    std::rewind(file_);
    while (const std::size_t count = std::fread(bytes, 1, sizeof bytes, file_)) {
      all.append(bytes, count);
    }
    return all;
  }

 private:
  int descriptor_, before_;
  std::FILE* file_ = std::tmpfile();
};

}  // namespace

std::vector<std::string> CommandRun::error_lines() const {
  std::vector<std::string> lines;
  std::istringstream stream(errors);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

CommandRun run_command(const std::vector<std::string>& arguments) {
  ::setenv("XDG_CACHE_HOME", PHOTILE_TEST_CACHE, 1);
  std::vector<const char*> pointers{"photile"};
  for (const std::string& argument : arguments) pointers.push_back(argument.c_str());
  CommandRun run;
  std::cout.flush();
  std::fflush(nullptr);
  const Captured output(STDOUT_FILENO), errors(STDERR_FILENO);
  run.exit_code = app::run_command_line(static_cast<int>(pointers.size()), pointers.data());
  std::cout.flush();
  std::fflush(nullptr);
  run.output = output.text();
  run.errors = errors.text();
  return run;
}

}  // namespace photile::test
