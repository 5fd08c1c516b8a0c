#include "coordinator/trace/dispatch_log.h"

namespace tcs {

namespace {

// More time than one turn of the coordinator takes.
constexpr std::int64_t kMostBetweenNs = 100'000;

}  // namespace

std::string DispatchLog::Open(const std::string& path, bool with_real_times) {
  with_real_times_ = with_real_times;
  return file_.Open(path, with_real_times
                              ? "row,virtual_start_ns,virtual_end_ns,real_start_ns,real_end_ns"
                              : "row,virtual_start_ns,virtual_end_ns");
}

void DispatchLog::Write() {
  if (row_ < 0) return;
  const std::string& name = rows_[static_cast<std::size_t>(row_)];
  if (with_real_times_) {
    file_.Line(name, virtual_.start_ns, virtual_.end_ns, real_.start_ns, real_.end_ns);
  } else {
    file_.Line(name, virtual_.start_ns, virtual_.end_ns);
  }
}

void DispatchLog::Slice(int row, Span virtual_time, Span real) {
  if (!file_.is_open()) return;
  const bool follows = row == row_ && virtual_time.start_ns == virtual_.end_ns &&
                       (!with_real_times_ || real.start_ns - real_.end_ns <= kMostBetweenNs);
  if (follows) {
    virtual_.end_ns = virtual_time.end_ns;
    real_.end_ns = real.end_ns;
    return;
  }
  Write();
  row_ = row;
  virtual_ = virtual_time;
  real_ = real;
}

std::string DispatchLog::Close() {
  Write();
  row_ = -1;
  return file_.Close();
}

}  // namespace tcs
