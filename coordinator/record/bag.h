// A recording as ROS 2 keeps it: a rosbag2 bag, that is a folder with metadata.yaml and a file with
// the samples: NAME_0.db3 or NAME_0.mcap, as the storage has it (bag_storage.h).
//
// Samples are written in batches of a virtual second at the most. Whatever ends the process,
// samples that were written before the last batch can be opened, and metadata.yaml counts the
// samples of the batches. Once a write fails, nothing more is written.
//
// Not thread-safe. Close() reports what could not be written.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "coordinator/dds/qos.h"
#include "coordinator/dds/ros_names.h"
#include "coordinator/os/files.h"
#include "coordinator/record/bag_metadata.h"
#include "coordinator/record/bag_storage.h"

namespace tcs::record {

class Bag {
 public:
  // The messages are as `release` has them.
  explicit Bag(dds::RosRelease release = dds::RosRelease::kIron,
               StorageKind kind = StorageKind::kSqlite3);
  // Closes the bag without a word if it is still open.
  ~Bag();
  Bag(const Bag&) = delete;
  Bag& operator=(const Bag&) = delete;

  // Makes the folder, and an empty bag in it in place of an earlier one. Empty on success, else one
  // sentence.
  [[nodiscard]] std::string Open(const std::string& folder);
  bool is_open() const { return storage_ != nullptr; }

  // The number of the topic, for Write. ROS 2's names (dds/ros_names.h); a topic and type that the
  // bag has already keep their number. A topic of another type is another topic, "/odom_2", for
  // readers of bags go by the name. `type_hash` is what the topic's endpoints say; where the
  // endpoints say none, the hash is that of the messages that tcs knows.
  int AddTopic(std::string_view name, std::string_view type, std::string_view type_hash = {});
  // A writer of the topic offers `qos`.
  void AddOffer(int topic, const dds::Qos& qos);

  // `cdr` is a sample with its encapsulation, `stamp_ns` its virtual time since 1970.
  void Write(int topic, std::int64_t stamp_ns, std::span<const std::byte> cdr);

  // Empty on success, else one sentence that says what is missing.
  [[nodiscard]] std::string Close();

  const BagMetadata& metadata() const { return metadata_; }

 private:
  void EndBatch();
  std::string UniqueName(const std::string& name);
  void WriteMetadata(Withstands what);
  // `why` is empty where nothing failed.
  void Note(const std::string& why);

  const dds::RosRelease release_;
  const StorageKind kind_;
  std::string folder_, path_;
  std::unique_ptr<BagStorage> storage_;
  BagMetadata metadata_;
  std::map<std::pair<std::string, std::string>, int> topics_;  // as they were asked for, with types
  std::map<std::string, int> names_;  // names that are taken, and how many topics wanted them
  std::set<std::string> types_;
  std::set<int> other_offers_;  // topics whose offers have changed in this batch
  BagMetadata in_batches_;      // metadata_ as of the last batch that was written whole
  bool is_in_batch_ = false;
  std::optional<std::int64_t> batch_began_ns_;  // none: no message in it
  std::size_t batch_bytes_ = 0;
  std::int64_t missing_ = 0;
  std::string failure_;
};

}  // namespace tcs::record
