// Datagrams that were sent to where nobody received any. Pure.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace tcs {

struct Unheard {
  std::string sender;  // ROBOT/CLIENT
  std::string where;   // "UDP port 27601", "@robot/commands"
  std::int64_t sent = 0;
};

struct Heard {
  std::string receiver;  // ROBOT/CLIENT
  std::string where;
};

// A sentence for each place, which names the clients that received elsewhere, as far as they are
// few.
std::vector<std::string> SentencesOn(const std::vector<Unheard>& unheard,
                                     const std::vector<Heard>& heard);

}  // namespace tcs
