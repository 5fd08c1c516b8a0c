// Which datagrams reached whom, and when: datagrams.csv of a run that is recorded, a line for each
// UDP or UNIX datagram of a channel or between two programs.
//
// The file is made with the first line. For the coordinator's thread only.
#pragma once

#include <string>

#include "coordinator/trace/csv_file.h"
#include "shm/time_kinds.h"

namespace tcs {

class DatagramLog {
 public:
  // A file that an earlier run has left there is removed.
  void Open(const std::string& folder);
  void Write(VirtualTime sent, const std::string& sender, VirtualTime received,
             const std::string& receiver, const std::string& channel);
  void Flush() { file_.Flush(); }
  // Empty on success, else one sentence.
  [[nodiscard]] std::string Close();

 private:
  std::string path_;  // empty: nothing is written
  CsvFile file_;
  std::string failure_;
};

}  // namespace tcs
