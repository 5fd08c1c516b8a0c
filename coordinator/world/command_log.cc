#include "coordinator/world/command_log.h"

namespace tcs {

std::string CommandLog::Open(const std::string& path) {
  return file_.Open(path, "sent_ns,acts_ns,channel,target,quantity,value");
}

}  // namespace tcs
