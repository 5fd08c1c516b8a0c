// Where a bag keeps its samples: one of the storages that rosbag2 has. bag.h does what all storages
// share: the folder, the topics' names, the batches and metadata.yaml.
//
// A storage is given topics and samples, and holds them back until the batch ends: then the samples
// are in the file, whatever ends the process afterwards. Not thread-safe.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <string_view>

#include "coordinator/dds/ros_names.h"
#include "coordinator/record/bag_metadata.h"

namespace tcs::record {

enum class StorageKind { kSqlite3, kMcap };

class BagStorage {
 public:
  virtual ~BagStorage() = default;

  // The size of the largest batch, in bytes of samples.
  virtual std::size_t LargestBatch() const = 0;
  // The files that the storage has beside its own while it writes, as endings of its file's name.
  virtual std::span<const std::string_view> Companions() const = 0;

  // The following functions say why they failed, as the rest of a sentence; empty: they did not.
  // After a failure only Abandon and Close are called.

  // Makes an empty storage at `path`, where there is no file.
  [[nodiscard]] virtual std::string Open(const std::string& path) = 0;
  // The next topic, with an empty list of offers. `is_new_type`: no topic before had its type.
  [[nodiscard]] virtual std::string AddTopic(const BagTopic& topic, bool is_new_type) = 0;
  // `topic` counts from 0.
  [[nodiscard]] virtual std::string Add(int topic, std::int64_t stamp_ns,
                                        std::span<const std::byte> cdr) = 0;
  // `metadata` counts the batch's samples; the offers of `other_offers` have changed in it.
  [[nodiscard]] virtual std::string EndBatch(const BagMetadata& metadata,
                                             const std::set<int>& other_offers) = 0;
  // Drops the samples of the batch.
  virtual void Abandon() = 0;
  // `metadata` is of the batches that are kept. False for `is_whole`: something has failed before.
  [[nodiscard]] virtual std::string Close(const BagMetadata& metadata, bool is_whole) = 0;
};

// rosbag2's name of the storage, and what its files' names end in.
std::string_view IdentifierOf(StorageKind kind);
std::string_view EndingOf(StorageKind kind);

// The definitions of messages in the storage are as `release` has them.
std::unique_ptr<BagStorage> MakeStorage(StorageKind kind, dds::RosRelease release);

}  // namespace tcs::record
