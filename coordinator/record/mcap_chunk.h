// A chunk of an MCAP file: messages that are compressed together (zstd), after the definitions of
// the topics whose first messages they are, and an index that says where each topic's messages are.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

struct ZSTD_CCtx_s;

namespace tcs::record {

// The entry of a chunk in the file's summary. Offsets are of the file.
struct McapChunkIndex {
  std::uint64_t first_ns = 0, last_ns = 0;  // stamps; without messages both are 0
  std::uint64_t start = 0, length = 0;
  std::map<std::uint16_t, std::uint64_t> message_indexes;  // where each channel's index is
  std::uint64_t message_indexes_length = 0;
  std::string_view compression;  // a literal
  std::uint64_t compressed_size = 0, size = 0;
};

class McapChunk {
 public:
  McapChunk();
  ~McapChunk();
  McapChunk(const McapChunk&) = delete;
  McapChunk& operator=(const McapChunk&) = delete;

  struct Message {
    std::uint16_t channel;
    std::uint32_t sequence;  // in its channel
    std::uint64_t stamp_ns;
  };
  void Add(const Message& message, std::span<const std::byte> data);
  bool empty() const { return messages_.empty(); }
  void Clear();

  // Appends the chunk and its index to `out`, whose beginning is `file_offset` in the file, and
  // clears the chunk. `definitions` are whole records.
  McapChunkIndex Finish(std::string_view definitions, std::uint64_t file_offset, std::string* out);

 private:
  struct FreeContext {
    void operator()(ZSTD_CCtx_s* context) const;
  };
  // Compresses into `packed_`, and returns the compression's name. Empty: compression is not worth
  // it, and `packed_` is `records`.
  std::string_view Compress(std::string_view records);

  std::unique_ptr<ZSTD_CCtx_s, FreeContext> context_;
  std::string messages_;  // as records
  // For each channel: the stamps, and where the records begin in messages_.
  std::map<std::uint16_t, std::vector<std::pair<std::uint64_t, std::uint64_t>>> index_;
  std::uint64_t first_ns_ = 0, last_ns_ = 0;
  std::string packed_;  // memory of Finish
};

}  // namespace tcs::record
