// The paths of DDS messages between robots, where the messages go in shared memory (`dds:
// endpoints`): the same links as those of packets.
//
// A best-effort sample that is lost does not arrive. A reliable sample arrives later by one round
// trip for each time that it is lost, because a reader asks for it again, and later reliable
// samples of the same process wait for it. Announcements of participants and endpoints are
// reliable, and no sample overtakes them. Pure, for the coordinator's thread only.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <utility>

#include "coordinator/dds/hub.h"
#include "coordinator/network/wire.h"

namespace tcs {

class DdsPaths final : public dds::HubPaths {
 public:
  // On which robot a process is, by its number; the number of robots: the process is on none.
  using RobotOf = std::function<std::size_t(std::uint32_t process)>;

  DdsPaths(Wire& wire, RobotOf robot_of) : wire_(wire), robot_of_(std::move(robot_of)) {}

  std::int64_t ArrivalNs(const shm::DdsMessage& header, std::uint32_t to) override;
  std::int64_t RoundTripNs(std::uint32_t one, std::uint32_t other) const override;

 private:
  // When the last message of each kind arrives, between two processes.
  struct Last {
    VirtualTime reliable, news;
  };

  bool AreApart(std::size_t from, std::size_t to) const;
  // Never: the message is lost each time.
  VirtualTime SendAgain(NetworkLink& link, std::size_t bytes, VirtualTime arrives,
                        VirtualDuration round_trip);

  Wire& wire_;
  RobotOf robot_of_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, Last> last_;
};

}  // namespace tcs
