// Two readers, one of which asks for more than the writer offers: that one is not matched, and both
// sides learn because of which policy; the other one gets the sample.
#pragma once

#include "tests/dds/support/process.h"
#include "tests/dds/support/samples.h"

namespace incompatible {

using namespace dds_test;

inline const char* Policy(std::uint32_t id) {
  switch (id) {
    case DDS_RELIABILITY_QOS_POLICY_ID:
      return "reliability";
    case DDS_DURABILITY_QOS_POLICY_ID:
      return "durability";
    case DDS_DEADLINE_QOS_POLICY_ID:
      return "deadline";
    default:
      return "another policy";
  }
}

inline void Offer(Process& self, const Qos& offered) {
  const dds_entity_t writer = self.Writer(self.Topic(), offered);
  WaitForStatus(writer, DDS_OFFERED_INCOMPATIBLE_QOS_STATUS, [=] {
    dds_offered_incompatible_qos_status_t status;
    OK(dds_get_offered_incompatible_qos_status(writer, &status));
    if (status.total_count == 0) return false;
    Event("offered incompatible: %u, %s", status.total_count, Policy(status.last_policy_id));
    return true;
  });
  self.peer.Reached("refused");
  WaitForReaders(writer, 1);
  self.peer.Meet("matched");
  dds_publication_matched_status_t matched;
  OK(dds_get_publication_matched_status(writer, &matched));
  Event("matched readers: %u of %u ever", matched.current_count, matched.total_count);
  // A best-effort writer may lose a sample: it goes on until there is one.
  for (bool here = false; !here; here = self.peer.Receive<bool>()) Write(writer, 1, 1);
}

inline void Request(Process& self, const Qos& too_much, const Qos& enough) {
  const dds_entity_t topic = self.Topic();
  const dds_entity_t refused = self.Reader(topic, too_much);
  WaitForStatus(refused, DDS_REQUESTED_INCOMPATIBLE_QOS_STATUS, [=] {
    dds_requested_incompatible_qos_status_t status;
    OK(dds_get_requested_incompatible_qos_status(refused, &status));
    if (status.total_count == 0) return false;
    Event("requested incompatible: %u, %s", status.total_count, Policy(status.last_policy_id));
    return true;
  });
  self.peer.Await("refused");
  const dds_entity_t served = self.Reader(topic, enough);
  WaitForWriters(served, 1);
  self.peer.Meet("matched");
  dds_subscription_matched_status_t matched;
  OK(dds_get_subscription_matched_status(refused, &matched));
  Event("matched writers: %u", matched.total_count);
  bool here = false;
  while (!here) {
    dds_sleepfor(DDS_MSECS(5));
    here = !All(served, How::kRead).empty();
    self.peer.Send(here);
  }
  Event("served: the first sample is %d", All(served).front().sample.value);
  TakeAndTell(refused, "refused");
}

}  // namespace incompatible
