// The files of calls that wait. A call holds the file that it was made on, never its number: Linux
// keeps the file while the call lasts, whether the number is closed meanwhile, replaced (dup2), or
// used again. Threads of a client wait by the coordinator's copies of their descriptors, so those
// copies are the files. When a wait is over the files are looked for by their numbers once more;
// where a number means another file, or none, the copies stay with the thread until its call is
// over. Then the shim asks for a descriptor of the file for each attempt that it makes, or waits
// for the file again.
//
// Nothing is kept where all numbers mean what they meant: the last one to close a file has to be
// the client.
//
// For the coordinator's thread only.
#pragma once

#include "coordinator/port/traps.h"
#include "coordinator/tasks/task.h"
#include "coordinator/tasks/wait.h"

namespace tcs {

class CallFiles {
 public:
  // The watched files are needed beyond the thread's wait, if their numbers come to mean other
  // files.
  static bool Keeps(const Task& task, const awaited::Descriptors& watched);
  // The thread's wait is over; it may have been for files that are to be kept.
  static void Keep(Task& task, Wait& wait);
  // The thread is to wait for something else, in a call on the descriptor of that number.
  static void Keep(Task& task, int number);
  // The same with the files that are kept already.
  static void KeepOn(Task& task);
  // The thread is about to go on, and is told whether files are kept (reply[0]). Files that it does
  // not need are not kept.
  static void LookAtNumbers(Task& task);

  // The thread has had a turn, in which it may have closed or replaced descriptors.
  static void NoteTurn(Task& task);

  // The shim asks for a file that was kept, or gives the kept files up.
  static bool AsksFor(const TrappedCall& call);
  // `task`: null if the caller is no thread of the run.
  static void Answer(Task* task, const TrappedCall& call);
};

}  // namespace tcs
