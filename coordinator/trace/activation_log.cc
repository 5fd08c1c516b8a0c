#include "coordinator/trace/activation_log.h"

#include <string_view>

namespace tcs {

namespace {

constexpr std::string_view NameOf(ReleaseCause cause) {
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

}  // namespace

std::string ActivationLog::Open(const std::string& path) {
  return file_.Open(path, "client,thread,cause,release_ns,start_ns,end_ns,charged_ns");
}

void ActivationLog::Write(const std::string& client, int thread, const Activation& activation,
                          std::int64_t end_ns, std::int64_t charged_ns) {
  file_.Line(client, thread, NameOf(activation.cause), activation.release_ns, activation.start_ns,
             end_ns, charged_ns - activation.charged_ns);
}

}  // namespace tcs
