// Files by which the program meets what is outside of the run (shm/outside_files.h): data that has
// come by such a file is there at once for any thread that looks, but to be seen only at the
// virtual time that the real time stands for which it took. The coordinator is told what the
// program does with these files.
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

// Null: the file is no such file.
OutsidePlace* OutsideOf(int fd);

// True if the data that is there in the file is not to be seen now.
bool IsHidden(GuestThread& thread, OutsidePlace* place);
// As IsHidden; kAll: the fact that a connection has been made, and can be written to, is hidden,
// too.
enum class Hides { kNothing, kInput, kAll };
Hides HiddenOf(GuestThread& thread, OutsidePlace* place);

// As IsHidden, for a look that does not wait: all data that is to be seen now is there when the
// function returns.
bool IsHiddenFromLook(GuestThread& thread, int fd);

// The thread is about to look into the epoll set. Returns as IsHiddenFromLook.
void BeginLookIntoSet(GuestThread& thread, int epoll_fd);

// The thread is about to look at the descriptors by poll. Returns as IsHiddenFromLook.
void BeginLooks(GuestThread& thread, const pollfd* fds, unsigned long count);

// Takes what is hidden out of what poll has found. Returns how many descriptors are left of
// `found`.
long WithoutHidden(GuestThread& thread, pollfd* fds, unsigned long count, long found);

// An epoll set, as it is before the kernel is asked what there is in it: events that it then tells
// of hidden members are taken out again, and told of later.
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

// True for a GPU, an accelerator, a camera: such devices compute and see by themselves. `path` has
// just been opened.
bool IsDeviceOutside(const char* path);
void NoteOpens(int fd);

// The state before the program sends by the file: input that the program has not taken by then is
// no answer.
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

// An ioctl is over: if it had to wait for something outside, this function returns when that is to
// be seen.
void EndIoctl();

}  // namespace tcs::preload
