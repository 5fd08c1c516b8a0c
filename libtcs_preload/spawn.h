// Telling the coordinator of new threads and children: new threads and children will attach, at
// their first turns. A thread or process that the kernel makes for a thread that says nothing of it
// has its place, and turns, without that.
#pragma once

#include <sys/types.h>

#include "libtcs_preload/guest.h"

namespace tcs::preload {

// The thread makes a thread or a child, of which it tells next. Between these two calls nothing
// else that it says counts as such; null: does nothing.
void BeginAnnouncement(GuestThread* thread);
void EndAnnouncement(GuestThread* thread);

// As both calls, the second at the end of a scope, which no child by fork comes to.
class Announcement {
 public:
  explicit Announcement(GuestThread* thread) : thread_(thread) { BeginAnnouncement(thread_); }
  ~Announcement() { EndAnnouncement(thread_); }
  Announcement(const Announcement&) = delete;
  Announcement& operator=(const Announcement&) = delete;

 private:
  GuestThread* const thread_;
};

void TellSpawned(GuestThread& thread, pid_t pid);

}  // namespace tcs::preload
