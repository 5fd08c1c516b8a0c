#include "coordinator/record/mcap_storage.h"

#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <unistd.h>

#include <utility>

#include "coordinator/record/mcap_record.h"
#include "coordinator/record/mcap_summary.h"
#include "coordinator/record/message_definitions.h"
#include "shm/check.h"

namespace tcs::record {

std::string McapStorage::Open(const std::string& path) {
  file_.Reset(open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666));
  if (!file_) return strerror(errno);
  std::string head(kMcapMagic);
  McapRecord(McapCode::kHeader, &head).Text("ros2").Text("tcs");
  return Append(head);
}

std::string McapStorage::Append(std::string_view bytes) {
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t n = write(file_.get(), bytes.data() + done, bytes.size() - done);
    if (n > 0) done += static_cast<std::size_t>(n);
    if (n > 0 || (n < 0 && errno == EINTR)) continue;
    const std::string why = strerror(n == 0 ? ENOSPC : errno);
    // Else the file would end within a record.
    if (ftruncate(file_.get(), static_cast<off_t>(size_)) == 0) {
      lseek(file_.get(), static_cast<off_t>(size_), SEEK_SET);
    }
    return why;
  }
  size_ += bytes.size();
  crc_ = Crc32(crc_, bytes);
  return {};
}

// The topic is defined when the batch ends: until then its writers say what they offer.
std::string McapStorage::AddTopic(const BagTopic&, bool) {
  TCS_CHECK(sequence_.size() < UINT16_MAX);
  sequence_.push_back(0);
  return {};
}

std::string McapStorage::Add(int topic, std::int64_t stamp_ns, std::span<const std::byte> cdr) {
  chunk_.Add({.channel = static_cast<std::uint16_t>(topic),
              .sequence = sequence_[static_cast<std::size_t>(topic)]++,
              .stamp_ns = static_cast<std::uint64_t>(stamp_ns)},
             cdr);
  return {};
}

// Schemas count from 1. The schema of a type that tcs does not know has the type's name and no
// more, as rosbag2 does it.
std::uint16_t McapStorage::SchemaOf(const std::string& type, std::string* definitions) {
  const auto next = static_cast<std::uint16_t>(schema_of_.size() + 1);
  const auto [known, is_new] = schema_of_.try_emplace(type, next);
  if (is_new) {
    const std::string text = DefinitionOf(type, release_);
    std::string record;
    McapRecord(McapCode::kSchema, &record)
        .U16(next)
        .Text(type)
        .Text(text.empty() ? "" : "ros2msg")
        .Text(text);
    schemas_ += record;
    *definitions += record;
  }
  return known->second;
}

std::string McapStorage::DefineNewTopics(const BagMetadata& metadata) {
  std::string definitions;
  for (; defined_ < metadata.topics.size(); ++defined_) {
    const BagTopic& topic = metadata.topics[defined_];
    const std::uint16_t schema = SchemaOf(topic.type, &definitions);
    std::string record;
    {
      McapRecord channel(McapCode::kChannel, &record);
      channel.U16(static_cast<std::uint16_t>(defined_)).U16(schema).Text(topic.name).Text("cdr");
      channel.List([&] {
        channel.Text("offered_qos_profiles").Text(OfferedQosYaml(topic.offered));
        if (!topic.type_hash.empty()) channel.Text("topic_type_hash").Text(topic.type_hash);
      });
    }
    channels_ += record;
    definitions += record;
  }
  return definitions;
}

// Offers that change later are in metadata.yaml alone: all records of a channel must be the same.
std::string McapStorage::EndBatch(const BagMetadata& metadata, const std::set<int>&) {
  const std::string definitions = DefineNewTopics(metadata);
  if (chunk_.empty() && definitions.empty()) return {};
  std::string bytes;
  McapChunkIndex index = chunk_.Finish(definitions, size_, &bytes);
  std::string why = Append(bytes);
  if (why.empty()) chunks_.push_back(std::move(index));
  return why;
}

// Where the data are not whole a summary of what there is may still have room.
std::string McapStorage::Close(const BagMetadata& metadata, bool) {
  const McapSummary summary{.schemas = schemas_,
                            .channels = channels_,
                            .schema_count = static_cast<std::uint16_t>(schema_of_.size()),
                            .channel_count = static_cast<std::uint32_t>(defined_),
                            .metadata = metadata,
                            .chunks = chunks_};
  std::string why = Append(McapEnd(summary, size_, crc_));
  if (fdatasync(file_.get()) != 0 && why.empty()) why = strerror(errno);
  file_.Reset();
  return why;
}

}  // namespace tcs::record
