// One attempt in a process of its own, so that what goes wrong in it is seen from outside.
#pragma once

#include <functional>
#include <string>

namespace tcs::fuzz {

// `attempt` returns what is wrong with how it went, or nothing. What came of it: nothing, that, or
// that it crashed, or took more than `most_s` seconds of processor time.
std::string Outcome(const std::function<std::string()>& attempt, unsigned most_s = 60);

}  // namespace tcs::fuzz
