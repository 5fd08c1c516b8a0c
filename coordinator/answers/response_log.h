// How long each activation by time or input took, and the causes of that time: responses.csv
// (docs/RESULTS.md), which `tcsim explain` reads. A file that was never opened is not written.
#pragma once

#include <string>
#include <vector>

#include "coordinator/answers/response.h"
#include "coordinator/trace/csv_file.h"

namespace tcs {

class ResponseLog {
 public:
  // With the names of clients, by their numbers. Empty on success, else one sentence.
  [[nodiscard]] std::string Open(const std::string& path, std::vector<std::string> clients);
  void Write(const Response& response);
  void Flush() { file_.Flush(); }
  [[nodiscard]] std::string Close() { return file_.Close(); }

 private:
  std::string WhoseOf(const TimeParts& parts) const;

  CsvFile file_;
  std::vector<std::string> clients_;
};

}  // namespace tcs
