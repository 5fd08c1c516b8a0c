// How many are matched now, and were ever, as events: "WHEN: 1 readers, 2 so far".
#pragma once

#include <dds/dds.h>

namespace dds_test {

void TellReaders(const char* when, dds_entity_t writer);
void TellWriters(const char* when, dds_entity_t reader);

}  // namespace dds_test
