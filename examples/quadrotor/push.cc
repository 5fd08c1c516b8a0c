// Not the quadrotor's: somebody who pushes it, once, for a while.
//
//   push NAME AT FOR X Y Z     seconds, seconds, newtons in the world
//   out  NAME/push             {"force": [x, y, z]}
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <string>

#include "examples/common/datagrams.h"

int main(int argc, char** argv) {
  if (argc != 7) {
    std::fprintf(stderr, "usage: push NAME AT FOR X Y Z\n");
    return 2;
  }
  const auto number = [&](int i) { return std::atof(argv[i]); };
  const auto sleep = [](double seconds) { ::usleep(static_cast<useconds_t>(1e6 * seconds)); };
  const std::string to = std::string(argv[1]) + "/push";
  examples::Socket socket;
  sleep(number(2));
  socket.Send(to, {{"force", {number(4), number(5), number(6)}}});
  sleep(number(3));
  socket.Send(to, {{"force", {0, 0, 0}}});
}
