// Files by which the program meets what is outside of the run (shm/outside_files.h): what has come
// by them is there at once for anybody who looks, but to be seen only at the virtual time that the
// real time stands for which it took. What the program does with them the coordinator is told.
//
// Nothing here costs anything where the run knows of no such file. Async-signal-safe; errno stays.
#pragma once

#include <poll.h>
#include <sys/epoll.h>

#include <cstdint>

#include "libtcs_preload/fd_info.h"
#include "libtcs_preload/guest.h"
#include "shm/outside_files.h"

namespace tcs::preload {

using OutsidePlace = const shm::OutsideFiles::Place;

// False where the run knows of no such file.
bool IsAnythingOutside();

// Null: the file is none of these.
OutsidePlace* OutsideOf(int fd);

// What is there in the file is not to be seen now.
bool IsHidden(GuestThread& thread, OutsidePlace* place);
// The same; kAll: that a connection has been made, and it can be written to, is hidden, too.
enum class Hides { kNothing, kInput, kAll };
Hides HiddenOf(GuestThread& thread, OutsidePlace* place);

// The same for a look that does not wait: all that is to be seen now is there when this returns.
bool IsHiddenFromLook(GuestThread& thread, int fd);

// The thread is about to look into the epoll set. Returns as IsHiddenFromLook.
void BeginLookIntoSet(GuestThread& thread, int epoll_fd);

// The same for those that poll is to look at.
void BeginLooks(GuestThread& thread, const pollfd* fds, unsigned long count);

// Of what poll has found, without what is hidden. Returns how many descriptors are left of `found`.
long WithoutHidden(GuestThread& thread, pollfd* fds, unsigned long count, long found);

// An epoll set, as it is before the kernel is asked what there is in it: what it then tells of
// hidden members is taken out again, and told of later.
class HiddenMembers {
 public:
  HiddenMembers(GuestThread& thread, int epoll_fd);

  // Returns how many of `found` events are left.
  long TakeOut(epoll_event* events, long found) const;

 private:
  static constexpr int kMost = 8;
  void Read(GuestThread& thread);

  const int epoll_fd_;
  int count_ = 0;
  EpollMember members_[kMost];
};

// A GPU, an accelerator, a camera: they compute and see by themselves. `path` has just been opened.
bool IsDeviceOutside(const char* path);
void NoteOpens(int fd);

// What there is before the program sends by the file: what it has not taken by then is no answer.
struct OutsideAsk {
  std::uint64_t begun_tsc;
  bool has_input;
};
OutsideAsk BeginAsk(int fd);

// The program has connected the socket, or has begun to (`is_going_on`); has sent by it; has taken
// something from the file, or its end; is about to close it.
void NoteConnects(GuestThread& thread, int fd, std::uint64_t begun_tsc, bool is_going_on);
void NoteAsks(GuestThread& thread, int fd, const OutsideAsk& ask);
void NoteTakes(GuestThread& thread, int fd);
void NoteCloses(int fd);

// An ioctl is over: if it had to wait for what is outside, this returns when that is to be seen.
void EndIoctl();

}  // namespace tcs::preload
