#include "coordinator/dump/kernel.h"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <fstream>
#include <set>
#include <sstream>
#include <vector>

#include "coordinator/os/mutex_owner.h"

namespace tcs {

namespace {

using Json = nlohmann::ordered_json;

std::string FirstLine(const std::string& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  return line;
}

}  // namespace

std::string KernelNameOf(pid_t pid) { return FirstLine(fmt::format("/proc/{}/comm", pid)); }

Json KernelStateOf(pid_t pid, pid_t tid) {
  const std::string folder = fmt::format("/proc/{}/task/{}", pid, tid);
  const std::string stat = FirstLine(folder + "/stat");
  const std::size_t begin = stat.find('('), end = stat.rfind(')');
  if (begin == std::string::npos || end == std::string::npos) return nullptr;
  // The fields from the third on, which is the state.
  std::vector<std::string> fields;
  std::istringstream rest(stat.substr(end + 1));
  for (std::string field; rest >> field;) fields.push_back(field);
  constexpr std::size_t kState = 0, kUser = 11, kSystem = 12, kProcessor = 36;
  if (fields.size() <= kProcessor) return nullptr;
  const std::int64_t tick_ns = 1'000'000'000 / sysconf(_SC_CLK_TCK);
  Json state = {
      {"name", stat.substr(begin + 1, end - begin - 1)},
      {"state", fields[kState]},
      {"cpu", std::atoi(fields[kProcessor].c_str())},
      {"processor_ns",
       (std::atoll(fields[kUser].c_str()) + std::atoll(fields[kSystem].c_str())) * tick_ns}};
  const std::string in = FirstLine(folder + "/wchan");
  if (!in.empty() && in != "0") state["in"] = in;
  // "running", or the number of the call and its arguments; -1: the thread waits, but in no call.
  const std::string call = FirstLine(folder + "/syscall");
  if (!call.empty() && call[0] >= '0' && call[0] <= '9') state["call"] = std::atoi(call.c_str());
  return state;
}

void AddWhatTheKernelKnows(Json* state) {
  for (Json& robot : state->at("robots")) {
    for (Json& process : robot.at("processes")) {
      const pid_t pid = process.at("pid").get<pid_t>();
      process["name"] = KernelNameOf(pid);
      std::set<pid_t> tids;
      for (const Json& thread : process.at("threads")) tids.insert(thread.at("tid").get<pid_t>());
      for (Json& thread : process.at("threads")) {
        thread["kernel"] = KernelStateOf(pid, thread.at("tid").get<pid_t>());
        const auto futex = thread.find("futex");
        if (futex == thread.end() || futex->contains("owner")) continue;
        // Of shared memory only the file's place is known.
        if (futex->at("process").get<pid_t>() == 0) continue;
        const auto owner = OwnerOfMutex(pid, futex->at("address").get<std::uint64_t>(),
                                        [&tids](pid_t tid) { return tids.contains(tid); });
        if (owner) (*futex)["owner"] = *owner;
      }
    }
  }
}

}  // namespace tcs
