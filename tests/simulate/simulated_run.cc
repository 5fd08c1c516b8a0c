#include "tests/simulate/simulated_run.h"

#include <errno.h>
#include <sys/epoll.h>
#include <sys/eventfd.h>

#include <string>
#include <utility>

#include "tests/simulate/broken.h"

namespace tcs::simulate {

namespace {

HostPermits Permits(bool has_levels) {
  HostPermits permits;
  permits.real_time.error = has_levels ? 0 : EPERM;
  return permits;
}

RunOptions Options(bool is_fixed) {
  RunOptions options;
  options.accounting = is_fixed ? shm::Accounting::kFixed : shm::Accounting::kMeasured;
  options.date_ns = 0;
  return options;
}

}  // namespace

SimulatedRun::SimulatedRun(Scenario scenario, std::uint64_t host, bool has_levels, bool is_fixed)
    : kernel_(host, has_levels), all_(std::move(scenario), Options(is_fixed), Permits(has_levels)) {
  all_.setup.Connect();
  // A world without channels is no matter of the machine's.
  const auto make = [](const std::string&, const std::function<void()>& it) { it(); };
  std::string error = all_.world.Open(all_.run.scenario, all_.dds.ends(), make, nullptr, false);
  if (error.empty()) error = all_.setup.PrepareParts({});
  if (!error.empty()) Broken("the run cannot be prepared: %s", error.c_str());
  all_.setup.MakeRobots();
  all_.clock.Start();
  preload::g_run = all_.memory;
  preload::g_header = all_.run.header;
}

Process& SimulatedRun::AddClient(Robot& robot, const ClientSpec& client) {
  client_ = all_.thread_creation.AddClient(next_pid_, robot, client, {}).process;
  next_pid_ += 1'000;
  threads_ = 0;
  client_->link = ProcessLink::Make();
  kernel_.descriptors().Join(client_->link->notify_fd(), client_->link->incoming_fd());
  all_.reactor.Add(client_->link->incoming_fd(), EPOLLIN, {Tag::kPipe, client_->index});
  SimProcess& process = processes_.emplace_back();
  process.pid = client_->pid;
  process.notify_fd = client_->link->notify_fd();
  UniqueFd listener(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK | EFD_SEMAPHORE));
  process.trap_listener = listener.get();
  kernel_.descriptors().Open(listener.get());
  all_.traps.Add(std::move(listener));
  return *client_;
}

Task& SimulatedRun::AddThread(std::function<void(const preload::GuestThread&)> body) {
  const pid_t tid = client_->pid + threads_;
  Task& task = threads_ == 0 ? *all_.run.table.Living(tid)
                             : all_.thread_creation.AddThread(*client_, tid, {});
  ++threads_;
  all_.registration.GivePlace(task, {}, 0, true);
  task.is_adopted = false;
  task.can_be_stopped = task.parked = true;
  preload::GuestThread guest;
  guest.slot = task.slot_memory;
  guest.index = static_cast<std::uint32_t>(task.slot);
  guest.pid = client_->pid;
  guest.tid = tid;
  kernel_.AddThread(processes_.back(), tid, [body = std::move(body), guest] { body(guest); });
  return task;
}

}  // namespace tcs::simulate
