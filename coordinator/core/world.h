// The dynamics leaf: physics, the sensors that read it and the commands that drive it.
#pragma once

#include <cstdint>
#include <deque>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "coordinator/channel/udp_socket.h"
#include "coordinator/core/command_input.h"
#include "coordinator/core/dds_channels.h"
#include "coordinator/scenario/scenario.h"

namespace tcs {

class World {
 public:
  // `input` hears what comes in on the channels of commands; it outlives this.
  explicit World(CommandInput& input) : input_(input) {}

  // Binds the channels' ports. Empty on success, else one sentence.
  std::string Open(const Scenario& scenario);

  // Where the body states are written to; none without a world. Empty on success, else one
  // sentence.
  std::string OpenCsv(const std::string& path);
  void FlushCsv();
  std::string CloseCsv();

  // The channels on DDS, once there are such endpoints; they outlive this.
  void OpenDds(dds::OwnEndpoints& ends, std::int64_t realtime_offset_ns);

  bool present() const { return dynamics_ != nullptr; }
  std::int64_t progress_ns() const { return progress_ns_; }
  // Nothing leaves the dynamics before this.
  std::int64_t NextOutputNs() const { return next_output_ns_; }
  // When somebody looks at the state next: a sample, an output, a line of the CSV.
  std::int64_t NextStopNs() const { return next_stop_ns_; }
  // Advances to the earliest of `limit_ns` and the next stop, and carries out what is due there. No
  // command for an earlier time comes any more. True if something was sent.
  bool Advance(std::int64_t limit_ns);
  // Goes on to `to_ns`, at most the next stop, though commands for times from `settled_ns` on may
  // still come. One that does is applied at its time.
  void Lead(std::int64_t settled_ns, std::int64_t to_ns);

  const std::vector<int>& command_fds() const { return command_fds_; }
  // Applies what has arrived on command channel `index` at virtual time `now_ns`.
  void ReceiveCommands(std::size_t index, std::int64_t now_ns);

  bool speaks_dds() const { return dds_.has_value(); }
  // Applies what has been written by `now_ns` to command channels on DDS.
  void TakeDdsCommands(std::int64_t now_ns);

  // Of the coordinator's processor time, what physics and channels took.
  std::int64_t host_ns() const { return host_ns_; }
  std::int64_t commands() const { return commands_; }
  std::int64_t samples() const { return samples_; }

 private:
  struct Sensor {
    SensorChannelSpec spec;
    std::int64_t next_ns = 0;                                     // sample
    std::deque<std::pair<std::int64_t, std::string>> on_the_way;  // (arrival, datagram)
  };
  void WriteCsv();
  void Sample(Sensor& sensor);
  bool SendDue(Sensor& sensor);
  void FindNextStop();
  void Settle(std::int64_t settled_ns);
  void IntegrateDue();
  void Apply(std::int64_t at_ns, int body, const Wrench& wrench);

  CommandInput& input_;
  Scenario scenario_;
  std::unique_ptr<Dynamics> dynamics_;
  std::int64_t progress_ns_ = 0, next_output_ns_ = 0, next_stop_ns_ = 0;
  // Commands for earlier times do not come any more.
  std::int64_t settled_ns_ = 0;
  std::vector<Sensor> sensors_;
  std::vector<UdpSocket> command_sockets_;
  std::vector<int> command_fds_;
  std::optional<UdpSocket> out_;
  std::optional<DdsChannels> dds_;
  std::ofstream csv_;
  std::string csv_path_, csv_text_;  // whole lines, not written yet
  std::int64_t next_csv_ns_ = 0;
  std::vector<int> all_bodies_, due_;
  std::vector<BodyState> states_;  // memory of WriteCsv and Sample
  std::int64_t host_ns_ = 0, commands_ = 0, samples_ = 0;
};

}  // namespace tcs
