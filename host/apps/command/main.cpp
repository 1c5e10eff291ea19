#include "command/command_line.hpp"

int main(int argument_count, char** arguments) {
  return photile::app::run_command_line(argument_count, arguments);
}
