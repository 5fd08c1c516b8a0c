// What came in on the channels of commands: for the sentences about those where nothing did, or
// nothing of use.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "coordinator/scenario/scenario.h"

namespace tcs {

class CommandInput {
 public:
  // `warn` is told of the first thing on each channel that was no command.
  explicit CommandInput(std::function<void(const std::string&)> warn) : warn_(std::move(warn)) {}

  void Took(const std::string& channel) { ++counts_[channel].taken; }
  void Refused(const std::string& channel, const std::string& why);

  // At the end of the run: a sentence for each channel on which nothing came in, and for each on
  // which more than what was said at once was no command.
  std::vector<std::string> Complaints(const Scenario& scenario) const;

 private:
  struct Counts {
    std::int64_t taken = 0, refused = 0;
  };
  std::function<void(const std::string&)> warn_;
  std::map<std::string, Counts> counts_;  // by the channel's name
};

}  // namespace tcs
