// What graph tools read of a participant, in the forms of both generations of ROS 2.
#include "coordinator/dds/participant_info.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace tcs::dds {
namespace {

Guid Numbered(int from) {
  Guid guid;
  for (std::size_t i = 0; i < guid.size(); ++i) {
    guid[i] = static_cast<std::uint8_t>(from + static_cast<int>(i));
  }
  return guid;
}

// Of `nodes` nodes with up to two endpoints of each kind.
ParticipantInfo Some(int nodes) {
  ParticipantInfo info{Numbered(100), {}};
  for (int n = 0; n < nodes; ++n) {
    Node node{"/robot" + std::to_string(n), std::string(static_cast<std::size_t>(n), 'n'), {}, {}};
    for (int i = 0; i < n % 3; ++i) node.readers.push_back(Numbered(10 * i + n));
    for (int i = 0; i < (n + 1) % 3; ++i) node.writers.push_back(Numbered(50 * i + n));
    info.nodes.push_back(node);
  }
  return info;
}

TEST(ParticipantInfo, ComesBackInTheFormItWasWritten) {
  for (const GidForm form : {GidForm::kHumble, GidForm::kIron}) {
    for (int nodes = 0; nodes < 12; ++nodes) {
      SCOPED_TRACE(nodes);
      const auto decoded = DecodeParticipant(EncodeParticipant(Some(nodes), form));
      ASSERT_TRUE(std::holds_alternative<DecodedParticipant>(decoded))
          << std::get<CdrError>(decoded).message;
      EXPECT_EQ(std::get<DecodedParticipant>(decoded).form, form);
      EXPECT_EQ(std::get<DecodedParticipant>(decoded).info, Some(nodes));
    }
  }
}

TEST(ParticipantInfo, BeginsWithTheParticipantsGid) {
  const auto is_gid_at_the_begin = [](const std::vector<std::byte>& cdr) {
    const Guid guid = Numbered(100);
    return std::equal(guid.begin(), guid.end(), cdr.begin() + 4,
                      [](std::uint8_t a, std::byte b) { return std::byte{a} == b; });
  };
  // Encapsulation, gid, length of the list of nodes.
  const auto humble = EncodeParticipant(Some(0), GidForm::kHumble);
  EXPECT_EQ(humble.size(), 4u + 24 + 4);
  EXPECT_TRUE(is_gid_at_the_begin(humble));
  EXPECT_EQ(std::count(humble.begin() + 4 + 16, humble.end(), std::byte{0}), 8 + 4);
  const auto iron = EncodeParticipant(Some(0), GidForm::kIron);
  EXPECT_EQ(iron.size(), 4u + 16 + 4);
  EXPECT_TRUE(is_gid_at_the_begin(iron));
}

TEST(ParticipantInfo, OfForeignBytesIsRefused) {
  auto cdr = EncodeParticipant(Some(3), GidForm::kHumble);
  cdr.resize(cdr.size() - 8);
  EXPECT_TRUE(std::holds_alternative<CdrError>(DecodeParticipant(cdr)));
  EXPECT_TRUE(std::holds_alternative<CdrError>(DecodeParticipant({})));
}

}  // namespace
}  // namespace tcs::dds
