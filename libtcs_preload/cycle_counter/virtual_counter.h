// What the virtual cycle counter shows. Called by entries.cc, as it says there.
#pragma once

#include <cstdint>

extern "C" {

// 0: it may not be read without a look at the coordinator. Uses general registers only.
__attribute__((visibility("hidden"))) std::uint64_t tcs_counter_at_once();
// May wait until the thread has its turn again, as a read of the clock does.
__attribute__((visibility("hidden"))) std::uint64_t tcs_counter_in_turn();
// What rdtscp says of the processor. Uses general registers only.
__attribute__((visibility("hidden"))) std::uint32_t tcs_counter_processor();
}
