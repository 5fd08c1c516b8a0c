// When clients were activated, began and were idle again: activations.csv, one line per activation
// of a thread. Everything derives from virtual time.
#pragma once

#include <cstdint>
#include <string>

#include "coordinator/trace/csv_file.h"

namespace tcs {

// What ended the wait before an activation; or, without one, what was received as it began.
enum class ReleaseCause { kStart, kTime, kInput, kThread, kChild, kSignal };

// One that has not ended yet. Times are those of the thread's own clock.
struct Activation {
  ReleaseCause cause = ReleaseCause::kStart;
  std::int64_t release_ns = 0;  // it became ready
  std::int64_t start_ns = -1;   // it ran first; -1: not yet
  std::int64_t charged_ns = 0;  // to the thread before, at its most
};

class ActivationLog {
 public:
  [[nodiscard]] std::string Open(const std::string& path);
  // `thread` is 0 for the client's first one. `charged_ns` is what the thread has been charged in
  // all.
  void Write(const std::string& client, int thread, const Activation& activation,
             std::int64_t end_ns, std::int64_t charged_ns);
  void Flush() { file_.Flush(); }
  [[nodiscard]] std::string Close() { return file_.Close(); }

 private:
  CsvFile file_;
};

}  // namespace tcs
