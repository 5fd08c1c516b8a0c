#include "coordinator/record/bag.h"

#include <errno.h>
#include <fmt/format.h>
#include <sqlite3.h>
#include <string.h>

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "coordinator/record/message_definitions.h"
#include "shm/check.h"

namespace tcs::record {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kLongestBatch_ns = 1'000'000'000;
constexpr std::size_t kLargestBatch = 4 << 20;
// What SQLite adds to a message, about: the row, and its line in the index.
constexpr std::size_t kRowBytes = 32;

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

// In the words of the kernel, which the other messages of a full disk have.
std::string Why(sqlite3* database) {
  if (sqlite3_errcode(database) == SQLITE_FULL) return strerror(ENOSPC);
  return sqlite3_errmsg(database);
}

// The folder's own name: that of "out/bag/" is "bag".
std::string NameOf(const std::string& folder) {
  fs::path path = fs::path(folder).lexically_normal();
  if (!path.has_filename()) path = path.parent_path();
  const std::string name = path.filename().string();
  return name.empty() || name == "." || name == ".." || name == "/" ? "bag" : name;
}

std::int64_t IdOf(int topic) { return topic + 1; }

void BindText(sqlite3_stmt* statement, int index, const std::string& text) {
  sqlite3_bind_text(statement, index, text.data(), static_cast<int>(text.size()), SQLITE_TRANSIENT);
}

}  // namespace

void Bag::Finalize::operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }

Bag::Bag(dds::RosRelease release) : release_(release) {}

Bag::~Bag() {
  if (is_open()) (void)Close();
}

std::string Bag::Open(const std::string& folder) {
  TCS_CHECK(!is_open());
  if (const std::string error = MakeFolder(folder); !error.empty()) return error;
  folder_ = folder;
  metadata_ = {};
  metadata_.file = NameOf(folder) + "_0.db3";
  topics_.clear();
  names_.clear();
  defined_.clear();
  other_offers_.clear();
  in_batches_ = metadata_;
  path_ = folder + "/" + metadata_.file;
  is_in_batch_ = false;
  batch_began_ns_.reset();
  batch_bytes_ = 0;
  missing_ = 0;
  failure_.clear();
  for (const std::string& old :
       {folder + "/metadata.yaml", path_, path_ + "-wal", path_ + "-shm"}) {
    std::error_code error;
    fs::remove(old, error);
    if (error) return fmt::format("{} cannot be replaced: {}", old, error.message());
  }
  constexpr int kFlags = SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE | SQLITE_OPEN_NOMUTEX;
  const bool done =
      (sqlite3_open_v2(path_.c_str(), &database_, kFlags, nullptr) == SQLITE_OK ||
       Fail(Why(database_))) &&
      Run("PRAGMA journal_mode = WAL") && Run("PRAGMA synchronous = NORMAL") && Run("BEGIN") &&
      Run(kTables) &&
      Run(release_ == dds::RosRelease::kHumble ? "INSERT INTO schema VALUES (4, 'humble')"
                                               : "INSERT INTO schema VALUES (4, 'iron')") &&
      Run("COMMIT") &&
      Prepare(
          "INSERT INTO topics(name, type, serialization_format, offered_qos_profiles, "
          "type_description_hash, id) VALUES (?, ?, 'cdr', '', '', ?)",
          &insert_topic_) &&
      Prepare(
          "INSERT INTO message_definitions(topic_type, encoding, encoded_message_definition, "
          "type_description_hash) VALUES (?, ?, ?, '')",
          &insert_definition_) &&
      Prepare("UPDATE topics SET offered_qos_profiles = ? WHERE id = ?", &update_topic_) &&
      Prepare("INSERT INTO messages(topic_id, timestamp, data) VALUES (?, ?, ?)",
              &insert_message_) &&
      WriteMetadata(Withstands::kCrash);
  if (done) return {};
  insert_topic_.reset();
  insert_definition_.reset();
  update_topic_.reset();
  insert_message_.reset();
  sqlite3_close(database_);
  database_ = nullptr;
  return fmt::format(
      "the recording {} cannot be made: {}; choose another folder with --out, or make room there",
      path_, failure_);
}

std::string Bag::UniqueName(const std::string& name) {
  int& wanted = names_[name];
  std::string unique = name;
  while (wanted++ > 0) {
    unique = fmt::format("{}_{}", name, wanted);
    if (names_.emplace(unique, 1).second) break;
  }
  return unique;
}

int Bag::AddTopic(std::string_view name, std::string_view type) {
  const int next = static_cast<int>(metadata_.topics.size());
  const auto [known, is_new] = topics_.try_emplace({std::string(name), std::string(type)}, next);
  if (!is_new) return known->second;
  const std::string unique = UniqueName(std::string(name));
  metadata_.topics.push_back({unique, std::string(type), {}, 0});
  if (Begin()) {
    BindText(insert_topic_.get(), 1, unique);
    BindText(insert_topic_.get(), 2, metadata_.topics.back().type);
    sqlite3_bind_int64(insert_topic_.get(), 3, IdOf(next));
    Step(insert_topic_.get());
    WriteDefinition(metadata_.topics.back().type);
  }
  return next;
}

// Of one that tcs does not know too, as rosbag2 does it where it finds no definition.
void Bag::WriteDefinition(const std::string& type) {
  if (!failure_.empty() || !defined_.insert(type).second) return;
  const std::string definition = DefinitionOf(type, release_);
  BindText(insert_definition_.get(), 1, type);
  BindText(insert_definition_.get(), 2, definition.empty() ? "unknown" : "ros2msg");
  BindText(insert_definition_.get(), 3, definition);
  Step(insert_definition_.get());
}

void Bag::AddOffer(int topic, const dds::Qos& qos) {
  std::vector<dds::Qos>& offered = metadata_.topics.at(static_cast<std::size_t>(topic)).offered;
  if (std::find(offered.begin(), offered.end(), qos) != offered.end()) return;
  offered.push_back(qos);
  if (Begin()) other_offers_.insert(topic);
}

void Bag::Write(int topic, std::int64_t stamp_ns, std::span<const std::byte> cdr) {
  const bool is_long = batch_began_ns_ && stamp_ns - *batch_began_ns_ >= kLongestBatch_ns;
  if (is_long || batch_bytes_ >= kLargestBatch) EndBatch();
  sqlite3_stmt* const insert = insert_message_.get();
  if (Begin()) {
    sqlite3_bind_int64(insert, 1, IdOf(topic));
    sqlite3_bind_int64(insert, 2, stamp_ns);
    // SQLite would make NULL of a null pointer.
    sqlite3_bind_blob64(insert, 3, cdr.empty() ? "" : static_cast<const void*>(cdr.data()),
                        cdr.size(), SQLITE_STATIC);
  }
  if (!failure_.empty() || !Step(insert)) {
    ++missing_;
    return;
  }
  if (!batch_began_ns_) batch_began_ns_ = stamp_ns;
  batch_bytes_ += cdr.size() + kRowBytes;
  const bool is_first = metadata_.messages == 0;
  metadata_.first_ns = is_first ? stamp_ns : std::min(metadata_.first_ns, stamp_ns);
  metadata_.last_ns = is_first ? stamp_ns : std::max(metadata_.last_ns, stamp_ns);
  ++metadata_.messages;
  ++metadata_.topics.at(static_cast<std::size_t>(topic)).messages;
}

std::string Bag::Close() {
  TCS_CHECK(is_open());
  if (EndBatch()) {
    Statement insert;
    if (Prepare("INSERT INTO metadata(metadata_version, metadata) VALUES (?, ?)", &insert)) {
      sqlite3_bind_int(insert.get(), 1, kMetadataVersion);
      BindText(insert.get(), 2, MetadataYaml(in_batches_));
      Step(insert.get());
    }
  }
  insert_topic_.reset();
  insert_definition_.reset();
  update_topic_.reset();
  insert_message_.reset();
  // One file, as readers that may not write beside it want it.
  if (failure_.empty()) Run("PRAGMA journal_mode = DELETE");
  if (sqlite3_close(database_) != SQLITE_OK && failure_.empty()) Fail(Why(database_));
  database_ = nullptr;
  WriteMetadata(Withstands::kPowerCut);
  if (failure_.empty()) return {};
  return fmt::format("the recording {} is not whole: {}; {} of {} samples are missing", path_,
                     failure_, missing_, missing_ + in_batches_.messages);
}

bool Bag::Run(const char* sql) {
  return sqlite3_exec(database_, sql, nullptr, nullptr, nullptr) == SQLITE_OK ||
         Fail(Why(database_));
}

bool Bag::Prepare(const char* sql, Statement* statement) {
  sqlite3_stmt* prepared = nullptr;
  const int result = sqlite3_prepare_v2(database_, sql, -1, &prepared, nullptr);
  statement->reset(prepared);
  return result == SQLITE_OK || Fail(Why(database_));
}

bool Bag::Step(sqlite3_stmt* statement) {
  const bool done = sqlite3_step(statement) == SQLITE_DONE;
  const std::string why = done ? "" : Why(database_);
  sqlite3_reset(statement);
  sqlite3_clear_bindings(statement);
  return done || Fail(why);
}

bool Bag::Begin() {
  if (!failure_.empty()) return false;
  if (!is_in_batch_) is_in_batch_ = Run("BEGIN");
  return is_in_batch_;
}

bool Bag::EndBatch() {
  if (!failure_.empty()) return false;
  if (!is_in_batch_) return true;
  for (const int topic : std::exchange(other_offers_, {})) {
    BindText(update_topic_.get(), 1,
             OfferedQosYaml(metadata_.topics[static_cast<std::size_t>(topic)].offered));
    sqlite3_bind_int64(update_topic_.get(), 2, IdOf(topic));
    if (!Step(update_topic_.get())) return false;
  }
  if (!Run("COMMIT")) return false;
  is_in_batch_ = false;
  batch_began_ns_.reset();
  batch_bytes_ = 0;
  in_batches_ = metadata_;
  return WriteMetadata(Withstands::kCrash);
}

bool Bag::WriteMetadata(Withstands what) {
  const std::string error = WriteWhole(folder_ + "/metadata.yaml", MetadataFile(in_batches_), what);
  return error.empty() || Fail(error);
}

// What the batch held is not in the bag, and nothing more will be.
bool Bag::Fail(const std::string& why) {
  if (!failure_.empty()) return false;
  failure_ = why;
  if (database_ != nullptr && sqlite3_get_autocommit(database_) == 0) {
    sqlite3_exec(database_, "ROLLBACK", nullptr, nullptr, nullptr);
  }
  missing_ += metadata_.messages - in_batches_.messages;
  return false;
}

}  // namespace tcs::record
