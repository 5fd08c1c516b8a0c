// NAME send WHERE COUNT, NAME receive WHERE COUNT: the latter says each message's number, and how
// many ns it took.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "tests/middleware/talk.h"

namespace {

// The receiver is there by then; so is the connection; and what is last sent is gone before the
// sender ends.
constexpr useconds_t kBeforeUs = 500'000, kConnectsUs = 300'000, kBetweenUs = 10'000,
                     kAfterUs = 200'000;

std::int64_t NowNs() {
  timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
  return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

}  // namespace

void talk::Fail(const char* what, const char* why) {
  fprintf(stderr, "%s: %s\n", what, why);
  exit(1);
}

int main(int argc, char** argv) {
  if (argc != 4) talk::Fail(argv[0], "send|receive WHERE COUNT");
  const std::int64_t count = atol(argv[3]);
  std::int64_t done = 0;
  if (strcmp(argv[1], "send") == 0) {
    usleep(kBeforeUs);
    talk::Send(argv[2], [&](talk::Message* message) {
      usleep(done == 0 ? kConnectsUs : done == count ? kAfterUs : kBetweenUs);
      *message = {done, NowNs()};
      return done++ < count;
    });
    return 0;
  }
  talk::Receive(argv[2], [&](const talk::Message& message) {
    printf("%ld %ld\n", static_cast<long>(message.number),
           static_cast<long>(NowNs() - message.sent_ns));
    return ++done < count;
  });
  return 0;
}
