// The QoS of shadows, from what messages say of their originals.
#pragma once

#include "libtcs_preload/dds/qos_code.h"

namespace tcs::dds {

// QoS that a message carries, as long as this object lives.
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

// The QoS of an endpoint, as its shadow has them: the shadow is to match what is in this process.
// The caller deletes the QoS.
dds_qos_t* ShadowQos(const Payload& payload);

bool IsReliable(const dds_qos_t* qos);
bool IsTransientLocal(const dds_qos_t* qos);

void CopyTopicData(const dds_qos_t* from, dds_qos_t* to);
void CopyGroupData(const dds_qos_t* from, dds_qos_t* to);

}  // namespace tcs::dds
