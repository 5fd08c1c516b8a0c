// What is done about what the kernel says, by the kind of descriptor that it says it at.
#include <signal.h>
#include <sys/epoll.h>
#include <sys/signalfd.h>
#include <unistd.h>
#include <x86gprintrin.h>

#include <algorithm>
#include <utility>

#include "coordinator/core/engine.h"
#include "coordinator/os/host.h"
#include "coordinator/os/open_file_limit.h"
#include "shm/clock_page.h"

namespace tcs {

void Engine::RegisterHandlers() {
  const auto on = [this](Tag tag,
                         Reactor::Found (Engine::*handler)(Subject, std::uint32_t, Moment)) {
    reactor_.On(tag, [this, handler](const Subject& subject, std::uint32_t events, Moment moment) {
      return (this->*handler)(subject, events, moment);
    });
  };
  on(Tag::kPipe, &Engine::OnPipe);
  on(Tag::kListener, &Engine::OnListener);
  on(Tag::kConnection, &Engine::OnConnection);
  on(Tag::kProcess, &Engine::OnProcessEnd);
  on(Tag::kAwaited, &Engine::OnAwaited);
  on(Tag::kUnknownChild, &Engine::OnUnknownChildEnd);
  on(Tag::kTrap, &Engine::OnTrap);
  on(Tag::kCommand, &Engine::OnCommand);
  on(Tag::kNetwork, &Engine::OnNetwork);
  on(Tag::kSignal, &Engine::OnSignal);
  on(Tag::kGraceRanOut, &Engine::OnGraceRanOut);
  on(Tag::kDetector, &Engine::OnDetector);
  on(Tag::kDetectorEnd, &Engine::OnDetectorEnd);
  on(Tag::kStateAsked, &Engine::OnStateAsked);
  on(Tag::kOutside, &Engine::OnOutside);
}

Reactor::Found Engine::OnPipe(Subject process, std::uint32_t, Moment moment) {
  return TakeNotifications(run_.table.ProcessAt(process.index), moment);
}

Reactor::Found Engine::OnListener(Subject listener, std::uint32_t, Moment) {
  if (sockets_.Accept(listener.index)) return {};
  if (run_.report.error.empty()) run_.report.error = WhyNoFurtherFile();
  return kConcernsAll;
}

Reactor::Found Engine::OnConnection(Subject subject, std::uint32_t, Moment moment) {
  const bool registers = registration_.Heard(static_cast<int>(subject.index), moment);
  return registers ? kConcernsAll : Reactor::Found{};
}

Reactor::Found Engine::OnProcessEnd(Subject process, std::uint32_t, Moment moment) {
  Process& ended = run_.table.ProcessAt(process.index);
  if (TurnsBeside::NoteDeathIn(ended)) {
    reactor_.Remove(ended.pidfd.get());
    return {};
  }
  const bool runs = run_.turn.IsIn(ended);
  moment.at = std::max(moment.at, ahead_.EndOfDebt(ended));
  const auto end = [this, process](Moment at) {
    deaths_.ProcessEnded(process.index, at);
    return kConcernsAll;
  };
  if (!PutOff(runs ? run_.turn.task() : nullptr, end)) return end(moment);
  reactor_.Remove(run_.table.ProcessAt(process.index).pidfd.get());  // it is readable for ever
  return {};
}

Reactor::Found Engine::OnAwaited(Subject subject, std::uint32_t, Moment) {
  Task& task = run_.table.At(static_cast<int>(subject.index));
  auto* wait = task.Awaits<awaited::Descriptors>();
  if (wait == nullptr || subject != DescriptorWaits::SubjectOf(task, *wait)) return {};
  // What comes in a later look is news: what was there may have gone before it was looked for.
  if (wait->skips_in != 0 && wait->skips_in + 1 >= reactor_.next_look()) return {};
  ready_awaiters_.push_back(&task);
  return {.wakes_others = true};
}

Reactor::Found Engine::OnOutside(Subject file, std::uint32_t, Moment moment) {
  outside_.HasCome(file, RunningTime(), awaits_outside_ ? moment.at : VirtualTime());
  ShowOutside();
  return {};
}

Reactor::Found Engine::OnUnknownChildEnd(Subject child, std::uint32_t, Moment moment) {
  const auto pid = static_cast<pid_t>(child.index);
  if (Process* parent = unknown_children_.Ended(pid); parent != nullptr) {
    stops_.ChildChanged(*parent, pid, false, moment);
  }
  return kConcernsAll;
}

Reactor::Found Engine::OnTrap(Subject subject, std::uint32_t events, Moment moment) {
  const auto listener = static_cast<int>(subject.index);
  if ((events & EPOLLIN) == 0) {
    traps_.Close(listener);
    return {};
  }
  return TrapArrived(listener, moment);
}

Reactor::Found Engine::OnCommand(Subject channel, std::uint32_t, Moment moment) {
  CommandSender from;
  if (run_.turn.HasClock()) {
    Task& task = *run_.turn.task();
    // What it has posted it has sent before.
    if (const char* what = posted_.Take(task); what != nullptr) {
      expulsion_.Expel(*task.process, what);
      return {.stops_running = true};
    }
    from = {static_cast<std::uint64_t>(task.tid),
            shm::RunTime(SlotOf(task).clock, host_cpu_.ClockOf(task))};
  }
  world_.ReceiveCommands(channel.index, moment.at, from);
  return {};
}

// The thread that has sent goes on, as far as those allow who receive it.
Reactor::Found Engine::OnNetwork(Subject robot, std::uint32_t, Moment moment) {
  network_.Take(robot.index, moment.at);
  ShowNetwork(network_progress_);
  if (run_.turn.lasts() && run_.turn.HasClock()) GoOnBesideWoken();
  return {};
}

Reactor::Found Engine::OnSignal(Subject, std::uint32_t, Moment) {
  signalfd_siginfo info;
  if (read(signal_fd_.get(), &info, sizeof info) != sizeof info) return {};
  // ^C is for the program that has the terminal.
  if (info.ssi_signo == SIGINT && info.ssi_code == SI_KERNEL &&
      run_.options.output_directory.empty()) {
    return {};
  }
  run_.stop.Take(static_cast<int>(info.ssi_signo), HostClockNs(CLOCK_MONOTONIC));
  return {.stops_running = true};
}

Reactor::Found Engine::OnGraceRanOut(Subject, std::uint32_t, Moment) {
  grace_.RanOut();
  return {.stops_running = true};
}

Reactor::Found Engine::OnDetector(Subject, std::uint32_t, Moment) {
  if (!host_cpu_.detector().TakeFired()) return {};
  host_cpu_.active().TakeBack();
  return {.blocks_running = true};
}

Reactor::Found Engine::OnDetectorEnd(Subject, std::uint32_t, Moment) {
  DetectorEnded();
  return {.stops_running = true};
}

// Nothing comes of it for the run.
Reactor::Found Engine::OnStateAsked(Subject, std::uint32_t, Moment) {
  if (state_link_.TakeAsked()) state_link_.Answer(state_dump_.Text(HomeCpu(), __rdtsc()));
  return {};
}

}  // namespace tcs
