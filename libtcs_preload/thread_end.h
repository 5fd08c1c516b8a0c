// The coordinator learns that a thread ends from the thread, whichever way it goes: returning,
// pthread_exit, cancelled.
#pragma once

namespace tcs::preload {

// Once per program, before any other library can ask for a key: keys are destroyed in the order of
// their making.
void PrepareThreadEnds();

// The calling thread has just registered.
void WatchThreadEnd();

}  // namespace tcs::preload
