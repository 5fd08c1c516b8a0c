// Where a process of tcsim's is when it dies of a fault of its own: for the report that its user is
// asked for.
#pragma once

namespace tcs {

// From now on the process writes on stderr which functions it is in before it dies of SIGABRT,
// SIGSEGV, SIGBUS, SIGFPE or SIGILL: a function as its file and the place there, as `addr2line -e
// FILE PLACE` takes them. Changes nothing for signals that are handled already. Programs that the
// process executes do not inherit that. Call it before there are threads.
void TellWhereItDies();

}  // namespace tcs
