// Records of an MCAP file (https://mcap.dev/spec), as bytes: a code, the content's length, the
// content. Numbers are little-endian; a text, a list and a map begin with their size in bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace tcs::record {

inline constexpr std::string_view kMcapMagic = "\x89MCAP0\r\n";

enum class McapCode : std::uint8_t {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kMessageIndex = 0x07,
  kChunkIndex = 0x08,
  kStatistics = 0x0B,
  kSummaryOffset = 0x0E,
  kDataEnd = 0x0F,
};

// The size of a record's head, before the content.
inline constexpr std::size_t kMcapHeadBytes = 9;

// A record that is being put together at the end of `out`, which outlives the object and gets
// nothing else meanwhile. The record is whole when the object ends.
class McapRecord {
 public:
  McapRecord(McapCode code, std::string* out);
  ~McapRecord();
  McapRecord(const McapRecord&) = delete;
  McapRecord& operator=(const McapRecord&) = delete;

  McapRecord& U8(std::uint8_t number);
  McapRecord& U16(std::uint16_t number);
  McapRecord& U32(std::uint32_t number);
  McapRecord& U64(std::uint64_t number);
  McapRecord& Text(std::string_view text);
  McapRecord& Bytes(std::span<const std::byte> bytes);
  McapRecord& Bytes(std::string_view bytes);

  // A list or a map of what `fill` adds to the record.
  template <class Fill>
  McapRecord& List(Fill fill) {
    const std::size_t at = out_->size();
    U32(0);
    fill();
    PatchSize(at, out_->size() - at - sizeof(std::uint32_t));
    return *this;
  }

 private:
  void PatchSize(std::size_t at, std::size_t size);

  std::string* out_;
  std::size_t length_at_;
};

// Goes on from `before`, the checksum of the bytes before; it is 0 where there are none.
std::uint32_t Crc32(std::uint32_t before, std::string_view bytes);

}  // namespace tcs::record
