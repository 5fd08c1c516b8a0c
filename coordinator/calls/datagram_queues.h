// The UDP and UNIX datagrams that wait for clients: which are on their way to which address, who
// has taken which of them, and which were lost because a socket was full. Datagrams of one address
// are received in the order in which they were sent there; this order tells which sending and which
// receiving belong together.
//
// The class keeps what each client was sent (answers/client_figures.h). It tells the book of
// answers what threads take and command, and the log of datagrams of both ends.
//
// The class does not see raw calls, descriptors that somebody outside has made, ports at which
// multicast comes in, and whether somebody outside received a datagram that was sent to the address
// of an interface. By DDS's own protocol participants look for each other where nobody may be. For
// the coordinator's thread only.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "coordinator/answers/client_figures.h"
#include "coordinator/calls/datagram_log.h"
#include "coordinator/calls/sample_feed.h"
#include "coordinator/channel/datagram_watch.h"
#include "coordinator/scenario/scenario.h"
#include "coordinator/tasks/answer_feed.h"
#include "coordinator/tasks/run_state.h"

namespace tcs {

class DatagramQueues final : public DatagramWatch {
 public:
  // All arguments outlive this. With a feed that is not open nothing is kept.
  DatagramQueues(RunState& run, AnswerFeed& answers, DatagramLog& log);

  // `samples` is told of DDS samples that threads take, and outlives this. Null: nobody is told.
  void Tell(SampleFeed* samples) { samples_ = samples; }
  // A datagram to that address is that command, as the scenario numbers commands: the coordinator
  // receives the datagram.
  void AddCommandAddress(const shm::ReceiverAddress& address, std::size_t command);

  void WorldSent(const std::string& channel, const shm::ReceiverAddress& to,
                 VirtualTime at) override;
  void WorldReceived(std::size_t channel, const CommandSent& sent) override;
  // Takes the notes of the thread, which has stopped, until `until`. Null, or what in the notes is
  // impossible, as in SlotCheck.
  const char* TakeNotes(const Task& task, VirtualTime until);

  // The run is over: datagrams that still wait were never read. The figures are by client, in the
  // order of the scenario.
  std::map<int, std::vector<InputFigures>> Conclude(VirtualTime end);
  // The datagrams that clients sent to addresses where nobody has received anything, in sentences.
  std::vector<std::string> WhatNobodyHeard() const;

 private:
  // The datagrams of one sender over one channel, to one address.
  struct Flow {
    std::string sender, channel;
    int sensor = -1;  // as AnswerBook::Taken has it
    std::int64_t period_ns = 0;
    bool is_of_dds = false;  // of a program whose samples travel by DDS's own protocol
    InputFigures input{};
  };
  struct Sent {
    VirtualTime at;
    std::int64_t sampled_ns = -1;  // as AnswerBook::Taken has it
    Lineage lineage{};             // what the sender knew of
    Flow* flow = nullptr;          // of its queue
  };
  struct Queue {
    std::deque<Sent> waiting;
    std::uint16_t drops = 0;  // as the kernel last counted them
    AnswerBook::Who reader;   // the last
    bool has_reader = false;
    std::string of_programs;  // the channel of what programs send there; empty: nothing was sent
    std::deque<Flow> flows;   // a few
  };
  using Address = std::pair<std::uint64_t, std::uint64_t>;  // the kind, and whose; the rest

  Address AddressOf(const Robot* by, const shm::DatagramNotes::Note& note) const;
  static Address AddressAt(std::uint32_t host, std::uint16_t port);
  Address PlaceOf(const Address& to) const;
  void ListensOnAll(std::uint16_t port);
  // Null: there are too many.
  Queue* QueueTo(const Address& to);
  static Flow& FlowOf(Queue& queue, const std::string& sender, const std::string& channel);
  Flow& FlowOfWorld(Queue& queue, const std::string& channel);
  static void Add(Queue& queue, Sent sent);
  void Take(const Task& task, const shm::DatagramNotes::Note& note, Queue& queue, VirtualTime at);
  static void DropLost(Queue& queue, std::uint16_t drops, VirtualTime at);
  static void DropNeverThere(Queue& queue, std::uint16_t taken, VirtualTime at);
  static void TakeBack(Queue& queue, const std::string& sender);
  static AnswerBook::Taken TakenOf(const Sent& sent);

  RunState& run_;
  AnswerFeed& answers_;
  DatagramLog& log_;
  SampleFeed* samples_ = nullptr;
  std::map<std::string, std::size_t> sensors_;  // places in the scenario
  std::map<Address, Queue> queues_;
  std::set<std::uint16_t> ports_of_all_;  // at which sockets listen on all addresses
  std::set<std::uint16_t> multicast_;  // ports to which something was sent that has many receivers
  std::map<Address, std::size_t> commands_;
};

}  // namespace tcs
