// A DDS program that forks, then executes itself, and in the end, from a thread that has outlived
// the first one, a program that does not speak DDS; and a reader of what it writes: the numbers
// from 1 to 150, of which the child of the fork has none to say.
//
//   changing_speaker read | write | write_rest
#include <pthread.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "dds/dds.h"
#include "rosgraph_msgs.h"
#include "tests/programs/dds_program.h"

namespace {

using Clock = rosgraph_msgs_msg_dds__Clock_;

constexpr int kLast = 150;

struct Ends {
  dds_entity_t participant, topic;
  dds_qos_t* qos;
};

Ends Begin() {
  Ends ends{};
  ends.participant = OrDie(dds_create_participant(0, nullptr, nullptr), "make a participant");
  ends.qos = dds_create_qos();
  dds_qset_reliability(ends.qos, DDS_RELIABILITY_RELIABLE, DDS_INFINITY);
  dds_qset_history(ends.qos, DDS_HISTORY_KEEP_ALL, 0);
  ends.topic = OrDie(dds_create_topic(ends.participant, &rosgraph_msgs_msg_dds__Clock__desc,
                                      "rt/numbers", nullptr, nullptr),
                     "make a topic");
  return ends;
}

dds_entity_t WriterThatIsRead(const Ends& ends) {
  const dds_entity_t writer =
      OrDie(dds_create_writer(ends.participant, ends.topic, ends.qos, nullptr), "make a writer");
  dds_publication_matched_status_t matched{};
  while (matched.current_count == 0) {
    dds_sleepfor(DDS_MSECS(1));
    OrDie(dds_get_publication_matched_status(writer, &matched), "look for readers");
  }
  return writer;
}

void Write(dds_entity_t writer, int from, int to) {
  for (int number = from; number <= to; ++number) {
    Clock clock{};
    clock.clock.sec = number;
    OrDie(dds_write(writer, &clock), "write");
  }
}

int Read() {
  const Ends ends = Begin();
  const dds_entity_t reader =
      OrDie(dds_create_reader(ends.participant, ends.topic, ends.qos, nullptr), "make a reader");
  for (int expected = 1; expected <= kLast;) {
    Clock clock{};
    void* sample = &clock;
    dds_sample_info_t info;
    const dds_return_t count = OrDie(dds_take(reader, &sample, &info, 1, 1), "take");
    if (count == 0) {
      dds_sleepfor(DDS_MSECS(1));
    } else if (info.valid_data && clock.clock.sec != expected++) {
      fprintf(stderr, "%d where %d was to come\n", clock.clock.sec, expected - 1);
      return 1;
    }
  }
  puts("all numbers");
  // Longer than the lease, and not as long as the program that the writer's process has become.
  for (int i = 0; i < 30; ++i) {
    dds_subscription_matched_status_t matched{};
    OrDie(dds_get_subscription_matched_status(reader, &matched), "look for writers");
    if (matched.current_count == 0) {
      puts("nobody writes");
      return 0;
    }
    dds_sleepfor(DDS_SECS(1));
  }
  return 1;
}

void* SleepInstead(void* first) {
  pthread_join(*static_cast<pthread_t*>(first), nullptr);
  execlp("sleep", "sleep", "60", nullptr);
  perror("execlp");
  exit(1);
}

[[noreturn]] void BecomeSleep() {
  static pthread_t first = pthread_self();
  pthread_t thread;
  if (pthread_create(&thread, nullptr, SleepInstead, &first) != 0) abort();
  pthread_exit(nullptr);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  if (strcmp(argv[1], "read") == 0) return Read();
  const dds_entity_t writer = WriterThatIsRead(Begin());
  if (strcmp(argv[1], "write_rest") == 0) {
    Write(writer, 101, kLast);
    BecomeSleep();
  }
  Write(writer, 1, 50);
  const pid_t child = fork();
  if (child == 0) {
    Write(writer, 1001, 1050);
    _exit(0);
  }
  Write(writer, 51, 100);
  int status = -1;
  if (waitpid(child, &status, 0) != child || status != 0) {
    fprintf(stderr, "the child ended with %d\n", status);
    return 1;
  }
  char rest[] = "write_rest";
  char* arguments[] = {argv[0], rest, nullptr};
  execv(argv[0], arguments);
  perror("execv");
  return 1;
}
