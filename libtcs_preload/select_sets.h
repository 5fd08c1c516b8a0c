// The three sets of select(2), for any number of descriptors and for a call that looks at them more
// than once. The kernel works on a copy, and the program's own sets change when the call is over.
#pragma once

#include <poll.h>
#include <sys/select.h>

#include <cstddef>
#include <cstdint>

#include "libtcs_preload/guest.h"

namespace tcs::preload {

class SelectSets {
 public:
  // Copies the sets' first `count` descriptors, or as many as the process can have. error() is then
  // 0, or the error of select.
  SelectSets(int count, fd_set* read, fd_set* write, fd_set* except);
  SelectSets(const SelectSets&) = delete;
  SelectSets& operator=(const SelectSets&) = delete;
  int error() const { return error_; }

  // The result that select finds at once, as the kernel returns it.
  long Probe();

  // As Probe, once the call has waited: a descriptor that has been closed meanwhile is no error,
  // but ready, and the call is over.
  long ProbeAgain();

  // The result of such a probe, less what is hidden (outside.h).
  long WithoutHidden(GuestThread& thread, long found);

  // The descriptors of all three sets, as poll takes them. Valid while this object lives.
  const pollfd* Wanted(unsigned long* count);

  // Shows the program what the last probe found; an error, or 0.
  int PutBack();

 private:
  static constexpr int kSets = 3;
  static constexpr std::size_t kWordBits = 64;
  // Sets of fd_set's size are kept on the stack, and so many descriptors for poll: threads have
  // stacks of 16 KiB, and may have used most of it.
  static constexpr std::size_t kOrdinary = FD_SETSIZE, kFew = 32;

  // Memory that lives as long as this object; null: there is none.
  class Mapping {
   public:
    ~Mapping();
    void* Make(std::size_t size);

   private:
    void* memory_ = nullptr;
    std::size_t size_ = 0;
  };

  bool MakeRoom();
  bool MakeRoomForWanted();
  std::uint64_t* Set(std::uint64_t* sets, int set) const { return sets + set * words_; }
  bool Wants(int set, std::size_t fd) const;
  fd_set* const user_[kSets];
  std::size_t count_, words_ = 0;
  int error_ = 0;
  std::uint64_t *wanted_ = nullptr, *found_ = nullptr;
  pollfd* fds_ = nullptr;
  Mapping mapped_sets_, mapped_fds_;
  std::uint64_t ordinary_sets_[2 * kSets * kOrdinary / kWordBits];
  pollfd ordinary_fds_[kFew];
};

}  // namespace tcs::preload
