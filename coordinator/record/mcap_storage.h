// An MCAP file of the profile ros2: a batch is a chunk, with a checksum and an index; the file ends
// with a summary. The file holds the definitions of the messages, so that Foxglove, Lichtblick and
// PlotJuggler open it with nothing installed, and rosbag2 as a bag.
//
// Each chunk is in the file, with its index, when its batch ends. Without a summary readers go
// through the chunks. A write of which the disk takes only a part is taken back.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "coordinator/port/unique_fd.h"
#include "coordinator/record/bag_storage.h"
#include "coordinator/record/mcap_chunk.h"

namespace tcs::record {

class McapStorage final : public BagStorage {
 public:
  explicit McapStorage(dds::RosRelease release) : release_(release) {}

  // The size that rosbag2 has. Compressing a batch of this size takes a millisecond.
  std::size_t LargestBatch() const override { return 768 << 10; }
  std::span<const std::string_view> Companions() const override { return {}; }
  std::string Open(const std::string& path) override;
  std::string AddTopic(const BagTopic& topic, bool is_new_type) override;
  std::string Add(int topic, std::int64_t stamp_ns, std::span<const std::byte> cdr) override;
  std::string EndBatch(const BagMetadata& metadata, const std::set<int>& other_offers) override;
  void Abandon() override { chunk_.Clear(); }
  std::string Close(const BagMetadata& metadata, bool is_whole) override;

 private:
  // Appends `bytes` to the file, or nothing of them.
  std::string Append(std::string_view bytes);
  // Records that define the topics of `metadata` that no chunk has defined yet.
  std::string DefineNewTopics(const BagMetadata& metadata);
  std::uint16_t SchemaOf(const std::string& type, std::string* definitions);

  const dds::RosRelease release_;
  UniqueFd file_;
  std::uint64_t size_ = 0;  // of the file
  std::uint32_t crc_ = 0;
  std::map<std::string, std::uint16_t> schema_of_;  // by type
  std::string schemas_, channels_;                  // records that are in chunks
  std::vector<std::uint32_t> sequence_;             // of each topic, the next
  std::size_t defined_ = 0;                         // topics
  McapChunk chunk_;
  std::vector<McapChunkIndex> chunks_;
};

}  // namespace tcs::record
