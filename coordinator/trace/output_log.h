// When clients wrote their output: output.csv, a line for each piece that came to the end of a
// client's .out.log or .err.log, with the virtual time by which the piece was there.
//
// The files are the clients' own: no client reports its writes there, and a program that prints
// must not take other time than a program that does not. So the kernel is asked (inotify), once for
// each stop of a client, which takes 0.4 us. The reactor would get the notices at no cost, but at
// once: each write would wake the coordinator, which takes the processor from the program that
// writes. Not thread-safe.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "coordinator/port/unique_fd.h"
#include "coordinator/trace/csv_file.h"

namespace tcs {

class OutputLog {
 public:
  // `folder` is where the clients' files will be. Empty on success, else one sentence. Where the
  // kernel has no watch left to give, nothing is written.
  [[nodiscard]] std::string Open(const std::string& folder);
  // The client's files are called FILE.out.log and FILE.err.log.
  void Add(const std::string& client, const std::string& file);
  // `grown` is told of each piece of a client's standard output that has been noted: up to which
  // byte of the file.
  using Grown =
      std::function<void(const std::string& client, std::int64_t end, std::int64_t now_ns)>;
  void Tell(Grown grown) { grown_output_ = std::move(grown); }
  // Notes what has been written since the last time.
  void LookAt(std::int64_t now_ns);
  // Output that the client writes from now on counts as written by the time of the next LookAt
  // after LetGo.
  void Hold(const std::string& client);
  void LetGo(const std::string& client);
  void Flush() { csv_.Flush(); }
  [[nodiscard]] std::string Close() { return csv_.Close(); }

 private:
  struct Stream {
    std::string client;
    const char* name;
    std::int64_t bytes = 0;  // noted so far
    bool is_held = false, has_grown = false;
  };
  using Streams = std::map<std::string, Stream, std::less<>>;
  void Grew(const std::string& file, std::int64_t now_ns);
  void Grew(Streams::value_type& grown, std::int64_t now_ns);

  std::string folder_;
  UniqueFd watch_;
  Streams streams_;                                                     // by file
  std::map<std::string, std::vector<Streams::value_type*>> of_client_;  // the client's
  std::vector<Streams::value_type*> grown_;                             // grew while held
  Grown grown_output_;
  CsvFile csv_;
};

}  // namespace tcs
