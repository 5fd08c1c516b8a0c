// The reference of dispatching: the least with which one process can have others run in turns, each
// of which says when it is done. A futex is opened, epoll slept in, and a pipe read; priorities are
// set once. What it costs with more processes is the kernel's and the caches'.
#pragma once

#include <optional>

namespace tcs::bench {

// Microseconds for each turn of one of so many processes, over about `turns` of them, on the
// processor that this process is bound to. None, with a sentence on stderr, if they cannot be had.
std::optional<double> MeasureBareSwitches(int processes, int turns);

}  // namespace tcs::bench
