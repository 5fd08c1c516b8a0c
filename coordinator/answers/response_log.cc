#include "coordinator/answers/response_log.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <utility>

namespace tcs {

namespace {

// As long as a text of a line may be (CsvFile); the clients with the least time are left out beyond
// that.
constexpr std::size_t kMostWhose = 250;

}  // namespace

std::string ResponseLog::Open(const std::string& path, std::vector<std::string> clients) {
  clients_ = std::move(clients);
  return file_.Open(path,
                    "client,thread,cause,release_ns,start_ns,end_ns,deadline_ns,queued_ns,away_ns,"
                    "wakeup_ns,executed_ns,cores_ns,locks_ns,room_ns,rest_ns,whose");
}

// "core:CLIENT=NS lock:CLIENT=NS", the client with the most time first.
std::string ResponseLog::WhoseOf(const TimeParts& parts) const {
  if (parts.cores_ns.empty() && parts.locks_ns.empty()) return {};
  struct Share {
    std::int64_t ns;
    std::string_view of;
    int client;
  };
  std::vector<Share> shares;
  for (const auto& [client, ns] : parts.cores_ns) shares.push_back({ns, "core:", client});
  for (const auto& [client, ns] : parts.locks_ns) shares.push_back({ns, "lock:", client});
  std::ranges::stable_sort(shares, std::greater<>{}, &Share::ns);
  std::string whose;
  for (const auto& [ns, of, client] : shares) {
    const std::size_t before = whose.size();
    if (before > 0) whose += ' ';
    whose += of;
    if (client >= 0) whose += clients_[static_cast<std::size_t>(client)];
    whose += '=';
    whose += std::to_string(ns);
    if (whose.size() <= kMostWhose) continue;
    whose.resize(before);
    break;
  }
  return whose;
}

void ResponseLog::Write(const Response& response) {
  if (!file_.is_open()) return;
  const TimeParts& parts = response.parts;
  file_.Line(clients_[static_cast<std::size_t>(response.client)], response.thread,
             NameOf(response.cause), response.release_ns, response.start_ns, response.end_ns,
             response.deadline_ns, parts.queued_ns, parts.away_ns, parts.wakeup_ns,
             parts.executed_ns, parts.cores_ns.TotalNs(), parts.locks_ns.TotalNs(), parts.room_ns,
             response.RestNs(), WhoseOf(parts));
}

}  // namespace tcs
