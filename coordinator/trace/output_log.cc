#include "coordinator/trace/output_log.h"

#include <sys/inotify.h>
#include <sys/stat.h>
#include <unistd.h>

#include <utility>

namespace tcs {

namespace {

constexpr const char* kOutput = "out";

}  // namespace

std::string OutputLog::Open(const std::string& folder) {
  folder_ = folder;
  const std::string path = folder + "/output.csv";
  unlink(path.c_str());
  watch_.Reset(inotify_init1(IN_NONBLOCK | IN_CLOEXEC));
  if (!watch_ || inotify_add_watch(watch_.get(), folder.c_str(), IN_MODIFY) < 0) {
    watch_.Reset();
    return {};
  }
  return csv_.Open(path, "time_ns,client,stream,begin,end");
}

void OutputLog::Add(const std::string& client, const std::string& file) {
  for (const char* name : {kOutput, "err"}) {
    const auto [at, added] = streams_.insert({file + "." + name + ".log", {client, name}});
    if (added) of_client_[client].push_back(&*at);
  }
}

void OutputLog::Hold(const std::string& client) {
  if (!watch_) return;
  const auto found = of_client_.find(client);
  if (found == of_client_.end()) return;
  for (Streams::value_type* stream : found->second) stream->second.is_held = true;
}

void OutputLog::LetGo(const std::string& client) {
  if (!watch_) return;
  const auto found = of_client_.find(client);
  if (found == of_client_.end()) return;
  for (Streams::value_type* stream : found->second) {
    stream->second.is_held = false;
    if (std::exchange(stream->second.has_grown, false)) grown_.push_back(stream);
  }
}

void OutputLog::LookAt(std::int64_t now_ns) {
  if (!watch_) return;
  for (Streams::value_type* stream : std::exchange(grown_, {})) Grew(*stream, now_ns);
  alignas(inotify_event) char events[8192];
  for (;;) {
    const ssize_t size = read(watch_.get(), events, sizeof events);
    if (size <= 0) return;
    for (const char* at = events; at < events + size;) {
      const auto& event = *reinterpret_cast<const inotify_event*>(at);
      at += sizeof event + event.len;
      if (event.len > 0) Grew(event.name, now_ns);
      if ((event.mask & IN_Q_OVERFLOW) == 0) continue;
      for (Streams::value_type& stream : streams_) Grew(stream, now_ns);
    }
  }
}

void OutputLog::Grew(const std::string& file, std::int64_t now_ns) {
  if (const auto found = streams_.find(file); found != streams_.end()) Grew(*found, now_ns);
}

void OutputLog::Grew(Streams::value_type& grown, std::int64_t now_ns) {
  auto& [file, stream] = grown;
  if (stream.is_held) {
    stream.has_grown = true;
    return;
  }
  struct stat is {};
  if (stat((folder_ + "/" + file).c_str(), &is) != 0) return;
  const std::int64_t before = std::exchange(stream.bytes, is.st_size);
  if (stream.bytes <= before) return;
  csv_.Line(now_ns, stream.client, stream.name, before, stream.bytes);
  if (grown_output_ && stream.name == kOutput) grown_output_(stream.client, stream.bytes, now_ns);
}

}  // namespace tcs
