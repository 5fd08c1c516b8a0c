// What is in the descriptors of a simulated run, and which of them its coordinator waits for. Their
// numbers are the host's, which has nothing in them; a descriptor that nobody has put anything into
// here is never ready.
//
// Ready descriptors of a set are told in the order in which they became ready, and each goes to the
// end once it was told, as epoll has it.
#pragma once

#include <sys/epoll.h>
#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <span>
#include <vector>

namespace tcs::simulate {

class Descriptors {
 public:
  // The number is a new descriptor's: nothing is in it, and nobody waits for it.
  void Open(int fd);

  // Counts, as an eventfd's: readable while it is not 0.
  void Raise(int fd);
  // One less. There must be one.
  void Lower(int fd);
  // All. False: there are none.
  bool Take(int fd);

  // What is written to one can be read from the other.
  void Join(int writes, int reads);
  void Write(int fd, const void* from, std::size_t size);
  // What there is, at most so much; -1 and EAGAIN if that is nothing.
  ssize_t Read(int fd, void* to, std::size_t size);

  // A set is while it has events.
  bool IsReadable(int fd) const;

  // As epoll_ctl.
  bool ChangeSet(int set, int operation, int fd, const epoll_event* event);
  std::size_t TakeEvents(int set, std::span<epoll_event> events);

 private:
  struct File {
    std::uint64_t count = 0;
    std::vector<unsigned char> bytes;
    bool IsReadable() const { return count > 0 || !bytes.empty(); }
  };
  struct WaitSet {
    std::map<int, epoll_event> awaited;
    std::deque<int> ready;  // whatever of these is readable still, and awaited
  };

  void BecameReady(int fd);
  bool IsReady(const WaitSet& set, int fd) const;
  bool HasEvents(const WaitSet& set) const;

  std::map<int, File> files_;
  std::map<int, int> pipes_;
  std::map<int, WaitSet> sets_;
};

}  // namespace tcs::simulate
