// The QoS of shadows, from what messages say of their originals.
#pragma once

#include "libtcs_preload/dds/qos_code.h"

namespace tcs::dds {

// QoS that a message carries, as long as it lives.
class Qos {
 public:
  explicit Qos(dds_qos_t* qos) : qos_(qos) {}
  ~Qos() { dds_delete_qos(qos_); }
  Qos(const Qos&) = delete;
  Qos& operator=(const Qos&) = delete;
  dds_qos_t* get() const { return qos_; }

 private:
  dds_qos_t* qos_;
};

// Of an endpoint, as its shadow has them: it is to match what is in this process. The caller
// deletes them.
dds_qos_t* ShadowQos(const Payload& payload);

bool IsReliable(const dds_qos_t* qos);
bool IsTransientLocal(const dds_qos_t* qos);

void CopyTopicData(const dds_qos_t* from, dds_qos_t* to);
void CopyGroupData(const dds_qos_t* from, dds_qos_t* to);

}  // namespace tcs::dds
