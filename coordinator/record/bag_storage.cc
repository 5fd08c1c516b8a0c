#include "coordinator/record/bag_storage.h"

#include "coordinator/record/mcap_storage.h"
#include "coordinator/record/sqlite_storage.h"

namespace tcs::record {

std::string_view IdentifierOf(StorageKind kind) {
  return kind == StorageKind::kMcap ? "mcap" : "sqlite3";
}

std::string_view EndingOf(StorageKind kind) {
  return kind == StorageKind::kMcap ? ".mcap" : ".db3";
}

std::unique_ptr<BagStorage> MakeStorage(StorageKind kind, dds::RosRelease release) {
  if (kind == StorageKind::kMcap) return std::make_unique<McapStorage>(release);
  return std::make_unique<SqliteStorage>(release);
}

}  // namespace tcs::record
