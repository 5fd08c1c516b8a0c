#include "coordinator/perfetto/event_writer.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace tcs::perfetto {
namespace {

constexpr std::size_t kAtOnce = 256 << 10;

std::string Quoted(std::string_view text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

// The format's unit is the microsecond; three decimals keep every nanosecond.
std::string Time(std::int64_t ns) { return fmt::format("{}.{:03}", ns / 1000, ns % 1000); }

}  // namespace

EventWriter::~EventWriter() { file_.Append(text_); }

void EventWriter::Event(std::string_view json) {
  if (has_events_) text_ += ",\n";
  has_events_ = true;
  text_ += json;
  if (text_.size() < kAtOnce) return;
  file_.Append(text_);
  text_.clear();
}

int EventWriter::AddGroup(std::string_view name) {
  Event(fmt::format(R"({{"ph":"M","name":"process_name","pid":{},"args":{{"name":{}}}}})",
                    ++last_pid_, Quoted(name)));
  return last_pid_;
}

void EventWriter::Counter(int group, std::string_view name, std::int64_t at_ns, Values values) {
  std::string args;
  for (const auto& [key, value] : values) {
    args += fmt::format("{}{}:{}", args.empty() ? "" : ",", Quoted(key), value);
  }
  Event(fmt::format(R"({{"ph":"C","name":{},"pid":{},"ts":{},"args":{{{}}}}})", Quoted(name), group,
                    Time(at_ns), args));
}

void EventWriter::Instant(const Row& row, std::string_view name, std::int64_t at_ns) {
  Event(fmt::format(R"({{"ph":"i","s":"t","cat":"output","name":{},"pid":{},"tid":{},"ts":{}}})",
                    Quoted(name), row.pid, row.tid, Time(at_ns)));
}

// An arrow goes from slice to slice: each end is a slice that takes no time.
void EventWriter::Flow(const End& from, const End& to) {
  ++flows_;
  FlowEnd(from, flows_, "flow_out");
  FlowEnd(to, flows_, "flow_in");
}

void EventWriter::FlowEnd(const End& end, std::uint64_t flow, std::string_view direction) {
  Event(fmt::format(
      R"({{"ph":"X","cat":"message","name":{},"pid":{},"tid":{},"ts":{},"dur":0,"bind_id":"{:#x}","{}":true}})",
      Quoted(end.name), end.row.pid, end.row.tid, Time(end.at_ns), flow, direction));
}

}  // namespace tcs::perfetto
