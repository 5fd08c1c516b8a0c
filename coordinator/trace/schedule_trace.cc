#include "coordinator/trace/schedule_trace.h"

#include <fmt/compile.h>
#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <iterator>
#include <nlohmann/json.hpp>
#include <utility>

#include "coordinator/os/file_errors.h"

namespace tcs {

namespace {

constexpr std::size_t kNotedAtOnce = 2048;
constexpr std::string_view kSeparator = ",\n", kEnd = "\n]}\n";

std::string Quoted(const std::string& text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace

ScheduleTrace::~ScheduleTrace() {
  if (file_ != nullptr) std::fclose(file_);
}

std::string ScheduleTrace::Open(const std::string& path) {
  path_ = path;
  file_ = std::fopen(path.c_str(), "we");
  if (file_ == nullptr) return CannotBeWritten(path);
  noted_.reserve(kNotedAtOnce);
  std::setvbuf(file_, nullptr, _IONBF, 0);
  const std::string begin = "{\"displayTimeUnit\":\"ms\",\"traceEvents\":[\n" + std::string(kEnd);
  std::fwrite(begin.data(), 1, begin.size(), file_);
  return {};
}

// Writes `events` in place of the file's end, which comes after them.
void ScheduleTrace::Write(std::string_view events) {
  const std::string text = std::string(events) + std::string(kEnd);
  std::fseek(file_, -static_cast<long>(kEnd.size()), SEEK_CUR);
  std::fwrite(text.data(), 1, text.size(), file_);
}

// Writes the event after all events that were noted before it: the file is the same, whenever the
// noted events are written.
void ScheduleTrace::Event(std::string_view json) {
  Flush();
  Write(std::string(std::exchange(first_, false) ? "" : kSeparator) + std::string(json));
}

int ScheduleTrace::AddRow(const std::string& group, const std::string& name) {
  auto found = std::find(groups_.begin(), groups_.end(), group);
  const auto pid = static_cast<int>(found - groups_.begin()) + 1;
  const auto tid = static_cast<int>(rows_.size()) + 1;
  if (file_ != nullptr && found == groups_.end()) {
    Event(fmt::format(R"({{"ph":"M","name":"process_name","pid":{},"args":{{"name":{}}}}})", pid,
                      Quoted(group)));
  }
  if (found == groups_.end()) groups_.push_back(group);
  if (file_ != nullptr) {
    Event(fmt::format(R"({{"ph":"M","name":"thread_name","pid":{},"tid":{},"args":{{"name":{}}}}})",
                      pid, tid, Quoted(name)));
  }
  rows_.push_back({pid});
  return tid - 1;
}

// Chrome's unit is the microsecond; three decimals keep every nanosecond.
void ScheduleTrace::WriteNoted() {
  fmt::memory_buffer text;
  for (const Noted& noted : noted_) {
    const int group = rows_[static_cast<std::size_t>(noted.row)].group;
    const std::int64_t start_ns = noted.start_ns, length_ns = noted.end_ns - start_ns;
    if (!std::exchange(first_, false)) text.append(kSeparator);
    const auto end = std::back_inserter(text);
    if (noted.what != nullptr) {
      fmt::format_to(
          end, FMT_COMPILE(R"({{"ph":"i","s":"t","name":"{}","pid":{},"tid":{},"ts":{}.{:03}}})"),
          noted.what, group, noted.row + 1, start_ns / 1000, start_ns % 1000);
    } else {
      fmt::format_to(
          end,
          FMT_COMPILE(
              R"({{"ph":"X","name":"run","pid":{},"tid":{},"ts":{}.{:03},"dur":{}.{:03}}})"),
          group, noted.row + 1, start_ns / 1000, start_ns % 1000, length_ns / 1000,
          length_ns % 1000);
    }
  }
  Write({text.data(), text.size()});
  noted_.clear();
}

void ScheduleTrace::Flush() {
  if (file_ != nullptr && !noted_.empty()) WriteNoted();
}

void ScheduleTrace::Note(const Noted& noted) {
  if (noted_.size() == kNotedAtOnce) WriteNoted();
  noted_.push_back(noted);
}

void ScheduleTrace::NoteSlice(int row) {
  Row& r = rows_[static_cast<std::size_t>(row)];
  if (r.has_slice) Note({row, nullptr, r.start_ns, r.end_ns});
  r.has_slice = false;
}

void ScheduleTrace::Slice(int row, std::int64_t start_ns, std::int64_t end_ns) {
  if (file_ == nullptr || start_ns > end_ns) return;
  Row& r = rows_[static_cast<std::size_t>(row)];
  if (!r.has_slice || start_ns != r.end_ns) {
    NoteSlice(row);
    r.has_slice = true;
    r.start_ns = start_ns;
  }
  r.end_ns = end_ns;
}

void ScheduleTrace::Instant(int row, const char* what, std::int64_t at_ns) {
  if (file_ == nullptr) return;
  Note({row, what, at_ns, at_ns});
}

std::string ScheduleTrace::Close() {
  if (file_ == nullptr) return {};
  for (int row = 0; row < static_cast<int>(rows_.size()); ++row) NoteSlice(row);
  WriteNoted();
  const bool bad = std::ferror(file_) != 0;
  const bool closed = std::fclose(file_) == 0;
  file_ = nullptr;
  if (bad || !closed) return NotWrittenWhole(path_);
  return {};
}

}  // namespace tcs
