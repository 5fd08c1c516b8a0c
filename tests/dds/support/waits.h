// Waiting for what must come. A wait in vain ends the program after kPatience.
#pragma once

#include <dds/dds.h>

#include <cstdint>
#include <functional>

namespace dds_test {

constexpr dds_duration_t kPatience = DDS_SECS(20);

// Until a condition, or an entity for one of its enabled statuses, triggers.
void WaitForTrigger(dds_entity_t entity);

// Until `holds`, which has to read the status: looks at first, and whenever it changes.
void WaitForStatus(dds_entity_t entity, std::uint32_t status, const std::function<bool()>& holds);

// Until exactly so many readers (writers) are matched.
void WaitForReaders(dds_entity_t writer, std::uint32_t count);
void WaitForWriters(dds_entity_t reader, std::uint32_t count);
// Until exactly so many writers that it has matched are alive.
void WaitForLiveWriters(dds_entity_t reader, std::uint32_t count);

// Looks again and again, for what nothing announces.
void WaitUntil(const char* what, const std::function<bool()>& holds);

}  // namespace dds_test
