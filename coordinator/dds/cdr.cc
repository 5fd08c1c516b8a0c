#include "coordinator/dds/cdr.h"

#include <dds/ddsi/ddsi_cdrstream.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>

#include "shm/check.h"

namespace tcs::dds::internal {
namespace {

constexpr std::size_t kEncapsulation = 4;
constexpr std::uint32_t kXcdr1 = 1;
constexpr std::uint32_t kXcdr2 = 2;

constexpr std::size_t Padding(std::size_t size) { return (4 - size % 4) % 4; }

struct Encoding {
  std::uint32_t version = kXcdr1;
  bool is_big_endian = false;
};

// The plain encodings, which are those of final types. None: another encoding.
std::optional<Encoding> EncodingOf(std::span<const std::byte> cdr) {
  switch (std::to_integer<unsigned>(cdr[0]) << 8 | std::to_integer<unsigned>(cdr[1])) {
    case 0x0000:
      return Encoding{kXcdr1, true};
    case 0x0001:
      return Encoding{kXcdr1, false};
    case 0x0006:
      return Encoding{kXcdr2, true};
    case 0x0007:
      return Encoding{kXcdr2, false};
    default:
      return std::nullopt;
  }
}

std::string Hex(std::span<const std::byte> bytes) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text;
  for (const std::byte byte : bytes) {
    text += kDigits[std::to_integer<unsigned>(byte) >> 4];
    text += kDigits[std::to_integer<unsigned>(byte) & 15];
  }
  return text;
}

}  // namespace

std::vector<std::byte> Serialise(const dds_topic_descriptor_t& type, const void* message) {
  dds_ostreamLE_t stream;
  dds_ostreamLE_init(&stream, type.m_size, kXcdr1);
  // Fails only for values that no message of ours has: an enumerator or a bounded string out of
  // bounds.
  TCS_CHECK(dds_stream_writeLE(&stream, static_cast<const char*>(message), type.m_ops) != nullptr);
  const std::size_t size = stream.x.m_index;
  const std::size_t padding = Padding(size);
  std::vector<std::byte> cdr(kEncapsulation + size + padding);
  cdr[1] = std::byte{1};
  cdr[3] = static_cast<std::byte>(padding);
  std::memcpy(cdr.data() + kEncapsulation, stream.x.m_buffer, size);
  dds_ostreamLE_fini(&stream);
  return cdr;
}

std::variant<std::monostate, CdrError> Deserialise(const dds_topic_descriptor_t& type,
                                                   std::span<const std::byte> cdr, void* message) {
  if (cdr.size() < kEncapsulation) {
    return CdrError{"has " + std::to_string(cdr.size()) + " bytes, too few for any CDR"};
  }
  if (cdr.size() > std::numeric_limits<std::int32_t>::max()) {
    return CdrError{"has " + std::to_string(cdr.size()) + " bytes, more than DDS carries"};
  }
  const auto encoding = EncodingOf(cdr);
  if (!encoding) {
    return CdrError{"is encoded as 0x" + Hex(cdr.first(2)) +
                    ", but a final type is plain CDR (0x0000, 0x0001, 0x0006 or 0x0007)"};
  }
  // The data are checked and brought to our byte order in place, so in a copy. The code after the
  // check trusts every length in the data. The copy has a byte more, because an empty vector's data
  // is no pointer.
  const auto size = static_cast<std::uint32_t>(cdr.size() - kEncapsulation);
  std::vector<char> data(size + 1);
  std::copy_n(reinterpret_cast<const char*>(cdr.data()) + kEncapsulation, size, data.begin());
  std::uint32_t used = 0;
  if (dds_stream_normalize_data(data.data(), &used, size, encoding->is_big_endian,
                                encoding->version, type.m_ops) == nullptr) {
    return CdrError{std::string("is no ") + type.m_typename + ": its " + std::to_string(size) +
                    " bytes of data are cut off or of another type"};
  }
  // DDS pads to a multiple of four; not every vendor says by how much.
  if (size - used > 3) {
    return CdrError{std::string("is no ") + type.m_typename + ": " + std::to_string(size - used) +
                    " bytes are left over"};
  }
  dds_istream_t stream;
  dds_istream_init(&stream, used, data.data(), encoding->version);
  dds_stream_read(&stream, static_cast<char*>(message), type.m_ops);
  dds_istream_fini(&stream);
  return std::monostate();
}

void FreeContents(const dds_topic_descriptor_t& type, void* message) {
  dds_stream_free_sample(message, type.m_ops);
}

}  // namespace tcs::dds::internal
