// in_own_network COMMAND...: runs COMMAND where it meets no other DDS program of this machine.
#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "coordinator/os/own_network.h"

int main(int argc, char** argv) {
  if (argc < 2) return 2;
  // Where that is not allowed, the domain of its own that each test has must do.
  if (tcs::WhyNoOwnNetwork().empty()) {
    if (const std::string error = tcs::EnterOwnNetwork(); !error.empty()) {
      fprintf(stderr, "in_own_network: %s\n", error.c_str());
      return 1;
    }
  }
  execvp(argv[1], argv + 1);
  fprintf(stderr, "in_own_network: %s: %s\n", argv[1], strerror(errno));
  return 127;
}
