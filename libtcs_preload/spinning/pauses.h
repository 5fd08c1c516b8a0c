// Pauses of a program that spins, that is, looks at memory until another thread has changed it.
//
// On one processor of the host that thread cannot run meanwhile. So a thread that spins tells the
// coordinator, which has the others come along, and the thread itself look again (spin_waits.h
// there).
#pragma once

#include <cstdint>

#include "libtcs_preload/guest.h"

extern "C" {
// Called in place of the instruction, as entries.h says of reads of the counter: all registers,
// flags and vectors are preserved.
__attribute__((visibility("hidden"))) void tcs_pause();

// `site`: where the program goes on. 0: the pause is to be counted by tcs_pause_in_turn. Uses
// general registers only.
__attribute__((visibility("hidden"))) int tcs_pause_at_once(std::uintptr_t site);
// May wait until the thread has its turn again.
__attribute__((visibility("hidden"))) void tcs_pause_in_turn(std::uintptr_t site);
}

namespace tcs::preload {

// A yield, which counts as a pause at that place. In an interposed call.
void YieldCounted(GuestThread& thread, std::uintptr_t site);

// The thread was at that instruction: says in its slot whether it spins without pauses.
void NoteWhetherInLoop(GuestThread& thread, std::uintptr_t at);

}  // namespace tcs::preload
