#include "coordinator/record/mcap_record.h"

#include <zlib.h>

#include <array>

#include "shm/check.h"

namespace tcs::record {
namespace {

template <class Number>
std::array<char, sizeof(Number)> LittleEndian(Number number) {
  std::array<char, sizeof(Number)> bytes;
  for (char& byte : bytes) {
    byte = static_cast<char>(number & 0xff);
    number = static_cast<Number>(static_cast<std::uint64_t>(number) >> 8);
  }
  return bytes;
}

template <class Number>
void Append(Number number, std::string* out) {
  const auto bytes = LittleEndian(number);
  out->append(bytes.data(), bytes.size());
}

}  // namespace

McapRecord::McapRecord(McapCode code, std::string* out) : out_(out) {
  U8(static_cast<std::uint8_t>(code));
  length_at_ = out_->size();
  U64(0);
}

McapRecord::~McapRecord() {
  const std::uint64_t length = out_->size() - length_at_ - sizeof(std::uint64_t);
  const auto bytes = LittleEndian(length);
  out_->replace(length_at_, bytes.size(), bytes.data(), bytes.size());
}

McapRecord& McapRecord::U8(std::uint8_t number) {
  Append(number, out_);
  return *this;
}

McapRecord& McapRecord::U16(std::uint16_t number) {
  Append(number, out_);
  return *this;
}

McapRecord& McapRecord::U32(std::uint32_t number) {
  Append(number, out_);
  return *this;
}

McapRecord& McapRecord::U64(std::uint64_t number) {
  Append(number, out_);
  return *this;
}

McapRecord& McapRecord::Text(std::string_view text) {
  return List([&] { Bytes(text); });
}

McapRecord& McapRecord::Bytes(std::span<const std::byte> bytes) {
  return Bytes(std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

McapRecord& McapRecord::Bytes(std::string_view bytes) {
  out_->append(bytes);
  return *this;
}

void McapRecord::PatchSize(std::size_t at, std::size_t size) {
  TCS_CHECK(size <= UINT32_MAX);
  const auto bytes = LittleEndian(static_cast<std::uint32_t>(size));
  out_->replace(at, bytes.size(), bytes.data(), bytes.size());
}

std::uint32_t Crc32(std::uint32_t before, std::string_view bytes) {
  return static_cast<std::uint32_t>(
      crc32_z(before, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

}  // namespace tcs::record
