// The owners of locks that threads wait for, as far as locks say who has them: mutexes of the C
// library's, and locks that lend priority. Not semaphores, conditions, or a language's own.
//
// For the coordinator's thread only. Reads the memory of programs.
#pragma once

#include <optional>

#include "coordinator/answers/answer_book.h"
#include "coordinator/queues/futex_table.h"
#include "coordinator/tasks/answer_feed.h"
#include "coordinator/tasks/run_state.h"

namespace tcs {

// The thread that has the lock that `task` waits for; null: `task` waits for no lock that says so.
const Task* OwnerOfAwaitedLock(const Task& task, const RunState& run, const FutexTable& futexes);

// The reason for which a thread begins to wait in the midst of its work: a lock, or that others
// take what the thread sends. Any other wait is the end of an activation.
std::optional<AnswerBook::Pause> PauseOf(const Task& task, const RunState& run,
                                         const FutexTable& futexes, const AnswerFeed& answers);

}  // namespace tcs
