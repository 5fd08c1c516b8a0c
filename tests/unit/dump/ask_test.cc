// A process that has the coordinator's end of the state's memory, and this one, which asks it.
#include "coordinator/dump/ask.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>
#include <x86gprintrin.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <string>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include "coordinator/dump/find_run.h"
#include "coordinator/dump/state_link.h"

namespace tcs {
namespace {

using testing::HasSubstr;

constexpr std::int64_t kSoonNs = 100'000'000, kInTimeNs = 20'000'000'000;

// What a coordinator does: `answers` once it was asked, and nothing besides; `first` before.
class Coordinator {
 public:
  using Answers = std::function<void(StateLink&)>;

  // It can be found by then, and has noted what it does.
  explicit Coordinator(Answers answers, const std::string& folder = "") {
    int begun[2];
    EXPECT_EQ(pipe(begun), 0);
    pid_ = fork();
    if (pid_ == 0) Serve(answers, folder, begun[1]);
    close(begun[1]);
    char told;
    EXPECT_EQ(read(begun[0], &told, 1), 1);
    close(begun[0]);
  }
  ~Coordinator() {
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
  Coordinator(const Coordinator&) = delete;
  Coordinator& operator=(const Coordinator&) = delete;

  pid_t pid() const { return pid_; }
  FoundRun Run() const {
    for (;;) {
      for (FoundRun& run : FindRuns()) {
        if (run.coordinator == pid_) return std::move(run);
      }
      usleep(1'000);
    }
  }

 private:
  [[noreturn]] static void Serve(const Answers& answers, const std::string& folder, int begun) {
    alarm(100);
    StateLink link;
    link.Open(folder);
    link.Dispatched(42, __rdtsc(), 1'500);
    link.Does(Doing::kIntegrates, __rdtsc());
    if (write(begun, "", 1) != 1) _exit(1);
    for (pollfd asked{link.wake_fd(), POLLIN, 0};;) {
      if (poll(&asked, 1, -1) == 1) answers(link);
    }
  }

  pid_t pid_ = -1;
};

void Greet(StateLink& link) {
  static int times = 0;
  if (link.TakeAsked()) link.Answer("hello " + std::to_string(++times));
}

TEST(AskForState, GetsTheAnswer) {
  const Coordinator coordinator(Greet);
  const FoundRun run = coordinator.Run();
  for (const char* expected : {"hello 1", "hello 2"}) {
    const StateAnswer answer = AskForState(run, kInTimeNs);
    EXPECT_EQ(answer.error, "");
    EXPECT_EQ(answer.text, expected);
  }
}

TEST(AskForState, GivesEachOfManyItsOwnAnswer) {
  const Coordinator coordinator(Greet);
  std::vector<std::string> answers(8);
  std::vector<std::thread> askers;
  for (std::string& text : answers) {
    askers.emplace_back(
        [&] { text = AskForState(coordinator.Run(), kInTimeNs).text.value_or("none"); });
  }
  for (std::thread& asker : askers) asker.join();
  std::sort(answers.begin(), answers.end());
  for (std::size_t i = 0; i < answers.size(); ++i) {
    EXPECT_EQ(answers[i], "hello " + std::to_string(i + 1));
  }
}

TEST(AskForState, SaysWhatTheCoordinatorDoesThatDoesNotAnswer) {
  const Coordinator coordinator([](StateLink&) { pause(); });
  const StateAnswer answer = AskForState(coordinator.Run(), kSoonNs);
  EXPECT_EQ(answer.error, "");
  EXPECT_EQ(answer.text, std::nullopt);
  EXPECT_GE(answer.waited_ns, kSoonNs);
  EXPECT_EQ(answer.coordinator.doing, Doing::kIntegrates);
  EXPECT_EQ(answer.coordinator.dispatched_tid, 42);
  EXPECT_EQ(answer.coordinator.virtual_ns, 1'500);
  EXPECT_EQ(answer.coordinator.dispatches, 1u);
}

TEST(AskForState, TakesALateAnswerForNobodysNext) {
  int may_answer[2];
  ASSERT_EQ(pipe(may_answer), 0);
  const Coordinator coordinator([&](StateLink& link) {
    char word;
    if (link.TakeAsked() && read(may_answer[0], &word, 1) == 1) link.Answer("late");
  });
  const FoundRun run = coordinator.Run();
  EXPECT_EQ(AskForState(run, kSoonNs).text, std::nullopt);
  // To the first question it answers while the second one waits, unless the host is busy.
  std::thread later([&] {
    usleep(200'000);
    EXPECT_EQ(write(may_answer[1], "123", 3), 3);
  });
  EXPECT_EQ(AskForState(run, kInTimeNs).text, "late");
  EXPECT_EQ(AskForState(run, kInTimeNs).text, "late");
  later.join();
  close(may_answer[0]);
  close(may_answer[1]);
}

TEST(AskForState, SaysThatTheRunHasEnded) {
  FoundRun run;
  {
    const Coordinator coordinator(Greet);
    run = coordinator.Run();
  }
  EXPECT_THAT(AskForState(run, kSoonNs).error, HasSubstr("has just ended"));
}

TEST(AskForState, SaysThatTheAnswerIsTooLong) {
  const Coordinator coordinator([](StateLink& link) {
    if (link.TakeAsked()) link.Answer(std::string(kMostStateText + 1, 'x'));
  });
  EXPECT_THAT(AskForState(coordinator.Run(), kInTimeNs).error, HasSubstr("too many threads"));
}

TEST(ChooseRun, GoesByFolderAndByProcess) {
  const Coordinator one(Greet, "/usr"), other(Greet, "/etc");
  one.Run();
  other.Run();
  const auto chosen = [](const std::string& named) {
    auto run = ChooseRun(FindRuns(), named);
    const auto* error = std::get_if<std::string>(&run);
    return error != nullptr ? *error : std::to_string(std::get<FoundRun>(run).coordinator);
  };
  EXPECT_EQ(chosen("/usr/../usr/"), std::to_string(one.pid()));
  EXPECT_EQ(chosen("/etc"), std::to_string(other.pid()));
  EXPECT_EQ(chosen(std::to_string(other.pid())), std::to_string(other.pid()));
  // This process has started both.
  EXPECT_THAT(chosen(std::to_string(getpid())),
              testing::MatchesRegex("2 runs go on: process [0-9]+ \\(/...\\), process [0-9]+ "
                                    "\\(/...\\); name one, as in `tcsim dump [0-9]+`"));
  EXPECT_EQ(chosen("/var"), "no run writes to the folder '/var' just now");
  EXPECT_EQ(chosen("/no/such"), "there is no folder '/no/such'");
  EXPECT_EQ(chosen("999999999"), "there is no process 999999999");
}

// A client of a run starts a run, whose client it asks for.
TEST(ChooseRun, OfRunsWithinEachOtherAProcessMeansTheInnermost) {
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  // Each ends with its parent, also with one that ends as soon as the last one has begun.
  const auto fork_bound = [] {
    const pid_t pid = fork();
    if (pid == 0) prctl(PR_SET_PDEATHSIG, SIGKILL);
    return pid;
  };
  const pid_t outer = fork_bound();
  if (outer == 0) {
    if (fork_bound() == 0 && fork_bound() == 0) {
      const pid_t pids[2] = {getppid(), getpid()};
      if (write(ends[1], pids, sizeof pids) != sizeof pids) _exit(1);
    }
    for (;;) pause();
  }
  pid_t pids[2] = {};
  ASSERT_EQ(read(ends[0], pids, sizeof pids), static_cast<ssize_t>(sizeof pids));
  const auto [inner, client] = pids;
  const auto chosen = [&, in = inner](pid_t named) {
    std::vector<FoundRun> runs(2);
    runs[0].coordinator = outer;
    runs[1].coordinator = in;
    return std::get<FoundRun>(ChooseRun(std::move(runs), std::to_string(named))).coordinator;
  };
  EXPECT_EQ(chosen(client), inner);
  EXPECT_EQ(chosen(inner), inner);
  EXPECT_EQ(chosen(outer), outer);
  EXPECT_EQ(chosen(getpid()), outer);
  kill(outer, SIGKILL);
  EXPECT_EQ(waitpid(outer, nullptr, 0), outer);
  close(ends[0]);
  close(ends[1]);
}

// Whoever asks has the run's memory, too, and comes before it where its number is lower.
TEST(FindRuns, NeverTakesWhoeverAsksForACoordinator) {
  const Coordinator coordinator(Greet, "/usr");
  const FoundRun asked = coordinator.Run();
  const pid_t parent = getpid();
  const pid_t asker = fork();
  if (asker == 0) {
    bool finds = false, takes_asker = false;
    for (const FoundRun& run : FindRuns()) {
      finds |= run.coordinator == coordinator.pid();
      takes_asker |= run.coordinator == parent || run.coordinator == getpid();
    }
    _exit(finds && !takes_asker ? 0 : 1);
  }
  int status = -1;
  ASSERT_EQ(waitpid(asker, &status, 0), asker);
  EXPECT_EQ(status, 0);
}

}  // namespace
}  // namespace tcs
