// Tells when the active thread of a processor has blocked in the kernel: a process at a level
// between the active thread's and the others'. When armed, the process runs exactly when neither
// the coordinator nor the active thread wants the processor, and says that it has.
//
// Owns the process, and ends it with itself. For the coordinator's thread only.
#pragma once

#include <sys/types.h>

#include <string>

#include "coordinator/port/unique_fd.h"

namespace tcs {

class BlockDetector {
 public:
  BlockDetector() = default;
  ~BlockDetector();
  BlockDetector(const BlockDetector&) = delete;
  BlockDetector& operator=(const BlockDetector&) = delete;

  // Makes the process, once, on the processor that the calling thread is bound to. Empty on
  // success, else one sentence.
  [[nodiscard]] std::string Start();

  // The detector fires once from now on. Nothing changes if it is armed already.
  void Arm();
  bool is_armed() const { return armed_; }
  // Readable once it has fired.
  int fired_fd() const { return fired_.get(); }
  // False if the detector has not fired since. Otherwise it is not armed any more.
  bool TakeFired();

  pid_t pid() const { return pid_; }
  // Readable once the detector's process has ended. While programs compute all the time the process
  // does not even get the processor to die, so that it may be worth while to look.
  int end_fd() const { return pidfd_.get(); }
  bool IsDying() const;
  // How a process that has ended or is dying came to its end, in one sentence.
  std::string HowItEnded() const;

 private:
  pid_t pid_ = -1;
  UniqueFd pidfd_;
  UniqueFd arm_, fired_;  // eventfds
  bool armed_ = false;
};

}  // namespace tcs
