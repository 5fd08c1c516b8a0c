#include "coordinator/calls/call_files.h"

#include <gtest/gtest.h>
#include <sys/epoll.h>
#include <unistd.h>

#include <utility>

#include "coordinator/port/pidfds.h"
#include "coordinator/tasks/remote_descriptor.h"

namespace tcs {
namespace {

// This process is the client, and its only thread the one that waits.
class FilesOfACall : public testing::Test {
 protected:
  FilesOfACall() {
    EXPECT_EQ(pipe(pipe_), 0);
    EXPECT_EQ(pipe(other_), 0);
    process_.pid = getpid();
    process_.pidfd.Reset(OpenPidfd(getpid()));
    process_.threads = 2;
    task_.process = &process_;
    task_.tid = gettid();
  }
  ~FilesOfACall() override {
    for (const int fd : {pipe_[0], pipe_[1], other_[0], other_[1]}) close(fd);
  }

  // The thread's wait for input from the pipe is over.
  void Keep(shm::KeepFiles keep = shm::KeepFiles::kForCall, bool raw = false) {
    awaited::Descriptors watched;
    watched.fds.push_back(CopyOfDescriptor(process_, pipe_[0]));
    watched.asked.push_back({pipe_[0], EPOLLIN});
    watched.keep = keep;
    watched.since = process_.changes;
    Wait wait{std::move(watched)};
    wait.is_in_trapped_call = raw;
    task_.kept.reset();
    task_.reply[0] = 0;
    task_.reason = shm::WakeReason::kGo;
    CallFiles::Keep(task_, wait);
  }
  void ExpectKept(bool is_kept, const char* what) {
    CallFiles::LookAtNumbers(task_);
    EXPECT_EQ(task_.kept.has_value(), is_kept) << what;
    EXPECT_EQ(task_.reply[0], is_kept ? 1 : 0) << what;
  }
  void Replace() { EXPECT_EQ(dup2(other_[0], pipe_[0]), pipe_[0]); }

  int pipe_[2], other_[2];
  Process process_;
  Task task_;
};

TEST_F(FilesOfACall, AreNotKeptWhereTheirNumbersMeanThem) {
  Keep();
  ExpectKept(false, "nobody has run");
  Keep();
  ++process_.changes.turns;
  ExpectKept(false, "another thread has run");
  Keep();
  Replace();
  task_.reason = shm::WakeReason::kSignal;
  ++process_.changes.turns;
  ExpectKept(false, "after a signal the call begins anew");
}

TEST_F(FilesOfACall, AreKeptOnceTheirNumbersMeanOthers) {
  Keep();
  Replace();
  ++process_.changes.turns;
  ExpectKept(true, "replaced");
  // The thread is dispatched again before its call is over.
  task_.reply[0] = 0;
  CallFiles::LookAtNumbers(task_);
  EXPECT_TRUE(task_.kept.has_value());
  EXPECT_EQ(task_.reply[0], 0) << "it has been told";
}

TEST_F(FilesOfACall, AreKeptOnceTheirNumbersMeanNothing) {
  Keep();
  close(pipe_[0]);
  ++process_.changes.turns;
  ExpectKept(true, "closed");
  pipe_[0] = dup(pipe_[1]);
}

TEST_F(FilesOfACall, OfASingleThreadAreNeverReplaced) {
  process_.threads = 1;
  Keep();
  EXPECT_FALSE(task_.kept.has_value());
}

TEST_F(FilesOfACall, ThatPollsAreLookedAtWhereTheShimHasSeenAChange) {
  Keep(shm::KeepFiles::kForPoll);
  Replace();
  ++process_.changes.turns;
  ExpectKept(false, "by nothing that the shim saw");
  for (const bool raw : {false, true}) {
    Keep(shm::KeepFiles::kForPoll, raw);
    Replace();
    ++process_.changes.turns;
    if (!raw) ++process_.changes.by_calls;
    // The pipe is `other_` by now, and its copy, too.
    task_.kept->files[0] = UniqueFd(dup(other_[1]));
    ExpectKept(true, raw ? "a raw call" : "a change");
  }
}

}  // namespace
}  // namespace tcs
