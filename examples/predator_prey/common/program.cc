#include "examples/predator_prey/common/program.h"

#include <poll.h>

#include <cerrno>
#include <cstdio>
#include <exception>
#include <system_error>
#include <vector>

namespace predator_prey {

void AddPort(CLI::App& app, const std::string& name, std::uint16_t& port, const std::string& help) {
  app.add_option(name, port, help)->required()->check(CLI::Range(1, 65535));
}

int RunProgram(CLI::App& app, int argc, char** argv, const std::function<void()>& body) {
  try {
    app.parse(argc, argv);
    body();
    return 0;
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help
    std::fprintf(stderr, "%s: %s\n", app.get_name().c_str(), error.what());
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", app.get_name().c_str(), error.what());
    return 1;
  }
}

void WaitForAny(std::initializer_list<int> fds) {
  std::vector<pollfd> waiting;
  for (const int fd : fds) waiting.push_back({.fd = fd, .events = POLLIN, .revents = 0});
  if (::poll(waiting.data(), waiting.size(), -1) < 0 && errno != EINTR) {
    throw std::system_error(errno, std::generic_category(), "cannot poll");
  }
}

}  // namespace predator_prey
