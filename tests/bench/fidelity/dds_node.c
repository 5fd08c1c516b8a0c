// A node of a DDS system, the same binary natively and under tcs. Sizes in bytes, times in
// microseconds.
//
//   dds_node write SIZE HZ COUNT RELIABLE READERS   "write TIME": processor time of the thread in
//   dds_write, per sample dds_node read COUNT RELIABLE                    "read TIME LATENCY":
//   processor time of the process per sample, and the
//                                                   median from the source time stamp to the end of
//                                                   the take
//   dds_node source SIZE HZ COUNT                   writes to topic 0 of a pipeline
//   dds_node stage NUMBER WORK                      takes from topic NUMBER, computes for WORK, and
//   writes to the next topic dds_node sink NUMBER COUNT WITHIN               "kept SHARE MEDIAN":
//   of COUNT samples, how many came within WITHIN of
//                                                   when they were written first; and the median
//                                                   age of those that came
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "dds/dds.h"
#include "frame.h"

static int64_t Clock(clockid_t clock) {
  struct timespec t;
  clock_gettime(clock, &t);
  return t.tv_sec * INT64_C(1000000000) + t.tv_nsec;
}

static dds_entity_t participant, waitset;

static dds_qos_t* Qos(int reliable, int depth) {
  dds_qos_t* qos = dds_create_qos();
  dds_qset_reliability(qos, reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT,
                       DDS_SECS(10));
  dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, depth);
  return qos;
}

static dds_entity_t Topic(int number) {
  char name[32];
  snprintf(name, sizeof name, "fidelity_%d", number);
  return dds_create_topic(participant, &Fidelity_Frame_desc, name, NULL, NULL);
}

static dds_entity_t Reader(int topic, const dds_qos_t* qos) {
  const dds_entity_t reader = dds_create_reader(participant, Topic(topic), qos, NULL);
  waitset = dds_create_waitset(participant);
  dds_set_status_mask(reader, DDS_DATA_AVAILABLE_STATUS);
  dds_waitset_attach(waitset, reader, 0);
  return reader;
}

static void AwaitReaders(dds_entity_t writer, int readers) {
  dds_publication_matched_status_t matched = {0};
  do {
    dds_sleepfor(DDS_MSECS(20));
    dds_get_publication_matched_status(writer, &matched);
  } while ((int)matched.current_count < readers);
  dds_sleepfor(DDS_SECS(1));  // until readers have met the writer, too
}

// Writes so many samples at that rate; returns the processor time of that.
static int64_t WriteAll(dds_entity_t writer, int size, double hz, int count) {
  Fidelity_Frame frame = {0};
  frame.data._length = frame.data._maximum = (uint32_t)size;
  frame.data._buffer = malloc((size_t)size + 1);
  memset(frame.data._buffer, 1, (size_t)size + 1);
  int64_t next = Clock(CLOCK_MONOTONIC), used = 0;
  for (int i = 0; i < count; ++i) {
    next += (int64_t)(1e9 / hz);
    const struct timespec until = {next / 1000000000, next % 1000000000};
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, NULL) != 0) {
    }
    frame.number = (uint32_t)i;
    frame.began = Clock(CLOCK_REALTIME);
    const int64_t begun = Clock(CLOCK_THREAD_CPUTIME_ID);
    dds_write(writer, &frame);
    used += Clock(CLOCK_THREAD_CPUTIME_ID) - begun;
  }
  return used;
}

static int Ascending(const void* a, const void* b) {
  const int64_t x = *(const int64_t*)a, y = *(const int64_t*)b;
  return (x > y) - (x < y);
}

static int Write(char** argv) {
  const int count = atoi(argv[4]);
  const dds_entity_t writer =
      dds_create_writer(participant, Topic(0), Qos(atoi(argv[5]), 10), NULL);
  AwaitReaders(writer, atoi(argv[6]));
  const int64_t used = WriteAll(writer, atoi(argv[2]), atof(argv[3]), count);
  printf("write %.2f\n", (double)used / count / 1000);
  fflush(stdout);
  dds_sleepfor(DDS_MSECS(300));
  return 0;
}

static int Read(char** argv) {
  const int count = atoi(argv[2]);
  const dds_entity_t reader = Reader(0, Qos(atoi(argv[3]), 10));
  int64_t* latency = calloc((size_t)count, sizeof *latency);
  int64_t begun = 0;
  int had = 0;
  // As long as something comes: some samples may be lost.
  while (had < count &&
         dds_waitset_wait(waitset, NULL, 0, had == 0 ? DDS_SECS(10) : DDS_MSECS(800)) > 0) {
    void* sample[1] = {NULL};
    dds_sample_info_t info[1];
    while (had < count && dds_take(reader, sample, info, 1, 1) == 1) {
      if (had == 0) begun = Clock(CLOCK_PROCESS_CPUTIME_ID);
      latency[had++] = Clock(CLOCK_REALTIME) - info[0].source_timestamp;
      dds_return_loan(reader, sample, 1);
    }
  }
  if (had < count - count / 10) return 1;
  const int64_t used = Clock(CLOCK_PROCESS_CPUTIME_ID) - begun;
  qsort(latency, (size_t)had, sizeof *latency, Ascending);
  printf("read %.2f %.2f\n", (double)used / (had - 1) / 1000, (double)latency[had / 2] / 1000);
  return 0;
}

static int Source(char** argv) {
  const dds_entity_t writer = dds_create_writer(participant, Topic(0), Qos(1, 1), NULL);
  AwaitReaders(writer, 1);
  dds_sleepfor(DDS_MSECS(500));  // until the rest of the pipeline has met
  WriteAll(writer, atoi(argv[2]), atof(argv[3]), atoi(argv[4]));
  dds_sleepfor(DDS_SECS(1));
  return 0;
}

static int Stage(char** argv) {
  const int number = atoi(argv[2]);
  const int64_t work = (int64_t)(atof(argv[3]) * 1000);
  const dds_entity_t reader = Reader(number, Qos(1, 1));
  const dds_entity_t writer = dds_create_writer(participant, Topic(number + 1), Qos(1, 1), NULL);
  while (dds_waitset_wait(waitset, NULL, 0, DDS_SECS(10)) > 0) {
    void* sample[1] = {NULL};
    dds_sample_info_t info[1];
    while (dds_take(reader, sample, info, 1, 1) == 1) {
      const int64_t until = Clock(CLOCK_THREAD_CPUTIME_ID) + work;
      while (Clock(CLOCK_THREAD_CPUTIME_ID) < until) {
      }
      if (info[0].valid_data) dds_write(writer, sample[0]);
      dds_return_loan(reader, sample, 1);
    }
  }
  return 0;
}

static int Sink(char** argv) {
  const int count = atoi(argv[3]);
  const int64_t within = (int64_t)(atof(argv[4]) * 1000);
  const dds_entity_t reader = Reader(atoi(argv[2]), Qos(1, 1));
  int64_t* age = calloc((size_t)count, sizeof *age);
  int had = 0, kept = 0;
  // As long as something comes.
  while (dds_waitset_wait(waitset, NULL, 0, had == 0 ? DDS_SECS(10) : DDS_MSECS(800)) > 0) {
    void* sample[1] = {NULL};
    dds_sample_info_t info[1];
    while (had < count && dds_take(reader, sample, info, 1, 1) == 1) {
      age[had] = Clock(CLOCK_REALTIME) - ((const Fidelity_Frame*)sample[0])->began;
      kept += age[had++] <= within;
      dds_return_loan(reader, sample, 1);
    }
  }
  qsort(age, (size_t)had, sizeof *age, Ascending);
  printf("kept %.4f %.2f\n", (double)kept / count, had == 0 ? -1.0 : (double)age[had / 2] / 1000);
  return 0;
}

int main(int argc, char** argv) {
  static const struct {
    const char* name;
    int arguments;
    int (*run)(char**);
  } kModes[] = {{"write", 7, Write},
                {"read", 4, Read},
                {"source", 5, Source},
                {"stage", 4, Stage},
                {"sink", 5, Sink}};
  participant = dds_create_participant(DDS_DOMAIN_DEFAULT, NULL, NULL);
  for (size_t i = 0; i < sizeof kModes / sizeof *kModes; ++i) {
    if (argc == kModes[i].arguments && strcmp(argv[1], kModes[i].name) == 0)
      return kModes[i].run(argv);
  }
  return 2;
}
