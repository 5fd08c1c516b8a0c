#include "coordinator/engine/kernel_events.h"

#include <sys/epoll.h>

#include <algorithm>

#include "coordinator/engine/wiring.h"
#include "coordinator/port/clocks.h"
#include "shm/clock_page.h"

namespace tcs {

void KernelEvents::Register() {
  const auto on = [this](Tag tag,
                         PollOutcome (KernelEvents::*handler)(Subject, std::uint32_t, EventTime)) {
    all_.reactor.On(tag,
                    [this, handler](const Subject& subject, std::uint32_t events, EventTime when) {
                      return (this->*handler)(subject, events, when);
                    });
  };
  on(Tag::kPipe, &KernelEvents::OnPipe);
  on(Tag::kListener, &KernelEvents::OnListener);
  on(Tag::kConnection, &KernelEvents::OnConnection);
  on(Tag::kProcess, &KernelEvents::OnProcessEnd);
  on(Tag::kAwaited, &KernelEvents::OnAwaited);
  on(Tag::kUnregisteredChild, &KernelEvents::OnUnregisteredChildEnd);
  on(Tag::kTrap, &KernelEvents::OnTrap);
  on(Tag::kCommand, &KernelEvents::OnCommand);
  on(Tag::kNetwork, &KernelEvents::OnNetwork);
  on(Tag::kSignal, &KernelEvents::OnSignal);
  on(Tag::kGraceRanOut, &KernelEvents::OnGraceRanOut);
  on(Tag::kDetector, &KernelEvents::OnDetector);
  on(Tag::kDetectorEnd, &KernelEvents::OnDetectorEnd);
  on(Tag::kStateAsked, &KernelEvents::OnStateAsked);
  on(Tag::kOutside, &KernelEvents::OnOutside);
}

PollOutcome KernelEvents::OnPipe(Subject process, std::uint32_t, EventTime when) {
  return all_.notification_receiver.Take(run_.table.ProcessAt(process.index), when);
}

PollOutcome KernelEvents::OnListener(Subject listener, std::uint32_t, EventTime) {
  if (all_.sockets.Accept(listener.index)) return {};
  all_.registration.EndForWantOfFiles();
  return kConcernsAll;
}

PollOutcome KernelEvents::OnConnection(Subject subject, std::uint32_t, EventTime when) {
  const bool registers = all_.registration.Heard(static_cast<int>(subject.index), when);
  return registers ? kConcernsAll : PollOutcome{};
}

PollOutcome KernelEvents::OnProcessEnd(Subject process, std::uint32_t, EventTime when) {
  Process& ended = run_.table.ProcessAt(process.index);
  if (TurnsBeside::NoteExitIn(ended)) {
    all_.reactor.Remove(ended.pidfd.get());
    return {};
  }
  const bool runs = run_.turn.IsIn(ended);
  when.at = std::max(when.at, all_.ahead.EndOfDebt(ended));
  const auto end = [this, process](EventTime at) {
    all_.thread_exit.ProcessEnded(process.index, at);
    return kConcernsAll;
  };
  if (!all_.gate_keeper.PutOff(runs ? run_.turn.task() : nullptr, end)) return end(when);
  all_.reactor.Remove(run_.table.ProcessAt(process.index).pidfd.get());  // readable for ever
  return {};
}

PollOutcome KernelEvents::OnAwaited(Subject subject, std::uint32_t, EventTime) {
  Task& task = run_.table.At(static_cast<int>(subject.index));
  auto* wait = task.Awaits<awaited::Descriptors>();
  if (wait == nullptr || subject != DescriptorWaits::SubjectOf(task, *wait)) return {};
  // An event in a later look is news: an event that was there may have gone before it was looked
  // for.
  if (wait->skips_in != 0 && wait->skips_in + 1 >= all_.reactor.next_look()) return {};
  all_.event_pump.NoteReady(task);
  return {.wakes_others = true};
}

PollOutcome KernelEvents::OnOutside(Subject file, std::uint32_t, EventTime when) {
  all_.outside.HasCome(file, all_.pacing.RunningTime(),
                       all_.outside_leaf.awaits() ? when.at : VirtualTime());
  all_.outside_leaf.Update();
  return {};
}

PollOutcome KernelEvents::OnUnregisteredChildEnd(Subject child, std::uint32_t, EventTime when) {
  const auto pid = static_cast<pid_t>(child.index);
  if (Process* parent = all_.unregistered_children.Ended(pid); parent != nullptr) {
    all_.stops.ChildChanged(*parent, pid, false, when);
  }
  return kConcernsAll;
}

PollOutcome KernelEvents::OnTrap(Subject subject, std::uint32_t events, EventTime when) {
  const auto listener = static_cast<int>(subject.index);
  if ((events & EPOLLIN) == 0) {
    all_.traps.Close(listener);
    return {};
  }
  return all_.trap_receiver.Arrived(listener, when);
}

PollOutcome KernelEvents::OnCommand(Subject channel, std::uint32_t, EventTime when) {
  CommandSender from;
  if (run_.turn.HasClock()) {
    Task& task = *run_.turn.task();
    // The thread has sent the commands that it has posted before this one.
    if (const char* what = all_.posted.Take(task); what != nullptr) {
      all_.violations.EndProcess(*task.process, what);
      return {.stops_running = true};
    }
    from = {static_cast<std::uint64_t>(task.tid),
            shm::RunTime(SlotOf(task).clock, all_.host_cpu.ClockOf(task))};
  }
  all_.world.ReceiveCommands(channel.index, when.at, from);
  return {};
}

// The thread that has sent goes on, as far as the receivers allow.
PollOutcome KernelEvents::OnNetwork(Subject robot, std::uint32_t, EventTime when) {
  all_.network.Take(robot.index, when.at);
  all_.network_leaf.Update();
  if (run_.turn.lasts() && run_.turn.HasClock()) all_.dispatcher.GoOnBesideWoken();
  return {};
}

PollOutcome KernelEvents::OnSignal(Subject, std::uint32_t, EventTime) {
  return {.stops_running = all_.end_requests.Take(run_)};
}

PollOutcome KernelEvents::OnGraceRanOut(Subject, std::uint32_t, EventTime) {
  all_.grace.RanOut();
  return {.stops_running = true};
}

PollOutcome KernelEvents::OnDetector(Subject, std::uint32_t, EventTime) {
  if (!all_.host_cpu.detector().TakeFired()) return {};
  all_.host_cpu.active().TakeBack();
  return {.blocks_running = true};
}

PollOutcome KernelEvents::OnDetectorEnd(Subject, std::uint32_t, EventTime) {
  all_.block_detection.DetectorEnded();
  return {.stops_running = true};
}

// The question changes nothing for the run.
PollOutcome KernelEvents::OnStateAsked(Subject, std::uint32_t, EventTime) {
  if (all_.state_link.TakeAsked())
    all_.state_link.Answer(all_.state_dump.Text(all_.home_processor.cpu(), HostTsc()));
  return {};
}

}  // namespace tcs
