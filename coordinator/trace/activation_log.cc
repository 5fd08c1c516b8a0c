#include "coordinator/trace/activation_log.h"

namespace tcs {

std::string_view NameOf(ReleaseCause cause) {
  switch (cause) {
    case ReleaseCause::kStart:
      return "start";
    case ReleaseCause::kTime:
      return "time";
    case ReleaseCause::kInput:
      return "input";
    case ReleaseCause::kThread:
      return "thread";
    case ReleaseCause::kChild:
      return "child";
    case ReleaseCause::kSignal:
      return "signal";
  }
  return "";
}

std::string ActivationLog::Open(const std::string& path, bool with_work) {
  with_work_ = with_work;
  const std::string header = "client,thread,cause,release_ns,start_ns,end_ns,charged_ns";
  return file_.Open(path, with_work ? header + ",calls,allocations,priced_ns" : header);
}

void ActivationLog::Write(const std::string& client, int thread, const Activation& activation,
                          std::int64_t end_ns, const Used& used) {
  const std::string_view cause = NameOf(activation.cause);
  const std::int64_t charged = used.charged_ns - activation.charged_ns;
  if (!with_work_) {
    file_.Line(client, thread, cause, activation.release_ns, activation.start_ns, end_ns, charged);
    return;
  }
  file_.Line(client, thread, cause, activation.release_ns, activation.start_ns, end_ns, charged,
             used.work.calls - activation.work.calls,
             used.work.allocations() - activation.work.allocations(),
             used.priced_ns - activation.priced_ns);
}

}  // namespace tcs
