#include "coordinator/engine/failures.h"

#include <fmt/format.h>
#include <string.h>
#include <sys/wait.h>

#include <algorithm>

#include "coordinator/os/files.h"
#include "coordinator/text/spoken.h"

namespace tcs {

namespace {

// "SIGINT".
std::string NameOfSignal(int signal) {
  const char* name = sigabbrev_np(signal);
  return name != nullptr ? fmt::format("SIG{}", name) : fmt::format("signal {}", signal);
}

// The client's last words, and where the rest stands.
std::string LastWordsOf(const std::string& client, const std::string& folder,
                        const std::string& shown) {
  std::string base = client;
  std::ranges::replace(base, '/', '-');
  for (const char* log : {".err.log", ".out.log"}) {
    const std::string line = LastLine(folder + "/" + base + log);
    if (!line.empty()) return fmt::format("\"{}\" ({}{}{})", line, shown, base, log);
  }
  return fmt::format("it printed nothing ({}{}.err.log and .out.log are empty)", shown, base);
}

}  // namespace

bool HasFailed(const ClientReport& client) {
  return client.ended_at_ns >= 0 && client.wait_status != 0;
}

std::string HowItEnded(const ClientReport& client) {
  const int status = client.wait_status;
  const std::string how = WIFEXITED(status) ? fmt::format("exit status {}", WEXITSTATUS(status))
                                            : fmt::format("signal {} ({})", WTERMSIG(status),
                                                          strsignal(WTERMSIG(status)));
  return fmt::format("{} ended at {:.3f} s with {}", client.name,
                     static_cast<double>(client.ended_at_ns) / 1e9, how);
}

std::string FailureOf(const ClientReport& client, const std::string& folder,
                      const std::string& shown) {
  return HowItEnded(client) + ": " + LastWordsOf(client.name, folder, shown);
}

std::vector<std::string> FailuresIn(const RunReport& report, std::int64_t end_ns,
                                    const std::string& folder) {
  std::vector<const ClientReport*> failed;
  for (const ClientReport& client : report.clients) {
    if (HasFailed(client)) failed.push_back(&client);
  }
  std::ranges::stable_sort(failed, {}, &ClientReport::ended_at_ns);
  std::vector<std::string> sentences;
  for (const ClientReport* client : failed) sentences.push_back(FailureOf(*client, folder, ""));
  if (report.interrupted) {
    sentences.push_back(fmt::format("{} stopped the run at {:.3f} s of its {}",
                                    NameOfSignal(report.stop_signal),
                                    static_cast<double>(report.virtual_ns) / 1e9, Spoken(end_ns)));
  }
  return sentences;
}

}  // namespace tcs
