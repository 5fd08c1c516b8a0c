#include "coordinator/perfetto/schedule.h"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <optional>

#include "coordinator/text/csv.h"

namespace tcs::perfetto {
namespace {

// The text after `key`, which a line of the trace has once.
std::optional<std::string_view> After(std::string_view line, std::string_view key) {
  const std::size_t at = line.find(key);
  if (at == std::string_view::npos) return std::nullopt;
  return line.substr(at + key.size());
}

std::optional<std::int64_t> NumberAfter(std::string_view line, std::string_view key) {
  const auto text = After(line, key);
  std::int64_t number = 0;
  if (!text || std::from_chars(text->begin(), text->end(), number).ec != std::errc()) {
    return std::nullopt;
  }
  return number;
}

// "12.345" are microseconds: three decimals, as the run writes them.
std::optional<std::int64_t> NsAfter(std::string_view line, std::string_view key) {
  const auto text = After(line, key);
  if (!text) return std::nullopt;
  std::int64_t us = 0, ns = 0;
  const auto whole = std::from_chars(text->begin(), text->end(), us);
  if (whole.ec != std::errc() || text->end() - whole.ptr < 4 || *whole.ptr != '.') {
    return std::nullopt;
  }
  const auto rest = std::from_chars(whole.ptr + 1, whole.ptr + 4, ns);
  if (rest.ec != std::errc() || rest.ptr != whole.ptr + 4) return std::nullopt;
  return us * 1000 + ns;
}

}  // namespace

LoadResult<Schedule> Schedule::Read(const std::string& path) {
  auto text = ReadFile(path);
  if (!text) {
    return LoadError{path + " cannot be read; give a folder that `tcsim run` wrote"};
  }
  Schedule schedule;
  schedule.text_ = std::move(*text);
  const std::string_view all = schedule.text_;
  const std::size_t begin = all.find('\n'), end = all.rfind("\n]}");
  if (!all.starts_with("{\"displayTimeUnit\"") || end == std::string_view::npos || end < begin) {
    return LoadError{path + " is no schedule of a run of this tcsim; run it again"};
  }
  const std::string_view events = all.substr(begin + 1, end > begin ? end - begin - 1 : 0);
  schedule.events_ = events;
  for (std::size_t at = 0; at < events.size();) {
    const std::size_t line_end = std::min(events.find('\n', at), events.size());
    schedule.TakeLine(events.substr(at, line_end - at));
    at = line_end + 1;
  }
  return schedule;
}

void Schedule::TakeLine(std::string_view line) {
  if (line.ends_with(',')) line.remove_suffix(1);
  const auto pid = NumberAfter(line, "\"pid\":"), tid = NumberAfter(line, "\"tid\":");
  if (pid) last_pid_ = std::max(last_pid_, static_cast<int>(*pid));
  if (!pid || !tid) return;
  const int thread = static_cast<int>(*tid);
  if (line.starts_with(R"({"ph":"M","name":"thread_name")")) {
    const auto json = nlohmann::json::parse(line, nullptr, false);
    if (json.is_discarded()) return;
    const std::string name = json["args"].value("name", "");
    rows_[name] = {static_cast<int>(*pid), thread, {}};
    names_[thread] = name;
  } else if (line.starts_with(R"({"ph":"X")")) {
    const auto from = NsAfter(line, "\"ts\":"), length = NsAfter(line, "\"dur\":");
    const auto name = names_.find(thread);
    if (from && length && name != names_.end()) {
      rows_[name->second].busy.emplace_back(*from, *from + *length);
    }
  }
}

const Row* Schedule::Find(const std::string& name) const {
  const auto found = rows_.find(name);
  return found == rows_.end() ? nullptr : &found->second;
}

const Row* Schedule::ThatStopped(const std::string& client, std::int64_t at_ns) const {
  return At(client, at_ns, Edge::kEnd);
}

const Row* Schedule::ThatBegan(const std::string& client, std::int64_t at_ns) const {
  return At(client, at_ns, Edge::kBegin);
}

const Row* Schedule::At(const std::string& client, std::int64_t at_ns, Edge edge) const {
  const Row* busy = nullptr;
  const std::string further = client + " #";
  for (auto row = rows_.lower_bound(client); row != rows_.end(); ++row) {
    if (!row->first.starts_with(client)) break;
    if (row->first != client && !row->first.starts_with(further)) continue;
    const auto& slices = row->second.busy;
    // The first slice that goes on until then or longer; a few slices may touch that time.
    auto slice =
        std::ranges::lower_bound(slices, at_ns, {}, &std::pair<std::int64_t, std::int64_t>::second);
    for (; slice != slices.end() && slice->first <= at_ns; ++slice) {
      if ((edge == Edge::kEnd ? slice->second : slice->first) == at_ns) return &row->second;
      busy = &row->second;
    }
  }
  return busy != nullptr ? busy : Find(client);
}

}  // namespace tcs::perfetto
