// Writing samples, waiting for them, and telling of them.
#pragma once

#include <dds/dds.h>

#include <vector>

#include "sample.h"
#include "tests/dds/support/events.h"
#include "tests/dds/support/waits.h"

namespace dds_test {

inline void Write(dds_entity_t writer, int key, int value) {
  const dds_test_Sample sample{key, value};
  OK(dds_write(writer, &sample));
}

// Samples with these keys say how far a writer has come: a reliable reader that has one has all
// that the writer wrote before. They are not told of.
constexpr int kMarkers = 90;

// Waits until a sample of that key is there, without reading it: a read would change the states
// that are to be told of.
template <int key>
void WaitForSample(dds_entity_t reader) {
  const auto is_it = [](const void* sample) {
    return static_cast<const dds_test_Sample*>(sample)->key == key;
  };
  const dds_entity_t condition = OK(dds_create_querycondition(reader, DDS_ANY_STATE, is_it));
  WaitForTrigger(condition);
  OK(dds_delete(condition));
}

// Of samples whose instance is disposed or has no writer.
constexpr std::uint32_t kNotAlive = DDS_ANY_SAMPLE_STATE | DDS_ANY_VIEW_STATE |
                                    DDS_NOT_ALIVE_DISPOSED_INSTANCE_STATE |
                                    DDS_NOT_ALIVE_NO_WRITERS_INSTANCE_STATE;

// Waits until there is a sample in one of these states.
inline void WaitForState(dds_entity_t reader, std::uint32_t states) {
  const dds_entity_t condition = OK(dds_create_readcondition(reader, states));
  WaitForTrigger(condition);
  OK(dds_delete(condition));
}

struct Received {
  dds_test_Sample sample;
  dds_sample_info_t info;
};

enum class How { kRead, kTake };

// All there is (or all that the condition lets through), by key, the samples of one in the order of
// the reader's cache. Fails if source timestamps of a writer go back.
std::vector<Received> All(dds_entity_t reader_or_condition, How how = How::kTake);

// One line each, markers left out; "nothing" if there is none.
void Tell(const char* who, const std::vector<Received>& samples);

inline void TakeAndTell(dds_entity_t reader, const char* who) { Tell(who, All(reader)); }

}  // namespace dds_test
