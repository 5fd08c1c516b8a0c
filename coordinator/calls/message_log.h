// Which DDS messages reached whom, and when: messages.csv, a line for each sample and process. A
// message that reaches the coordinator is one of the world's commands; messages that only
// recordings read are left out.
//
// The file is made with the first line. For the coordinator's thread only.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <string>

#include "coordinator/dds/topic_log.h"
#include "coordinator/scenario/scenario.h"
#include "coordinator/trace/csv_file.h"

namespace tcs {

class MessageLog final : public dds::TopicLog::DeliveryListener {
 public:
  using NameOf = std::function<std::string(dds::Hub::Number)>;

  // `name` says what a process is called. `topics` outlives this. `realtime_offset_ns`: how far
  // stamps are ahead of virtual time.
  MessageLog(std::string folder, const Scenario& scenario, const dds::TopicLog& topics, NameOf name,
             std::int64_t realtime_offset_ns);

  void Delivered(const dds::TopicLog::Delivery& delivery) override;
  void Flush() { file_.Flush(); }
  // Empty on success, else one sentence.
  [[nodiscard]] std::string Close();

 private:
  const std::string& NameOfProcess(dds::Hub::Number number);

  const std::string path_;
  const dds::TopicLog& topics_;
  NameOf name_;
  const std::int64_t realtime_offset_ns_;
  const std::set<std::string> commanded_;
  std::map<dds::Hub::Number, std::string> names_;
  CsvFile file_;
  std::string failure_;
};

}  // namespace tcs
