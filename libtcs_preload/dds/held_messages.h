// Messages that a deaf domain misses, or that a mute one does not get rid of (deaf_mute.h), in
// their order: messages that a network would carry once more when it carries something again.
// Best-effort samples and assertions of liveliness are lost; of a writer that keeps the last few
// samples of an instance, the samples before are lost, too.
//
// Not thread-safe.
#pragma once

#include <cstddef>
#include <vector>

#include "libtcs_preload/dds/guid.h"
#include "libtcs_preload/dds/type_code.h"
#include "shm/dds_exchange.h"

namespace tcs::dds {

struct HeldMessage {
  shm::DdsMessage message;
  Payload payload;
};

class HeldMessages {
 public:
  void Add(const shm::DdsMessage& message, const void* payload, std::size_t size);

  const std::vector<HeldMessage>& all() const { return all_; }
  // Bytes of samples of that writer.
  std::size_t SizeOf(const Guid& writer) const;

 private:
  void MakeRoom(const shm::DdsMessage& message);

  std::vector<HeldMessage> all_;
};

}  // namespace tcs::dds
