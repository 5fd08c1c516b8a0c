#include "examples/predator_prey/common/dds_endpoints.h"

namespace predator_prey::internal {
namespace {

struct DeleteQos {
  void operator()(dds_qos_t* qos) const { dds_delete_qos(qos); }
};

std::unique_ptr<dds_qos_t, DeleteQos> ReliableNewest() {
  std::unique_ptr<dds_qos_t, DeleteQos> qos(dds_create_qos());
  dds_qset_reliability(qos.get(), DDS_RELIABILITY_RELIABLE, DDS_MSECS(100));
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, 1);
  return qos;
}

dds_entity_t ParticipantOf(const DdsEntity& entity) { return dds_get_participant(entity.handle()); }

}  // namespace

DdsEntity CreateReader(const DdsEntity& topic) {
  return DdsEntity(
      dds_create_reader(ParticipantOf(topic), topic.handle(), ReliableNewest().get(), nullptr),
      "make a reader");
}

DdsEntity CreateWriter(const DdsEntity& topic) {
  return DdsEntity(
      dds_create_writer(ParticipantOf(topic), topic.handle(), ReliableNewest().get(), nullptr),
      "make a writer");
}

void* TakeLoan(const DdsEntity& reader) {
  void* sample = nullptr;
  dds_sample_info_t info;
  if (CheckDds(dds_take(reader.handle(), &sample, &info, 1, 1), "take a sample") == 0) {
    return nullptr;
  }
  if (info.valid_data) return sample;
  dds_return_loan(reader.handle(), &sample, 1);  // news of a writer, without data
  return nullptr;
}

}  // namespace predator_prey::internal
