// Something that must hold does not.
#pragma once

namespace tcs::simulate {

// Ends the simulation's process, with that sentence, the seeds, and the command that does it again.
[[noreturn]] __attribute__((format(printf, 1, 2))) void Broken(const char* what, ...);

}  // namespace tcs::simulate
