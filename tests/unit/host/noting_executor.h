// An executor that only notes what it is told.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "coordinator/host/executor.h"

namespace tcs {

class NotingExecutor final : public Executor {
 public:
  void LetRun(pid_t tid) override { Note("run", tid); }
  void Hold(pid_t tid) override {
    Note("hold", tid);
    if (holds) holds(tid);
  }
  void LetKernelFinish(pid_t tid) override { Note("finish", tid); }
  void LetGo(pid_t tid) override {
    if (lets_go) lets_go(tid);
  }

  std::function<void(pid_t)> lets_go, holds;  // asked in that very instant; may be null

  // Since it was last asked.
  std::vector<std::string> Told() { return std::exchange(told_, {}); }

 private:
  void Note(const char* what, pid_t tid) {
    told_.push_back(std::string(what) + " " + std::to_string(tid));
  }

  std::vector<std::string> told_;
};

}  // namespace tcs
