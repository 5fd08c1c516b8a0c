#include "coordinator/dump/state_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>
#include <string>

namespace tcs {
namespace {

using Json = nlohmann::ordered_json;
using testing::HasSubstr;
using testing::Not;

Json Answered() {
  return Json::parse(R"({
    "answered": true,
    "coordinator": {"doing": "awaits thread", "since_host_ns": 120000, "waited_ns": 300000},
    "run": {"coordinator": 7, "folder": "/tmp/out", "accounting": "measured",
            "sync": "consistent", "levels": true, "real_ns": 2000000000},
    "time": {"virtual_ns": 1500000000, "furthest_ns": 1501000000, "next_ns": null,
             "end_ns": null, "drift_ns": 1000000, "drift_bound_ns": 1000000, "dispatches": 12,
             "ends": false, "pace": 1.0, "paused": true, "behind_pace_ns": 0},
    "world": null,
    "host_cpus": [{"cpu": 1, "thread": 11, "since_host_ns": 40000, "horizon_ns": 1501000000}],
    "robots": [{"name": "drone", "speed": 1.0, "ideal": false, "to_start": [],
      "cores": [{"core": 0, "progress_ns": 1500000000, "next_thread": 11,
                 "next_ns": 1500000000, "first": true}],
      "processes": [{"pid": 10, "parent": 7, "client": "drone/controller", "is_client": true,
        "name": "controller", "stopped": false, "unregistered_threads": false, "clock_lead_ns": 0,
        "timers": [{"id": 16, "clock": "time", "next_ns": 1510000000, "interval_ns": 10000000,
                    "signal": 14}],
        "threads": [{"tid": 11, "state": "waiting", "text": "waits for a lock or a condition",
          "since_ns": 1000000000, "until_ns": 2000000000, "policy": "SCHED_FIFO", "priority": 80,
          "charged_ns": 5000000, "debt_ns": 0, "core": 0, "activations": 1,
          "at_gate": true, "gate": "waiting",
          "futex": {"process": 10, "file": 0, "address": 4096, "owner": 10},
          "kernel": {"name": "wor\u001bker", "state": "S", "cpu": 1, "processor_ns": 10000000,
                     "in": "futex_wait_queue", "call": 202}}]}]}],
    "queues": {"futexes": [{"process": 10, "file": 0, "address": 4096, "waiters": [11]}],
               "kernel_objects": [], "dds": [], "network_next_ns": null, "unregistered_children": []}
  })");
}

TEST(StateText, IsNotWiderThanTheTerminal) {
  for (const std::size_t columns : {50u, 80u, 120u}) {
    std::istringstream lines(StateText(Answered(), columns));
    for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), columns) << line;
  }
}

TEST(StateText, SaysWhoWaitsForWhomSinceWhenAndUntilWhen) {
  const std::string text = StateText(Answered(), 1000);
  EXPECT_THAT(text, HasSubstr("waits for a lock or a condition that thread 10 has, since 1.000000 "
                              "s, until 2.000000 s (in 0.500000 s)"));
  EXPECT_THAT(text, HasSubstr("SCHED_FIFO 80, core 0, charged 0.005000 s, gate waiting"));
  EXPECT_THAT(text, HasSubstr("sleeping in futex_wait_queue, system call 202, on processor 1"));
  EXPECT_THAT(text, HasSubstr("processor 1 of the host: thread 11 for 40 us, up to 1.501000 s"));
  EXPECT_THAT(text, HasSubstr("timer 16: at 1.510000 s of its clock, every 0.010000 s, signal 14"));
  EXPECT_THAT(text, HasSubstr("the run stands: it was paused"));
  EXPECT_THAT(text, HasSubstr("at futex 0x1000 of process 10: 11"));
}

TEST(StateText, ShowsWhatATerminalWouldObey) {
  const std::string text = StateText(Answered(), 80);
  EXPECT_THAT(text, HasSubstr("wor\\x1bker"));
  EXPECT_THAT(text, Not(HasSubstr("\x1b")));
}

TEST(StateText, SaysThatTheCoordinatorDoesNotAnswer) {
  const Json state = Json::parse(R"({
    "answered": false,
    "coordinator": {"doing": "integrates", "since_host_ns": 3000000000, "dispatches": 5,
      "dispatched_tid": 11, "dispatched_since_host_ns": 3100000000, "virtual_ns": 1000000000,
      "waited_ns": 2000000000, "computed_ns": 1990000000, "tracer": 0,
      "kernel": {"name": "tcsim", "state": "R", "cpu": 1, "processor_ns": 0}},
    "run": {"coordinator": 7, "folder": ""},
    "outside": {"processes": [{"pid": 10, "name": "controller", "registered": true,
      "threads": [{"tid": 10, "slot": {"asked": "to sleep", "at_ns": 900000000,
        "until_ns": 950000000, "shown_ns": 900000000, "horizon_ns": 0, "gate": "waiting"},
        "kernel": {"name": "controller", "state": "S", "cpu": 1, "processor_ns": 0}}]}]}
  })");
  const std::string text = StateText(state, 1000);
  EXPECT_THAT(text, HasSubstr("the coordinator does not answer: 2000 ms of waiting, in which it "
                              "computed for 1990 ms; the kernel has it running or ready"));
  EXPECT_THAT(text, HasSubstr("as it noted last: it integrates the dynamics, for 3000 ms by now"));
  EXPECT_THAT(text, HasSubstr("asked to sleep at 0.900000 s, until 0.950000 s"));
}

}  // namespace
}  // namespace tcs
