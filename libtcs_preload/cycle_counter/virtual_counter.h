// The value of the virtual cycle counter. Called by entries.cc, as that file says.
#pragma once

#include <cstdint>

extern "C" {

// 0: the counter may not be read without a look at the coordinator. Uses general registers only.
__attribute__((visibility("hidden"))) std::uint64_t tcs_counter_at_once();
// May wait until the thread has its turn again, as a read of the clock does.
__attribute__((visibility("hidden"))) std::uint64_t tcs_counter_in_turn();
// The number of the processor that rdtscp tells. Uses general registers only.
__attribute__((visibility("hidden"))) std::uint32_t tcs_counter_processor();
}
