// tcs-dds-gateway: carries the scenario's DDS topics to programs whose DDS uses sockets, and their
// commands back. tcsim starts it, as a client of the run on an ideal robot (gateway_robot.h).
//
//   tcs-dds-gateway humble|iron USER_DATA END...
//
// USER_DATA is that of the endpoint that announces nodes; an END is of served_end.h. One process of
// the gateway meets the simulation in shared memory, as any DDS program of a run. Its child meets
// the programs by sockets: tcsim has children of the gateway use these
// (processes/thread_creation.cc). Between the two processes is a stream of samples. Both processes
// are killed at the run's end.
#include <dds/ddsrt/log.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#include <string>
#include <vector>

#include "coordinator/gateway/frames.h"
#include "coordinator/gateway/half.h"
#include "coordinator/gateway/ros_graph.h"
#include "coordinator/gateway/served_end.h"
#include "coordinator/port/unique_fd.h"

namespace {

using tcs::gateway::Side;

constexpr int kEndsFrom = 3;

// What Cyclone says of interfaces and the like is not for the user of tcsim.
void SaysNothing(void*, const dds_log_data_t*) {}

std::vector<tcs::gateway::ServedEnd> EndsIn(int argc, char** argv) {
  std::vector<tcs::gateway::ServedEnd> ends;
  for (int i = kEndsFrom; i < argc; ++i) {
    if (auto end = tcs::gateway::FromText(argv[i])) {
      ends.push_back(*std::move(end));
    } else {
      fprintf(stderr, "tcs-dds-gateway: '%s' is no topic; tcsim is to start it\n", argv[i]);
      _Exit(1);
    }
  }
  return ends;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc <= kEndsFrom) {
    fprintf(stderr, "tcs-dds-gateway is a part of tcsim, which starts it\n");
    return 1;
  }
  const auto ends = EndsIn(argc, argv);
  int stream[2];
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, stream) != 0) {
    perror("tcs-dds-gateway: socketpair");
    return 1;
  }
  dds_set_log_sink(SaysNothing, nullptr);
  const pid_t child = fork();
  if (child < 0) {
    perror("tcs-dds-gateway: fork");
    return 1;
  }
  const Side side = child == 0 ? Side::kPrograms : Side::kSimulation;
  const int own = child == 0 ? 1 : 0;
  const tcs::UniqueFd keeps(stream[own]);
  tcs::UniqueFd(stream[1 - own]).Reset();
  tcs::gateway::Frames frames(keeps.get());
  tcs::gateway::Half half(side, ends, frames);
  if (side == Side::kPrograms) {
    tcs::gateway::AnnounceNodes(half, strcmp(argv[1], "humble") == 0,
                                strcmp(argv[2], "-") == 0 ? "" : argv[2]);
  }
  while (const auto frame = frames.Receive()) half.Write(*frame);
  // The other process has ended, which it does only with the run, or because of an error.
  _Exit(1);
}
