// The dynamics leaf: physics, the sensors that read it and the commands that drive it.
#pragma once

#include <cstdint>
#include <fstream>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "coordinator/channel/open/channels.h"
#include "coordinator/channel/recorded/channel_records.h"
#include "coordinator/record/message_sink.h"
#include "coordinator/scenario/scenario.h"
#include "coordinator/trace/csv_file.h"
#include "coordinator/world/command_queue.h"
#include "coordinator/world/commands.h"
#include "coordinator/world/contact_lines.h"
#include "coordinator/world/due_links.h"
#include "coordinator/world/joint_lines.h"
#include "coordinator/world/link_lines.h"
#include "coordinator/world/measurement_log.h"
#include "coordinator/world/scenario_metrics.h"
#include "coordinator/world/sensors.h"
#include "coordinator/world/world_topics.h"
#include "shm/own_receivers.h"

namespace tcs {

// Why the physics refuse the scenario's world, in one sentence; empty: they do not.
std::string WhyNoWorld(const Scenario& scenario);

class World {
 public:
  // `warn` is told of messages that come in on a channel and are no commands.
  explicit World(std::function<void(const std::string&)> warn);

  // Claims what the channels need of the host. Empty on success, else one sentence. `ends` is for
  // the channels on DDS, and outlives this. With a `watch` RecordInto follows.
  [[nodiscard]] std::string Open(const Scenario& scenario, dds::OwnEndpoints& ends,
                                 const MakeAt& make_at, DatagramWatch* watch = nullptr,
                                 bool is_recorded = false);
  // See Dynamics.
  void InterruptBy(const std::function<bool()>& asked) {
    if (present()) dynamics_->InterruptBy(asked);
  }
  // Other processors that a run with its turns on `home` may use, and that no other run has; to be
  // asked before this process is bound to one.
  static std::vector<int> ProcessorsBeside(int home, int host_cpus);
  // The dynamics use `cpus` (Dynamics::UseProcessors).
  void UseProcessors(const std::vector<int>& cpus);
  // The run begins; virtual CLOCK_REALTIME is so far ahead of virtual time.
  void Begin(std::int64_t realtime_offset_ns);

  // Writes into this folder what the world looks like, how it moved and what moved it: scene.json,
  // bodies.csv, joints.csv, commands.csv, contacts.csv if the scenario asks for it, and sensors.csv
  // if the run is recorded; nothing without a world. Empty on success, else one sentence.
  [[nodiscard]] std::string OpenRecords(const std::string& folder);
  void FlushRecords();
  [[nodiscard]] std::string CloseRecords();
  // Values of the scenario's metrics are taken from now on; the book outlives this.
  void Measure(MetricBook& book);
  // Called after OpenRecords. Records as messages where bodies are, as often as the files are told,
  // and what goes over channels that are not on DDS. The sink outlives this.
  void RecordInto(record::MessageSink& sink);

  bool present() const { return dynamics_ != nullptr; }
  VirtualTime progress() const { return progress_; }
  // True if threads on further processors have integrated islands.
  bool HasHadHelp() const { return present() && dynamics_->work().helped > 0; }
  // Nothing leaves the dynamics before this time.
  VirtualTime NextOutput() const { return next_output_; }
  // The time at which the state is read next: for a sample, an output, a line of the CSV.
  VirtualTime NextStop() const { return next_stop_; }
  // Advances to the earliest of `limit` and the next stop, and carries out what is due there. No
  // command for an earlier time comes any more. True if something was sent.
  bool Advance(VirtualTime limit);
  // All programs have ended by `end`: their last commands act, whoever sees it.
  void LetLastCommandsAct(VirtualTime end);
  // Goes on to `to`, at most the next stop, while a thread acts at `now` whose commands are still
  // to come. Each command is applied at its time.
  void Lead(VirtualTime now, VirtualTime to);

  // How many commands were sent and do not act yet; and the channels of sensors that have readings
  // on their way, each with how many, by their numbers in the scenario.
  std::size_t kept_commands() const { return queue_.size(); }
  std::vector<std::pair<std::size_t, std::size_t>> KeptReadings() const;

  // The descriptors at which commands come in, by number: to be read from when they are readable.
  std::vector<int> command_fds() const;
  // Fills in the addresses of the inlets to which programs send datagrams, and their number.
  void NameReceivers(shm::OwnReceivers& receivers);
  // For each of these inlets, the command that comes in there, as the scenario numbers commands.
  std::vector<std::size_t> CommandsOfReceivers() const;
  std::size_t receivers() const { return inlet_of_receiver_.size(); }
  // Takes what has arrived at descriptor `index` at `now`, from the thread that is known to have
  // sent it; other threads may still send for times before.
  void ReceiveCommands(std::size_t index, VirtualTime now, const CommandSender& from);
  // Takes a datagram that was sent to that receiver, as NameReceivers numbers them, and did not
  // come in there.
  void ReceivePosted(std::size_t receiver, std::string_view datagram, const CommandSent& sent);
  // Applies commands that have been sent by `now` to inlets where no descriptor tells of them.
  void ReceiveUntold(VirtualTime now);
  // Takes what has been written to terminals, at `now`.
  bool has_terminals() const { return !terminals_.empty(); }
  void ReceiveFromTerminals(VirtualTime now);

  // The files that the robot's programs find under other names, as shm::kAliasesVariable has them.
  std::string AliasesOf(const std::string& robot) const;

  // The part of the coordinator's processor time that physics and channels took.
  std::int64_t host_ns() const { return host_ns_; }
  std::int64_t commands() const { return commands_.taken(); }
  std::int64_t samples() const { return sensors_.samples(); }
  // At the run's end, a sentence each: channels of commands where nothing of use came in, sensors
  // that no program can have heard, and sensors that left readings out.
  std::vector<std::string> CommandComplaints() const;
  std::vector<std::string> UnheardSensors() const;
  std::vector<std::string> LossesOfSensors() const;

 private:
  void WriteStates();
  void FlushBodies();
  std::vector<std::string> OfSensors(const std::function<std::string(const Outlet&)>& what) const;
  void FindNextStop();
  void NoteSent(VirtualTime at);
  bool PassOnSentUntil(VirtualTime time);
  // Commands for earlier times do not come any more.
  void Settle(VirtualTime time);
  void ReadDue();
  // The time at which a command acts that was sent at `sent`: not before the time that is settled.
  VirtualTime ActsAt(VirtualTime sent, VirtualDuration latency) const;
  std::string WhomMoves(const CommandChannelSpec& spec) const;

  Scenario scenario_;
  std::unique_ptr<Dynamics> dynamics_;
  VirtualTime progress_, next_output_, next_stop_;
  std::optional<ChannelRecords> channel_records_;  // outlives what it has wrapped
  MeasurementLog measurements_;                    // likewise
  ScenarioMetrics metrics_;                        // likewise
  Channels channels_;
  std::vector<std::size_t> inlet_of_receiver_;
  std::vector<Inlet*> terminals_;
  Sensors sensors_;
  Commands commands_;
  CommandQueue queue_{commands_};
  std::ofstream csv_;
  std::string csv_path_, csv_text_;  // whole lines, not written yet
  VirtualTime next_csv_;
  LinkLines link_lines_;
  JointLines joint_lines_;
  CsvFile joints_csv_;
  ContactLines contact_lines_;
  CsvFile contacts_csv_;
  bool is_recorded_ = false;
  DueLinks due_links_;
  std::optional<WorldTopics> topics_;
  std::vector<int> all_bodies_, due_;
  std::vector<BodyState> states_;  // of all bodies, as each was read last
  std::vector<BodyState> read_;    // memory of ReadDue
  std::int64_t host_ns_ = 0;
};

}  // namespace tcs
