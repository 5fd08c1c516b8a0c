#include "tests/dds/support/matches.h"

#include "tests/dds/support/events.h"

namespace dds_test {

void TellReaders(const char* when, dds_entity_t writer) {
  dds_publication_matched_status_t status;
  OK(dds_get_publication_matched_status(writer, &status));
  Event("%s: %u readers, %u so far", when, status.current_count, status.total_count);
}

void TellWriters(const char* when, dds_entity_t reader) {
  dds_subscription_matched_status_t status;
  OK(dds_get_subscription_matched_status(reader, &status));
  Event("%s: %u writers, %u so far", when, status.current_count, status.total_count);
}

}  // namespace dds_test
