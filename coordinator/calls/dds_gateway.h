// Programs that speak DDS: which ones have joined, what they send each other, and each program's
// deliverer, the thread that takes its messages in (shm/dds_exchange.h). The hub keeps messages in
// order; this class makes threads wait and go on for the hub. The world's channels on DDS are part
// of it, too.
//
// For the coordinator's thread only. Trusts nothing that processes say, and warns of what is wrong
// once per client.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "coordinator/calls/dds_costs.h"
#include "coordinator/calls/dds_records.h"
#include "coordinator/calls/priority_inheritance.h"
#include "coordinator/dds/hub.h"
#include "coordinator/dds/own_endpoints.h"
#include "coordinator/dds/topic_log.h"
#include "coordinator/tasks/event_time.h"
#include "coordinator/tasks/run_state.h"
#include "coordinator/tasks/waker.h"
#include "coordinator/world/world.h"
#include "shm/layout.h"

namespace tcs {

class DdsGateway {
 public:
  DdsGateway(RunState& run, Waker& waker, World& world, PriorityInheritance& inheritance)
      : run_(run), waker_(waker), world_(world), inheritance_(inheritance) {
    hub_.Route(&costs_);
  }

  // Once the run's header has its times, and the world is open. Empty on success, else one
  // sentence.
  [[nodiscard]] std::string Open();
  const dds::Hub& hub() const { return hub_; }
  DdsRecords& records() { return records_; }
  // The coordinator's own endpoints, for the world's channels on DDS.
  dds::OwnEndpoints& ends() { return ends_; }
  const DdsRecords& records() const { return records_; }
  // The world, if there is one, takes the messages that are for it, as far as no earlier message
  // can come any more.
  void TakeOwnMessages();

  // Messages between robots go over the links of `wire`, which outlives this.
  void UseNetwork(Wire& wire) { costs_.UseNetwork(wire); }

  // Handles a thread's notification of DDS: the thread gets what it asks for in its reply, or
  // waits.
  void Handle(Task& task, const shm::Notification& note, VirtualTime deadline);
  // The process has died, or executes another program.
  void Leave(Process& process, EventTime when);
  // Other programs miss a stopped program when its leases are over. Looks whether the process is
  // stopped.
  void NoteWhetherStopped(const Process& process, VirtualTime at);

  // The memory through which the process exchanges messages; -1 if it has not joined.
  int AreaOf(const Process& process) const { return hub_.AreaOf(process.dds_number); }
  // Before the turn of a thread: a deliverer whose wait is over is charged for what it will be
  // handed over.
  void ChargeForDue(Task& task);
  // At the dispatch of a deliverer whose wait is over.
  void HandOver(Task& task);
  // Something may have been sent: deliverers wait until what is for them is due.
  void ShowDeliverersTheirDeadlines();
  // Wakes the threads that wait until the process's deliverer has handed over the due messages, if
  // it has none left to hand over.
  void ReleaseThoseAwaitingDeliverer(const Process& process, EventTime when);

 private:
  dds::Speaker WhoIs(dds::Hub::Number number) const;
  const Process* ProcessOf(dds::Hub::Number number) const;
  void Join(Task& task);
  void Send(Process& process, std::size_t bytes, Task& by);
  void WarnOfSockets(const Process& process, shm::WhySockets why);
  void AwaitMessages(Task& task);
  void AwaitDeliverer(Task& task, VirtualTime deadline);
  bool IsFirstDueFree(const Process& process, VirtualTime now) const;
  bool IsDelivering(const Process& process, VirtualTime now) const;
  void ReleaseThoseAwaitingRoom(std::uint32_t number, EventTime when);

  RunState& run_;
  Waker& waker_;
  World& world_;
  PriorityInheritance& inheritance_;
  dds::Hub hub_;
  dds::OwnEndpoints ends_{hub_};
  DdsRecords records_{run_, hub_, ends_, [this](dds::Hub::Number number) { return WhoIs(number); }};
  std::vector<Process*> joined_;
  DdsCosts costs_{run_.IsFixed(), [this](dds::Hub::Number number) { return ProcessOf(number); }};
};

}  // namespace tcs
