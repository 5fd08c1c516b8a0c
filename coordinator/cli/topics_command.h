// `tcsim topics`.
#pragma once

#include <string>

namespace tcs {

struct TopicsArguments {
  std::string folder;
  bool with_qos = false;
};

// The exit status.
int TopicsCommand(const TopicsArguments& arguments);

}  // namespace tcs
