// TCS_CHECK(condition): a bug of ours ends the program with one line that says where. Always on.
#pragma once

#include <cstdio>
#include <cstdlib>

#define TCS_CHECK(condition)                                                                      \
  do {                                                                                            \
    if (!(condition)) {                                                                           \
      std::fprintf(stderr, "tcs: a bug in tcs: %s does not hold (%s:%d)\n", #condition, __FILE__, \
                   __LINE__);                                                                     \
      std::abort();                                                                               \
    }                                                                                             \
  } while (false)
