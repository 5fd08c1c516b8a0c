#include "coordinator/processes/thread_exit.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/unit/times.h"

namespace tcs {
namespace {

class NoExecutor : public Executor {
 public:
  void LetRun(pid_t) override {}
  void Hold(pid_t) override {}
  void LetKernelFinish(pid_t) override {}
};

// A client with two threads that wait, and a child of it with one. None of them has registered, and
// their numbers are nobody's.
class ThreadExitTest : public testing::Test {
 protected:
  ThreadExitTest() {
    const auto note = [this](std::string what, const Task& task) {
      happened_.push_back(what + " " + std::to_string(task.tid - kFirst));
    };
    thread_exit_.Tell({
        .settle = [note](Task& task) { note("settle", task); },
        .thread_ends = [note](Task& task, EventTime) { note("ends", task); },
        .thread_has_ended = [note](Task& task) { note("has ended", task); },
        .wake_those_waiting_for = [note](Task& task, EventTime) { note("wake for", task); },
        .child_has_ended =
            [this](Process& parent, pid_t child, EventTime) {
              EXPECT_EQ(&parent, client_);
              happened_.push_back("child " + std::to_string(child - kFirst));
            },
        .process_has_ended =
            [this](Process& process, EventTime) {
              happened_.push_back("process " + std::to_string(process.pid - kFirst));
            },
    });
    waker_.Tell({.began_by_signal = [](Task&) {},
                 .left = [](Task&, const Wait&) {},
                 .ends_in_trapped_call = [](Task&, shm::WakeReason) {},
                 .deliverer_is_held_up = [](const Process&, EventTime) {}});
    client_ = &AddProcess(kFirst, nullptr);
    AddThread(*client_, kFirst + 1);
    child_ = &AddProcess(kFirst + 2, client_);
  }
  Process& AddProcess(pid_t pid, Process* parent) {
    Process& process = run_.table.AddProcess(pid);
    process.robot = &robot_;
    process.client = parent == nullptr ? &process : parent;
    process.is_client = parent == nullptr;
    process.parent = parent == nullptr ? 1 : parent->pid;
    process.threads = 0;
    AddThread(process, pid);
    return process;
  }
  void AddThread(Process& process, pid_t tid) {
    Task& task = run_.table.AddTask(tid);
    task.process = &process;
    ++process.threads;
    task.charged = 5 * kMs;
    robot_.tasks.push_back(&task);
    robot_.scheduler.Add(task.order, 0);
  }

  static constexpr pid_t kFirst = 1'000'000'000;
  std::vector<std::string> happened_;
  Robot robot_{"robot", 1.0, RobotScheduler(1, true, [](int) { return RobotScheduler::Wait{}; })};
  RunState run_{Scenario{}, RunOptions{}, false};
  Activations activations_{false};
  Waker waker_{run_, activations_};
  Reactor reactor_;
  NoExecutor executor_;
  HostCpu cpu_{executor_, HostDuration::Seconds(10)};
  SlotCheck check_{true, [] { return std::int64_t{0}; }};
  UsageBook usage_{run_.table, check_};
  ThreadExit thread_exit_{run_, waker_, reactor_, cpu_, usage_};
  Process* client_ = nullptr;
  Process* child_ = nullptr;
};

TEST_F(ThreadExitTest, AThreadThatHasEndedIsNobodyAnyMore) {
  Task& task = *run_.table.Living(kFirst + 1);
  thread_exit_.End(task, {});
  EXPECT_EQ(happened_, (std::vector<std::string>{"ends 1", "has ended 1"}));
  EXPECT_EQ(task.state, TaskState::kDead);
  EXPECT_EQ(run_.table.Living(kFirst + 1), nullptr);
  EXPECT_EQ(robot_.tasks.size(), 2u);
}

TEST_F(ThreadExitTest, WhatAThreadWasChargedStaysItsProcesses) {
  thread_exit_.EndAndWake(*run_.table.Living(kFirst + 1), {});
  EXPECT_EQ(happened_.back(), "wake for 1");
  EXPECT_EQ(UsageBook::ChargedTo(*client_), 10 * kMs);
  EXPECT_EQ(usage_.ChargedToAllOf(*client_), 15 * kMs);
}

TEST_F(ThreadExitTest, AProcessEndsWithAllItsThreadsAndThenItsParentIsTold) {
  thread_exit_.ProcessEnded(child_->index, {At(7 * kMs)});
  EXPECT_EQ(happened_, (std::vector<std::string>{"ends 2", "has ended 2", "wake for 2", "child 2",
                                                 "process 2"}));
  EXPECT_TRUE(child_->dead);
  EXPECT_EQ(child_->ended_at, At(7 * kMs));
  EXPECT_EQ(client_->children_cpu, 5 * kMs);
  // What it was charged is its client's from now on.
  EXPECT_EQ(client_->descendants.charged_ns, (5 * kMs).ns());
  EXPECT_EQ(usage_.ChargedToAllOf(*client_), 15 * kMs);
}

TEST_F(ThreadExitTest, AProcessEndsOnce) {
  thread_exit_.ProcessEnded(child_->index, {At(7 * kMs)});
  happened_.clear();
  thread_exit_.ProcessEnded(child_->index, {At(9 * kMs)});
  EXPECT_TRUE(happened_.empty());
  EXPECT_EQ(child_->ended_at, At(7 * kMs));
}

}  // namespace
}  // namespace tcs
