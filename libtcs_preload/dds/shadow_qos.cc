#include "libtcs_preload/dds/shadow_qos.h"

namespace tcs::dds {

dds_qos_t* ShadowQos(const Payload& payload) {
  dds_qos_t* qos = DecodeQos(payload, false);
  dds_qset_ignorelocal(qos, DDS_IGNORELOCAL_NONE);
  return qos;
}

bool IsReliable(const dds_qos_t* qos) {
  dds_reliability_kind_t reliability = DDS_RELIABILITY_BEST_EFFORT;
  dds_duration_t blocking = 0;
  dds_qget_reliability(qos, &reliability, &blocking);
  return reliability == DDS_RELIABILITY_RELIABLE;
}

bool IsTransientLocal(const dds_qos_t* qos) {
  dds_durability_kind_t durability = DDS_DURABILITY_VOLATILE;
  dds_qget_durability(qos, &durability);
  return durability >= DDS_DURABILITY_TRANSIENT_LOCAL;
}

void CopyTopicData(const dds_qos_t* from, dds_qos_t* to) {
  void* data = nullptr;
  std::size_t size = 0;
  if (!dds_qget_topicdata(from, &data, &size)) return;
  dds_qset_topicdata(to, data, size);
  dds_free(data);
}

void CopyGroupData(const dds_qos_t* from, dds_qos_t* to) {
  void* data = nullptr;
  std::size_t size = 0;
  if (!dds_qget_groupdata(from, &data, &size)) return;
  dds_qset_groupdata(to, data, size);
  dds_free(data);
}

}  // namespace tcs::dds
