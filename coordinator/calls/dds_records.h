// The records that a run keeps of its DDS topics: topics.json, messages.csv, and with
// RunOptions::record a bag (docs/RESULTS.md), to which other parts write, too.
//
// For the coordinator's thread only. Errors are one sentence; empty is success.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "coordinator/calls/message_log.h"
#include "coordinator/calls/sample_feed.h"
#include "coordinator/dds/hub.h"
#include "coordinator/dds/own_endpoints.h"
#include "coordinator/dds/topic_log.h"
#include "coordinator/record/recording.h"
#include "coordinator/tasks/run_state.h"

namespace tcs {

class DdsRecords {
 public:
  using WhoIs = std::function<dds::Speaker(dds::Hub::Number)>;

  // The hub and the endpoints outlive this.
  DdsRecords(RunState& run, dds::Hub& hub, dds::OwnEndpoints& ends, WhoIs who)
      : run_(run), hub_(hub), ends_(ends), who_(who), topic_log_(std::move(who)) {}

  // The book of answers is fed with samples from then on.
  void UseAnswers(AnswerFeed& answers);
  const SampleFeed* samples() const { return samples_ ? &*samples_ : nullptr; }
  SampleFeed* samples() { return samples_ ? &*samples_ : nullptr; }
  // Once the run's header has its times. The files that an earlier run has left are removed.
  [[nodiscard]] std::string Open();
  // Endpoints may have come since the last call: a recording reads their topics. Not from within
  // the hub.
  void ReadNewTopics(std::int64_t now_ns);
  void Flush() {
    if (messages_) messages_->Flush();
  }
  [[nodiscard]] std::string Close();
  // The recording; null where there is none.
  record::MessageSink* sink() { return recording_ ? &*recording_ : nullptr; }
  // Messages that are sent from now on are no part of the run.
  void Stop();

  // Warns of samples that no reader got, and of endpoints that were not recorded.
  void WarnOfDrops() const;
  const dds::TopicLog& topics() const { return topic_log_; }

 private:
  RunState& run_;
  dds::Hub& hub_;
  dds::OwnEndpoints& ends_;
  WhoIs who_;
  dds::TopicLog topic_log_;
  std::optional<MessageLog> messages_;
  std::optional<SampleFeed> samples_;
  std::optional<record::Recording> recording_;
};

}  // namespace tcs
