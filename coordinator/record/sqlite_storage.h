// rosbag2's SQLite storage, in the form of ROS 2 Iron (schema 4): the storage has the definitions
// of the messages that tcs knows, and Humble's readers, which want none, read it as well.
//
// SQLite's write-ahead log keeps the database whole, whatever ends the process (NAME_0.db3-wal,
// beside it until Close).
#pragma once

#include <memory>
#include <string>

#include "coordinator/record/bag_storage.h"

struct sqlite3;
struct sqlite3_stmt;

namespace tcs::record {

class SqliteStorage final : public BagStorage {
 public:
  explicit SqliteStorage(dds::RosRelease release) : release_(release) {}
  ~SqliteStorage() override;
  SqliteStorage(const SqliteStorage&) = delete;
  SqliteStorage& operator=(const SqliteStorage&) = delete;

  std::size_t LargestBatch() const override { return 4 << 20; }
  std::span<const std::string_view> Companions() const override;
  std::string Open(const std::string& path) override;
  std::string AddTopic(const BagTopic& topic, bool is_new_type) override;
  std::string Add(int topic, std::int64_t stamp_ns, std::span<const std::byte> cdr) override;
  std::string EndBatch(const BagMetadata& metadata, const std::set<int>& other_offers) override;
  void Abandon() override;
  std::string Close(const BagMetadata& metadata, bool is_whole) override;

 private:
  struct Finalize {
    void operator()(sqlite3_stmt* statement) const;
  };
  using Statement = std::unique_ptr<sqlite3_stmt, Finalize>;

  // Each function is false, and `failure_` says why, once something went wrong.
  bool Run(const char* sql);
  bool Prepare(const char* sql, Statement* statement);
  bool Step(sqlite3_stmt* statement);
  bool Begin();
  bool WriteDefinition(const BagTopic& topic);
  void Release();

  const dds::RosRelease release_;
  sqlite3* database_ = nullptr;
  Statement insert_topic_, update_topic_, insert_definition_, insert_message_;
  std::int64_t topics_ = 0;
  bool is_in_batch_ = false;
  std::string failure_;
};

}  // namespace tcs::record
