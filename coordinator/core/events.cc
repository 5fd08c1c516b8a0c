// What the kernel says: notifications in the pipe, timers, descriptors that clients wait for,
// births and deaths.
#include <fmt/format.h>
#include <signal.h>
#include <sys/epoll.h>
#include <sys/signalfd.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstring>

#include "coordinator/core/engine.h"
#include "shm/attach_protocol.h"

namespace tcs {

void Engine::Watch(int fd, std::uint32_t events, Tag tag, std::uint32_t index) {
  epoll_event event{};
  event.events = events;
  event.data.u64 = (static_cast<std::uint64_t>(tag) << 32) | index;
  epoll_ctl(epoll_, EPOLL_CTL_ADD, fd, &event);
}

Task* Engine::NewTask(pid_t pid, pid_t parent, VirtualCpu* cpu, const std::string& name,
                      int priority) {
  Process& process = processes_.emplace_back();
  process.pid = pid;
  process.parent = parent;
  process.cpu = cpu;
  process.name = name;
  process.priority = priority;
  process.pidfd = OpenPidfd(pid);
  for (const Process& other : processes_) {
    if (other.pid == parent) process.call_cost_ns = other.call_cost_ns;
  }
  if (process.pidfd >= 0) {
    Watch(process.pidfd, EPOLLIN, Tag::kProcess, static_cast<std::uint32_t>(processes_.size() - 1));
  }
  Task& task = tasks_.emplace_back();
  task.process = &process;
  task.cpu = cpu;
  task.tid = pid;
  task.order = static_cast<int>(tasks_.size() - 1);
  task.priority = priority;
  task.ready_number = ++ready_counter_;
  task.parked = false;
  cpu->tasks.push_back(&task);
  return &task;
}

void Engine::Attach(int connection) {
  shm::AttachHello hello{};
  const ssize_t n = recv(connection, &hello, sizeof hello, MSG_DONTWAIT);
  ucred peer{};
  socklen_t size = sizeof peer;
  getsockopt(connection, SOL_SOCKET, SO_PEERCRED, &peer, &size);
  shm::AttachReply reply{};
  reply.magic = shm::kMagic;
  reply.version = shm::kVersion;
  auto refuse = [&](const char* why) {
    reply.refused = 1;
    strncpy(reply.text, why, sizeof reply.text - 1);
    send(connection, &reply, sizeof reply, MSG_NOSIGNAL);
  };
  if (n != sizeof hello || hello.magic != shm::kMagic || hello.version != shm::kVersion ||
      hello.pid != peer.pid) {
    refuse("it comes from another version of tcs");
    return;
  }
  Task* task = nullptr;
  Process* process = nullptr;
  Process* parent = nullptr;
  for (Task& known : tasks_) {
    if (known.tid == hello.tid && known.state != TaskState::kDead) task = &known;
  }
  for (Process& known : processes_) {
    if (known.dead) continue;
    if (known.pid == hello.pid) process = &known;
    if (known.pid == hello.parent_pid) parent = &known;
  }
  if (task == nullptr && next_slot_ == static_cast<int>(shm::kSlotCount)) {
    refuse("there is no room for more threads");
    return;
  }
  if (task == nullptr && process != nullptr) {
    // Another thread of a known process.
    task = &tasks_.emplace_back();
    task->process = process;
    ++process->threads;
    task->cpu = process->cpu;
    task->tid = hello.tid;
    task->order = static_cast<int>(tasks_.size() - 1);
    task->priority = process->priority;
    process->cpu->tasks.push_back(task);
  } else if (task == nullptr) {
    VirtualCpu* cpu = parent != nullptr ? parent->cpu : &cpus_.front();
    task = NewTask(hello.pid, hello.parent_pid, cpu,
                   parent != nullptr ? parent->name : fmt::format("pid {}", hello.pid),
                   parent != nullptr ? parent->priority : 0);
  }
  if (task != running_) SetLevel(task->tid, Level::kWaiting), task->level = Level::kWaiting;
  if (task->slot < 0) task->slot = next_slot_++;
  shm::ThreadSlot& slot = Slot(*task);
  slot.pid = task->process->pid;
  slot.tid = task->tid;
  slot.cores = task->cpu->cores;
  slot.seed = scenario_.seed * 0x9e3779b97f4a7c15 + static_cast<std::uint64_t>(task->order);
  slot.gate.store(shm::kGateClosed);
  task->state = TaskState::kReady;
  task->parked = true;
  task->reason = shm::WakeReason::kGo;
  reply.slot = static_cast<std::uint32_t>(task->slot);

  iovec iov{&reply, sizeof reply};
  alignas(cmsghdr) char control[CMSG_SPACE(2 * sizeof(int))] = {};
  msghdr message{};
  message.msg_iov = &iov;
  message.msg_iovlen = 1;
  message.msg_control = control;
  message.msg_controllen = sizeof control;
  cmsghdr* header = CMSG_FIRSTHDR(&message);
  header->cmsg_level = SOL_SOCKET;
  header->cmsg_type = SCM_RIGHTS;
  header->cmsg_len = CMSG_LEN(2 * sizeof(int));
  const int fds[2] = {memfd_, pipe_[1]};
  memcpy(CMSG_DATA(header), fds, sizeof fds);
  sendmsg(connection, &message, MSG_NOSIGNAL);
}

void Engine::ProcessEnded(std::size_t index) {
  Process& process = processes_[index];
  if (process.dead) return;
  process.dead = true;
  std::int64_t charged = process.ended_cpu_ns;
  for (Task& task : tasks_) {
    if (task.process != &process || task.state == TaskState::kDead) continue;
    EndWatches(task);
    if (task.slot >= 0) Settle(task);
    charged += task.charged_ns;
    task.state = TaskState::kDead;
    if (running_ == &task) event_ns_ = task.cpu->progress_ns;
    auto& list = task.cpu->tasks;
    list.erase(std::remove(list.begin(), list.end(), &task), list.end());
    if (last_ == &task) last_ = nullptr;
  }
  for (auto& [id, timer] : process.timers) {
    if (timer.event_fd >= 0) close(timer.event_fd);
  }
  epoll_ctl(epoll_, EPOLL_CTL_DEL, process.pidfd, nullptr);
  close(process.pidfd);
  for (Process& other : processes_) {
    if (other.pid == process.parent && !other.dead) other.children_cpu_ns += charged;
  }
  for (Task& task : tasks_) {
    if (task.waits_for_child && task.process->pid == process.parent) {
      MakeReady(task, shm::WakeReason::kGo);
    }
  }
  // Our own children, and those who lost their parent, are reaped here.
  int status = 0;
  if (waitpid(process.pid, &status, WNOHANG) == process.pid && index == 0) {
    report_.exit_status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }
}

void Engine::DetectorFired() {
  std::uint64_t count;
  if (read(detector_fired_, &count, sizeof count) != sizeof count) return;
  detector_armed_ = false;
}

bool Engine::PollEvents(int timeout_ms) {
  epoll_event events[64];
  const int n = epoll_wait(epoll_, events, 64, timeout_ms);
  bool stop = false, blocked = false;
  if (running_ != nullptr) event_ns_ = RunningNow();
  for (int i = 0; i < n; ++i) {
    const auto tag = static_cast<Tag>(events[i].data.u64 >> 32);
    const auto index = static_cast<std::uint32_t>(events[i].data.u64);
    switch (tag) {
      case Tag::kPipe: {
        shm::PipeMessage messages[64];
        const ssize_t bytes = read(pipe_[0], messages, sizeof messages);
        for (ssize_t m = 0; m * static_cast<ssize_t>(sizeof messages[0]) < bytes; ++m) {
          for (Task& task : tasks_) {
            if (task.slot < 0 || static_cast<std::uint32_t>(task.slot) != messages[m].slot ||
                task.state == TaskState::kDead) {
              continue;
            }
            if (&task == running_) {
              notified_ = true;
            } else if (task.state == TaskState::kWaiting &&
                       Slot(task).note.kind == shm::NotificationKind::kInterrupted) {
              MakeReady(task, shm::WakeReason::kSignal);
              task.reply[0] = 1;
            } else if (task.state == TaskState::kUnseen) {
              MakeReady(task, shm::WakeReason::kGo);
              task.parked = true;
              CheckCpuClock(task);
              const shm::Notification note = Slot(task).note;
              Handle(task, note);
            } else if (!task.parked) {
              // It ran on while the coordinator slept for a thread that the kernel held.
              task.notified_early = true;
            }
          }
        }
        stop = true;
        external_event_ = true;
        break;
      }
      case Tag::kTimer: {
        std::uint64_t count;
        if (read(timer_, &count, sizeof count) != sizeof count) break;
        if (running_ == nullptr) break;
        if (running_->slot < 0) {
          preempted_ = true;
        } else if (options_.accounting != shm::Accounting::kFixed && ReachedHorizon(*running_)) {
          preempted_ = true;
          stop = true;
        }
        break;
      }
      case Tag::kListener: {
        const int connection = accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
        if (connection >= 0) {
          Watch(connection, EPOLLIN, Tag::kConnection, static_cast<std::uint32_t>(connection));
        }
        break;
      }
      case Tag::kConnection:
        Attach(static_cast<int>(index));
        close(static_cast<int>(index));
        stop = true;
        external_event_ = true;
        break;
      case Tag::kProcess:
        ProcessEnded(index);
        stop = true;
        external_event_ = true;
        break;
      case Tag::kAwaited:
        if (Task& task = tasks_[index]; task.state == TaskState::kWaiting) {
          MakeReady(task, shm::WakeReason::kGo);
          external_event_ = true;
        }
        stop = true;
        break;
      case Tag::kCommand:
        world_.ReceiveCommands(index, event_ns_);
        break;
      case Tag::kSignal: {
        signalfd_siginfo info;
        if (read(signals_, &info, sizeof info) == sizeof info) stop_requested_ = stop = true;
        break;
      }
      case Tag::kDetector:
        DetectorFired();
        blocked = true;
        break;
    }
  }
  if (running_ == nullptr) return true;
  if (!stop && blocked) {
    const char state = ThreadState(running_->tid);
    if (state == 'S' && running_->slot >= 0) {
      running_->state = TaskState::kUnseen;
      Warn(
          fmt::format("{} blocked in system call {}, which the shim does not see; that time is not "
                      "charged",
                      running_->process->name, ThreadSystemCall(running_->tid)));
      running_->parked = false;
      return true;
    }
    if (running_->slot < 0 || state != 'X') {
      // Starting, or in the disk's hands: it stands still until it goes on.
      usleep(100);
      const std::uint64_t one = 1;
      detector_armed_ = write(detector_arm_, &one, sizeof one) == sizeof one;
    }
  }
  return stop;
}

}  // namespace tcs
