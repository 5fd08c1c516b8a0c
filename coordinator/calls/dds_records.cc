#include "coordinator/calls/dds_records.h"

#include <fmt/format.h>

#include <filesystem>
#include <system_error>
#include <vector>

#include "coordinator/dds/topics_file.h"

namespace tcs {

void DdsRecords::UseAnswers(AnswerFeed& answers) {
  samples_.emplace(run_, answers, topic_log_,
                   [this](dds::Hub::Number number) { return who_(number).process; });
}

std::string DdsRecords::Open() {
  const std::string& directory = run_.options.output_directory;
  if (!directory.empty()) {
    std::error_code ignored;  // of an earlier run into the same folder
    std::filesystem::remove(directory + "/topics.json", ignored);
    std::filesystem::remove(directory + "/messages.csv", ignored);
    std::filesystem::remove_all(directory + "/bag", ignored);
    hub_.Observe(&topic_log_);
    messages_.emplace(
        directory, run_.scenario, topic_log_,
        [this](dds::Hub::Number number) { return who_(number).process; },
        run_.header->realtime_offset_ns);
    topic_log_.TellDeliveries(&*messages_);
    if (samples_.has_value()) topic_log_.TellDeliveries(&*samples_);
  }
  if (run_.options.record == RecordingKind::kNone) return {};
  recording_.emplace(topic_log_, ends_, run_.header->realtime_offset_ns, run_.scenario.ros,
                     run_.options.record == RecordingKind::kMcap ? record::StorageKind::kMcap
                                                                 : record::StorageKind::kSqlite3);
  topic_log_.Tell(&*recording_);
  std::string error = recording_->Open(directory + "/bag");
  if (!error.empty()) {
    topic_log_.Tell(nullptr);
    recording_.reset();
  }
  return error;
}

void DdsRecords::ReadNewTopics(std::int64_t now_ns) {
  if (recording_.has_value()) recording_->ReadNewTopics(now_ns);
}

std::string DdsRecords::Close() {
  const std::vector<dds::TopicReport>& topics = topic_log_.reports();
  std::string error;
  if (!topics.empty()) {
    error = dds::WriteTopics(topics, run_.options.output_directory + "/topics.json");
  }
  if (messages_.has_value()) {
    if (std::string missing = messages_->Close(); error.empty()) error = std::move(missing);
  }
  if (recording_.has_value()) {
    if (std::string missing = recording_->Close(); error.empty()) error = std::move(missing);
  }
  return error;
}

void DdsRecords::Stop() {
  hub_.Observe(nullptr);
  topic_log_.Tell(nullptr);
  topic_log_.TellNobody();
}

void DdsRecords::WarnOfDrops() const {
  const dds::Hub::Drops& drops = hub_.drops();
  const auto say = [this](std::uint64_t count, const char* what) {
    if (count > 0) run_.Warn(fmt::format("{} DDS samples {}", count, what));
  };
  say(drops.lost,
      "were dropped because a program does not take them any more and 256 MiB were waiting for it: "
      "look for a listener that never returns");
  say(drops.unreliable,
      "of best-effort readers or writers were dropped because 1 MiB was waiting for a program that "
      "takes too slowly: `tcsim topics DIR` names the topics");
  say(drops.replaced,
      "of KEEP_LAST writers were replaced by later ones because 1 MiB was waiting for a program "
      "that takes too slowly: `tcsim topics DIR` names the topics");
  if (!topic_log_.is_whole()) {
    run_.Warn(fmt::format(
        "the programs have made more than {} different writers and readers of DDS topics: "
        "topics.json{} of the first ones only; look for a counter in their names or QoS",
        dds::TopicLog::kMostEnds, recording_.has_value() ? " and bag/ tell" : " tells"));
  }
}

}  // namespace tcs
