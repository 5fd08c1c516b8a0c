// Metrics that clients print (`tcs-metric NAME VALUE [TIME]`), read from the clients' logs once
// they are there. The logs are the clients' own and stay as they are; a program that prints takes
// no other time for it.
//
// Not thread-safe.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "coordinator/metrics/line_finder.h"
#include "coordinator/metrics/metric_book.h"
#include "coordinator/metrics/metric_line.h"
#include "coordinator/port/unique_fd.h"

namespace tcs {

class ClientMetrics {
 public:
  // `warn` is told of a client's first line that is meant to tell of a metric and does not. `book`
  // and `warn` outlive this object.
  ClientMetrics(MetricBook& book, std::function<void(const std::string&)> warn)
      : book_(book), warn_(std::move(warn)) {}

  void Begin(const ProgramClocks& clocks) { clocks_ = clocks; }
  // The client's standard output goes to that file, of which there is nothing yet.
  void Add(const std::string& client, const std::string& path);
  // Up to byte `end`, the client's output was there at `now_ns`. The output is read later, with
  // what follows.
  void Grew(const std::string& client, std::int64_t end, std::int64_t now_ns);
  // Reads the output that Grew was told of. A client that has made its log longer than a program
  // can print in a while is left out: the read would keep the run waiting.
  void CatchUp();
  // Takes all clients' output that is there at the run's end.
  void Finish(std::int64_t now_ns);

 private:
  // The output that was there at a time.
  struct Piece {
    std::int64_t end, now_ns;
  };
  struct Output {
    std::string client, path;
    UniqueFd fd;               // open once there is output
    std::int64_t read = 0;     // bytes
    std::vector<Piece> ahead;  // the output to be read, in its order
    MetricLineFinder finder;
    bool has_complained = false, is_left = false;
    std::map<std::string, int, std::less<>> numbers;  // of its metrics
  };
  void Read(Output& output);
  void Take(Output& output, std::string_view line, std::int64_t number, std::int64_t now_ns);
  int NumberOf(Output& output, std::string_view name);
  void Complain(Output& output, std::int64_t number, const std::string& what);

  MetricBook& book_;
  std::function<void(const std::string&)> warn_;
  ProgramClocks clocks_;
  std::map<std::string, Output, std::less<>> outputs_;  // by client
};

}  // namespace tcs
