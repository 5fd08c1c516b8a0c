#include "tests/dds/support/waits.h"

#include "tests/dds/support/events.h"

namespace dds_test {

void WaitForTrigger(dds_entity_t entity) {
  const dds_entity_t set = OK(dds_create_waitset(OK(dds_get_participant(entity))));
  OK(dds_waitset_attach(set, entity, entity));
  if (OK(dds_waitset_wait(set, nullptr, 0, kPatience)) == 0) Fail("waited in vain for a trigger");
  OK(dds_delete(set));
}

void WaitForStatus(dds_entity_t entity, std::uint32_t status, const std::function<bool()>& holds) {
  OK(dds_set_status_mask(entity, status));
  while (!holds()) WaitForTrigger(entity);
}

void WaitForReaders(dds_entity_t writer, std::uint32_t count) {
  WaitForStatus(writer, DDS_PUBLICATION_MATCHED_STATUS, [=] {
    dds_publication_matched_status_t status;
    OK(dds_get_publication_matched_status(writer, &status));
    return status.current_count == count;
  });
}

void WaitForWriters(dds_entity_t reader, std::uint32_t count) {
  WaitForStatus(reader, DDS_SUBSCRIPTION_MATCHED_STATUS, [=] {
    dds_subscription_matched_status_t status;
    OK(dds_get_subscription_matched_status(reader, &status));
    return status.current_count == count;
  });
}

void WaitForLiveWriters(dds_entity_t reader, std::uint32_t count) {
  WaitForStatus(reader, DDS_LIVELINESS_CHANGED_STATUS, [=] {
    dds_liveliness_changed_status_t status;
    OK(dds_get_liveliness_changed_status(reader, &status));
    return status.alive_count == count;
  });
}

void WaitUntil(const char* what, const std::function<bool()>& holds) {
  const dds_time_t end = dds_time() + kPatience;
  while (!holds()) {
    if (dds_time() > end) Fail("waited in vain until %s", what);
    dds_sleepfor(DDS_MSECS(5));
  }
}

}  // namespace dds_test
