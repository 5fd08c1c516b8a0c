// What the soak sends: for each topic who writes it, who reads it, with which QoS, how much and how
// fast. All four processes have the same table, and so know what must come.
#pragma once

#include <dds/dds.h>

#include <cstdint>
#include <span>

#include "soak.h"
#include "tests/dds/support/qos.h"

namespace dds_soak {

using dds_test::Qos;
using Sample = ::dds_soak_Sample;
using Mark = ::dds_soak_Mark;

constexpr int kProcesses = 4;

// What a reader may rely on.
enum class Promise {
  kAll,   // every sample, those of a writer and a key in their order
  kLast,  // the last of each key, and what comes comes in order
  kOrder  // what comes comes in order
};

struct ReadBy {
  int process;
  Promise promise;
  Qos qos;
  bool listens = false;     // takes in a listener instead of being waited for
  bool comes_late = false;  // when its process has read a twentieth of all samples
};

struct Flow {
  const char* name;
  Qos writer_qos;
  std::uint32_t written_by;  // bit 0 is process 0
  std::span<const ReadBy> readers;
  double share;       // of all samples that are written
  std::int32_t keys;  // sample n has key n % keys; of a writer's own, or everybody's
  bool own_keys;
  std::uint32_t least_bytes, most_bytes;  // of payloads
  std::uint32_t at_once;                  // samples, then a pause; 0: as fast as it can
  dds_duration_t pause;
  std::uint32_t disposes_every;  // sample n of these disposes of its key, too; 0: none
};

std::span<const Flow> Flows();

// How many samples each writer of a flow writes, of `total` in all.
std::uint32_t SamplesOfEach(const Flow& flow, std::uint64_t total);

inline bool Writes(const Flow& flow, int process) { return (flow.written_by >> process & 1) != 0; }
inline std::int32_t KeyOf(const Flow& flow, int writer, std::uint32_t number) {
  const auto key = static_cast<std::int32_t>(number % static_cast<std::uint32_t>(flow.keys));
  return flow.own_keys ? writer * flow.keys + key : key;
}

// The payload of a sample: nothing of it is a function of another's, and no two are alike.
std::span<const std::uint8_t> PayloadOf(const Flow& flow, int writer, std::uint32_t number);

}  // namespace dds_soak
