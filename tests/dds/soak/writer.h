// One writer of the soak.
#pragma once

#include <dds/dds.h>

#include <cstdint>

#include "tests/dds/soak/flow.h"

namespace dds_soak {

class Writer {
 public:
  Writer(dds_entity_t participant, const Flow& flow, int process, std::uint64_t total);

  // Until as many readers are matched as the flow has at first.
  void AwaitReaders() const;
  // All of its samples, in a thread of its own.
  void WriteAll() const;

 private:
  const Flow& flow_;
  int process_;
  std::uint32_t of_each_;
  dds_entity_t entity_;
};

}  // namespace dds_soak
