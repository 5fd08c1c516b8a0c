// Where functions begin and end that no table for unwinding lists: in assembly language, and Go's.
//
// Pure; async-signal-safe.
#pragma once

#include "shm/machine_code/functions.h"
#include "shm/machine_code/instruction.h"

namespace tcs::shm {

namespace machine_code {

inline constexpr std::ptrdiff_t kLongestUnlisted = 4096;

// The function between the int3 instructions that fill the way to where functions are aligned.
inline CodeRange FunctionBetweenFillers(CodeRange code, Code at) {
  constexpr std::uint8_t kFiller = 0xcc;
  Code begin = at - reinterpret_cast<std::uintptr_t>(at) % 16;
  while (begin > code.begin && begin[-1] != kFiller) {
    begin -= 16;
    if (at - begin > kLongestUnlisted) return {};
  }
  if (begin <= code.begin) return {};
  for (Code here = begin; here < code.end && here - begin < kLongestUnlisted;) {
    const Instruction one = Decode(here, code.end);
    if (one.size == 0) return {};
    here += one.size;
    const bool goes_on =
        one.flow == Flow::kNext || one.flow == Flow::kBranch || one.flow == Flow::kCall;
    if (!goes_on && here > at && here < code.end && *here == kFiller) return {begin, here};
  }
  return {};
}

}  // namespace machine_code

// The function that has an instruction at `at`; an empty range: the function is not known.
inline CodeRange FunctionWithoutEntry(CodeRange code, const UnwindTable& listed, Code at) {
  const CodeRange gap = listed.GapAround(at);
  if (!gap.IsEmpty() && gap.end - gap.begin <= machine_code::kLongestUnlisted) return gap;
  return machine_code::FunctionBetweenFillers(code, at);
}

}  // namespace tcs::shm
