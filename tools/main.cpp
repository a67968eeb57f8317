#include <iostream>

#include "tools/command.h"

int main(int argc, char** argv) {
  return ergon::run_command_line(std::vector<std::string>(argv + 1, argv + argc), std::cout, std::cerr);
}
