#include "coordinator/record/mcap_chunk.h"

#include <zstd.h>

#include <algorithm>
#include <new>

#include "coordinator/record/mcap_record.h"

namespace tcs::record {
namespace {

// The level that costs the run least: on messages of numbers higher levels save a few per cent.
constexpr int kLevel = 1;

}  // namespace

void McapChunk::FreeContext::operator()(ZSTD_CCtx_s* context) const { ZSTD_freeCCtx(context); }

McapChunk::McapChunk() : context_(ZSTD_createCCtx()) {
  if (context_ == nullptr) throw std::bad_alloc();
}

McapChunk::~McapChunk() = default;

void McapChunk::Add(const Message& message, std::span<const std::byte> data) {
  first_ns_ = messages_.empty() ? message.stamp_ns : std::min(first_ns_, message.stamp_ns);
  last_ns_ = messages_.empty() ? message.stamp_ns : std::max(last_ns_, message.stamp_ns);
  index_[message.channel].emplace_back(message.stamp_ns, messages_.size());
  McapRecord(McapCode::kMessage, &messages_)
      .U16(message.channel)
      .U32(message.sequence)
      .U64(message.stamp_ns)  // logged
      .U64(message.stamp_ns)  // published
      .Bytes(data);
}

void McapChunk::Clear() {
  messages_.clear();
  index_.clear();
  first_ns_ = last_ns_ = 0;
}

std::string_view McapChunk::Compress(std::string_view records) {
  packed_.resize(ZSTD_compressBound(records.size()));
  const std::size_t size = ZSTD_compressCCtx(context_.get(), packed_.data(), packed_.size(),
                                             records.data(), records.size(), kLevel);
  if (ZSTD_isError(size) == 0 && size < records.size()) {
    packed_.resize(size);
    return "zstd";
  }
  packed_ = records;
  return "";
}

McapChunkIndex McapChunk::Finish(std::string_view definitions, std::uint64_t file_offset,
                                 std::string* out) {
  const std::string records = std::string(definitions) + messages_;
  McapChunkIndex index{.first_ns = first_ns_, .last_ns = last_ns_};
  index.compression = Compress(records);
  index.compressed_size = packed_.size();
  index.size = records.size();
  index.start = file_offset + out->size();
  McapRecord(McapCode::kChunk, out)
      .U64(index.first_ns)
      .U64(index.last_ns)
      .U64(index.size)
      .U32(Crc32(0, records))
      .Text(index.compression)
      .U64(packed_.size())
      .Bytes(packed_);
  const std::uint64_t end = file_offset + out->size();
  index.length = end - index.start;
  for (const auto& [channel, messages] : index_) {
    index.message_indexes[channel] = file_offset + out->size();
    McapRecord record(McapCode::kMessageIndex, out);
    record.U16(channel).List([&] {
      for (const auto& [stamp_ns, at] : messages) record.U64(stamp_ns).U64(definitions.size() + at);
    });
  }
  index.message_indexes_length = file_offset + out->size() - end;
  Clear();
  return index;
}

}  // namespace tcs::record
