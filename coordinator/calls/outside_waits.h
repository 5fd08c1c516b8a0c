// Waits of programs for what is outside of the run: for answers on sockets whose peer is outside,
// devices (GPUs, accelerators, cameras), and what `clients.NAME.outside` names.
//
// Such a wait takes real time, and virtual time leaps over whatever it can. So from a request on,
// while a thread waits or has looked for the answer, no leaf passes the virtual time that the real
// time since the request stands for: a leaf of the scheduler tree stands there
// (engine/outside_leaf.h). An answer that came after a real time d is seen at the request's time +
// d x outside_speed, neither before, where the run is slower than real time, nor after. Under set
// costs an answer takes the time that was set, and virtual time stands at the end of that time
// until the answer is there.
//
// A request is the first sending by such a socket since the program last took something from it; of
// devices and of what is named, the beginning of a wait or a look, or of an ioctl that waits. A
// peer or a device that outlasts `outside.patience` is not waited for until it is heard again.
//
// For the coordinator's thread only.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "coordinator/port/unique_fd.h"
#include "coordinator/processes/peers.h"
#include "coordinator/tasks/reactor.h"
#include "coordinator/tasks/run_state.h"
#include "shm/outside_files.h"

namespace tcs {

class OutsideWaits {
 public:
  // `clock`: the host's, as are all host times that are given here.
  OutsideWaits(RunState& run, Reactor& reactor, Peers& peers, std::function<HostTime()> clock)
      : run_(run), reactor_(reactor), peers_(peers), clock_(std::move(clock)) {}
  OutsideWaits(const OutsideWaits&) = delete;
  OutsideWaits& operator=(const OutsideWaits&) = delete;

  // Publishes what is hidden in `files`, which all clients see and which outlives this. The files
  // that clients name are in there from then on.
  void PublishIn(shm::OutsideFiles& files);

  // The thread says what it does with a file. kHolds: the thread is to hold, as for a read.
  // kHasAsked: the threads that wait already wait for the answer from now on.
  enum class Next { kGoesOn, kHolds, kHasAsked };
  Next Handle(Task& task, const shm::Notification& note);

  // The same where the shim does not see the call: the thread is about to send by the socket of
  // which `fd` is a copy (true: kHasAsked), or to connect the socket with that number. The peer
  // that the socket reaches is found when the thread's process next waits, or sends.
  bool AsksRaw(const Task& task, int fd);
  void ConnectsRaw(const Task& task, int number, int fd);

  // The thread begins to wait at the file, or the epoll set, of which `fd` is a copy, for such
  // events. Events of the file, or of a member of the set, may be hidden from the thread: they must
  // not end the wait until Show() says so. kInput: that there is input is hidden; kAll: that the
  // file is connected, too.
  enum class Hidden { kNothing, kInput, kAll };
  Hidden BeginsWait(const Task& task, int fd, std::uint32_t events);
  // Whether something is still hidden from the thread there.
  bool Hides(const Task& task, int fd);
  // Whether the file is hidden now from threads that are at that time; false for an epoll set.
  bool IsHidden(int fd, VirtualTime at);

  // Whether something was hidden until it was taken, closed or given up: threads that wait for it
  // have to look again.
  bool TakeRested() { return std::exchange(has_rested_, false); }

  // The thread, which has its turn, stands in the kernel, and has used so much processor time.
  // kWaits: the thread is in an ioctl of a device, or of a file that is named. Until the thread
  // says that the ioctl is over, it waits for what is outside, from where its turn ends
  // (CallBegan). kMayWait: the same, but the thread has not been in the ioctl for long.
  enum class InCall { kNo, kMayWait, kWaits };
  InCall LookIntoCall(const Task& task, HostDuration used);
  void CallBegan(const Task& task);
  // The ioctl is over, and its end is seen at the virtual time `at`.
  void CallReturns(const Task& task, VirtualTime at);

  // Something has come from outside, and was found at the virtual time `at`.
  void HasCome(const Subject& subject, HostTime now, VirtualTime at);

  // A thread waits for something outside, or has looked for it.
  bool IsAwaited() const { return awaited_ > 0; }
  // When something from outside is seen next, at the earliest: no leaf may pass that.
  VirtualTime Due(HostTime now) const;
  // The virtual time that the real time stands for, for the request that is furthest behind.
  VirtualTime At(HostTime now) const;
  // How long it is, in real time, until other leaves may come to `until`.
  HostDuration RealTimeUntil(VirtualTime until, HostTime now) const;
  // Events that are to be seen at `at` are not hidden any more, and a file that has had no answer
  // for too long is waited for no longer. True: there was such an event or file.
  bool Show(VirtualTime at, HostTime now);

 private:
  enum class State {
    kIdle,
    kAsked,  // nothing has come yet
    kCame,   // something has come, but is hidden
    kShown,  // what has come is seen, and is to be taken
  };
  struct File {
    std::uint64_t key = 0;
    std::string name;
    bool is_always = false;  // waited for without a request
    shm::OutsideFiles::Place* place = nullptr;
    const Process* process =
        nullptr;  // the one that has connected it, or asked; of named files: null at first
    State state = State::kIdle;
    bool is_awaited = false, has_outlasted = false;
    bool is_bare = false;            // nothing of it is hidden
    std::int64_t shown_from_ns = 0;  // as its place has it, unless it is bare
    bool is_connecting = false;      // the request is to be connected
    VirtualTime asked_at, seen_from;
    HostTime asked_real;
    HostDuration used;         // of a call: by its thread, when that was first found in the call
    bool begins = false;       // of a call: in the turn that is about to end
    UniqueFd copy;             // watched while it is awaited
    std::uint32_t number = 0;  // of the watch
  };

  File* Find(std::uint64_t key);
  File* FileOf(int fd);
  File* FreeFile();
  File* Publish(std::uint64_t key, std::string name, bool is_always, const Process* process);
  bool PublishDevice(const Task& task, int fd);
  // The peer that a socket reaches, or is being connected to, as far as it is known by now.
  enum class Reached { kNobody, kRun, kOutside };
  Reached Connects(const Task& task, int fd, File** file);
  // The file is being connected, and the connection is waited for. False if it was already.
  bool BeginsToConnect(File& file, const Task& task, HostDuration ago);
  struct Asking {
    int fd;  // a copy
    HostDuration ago;
    bool has_input;  // before the request was sent
  };
  bool Asks(File& file, const Task& task, const Asking& asking);
  void Closes(int fd);
  void LookAtRawConnects(const Task& task);
  void ShowRest(File& file);
  template <class Take>
  void ForEachAt(const Task& task, int fd, Take take);
  static bool IsHidden(const File& file, VirtualTime at);
  HostDuration SinceTsc(std::uint64_t tsc) const;
  void Ask(File& file, const Task& task, HostDuration ago = {});
  void Await(File& file, const Task& task, int fd);
  void Unwatch(File& file);
  void HasCome(File& file, HostTime now, VirtualTime at);
  void Rest(File& file);
  void GiveUp(File& file);
  bool HasEnded(const File& file) const;
  bool MayMeetOutside(const Process& process) const;
  VirtualTime DueOf(const File& file, HostTime now) const;
  static void ShowFrom(File& file, std::int64_t ns);
  static void SetBare(File& file, bool is_bare);

  RunState& run_;
  Reactor& reactor_;
  Peers& peers_;
  const std::function<HostTime()> clock_;
  shm::OutsideFiles* published_ = nullptr;
  std::deque<File> files_;  // never moved
  int awaited_ = 0;         // of the files
  bool has_rested_ = false;
  struct RawConnect {
    const Process* process;
    int number;
    std::uint64_t socket;  // the socket's key
  };
  std::deque<RawConnect> raw_connects_;  // of which nothing is known yet
  std::uint32_t watches_ = 0;
};

}  // namespace tcs
