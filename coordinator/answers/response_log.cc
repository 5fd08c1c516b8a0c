#include "coordinator/answers/response_log.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <utility>

namespace tcs {

namespace {

// As long as a text of a line may be (CsvFile); who had least is left out beyond that.
constexpr std::size_t kMostWhose = 250;

std::int64_t SumOf(const std::map<int, std::int64_t>& part) {
  std::int64_t sum_ns = 0;
  for (const auto& [client, ns] : part) sum_ns += ns;
  return sum_ns;
}

}  // namespace

std::string ResponseLog::Open(const std::string& path, std::vector<std::string> clients) {
  clients_ = std::move(clients);
  return file_.Open(path,
                    "client,thread,cause,release_ns,start_ns,end_ns,deadline_ns,queued_ns,away_ns,"
                    "executed_ns,cores_ns,locks_ns,room_ns,rest_ns,whose");
}

// "core:CLIENT=NS lock:CLIENT=NS", who had most first.
std::string ResponseLog::WhoseOf(const TimeParts& parts) const {
  if (parts.cores_ns.empty() && parts.locks_ns.empty()) return {};
  std::vector<std::pair<std::int64_t, std::string>> shares;
  const auto add = [&](const std::map<int, std::int64_t>& part, std::string_view of) {
    for (const auto& [client, ns] : part) {
      const std::string name = client < 0 ? "" : clients_[static_cast<std::size_t>(client)];
      shares.emplace_back(ns, fmt::format("{}:{}={}", of, name, ns));
    }
  };
  add(parts.cores_ns, "core");
  add(parts.locks_ns, "lock");
  std::ranges::stable_sort(shares, std::greater<>{}, &decltype(shares)::value_type::first);
  std::string whose;
  for (const auto& [ns, share] : shares) {
    if (whose.size() + 1 + share.size() > kMostWhose) break;
    whose += (whose.empty() ? "" : " ") + share;
  }
  return whose;
}

void ResponseLog::Write(const Response& response) {
  if (!file_.is_open()) return;
  const TimeParts& parts = response.parts;
  file_.Line(clients_[static_cast<std::size_t>(response.client)], response.thread,
             NameOf(response.cause), response.release_ns, response.start_ns, response.end_ns,
             response.deadline_ns, parts.queued_ns, parts.away_ns, parts.executed_ns,
             SumOf(parts.cores_ns), SumOf(parts.locks_ns), parts.room_ns, response.RestNs(),
             WhoseOf(parts));
}

}  // namespace tcs
