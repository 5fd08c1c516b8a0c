// The samples that go over the topics of a run, as the hub sees them: for topics.json and for
// recordings.
//
// A sample is sent once to each process that reads it; here it counts once. A sample that is sent
// again to a reader that came late does not count, and neither does a sample that a program writes
// and nobody reads.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "coordinator/dds/endpoint_code.h"
#include "coordinator/dds/hub.h"
#include "coordinator/dds/topics_file.h"

namespace tcs::dds {

// The names of a process and of its robot.
struct Speaker {
  std::string process, robot;  // as in EndpointReport
};

class TopicLog : public HubObserver {
 public:
  using Topic = std::size_t;  // by number, from 0 on
  struct Listener {
    virtual ~Listener() = default;
    // A new endpoint of a process, of a topic that may be new. The name is DDS's.
    virtual void Opened(Topic topic, int domain, const Endpoint& endpoint) = 0;
    // A sample was written at `at_ns`; data, rather than the end of an instance.
    virtual void Written(Topic topic, std::int64_t at_ns, std::span<const std::byte> cdr) = 0;
  };

  // A sample that has reached a process.
  struct Delivery {
    Topic topic;
    Hub::Number from, to;  // 0: the coordinator
    std::int64_t sent_ns;  // the hub's: the coordinator's samples are sent when they arrive
    std::int64_t source_timestamp_ns;
    std::int64_t received_ns;
  };
  struct DeliveryListener {
    virtual ~DeliveryListener() = default;
    // A sample has been sent, and is delivered later, if at all; `received_ns` is 0.
    virtual void Sent(const Delivery&) {}
    virtual void Delivered(const Delivery& delivery) = 0;
  };

  explicit TopicLog(std::function<Speaker(Hub::Number)> who) : who_(std::move(who)) {}
  // Null: nobody is told. The listeners outlive this.
  void Tell(Listener* listener) { listener_ = listener; }
  void TellDeliveries(DeliveryListener* listener) { deliveries_.push_back(listener); }
  void TellNobody() { deliveries_.clear(); }

  const std::vector<TopicReport>& reports() const { return reports_; }
  // False: a program has made ever other topics, or writers and readers of ever other QoS. Nothing
  // is known of the ends beyond kMostEnds.
  bool is_whole() const { return is_whole_; }
  static constexpr std::size_t kMostEnds = 10'000;

  void Entered(const shm::DdsMessage& header, std::span<const std::byte> payload) override;
  void Dropped(const shm::DdsMessage& header, std::uint32_t to) override;
  void Delivered(const shm::DdsMessage& header, std::uint32_t to, std::int64_t at_ns) override;
  void Left(std::uint32_t from) override;

 private:
  struct Known {
    Topic topic;
    Hub::Number from;
    Guid participant;
    // The last sample, and the processes that it was sent to so far.
    std::int64_t timestamp_ns = INT64_MIN;
    std::uint32_t payload_size = 0;
    std::set<std::uint32_t> sent_to;
  };
  std::optional<Topic> Note(const Endpoint& endpoint, int domain, Speaker speaker);
  void ForgetAllOf(const Guid& participant);
  void NoteEndpoint(const shm::DdsMessage& header, std::span<const std::byte> payload);
  void NoteSample(const shm::DdsMessage& header, std::span<const std::byte> payload);
  // None: no sample with data, or of a writer that is not known.
  std::optional<Delivery> DeliveryOf(const shm::DdsMessage& header, std::uint32_t to,
                                     std::int64_t at_ns) const;

  std::function<Speaker(Hub::Number)> who_;
  Listener* listener_ = nullptr;
  std::vector<DeliveryListener*> deliveries_;
  std::vector<TopicReport> reports_;
  std::map<Guid, Known> known_;  // the endpoints that exist
  std::size_t ends_ = 0;         // in reports_
  bool is_whole_ = true;
};

}  // namespace tcs::dds
