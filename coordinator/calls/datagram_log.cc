#include "coordinator/calls/datagram_log.h"

#include <algorithm>
#include <filesystem>
#include <system_error>

namespace tcs {

void DatagramLog::Open(const std::string& folder) {
  path_ = folder + "/datagrams.csv";
  std::error_code ignored;
  std::filesystem::remove(path_, ignored);
}

void DatagramLog::Write(VirtualTime sent, const std::string& sender, VirtualTime received,
                        const std::string& receiver, const std::string& channel) {
  if (!file_.is_open()) {
    if (path_.empty() || !failure_.empty()) return;
    failure_ = file_.Open(path_, "sent_ns,sender,received_ns,receiver,channel");
    if (!failure_.empty()) return;
  }
  file_.Line(sent.ns(), sender, std::max(sent, received).ns(), receiver, channel);
}

std::string DatagramLog::Close() {
  std::string error = file_.Close();
  return failure_.empty() ? error : failure_;
}

}  // namespace tcs
