#include "coordinator/record/bag.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <vector>

#include "coordinator/dds/type_hash.h"
#include "shm/check.h"

namespace tcs::record {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kLongestBatch_ns = 1'000'000'000;
// The bytes that a storage adds to a message, about: a row, or a record's head, and its line in the
// index.
constexpr std::size_t kRowBytes = 32;

// The folder's own name: the name of "out/bag/" is "bag".
std::string NameOf(const std::string& folder) {
  fs::path path = fs::path(folder).lexically_normal();
  if (!path.has_filename()) path = path.parent_path();
  const std::string name = path.filename().string();
  return name.empty() || name == "." || name == ".." || name == "/" ? "bag" : name;
}

}  // namespace

Bag::Bag(dds::RosRelease release, StorageKind kind) : release_(release), kind_(kind) {}

Bag::~Bag() {
  if (is_open()) (void)Close();
}

std::string Bag::Open(const std::string& folder) {
  TCS_CHECK(!is_open());
  if (const std::string error = MakeFolder(folder); !error.empty()) return error;
  folder_ = folder;
  metadata_ = {};
  metadata_.storage = IdentifierOf(kind_);
  metadata_.file = NameOf(folder) + "_0" + std::string(EndingOf(kind_));
  topics_.clear();
  names_.clear();
  types_.clear();
  other_offers_.clear();
  in_batches_ = metadata_;
  path_ = folder + "/" + metadata_.file;
  is_in_batch_ = false;
  batch_began_ns_.reset();
  batch_bytes_ = 0;
  missing_ = 0;
  failure_.clear();
  storage_ = MakeStorage(kind_, release_);
  std::vector<std::string> old_files = {folder + "/metadata.yaml", path_};
  for (const std::string_view ending : storage_->Companions()) {
    old_files.push_back(path_ + std::string(ending));
  }
  for (const std::string& old : old_files) {
    std::error_code error;
    fs::remove(old, error);
    if (!error) continue;
    storage_.reset();
    return fmt::format("{} cannot be replaced: {}", old, error.message());
  }
  Note(storage_->Open(path_));
  if (failure_.empty()) WriteMetadata(Withstands::kCrash);
  if (failure_.empty()) return {};
  storage_.reset();
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

int Bag::AddTopic(std::string_view name, std::string_view type, std::string_view type_hash) {
  const int next = static_cast<int>(metadata_.topics.size());
  const auto [known, is_new] = topics_.try_emplace({std::string(name), std::string(type)}, next);
  if (!is_new) return known->second;
  metadata_.topics.push_back(
      {.name = UniqueName(std::string(name)),
       .type = std::string(type),
       .offered = {},
       .type_hash = type_hash.empty() ? dds::TypeHashOf(type, release_) : std::string(type_hash)});
  if (failure_.empty()) {
    is_in_batch_ = true;
    Note(storage_->AddTopic(metadata_.topics.back(), types_.emplace(type).second));
  }
  return next;
}

void Bag::AddOffer(int topic, const dds::Qos& qos) {
  std::vector<dds::Qos>& offered = metadata_.topics.at(static_cast<std::size_t>(topic)).offered;
  if (std::find(offered.begin(), offered.end(), qos) != offered.end()) return;
  offered.push_back(qos);
  is_in_batch_ = true;
  other_offers_.insert(topic);
}

void Bag::Write(int topic, std::int64_t stamp_ns, std::span<const std::byte> cdr) {
  const bool is_long = batch_began_ns_ && stamp_ns - *batch_began_ns_ >= kLongestBatch_ns;
  if (is_long || batch_bytes_ >= storage_->LargestBatch()) EndBatch();
  if (failure_.empty()) {
    is_in_batch_ = true;
    Note(storage_->Add(topic, stamp_ns, cdr));
  }
  if (!failure_.empty()) {
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
  EndBatch();
  Note(storage_->Close(in_batches_, failure_.empty()));
  storage_.reset();
  WriteMetadata(Withstands::kPowerCut);
  if (failure_.empty()) return {};
  return fmt::format("the recording {} is incomplete: {}; {} of {} samples are missing", path_,
                     failure_, missing_, missing_ + in_batches_.messages);
}

void Bag::EndBatch() {
  if (!failure_.empty() || !is_in_batch_) return;
  Note(storage_->EndBatch(metadata_, std::exchange(other_offers_, {})));
  if (!failure_.empty()) return;
  is_in_batch_ = false;
  batch_began_ns_.reset();
  batch_bytes_ = 0;
  in_batches_ = metadata_;
  WriteMetadata(Withstands::kCrash);
}

void Bag::WriteMetadata(Withstands what) {
  Note(WriteWhole(folder_ + "/metadata.yaml", MetadataFile(in_batches_), what));
}

// The samples of the batch are not in the bag, and no more samples will be.
void Bag::Note(const std::string& why) {
  if (why.empty() || !failure_.empty()) return;
  failure_ = why;
  if (storage_ != nullptr) storage_->Abandon();
  missing_ += metadata_.messages - in_batches_.messages;
}

}  // namespace tcs::record
