// When clients were activated, began and were idle again: activations.csv, one line per activation
// of a thread. Everything derives from virtual time.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "coordinator/trace/csv_file.h"
#include "shm/work_counts.h"

namespace tcs {

// The event that ended the wait before an activation; or, without a wait, the event that was
// received as the activation began.
enum class ReleaseCause { kStart, kTime, kInput, kThread, kChild, kSignal };
// The cause's name in tables: "start", "time"…
std::string_view NameOf(ReleaseCause cause);

// An activation that has not ended yet. Times are those of the thread's own clock.
struct Activation {
  ReleaseCause cause = ReleaseCause::kStart;
  std::int64_t release_ns = 0;  // the thread became ready
  std::int64_t wakeup_ns = 0;   // and could run so much later
  std::int64_t start_ns = -1;   // the thread ran first; -1: not yet
  std::int64_t charged_ns = 0;  // the thread's highest charge before,
  std::int64_t priced_ns = 0;   // and what of it was not computed
  shm::WorkCounts work{};       // done by the thread before
};

class ActivationLog {
 public:
  // `with_work`: whether lines tell of calls and allocations, too, and of what was not computed.
  [[nodiscard]] std::string Open(const std::string& path, bool with_work);
  // Of a thread, in all.
  struct Used {
    std::int64_t charged_ns = 0, priced_ns = 0;
    shm::WorkCounts work{};
  };
  // `thread` is 0 for the client's first one.
  void Write(const std::string& client, int thread, const Activation& activation,
             std::int64_t end_ns, const Used& used);
  void Flush() { file_.Flush(); }
  [[nodiscard]] std::string Close() { return file_.Close(); }

 private:
  CsvFile file_;
  bool with_work_ = false;
};

}  // namespace tcs
