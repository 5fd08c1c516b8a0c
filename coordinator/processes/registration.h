// Threads that register themselves (shm/attach_protocol.h): which process has connected, what it
// becomes, and when. A process that connects can claim anything; only what the kernel says of it
// counts.
//
// While the kernel holds the thread whose turn it is, other threads of the run get the processor,
// and so come as far as here. When they do depends on the host, so it must not show: such a thread
// registers later, at its own first dispatch; or, if its maker runs and has not told yet of the
// thread that it has made, once the maker has.
//
// For the coordinator's thread only. Never waits. `when` is when the registration happens, for
// threads that did not have to wait for it.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <functional>
#include <map>
#include <utility>

#include "coordinator/host/host_cpu.h"
#include "coordinator/processes/bare_programs.h"
#include "coordinator/processes/registration_sockets.h"
#include "coordinator/processes/thread_creation.h"
#include "coordinator/processes/thread_exit.h"
#include "coordinator/tasks/event_time.h"
#include "coordinator/tasks/reactor.h"
#include "coordinator/tasks/run_state.h"
#include "coordinator/tasks/waker.h"
#include "shm/attach_protocol.h"

namespace tcs {

class Registration {
 public:
  // The parts that a Registration needs, and that outlive it.
  struct Parts {
    RunState& run;
    Waker& waker;
    Reactor& reactor;
    HostCpu& cpu;
    RegistrationSockets& sockets;
    BarePrograms& bare_programs;
    ThreadCreation& thread_creation;
    ThreadExit& thread_exit;
  };

  struct Callbacks {
    // A process is new, or executes another program: all that the process had before is gone.
    std::function<void(Process&, EventTime)> starts_anew;
    // The memory through which the process exchanges DDS messages; -1 if it has not joined.
    std::function<int(const Process&)> dds_area_of;
  };

  Registration(const Parts& parts, Callbacks callbacks)
      : parts_(parts), run_(parts.run), callbacks_(std::move(callbacks)) {}

  // The run's memory, which all processes that register get to see.
  void ShareMemory(int fd) { memory_fd_ = fd; }

  // A process that has connected says what it wants, at that descriptor. True if the running thread
  // has to be stopped.
  bool Heard(int fd, EventTime when);
  // A thread that has no place yet has made a trapped call. If its program runs without the shim,
  // or such a program has forked it, the thread will never register, and has its place from now on;
  // null: the thread will register, or is unregistered.
  Task* Adopt(pid_t tid, EventTime when);
  // The thread, which is known, has its place without registering; it may do so later. The kernel
  // clears `end_word` when the thread ends (0: the word is not known). `is_newborn`: all that the
  // thread has computed is its own.
  void GivePlace(Task& task, EventTime when, std::uint64_t end_word, bool is_newborn);
  // The thread is dispatched, and registers now if it has wanted to before.
  void LetRegister(const Task& dispatched);
  // The turns of the threads that make others are over, and they have announced none of the threads
  // that wait to register.
  void RegisterUnannounced(EventTime when);
  // No further process can be followed: no other one is accepted, and the run ends with a sentence.
  void EndForWantOfFiles();
  // The thread has ended.
  void Forget(const Task& ended) { early_.erase(ended.tid); }

 private:
  using Connection = RegistrationSockets::Connection;

  bool RegistersLater(const shm::AttachHello& hello) const;
  bool Register(const Connection& connection, EventTime when);
  const char* WhyNot(const shm::AttachHello& hello, EventTime when);
  bool TakePlace(int connection, const shm::AttachHello& hello, Process& client, EventTime when);
  bool RefuseForFiles(int connection);
  Task& TaskFor(pid_t pid, pid_t tid, Process& client, EventTime when);
  void TakeEndWord(Task& task, std::uint64_t address);
  void GiveDdsArea(int connection, pid_t pid);
  void Connect(Process& process);
  UniqueFd GiveBroker(Process& process);
  void PlaceAtGate(Task& task, VirtualTime at, bool is_first);

  const Parts parts_;
  RunState& run_;
  const Callbacks callbacks_;
  int memory_fd_ = -1;
  std::map<pid_t, Connection> early_;  // of threads that register later, by their numbers
};

}  // namespace tcs
