// The DDS samples that wait for clients: which have reached which program, and which of them its
// threads have taken. The class keeps what each client was sent, and it tells the book of answers
// what threads take and command (answers/).
//
// The source timestamps of samples tell which of them a thread takes. The first sample that only
// one topic can have had tells which topic a reader is of. For the coordinator's thread only.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "coordinator/answers/client_figures.h"
#include "coordinator/dds/topic_log.h"
#include "coordinator/scenario/scenario.h"
#include "coordinator/tasks/answer_feed.h"
#include "coordinator/tasks/run_state.h"
#include "shm/datagram_notes.h"

namespace tcs {

class SampleFeed final : public dds::TopicLog::DeliveryListener {
 public:
  using NameOf = std::function<std::string(dds::Hub::Number)>;

  // `name` says which client a process is of. `run`, `answers` and `topics` outlive this.
  SampleFeed(RunState& run, AnswerFeed& answers, const dds::TopicLog& topics, NameOf name);

  // The thread that has written the samples that the hub is about to be told of; null: nobody.
  void BeginSending(const Task* by) { sender_ = by; }
  void Sent(const dds::TopicLog::Delivery& sample) override;
  void Delivered(const dds::TopicLog::Delivery& delivery) override;
  // The thread has taken samples, as it has noted, at that time.
  void Taken(const Task& task, const shm::DatagramNotes::Note& note, VirtualTime at);

  // By client, in the order of the scenario.
  std::map<int, std::vector<InputFigures>> Conclude() const;

 private:
  using Topic = dds::TopicLog::Topic;
  struct Sample {
    Topic topic = 0;
    std::int64_t source_ns = 0;  // the source timestamp
    std::int64_t arrived_ns = 0, sampled_ns = -1, period_ns = 0;
    int sensor = -1;   // as AnswerBook::Taken has it
    std::string from;  // InputFigures::from
    Lineage lineage{};
  };
  // A sample on its way: what it is made of was known when it was sent.
  struct OnTheWay {
    Topic topic;
    std::int64_t source_ns;
    Lineage lineage;
  };
  struct Receiver {
    std::deque<Sample> waiting;
    std::map<std::string, InputFigures> inputs;
    std::optional<AnswerBook::Who> last;  // of its threads that took something
  };

  const std::optional<AnswerBook::Who>& WhoIs(dds::Hub::Number number);
  std::optional<AnswerBook::Who> SenderOf(const dds::TopicLog::Delivery& delivery);
  void Commanded(const dds::TopicLog::Delivery& delivery);
  Sample SampleOf(const dds::TopicLog::Delivery& delivery);
  Lineage LineageFrom(const dds::TopicLog::Delivery& delivery);
  std::int64_t SentAt(const dds::TopicLog::Delivery& delivery) const;
  std::optional<Topic> TopicOf(std::pair<std::uint32_t, std::int32_t> reader,
                               const Receiver& receiver, std::int64_t newest_ns);

  RunState& run_;
  AnswerFeed& answers_;
  const dds::TopicLog& topics_;
  NameOf name_;
  const std::map<std::string, int> commanded_;  // topics, and which command
  std::map<dds::Hub::Number, std::optional<AnswerBook::Who>> clients_;
  const Task* sender_ = nullptr;
  std::map<dds::Hub::Number, std::deque<OnTheWay>> on_the_way_;      // by sender, the last ones
  std::map<int, Receiver> receivers_;                                // by client
  std::map<std::pair<std::uint32_t, std::int32_t>, Topic> readers_;  // by process and entity
};

}  // namespace tcs
