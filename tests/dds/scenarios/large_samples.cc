// Samples of many datagrams each, keyed by text: whole, in order, none lost.
#include <string>
#include <vector>

#include "tests/dds/support/process.h"
#include "tests/dds/support/waits.h"

namespace {

using namespace dds_test;

constexpr std::uint32_t kSizes[] = {0, 1, 1'000, 20'000, 70'000, 300'000, 20'000'000};

void Fill(std::vector<std::uint8_t>& bytes) {
  for (std::size_t i = 0; i < bytes.size(); i++)
    bytes[i] = static_cast<std::uint8_t>(i * 7 + bytes.size());
}

void Writer(Process& self) {
  const dds_entity_t writer = self.Writer(self.Topic("block", &dds_test_Block_desc));
  WaitForReaders(writer, 1);
  self.peer.Meet("matched");
  for (const std::uint32_t size : kSizes) {
    std::vector<std::uint8_t> bytes(size);
    Fill(bytes);
    std::string name = std::to_string(size) + " bytes";
    dds_test_Block block{name.data(), {size, size, bytes.data(), false}};
    OK(dds_write(writer, &block));
  }
}

void Reader(Process& self) {
  const dds_entity_t reader = self.Reader(self.Topic("block", &dds_test_Block_desc));
  WaitForWriters(reader, 1);
  self.peer.Meet("matched");
  for (const std::uint32_t size : kSizes) {
    const dds_entity_t any = OK(dds_create_readcondition(reader, DDS_ANY_STATE));
    WaitForTrigger(any);
    void* samples[1] = {};
    dds_sample_info_t info;
    OK(dds_take(reader, samples, &info, 1, 1));
    const auto& block = *static_cast<const dds_test_Block*>(samples[0]);
    std::vector<std::uint8_t> wanted(size);
    Fill(wanted);
    const bool whole = block.bytes._length == size &&
                       (size == 0 || memcmp(block.bytes._buffer, wanted.data(), size) == 0);
    Event("%s: %s", block.name, whole ? "whole" : "not what was written");
    OK(dds_return_loan(reader, samples, 1));
    OK(dds_delete(any));
  }
}

}  // namespace

TCS_DDS_SCENARIO(large_samples, Writer, Reader);
