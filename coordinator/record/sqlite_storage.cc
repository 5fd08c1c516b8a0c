#include "coordinator/record/sqlite_storage.h"

#include <errno.h>
#include <sqlite3.h>
#include <string.h>

#include <array>

#include "coordinator/record/message_definitions.h"

namespace tcs::record {
namespace {

// The hashes of types (REP 2011) stay empty, as those of Humble's types are.
constexpr const char* kTables = R"(
CREATE TABLE schema(schema_version INTEGER PRIMARY KEY, ros_distro TEXT NOT NULL);
CREATE TABLE metadata(id INTEGER PRIMARY KEY, metadata_version INTEGER NOT NULL,
                      metadata TEXT NOT NULL);
CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL,
                    serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL,
                    type_description_hash TEXT NOT NULL);
CREATE TABLE message_definitions(id INTEGER PRIMARY KEY, topic_type TEXT NOT NULL,
                                 encoding TEXT NOT NULL, encoded_message_definition TEXT NOT NULL,
                                 type_description_hash TEXT NOT NULL);
CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL,
                      timestamp INTEGER NOT NULL, data BLOB NOT NULL);
CREATE INDEX timestamp_idx ON messages (timestamp ASC);
)";

// The error in the words of the kernel, which the other messages of a full disk have.
std::string Why(sqlite3* database) {
  if (sqlite3_errcode(database) == SQLITE_FULL) return strerror(ENOSPC);
  const int error = sqlite3_system_errno(database);
  if (sqlite3_errcode(database) == SQLITE_IOERR && error != 0) return strerror(error);
  return sqlite3_errmsg(database);
}

std::int64_t IdOf(std::int64_t topic) { return topic + 1; }

void BindText(sqlite3_stmt* statement, int index, const std::string& text) {
  sqlite3_bind_text(statement, index, text.data(), static_cast<int>(text.size()), SQLITE_TRANSIENT);
}

}  // namespace

void SqliteStorage::Finalize::operator()(sqlite3_stmt* statement) const {
  sqlite3_finalize(statement);
}

SqliteStorage::~SqliteStorage() { Release(); }

void SqliteStorage::Release() {
  for (Statement* one : {&insert_topic_, &update_topic_, &insert_definition_, &insert_message_}) {
    one->reset();
  }
  if (sqlite3_close(database_) != SQLITE_OK && failure_.empty()) failure_ = Why(database_);
  database_ = nullptr;
}

std::span<const std::string_view> SqliteStorage::Companions() const {
  static constexpr std::array<std::string_view, 2> kCompanions = {"-wal", "-shm"};
  return kCompanions;
}

std::string SqliteStorage::Open(const std::string& path) {
  constexpr int kFlags = SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE | SQLITE_OPEN_NOMUTEX;
  if (sqlite3_open_v2(path.c_str(), &database_, kFlags, nullptr) != SQLITE_OK) {
    return Why(database_);
  }
  const bool done =
      Run("PRAGMA journal_mode = WAL") && Run("PRAGMA synchronous = NORMAL") && Run("BEGIN") &&
      Run(kTables) &&
      Run(release_ == dds::RosRelease::kHumble ? "INSERT INTO schema VALUES (4, 'humble')"
                                               : "INSERT INTO schema VALUES (4, 'iron')") &&
      Run("COMMIT") &&
      Prepare(
          "INSERT INTO topics(name, type, serialization_format, offered_qos_profiles, "
          "type_description_hash, id) VALUES (?, ?, 'cdr', '', ?, ?)",
          &insert_topic_) &&
      Prepare(
          "INSERT INTO message_definitions(topic_type, encoding, encoded_message_definition, "
          "type_description_hash) VALUES (?, ?, ?, ?)",
          &insert_definition_) &&
      Prepare("UPDATE topics SET offered_qos_profiles = ? WHERE id = ?", &update_topic_) &&
      Prepare("INSERT INTO messages(topic_id, timestamp, data) VALUES (?, ?, ?)", &insert_message_);
  return done ? std::string() : failure_;
}

std::string SqliteStorage::AddTopic(const BagTopic& topic, bool is_new_type) {
  if (!Begin()) return failure_;
  BindText(insert_topic_.get(), 1, topic.name);
  BindText(insert_topic_.get(), 2, topic.type);
  BindText(insert_topic_.get(), 3, topic.type_hash);
  sqlite3_bind_int64(insert_topic_.get(), 4, IdOf(topics_++));
  if (Step(insert_topic_.get()) && is_new_type) WriteDefinition(topic);
  return failure_;
}

// A type that tcs does not know gets an entry, too, as rosbag2 does it where it finds no
// definition.
bool SqliteStorage::WriteDefinition(const BagTopic& topic) {
  const std::string definition = DefinitionOf(topic.type, release_);
  BindText(insert_definition_.get(), 1, topic.type);
  BindText(insert_definition_.get(), 2, definition.empty() ? "unknown" : "ros2msg");
  BindText(insert_definition_.get(), 3, definition);
  BindText(insert_definition_.get(), 4, topic.type_hash);
  return Step(insert_definition_.get());
}

std::string SqliteStorage::Add(int topic, std::int64_t stamp_ns, std::span<const std::byte> cdr) {
  if (!Begin()) return failure_;
  sqlite3_stmt* const insert = insert_message_.get();
  sqlite3_bind_int64(insert, 1, IdOf(topic));
  sqlite3_bind_int64(insert, 2, stamp_ns);
  // SQLite would make NULL of a null pointer.
  sqlite3_bind_blob64(insert, 3, cdr.empty() ? "" : static_cast<const void*>(cdr.data()),
                      cdr.size(), SQLITE_STATIC);
  Step(insert);
  return failure_;
}

std::string SqliteStorage::EndBatch(const BagMetadata& metadata,
                                    const std::set<int>& other_offers) {
  if (!Begin()) return failure_;
  for (const int topic : other_offers) {
    BindText(update_topic_.get(), 1,
             OfferedQosYaml(metadata.topics[static_cast<std::size_t>(topic)].offered));
    sqlite3_bind_int64(update_topic_.get(), 2, IdOf(topic));
    if (!Step(update_topic_.get())) return failure_;
  }
  if (Run("COMMIT")) is_in_batch_ = false;
  return failure_;
}

void SqliteStorage::Abandon() {
  if (database_ != nullptr && sqlite3_get_autocommit(database_) == 0) {
    sqlite3_exec(database_, "ROLLBACK", nullptr, nullptr, nullptr);
  }
  is_in_batch_ = false;
}

std::string SqliteStorage::Close(const BagMetadata& metadata, bool is_whole) {
  Statement insert;
  if (is_whole &&
      Prepare("INSERT INTO metadata(metadata_version, metadata) VALUES (?, ?)", &insert)) {
    sqlite3_bind_int(insert.get(), 1, kMetadataVersion);
    BindText(insert.get(), 2, MetadataYaml(metadata));
    Step(insert.get());
  }
  insert.reset();
  for (Statement* one : {&insert_topic_, &update_topic_, &insert_definition_, &insert_message_}) {
    one->reset();
  }
  // Leaves one file, as readers that may not write beside it want it.
  if (is_whole && failure_.empty()) Run("PRAGMA journal_mode = DELETE");
  Release();
  return failure_;
}

bool SqliteStorage::Run(const char* sql) {
  if (sqlite3_exec(database_, sql, nullptr, nullptr, nullptr) == SQLITE_OK) return true;
  failure_ = Why(database_);
  return false;
}

bool SqliteStorage::Prepare(const char* sql, Statement* statement) {
  sqlite3_stmt* prepared = nullptr;
  const int result = sqlite3_prepare_v2(database_, sql, -1, &prepared, nullptr);
  statement->reset(prepared);
  if (result == SQLITE_OK) return true;
  failure_ = Why(database_);
  return false;
}

bool SqliteStorage::Step(sqlite3_stmt* statement) {
  const bool done = sqlite3_step(statement) == SQLITE_DONE;
  if (!done) failure_ = Why(database_);
  sqlite3_reset(statement);
  sqlite3_clear_bindings(statement);
  return done;
}

bool SqliteStorage::Begin() {
  if (!is_in_batch_) is_in_batch_ = Run("BEGIN");
  return is_in_batch_;
}

}  // namespace tcs::record
