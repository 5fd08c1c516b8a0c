#include "coordinator/metrics/client_metrics.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <utility>
#include <variant>

namespace tcs {

namespace {

constexpr std::size_t kReadAtOnce = 64 << 10;
constexpr std::int64_t kMostAtOnce = 1 << 30;

// The client's log, opened. None if it is no file: a program may have put something else in its
// place.
UniqueFd OpenLog(const std::string& path) {
  UniqueFd fd(open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOCTTY | O_NONBLOCK));
  struct stat is {};
  if (fd && (fstat(fd.get(), &is) != 0 || !S_ISREG(is.st_mode))) fd.Reset();
  return fd;
}

}  // namespace

void ClientMetrics::Add(const std::string& client, const std::string& path) {
  Output& output = outputs_[client];
  output.client = client;
  output.path = path;
}

// A read takes longer than all else here, so that many small pieces are read at once.
void ClientMetrics::Grew(const std::string& client, std::int64_t end, std::int64_t now_ns) {
  const auto found = outputs_.find(client);
  if (found == outputs_.end()) return;
  Output& output = found->second;
  const std::int64_t known = output.ahead.empty() ? output.read : output.ahead.back().end;
  if (output.is_left || end <= known) return;
  if (end - known > kMostAtOnce) {
    output.is_left = true;
    warn_(
        fmt::format("{} has made its standard output longer by more than {} MiB at once; what "
                    "it prints of metrics from then on is left out",
                    client, kMostAtOnce >> 20));
    return;
  }
  if (!output.ahead.empty() && output.ahead.back().now_ns == now_ns) {
    output.ahead.back().end = end;
  } else {
    output.ahead.push_back({end, now_ns});
  }
  if (end - output.read >= static_cast<std::int64_t>(kReadAtOnce)) Read(output);
}

void ClientMetrics::CatchUp() {
  for (auto& [client, output] : outputs_) Read(output);
}

void ClientMetrics::Read(Output& output) {
  const std::vector<Piece> pieces = std::exchange(output.ahead, {});
  if (pieces.empty()) return;
  if (!output.fd) output.fd = OpenLog(output.path);
  if (!output.fd) return;
  char bytes[kReadAtOnce];
  std::int64_t begin = 0, end = 0;  // of what is in there, in the file
  for (const Piece& piece : pieces) {
    const auto on_line = [&](std::string_view line, std::int64_t number) {
      Take(output, line, number, piece.now_ns);
    };
    while (output.read < piece.end) {
      if (output.read >= end) {
        const ssize_t size = pread(output.fd.get(), bytes, sizeof bytes, output.read);
        if (size <= 0) return;
        begin = output.read;
        end = begin + size;
      }
      const std::int64_t until = std::min(end, piece.end);
      output.finder.Feed(
          {bytes + (output.read - begin), static_cast<std::size_t>(until - output.read)}, on_line);
      output.read = until;
    }
  }
}

void ClientMetrics::Finish(std::int64_t now_ns) {
  for (auto& [client, output] : outputs_) {
    struct stat is {};
    const UniqueFd log = OpenLog(output.path);
    if (log && fstat(log.get(), &is) == 0) Grew(client, is.st_size, now_ns);
    Read(output);
    output.finder.Finish([&, &of = output](std::string_view line, std::int64_t number) {
      Take(of, line, number, now_ns);
    });
  }
}

void ClientMetrics::Take(Output& output, std::string_view line, std::int64_t number,
                         std::int64_t now_ns) {
  const auto parsed = ParseMetricLine(line);
  if (const auto* what = std::get_if<std::string>(&parsed)) {
    Complain(output, number, *what);
    return;
  }
  const auto& metric = std::get<MetricLine>(parsed);
  std::int64_t time_ns = now_ns;
  if (metric.reading_ns) {
    const auto shown = VirtualTimeOfReading(*metric.reading_ns, now_ns, clocks_);
    if (!shown) {
      Complain(output, number,
               fmt::format("has the time {}.{:09} s, which no clock of the program shows in this "
                           "run",
                           *metric.reading_ns / 1'000'000'000, *metric.reading_ns % 1'000'000'000));
      return;
    }
    time_ns = *shown;
  }
  const int of = NumberOf(output, metric.name);
  if (of < 0) {
    Complain(
        output, number,
        fmt::format("names {}, the client's metric number {}, and no more than {} are taken",
                    metric.name, MetricBook::kMostOfOneSource + 1, MetricBook::kMostOfOneSource));
  } else if (!book_.Add(of, time_ns, metric.value)) {
    warn_(fmt::format(
        "{} has printed more than {} values of the metric {}; metrics.csv has these, its figures "
        "are of all",
        output.client, MetricBook::kMostLines, metric.name));
  }
}

int ClientMetrics::NumberOf(Output& output, std::string_view name) {
  if (const auto known = output.numbers.find(name); known != output.numbers.end()) {
    return known->second;
  }
  const int number = book_.NumberOf(output.client, name);
  if (number >= 0) output.numbers.emplace(name, number);
  return number;
}

void ClientMetrics::Complain(Output& output, std::int64_t number, const std::string& what) {
  if (std::exchange(output.has_complained, true)) return;
  warn_(
      fmt::format("{}: a line that begins with tcs-metric {}, so it is no metric ({}:{}); write "
                  "tcs-metric NAME VALUE [TIME]; further lines of this client that are none are "
                  "left out without a word",
                  output.client, what, output.path, number));
}

}  // namespace tcs
