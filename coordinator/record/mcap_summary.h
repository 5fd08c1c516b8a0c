// The end of an MCAP file, so that readers need not go through all of the file: the definitions
// once more, numbers, and where each chunk is.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "coordinator/record/bag_metadata.h"
#include "coordinator/record/mcap_chunk.h"

namespace tcs::record {

struct McapSummary {
  std::string_view schemas, channels;  // as records
  std::uint16_t schema_count = 0;
  std::uint32_t channel_count = 0;
  const BagMetadata& metadata;  // counts the messages; channels have its topics' numbers
  std::span<const McapChunkIndex> chunks;
};

// The bytes from the end of the data to the end of the file. The end of the data is at
// `file_offset`, `data_crc` is the checksum of all before it.
std::string McapEnd(const McapSummary& summary, std::uint64_t file_offset, std::uint32_t data_crc);

}  // namespace tcs::record
