#include "command/command_line.hpp"
#include "common/touched_memory.hpp"

int main(int argument_count, char** arguments) {
  photile::keep_freed_memory();
  return photile::app::run_command_line(argument_count, arguments);
}
