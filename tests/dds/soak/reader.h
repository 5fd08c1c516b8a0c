// One reader of the soak: takes what has come, checks that it keeps what was promised, and folds
// all that it sees into a number.
#pragma once

#include <dds/dds.h>

#include <atomic>
#include <cstdint>
#include <map>
#include <string>
#include <utility>

#include "tests/dds/soak/flow.h"

namespace dds_soak {

class Reader {
 public:
  // From now on there is a reader. `total` is of all flows together. If it listens, it sets the
  // guard condition `done` when it has all.
  Reader(dds_entity_t participant, const Flow& flow, const ReadBy& how, std::uint64_t total,
         dds_entity_t done);
  ~Reader();
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  dds_entity_t entity() const { return entity_; }
  bool listens() const { return how_.listens; }
  // It has all that it must get.
  bool HasAll() const { return missing_ == 0; }
  std::uint64_t taken() const { return taken_; }

  void Take() { TakeFrom(entity_); }
  // What it has seen, as one line; fails if it has missed what must come.
  void Conclude();

 private:
  struct Stream {
    std::uint32_t next = 0;  // the number that is to come
    std::uint32_t last;      // that will ever come
  };

  void TakeFrom(dds_entity_t reader);
  void Check(const Sample& sample, const dds_sample_info_t& info, std::int64_t now_ns);
  void Fold(std::uint64_t value);

  const Flow& flow_;
  const ReadBy& how_;
  const std::uint32_t of_each_;
  std::map<std::pair<int, std::int32_t>, Stream> streams_;  // by writer and key
  std::atomic<std::uint64_t> missing_ = 0;  // samples, or last samples, still to come
  std::atomic<std::uint64_t> taken_ = 0;
  std::uint64_t skipped_ = 0, ended_ = 0;
  std::uint64_t digest_ = 14695981039346656037u;
  std::int64_t longest_ns_ = 0;  // from write to take
  dds_entity_t entity_ = 0, done_;
};

}  // namespace dds_soak
