// What programs are charged for DDS samples that travel in shared memory: natively Cyclone and the
// kernel would carry them, in the thread that writes and in the one that receives
// (coordinator/prices/price_list.h). A sample leaves when the thread that writes has done its part.
//
// For the coordinator's thread only.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "coordinator/dds/hub.h"
#include "coordinator/dds/message.h"
#include "coordinator/network/dds_paths.h"
#include "coordinator/tasks/task.h"
#include "shm/time_kinds.h"

namespace tcs {

class DdsCosts final : public dds::HubPaths {
 public:
  // By the process's number; null: none that lives, or the coordinator.
  using ProcessOf = std::function<const Process*(std::uint32_t number)>;

  // `counts_calls`: programs are charged for their calls, rather than for what they compute.
  DdsCosts(bool counts_calls, ProcessOf process_of)
      : counts_calls_(counts_calls), process_of_(std::move(process_of)) {}

  // Messages between robots go over the links of `wire`, which outlives this.
  void UseNetwork(Wire& wire);

  std::int64_t ArrivalNs(const shm::DdsMessage& header, std::uint32_t to) override;
  std::int64_t RoundTripNs(std::uint32_t one, std::uint32_t other) const override;

  // For what has been sent since the last call.
  VirtualDuration TakeForSent() { return std::exchange(for_sent_, {}); }
  VirtualDuration ForReceiving(const Process& process, const shm::DdsMessage& header) const;

 private:
  // A process's last sample: it goes to one process after the other, in messages of their own.
  struct Sent {
    dds::Guid writer{};
    std::int64_t timestamp_ns = -1;
    std::vector<std::uint32_t> to;
  };

  VirtualDuration Price(const Process& process, const shm::DdsMessage& header,
                        PriceBySize DdsPrices::*part) const;
  // Whether another process has been sent the same sample before.
  bool IsFurther(const shm::DdsMessage& header, std::uint32_t to);
  std::size_t RobotOf(std::uint32_t process) const;

  bool counts_calls_;
  ProcessOf process_of_;
  std::optional<DdsPaths> network_;
  VirtualDuration for_sent_;
  std::map<std::uint32_t, Sent> last_;  // by process
};

}  // namespace tcs
