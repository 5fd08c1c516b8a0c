#include "coordinator/record/mcap_summary.h"

#include <utility>
#include <vector>

#include "coordinator/record/mcap_record.h"

namespace tcs::record {
namespace {

void AppendStatistics(const McapSummary& summary, std::string* out) {
  const BagMetadata& metadata = summary.metadata;
  McapRecord record(McapCode::kStatistics, out);
  record.U64(static_cast<std::uint64_t>(metadata.messages))
      .U16(summary.schema_count)
      .U32(summary.channel_count)
      .U32(0)  // attachments
      .U32(0)  // metadata records
      .U32(static_cast<std::uint32_t>(summary.chunks.size()))
      .U64(static_cast<std::uint64_t>(metadata.first_ns))
      .U64(static_cast<std::uint64_t>(metadata.last_ns))
      .List([&] {
        for (std::size_t i = 0; i < metadata.topics.size(); ++i) {
          if (metadata.topics[i].messages == 0) continue;
          record.U16(static_cast<std::uint16_t>(i))
              .U64(static_cast<std::uint64_t>(metadata.topics[i].messages));
        }
      });
}

void AppendIndex(const McapChunkIndex& chunk, std::string* out) {
  McapRecord record(McapCode::kChunkIndex, out);
  record.U64(chunk.first_ns).U64(chunk.last_ns).U64(chunk.start).U64(chunk.length);
  record.List([&] {
    for (const auto& [channel, at] : chunk.message_indexes) record.U16(channel).U64(at);
  });
  record.U64(chunk.message_indexes_length)
      .Text(chunk.compression)
      .U64(chunk.compressed_size)
      .U64(chunk.size);
}

}  // namespace

std::string McapEnd(const McapSummary& summary, std::uint64_t file_offset, std::uint32_t data_crc) {
  std::string out;
  McapRecord(McapCode::kDataEnd, &out).U32(data_crc);
  const std::size_t begin = out.size();
  const std::uint64_t begin_in_file = file_offset + begin;

  struct Group {
    McapCode code;
    std::uint64_t start, length;
  };
  std::vector<Group> groups;
  const auto add = [&](McapCode code, auto append) {
    const std::size_t before = out.size();
    append();
    if (out.size() == before) return;
    groups.push_back({code, file_offset + before, out.size() - before});
  };
  add(McapCode::kSchema, [&] { out += summary.schemas; });
  add(McapCode::kChannel, [&] { out += summary.channels; });
  add(McapCode::kStatistics, [&] { AppendStatistics(summary, &out); });
  add(McapCode::kChunkIndex, [&] {
    for (const McapChunkIndex& chunk : summary.chunks) AppendIndex(chunk, &out);
  });
  const std::uint64_t offsets_in_file = file_offset + out.size();
  for (const Group& group : groups) {
    McapRecord(McapCode::kSummaryOffset, &out)
        .U8(static_cast<std::uint8_t>(group.code))
        .U64(group.start)
        .U64(group.length);
  }

  // The checksum covers the footer up to itself, its head included.
  std::string footer;
  McapRecord(McapCode::kFooter, &footer).U64(begin_in_file).U64(offsets_in_file).U32(0);
  footer.resize(footer.size() - sizeof(std::uint32_t));
  const std::uint32_t before = Crc32(0, std::string_view(out).substr(begin));
  const std::uint32_t crc = Crc32(before, footer);
  McapRecord(McapCode::kFooter, &out).U64(begin_in_file).U64(offsets_in_file).U32(crc);
  out += kMcapMagic;
  return out;
}

}  // namespace tcs::record
