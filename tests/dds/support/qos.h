// A QoS written in one line: Qos().Reliable().TransientLocal().KeepLast(2).
#pragma once

#include <dds/dds.h>
#include <string.h>

namespace dds_test {

class Qos {
 public:
  Qos() : qos_(dds_create_qos()) {}
  ~Qos() { dds_delete_qos(qos_); }
  Qos(const Qos& other) : Qos() { dds_copy_qos(qos_, other.qos_); }
  Qos& operator=(const Qos&) = delete;

  const dds_qos_t* get() const { return qos_; }

  // Without an argument there is no limit to how long a write waits for slow readers: tests have
  // limits of their own.
  Qos& Reliable(dds_duration_t most_blocking = DDS_INFINITY) {
    dds_qset_reliability(qos_, DDS_RELIABILITY_RELIABLE, most_blocking);
    return *this;
  }
  Qos& BestEffort() {
    dds_qset_reliability(qos_, DDS_RELIABILITY_BEST_EFFORT, 0);
    return *this;
  }
  Qos& KeepAll() {
    dds_qset_history(qos_, DDS_HISTORY_KEEP_ALL, 0);
    return *this;
  }
  Qos& KeepLast(int depth) {
    dds_qset_history(qos_, DDS_HISTORY_KEEP_LAST, depth);
    return *this;
  }
  // A reader that has so many samples takes no more until the program has taken some.
  Qos& AtMost(int samples) {
    dds_qset_resource_limits(qos_, samples, DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED);
    return *this;
  }
  // Of a writer: `kept` samples of each instance for those who come later, 0: all.
  Qos& TransientLocal(int kept = 0) {
    dds_qset_durability(qos_, DDS_DURABILITY_TRANSIENT_LOCAL);
    dds_qset_durability_service(qos_, 0, kept == 0 ? DDS_HISTORY_KEEP_ALL : DDS_HISTORY_KEEP_LAST,
                                kept == 0 ? DDS_LENGTH_UNLIMITED : kept, DDS_LENGTH_UNLIMITED,
                                DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED);
    return *this;
  }
  Qos& Deadline(dds_duration_t d) {
    dds_qset_deadline(qos_, d);
    return *this;
  }
  Qos& Lifespan(dds_duration_t d) {
    dds_qset_lifespan(qos_, d);
    return *this;
  }
  Qos& Liveliness(dds_liveliness_kind_t kind, dds_duration_t lease) {
    dds_qset_liveliness(qos_, kind, lease);
    return *this;
  }
  Qos& IgnoreLocal(dds_ignorelocal_kind_t kind) {
    dds_qset_ignorelocal(qos_, kind);
    return *this;
  }
  Qos& Exclusive() {
    dds_qset_ownership(qos_, DDS_OWNERSHIP_EXCLUSIVE);
    return *this;
  }
  Qos& Exclusive(int strength) {
    dds_qset_ownership_strength(qos_, strength);
    return Exclusive();
  }
  Qos& BySourceTimestamp() {
    dds_qset_destination_order(qos_, DDS_DESTINATIONORDER_BY_SOURCE_TIMESTAMP);
    return *this;
  }
  Qos& Partition(const char* name) {
    dds_qset_partition1(qos_, name);
    return *this;
  }
  Qos& UserData(const char* text) {
    dds_qset_userdata(qos_, text, strlen(text));
    return *this;
  }
  // Cyclone disposes what is unregistered unless told not to.
  Qos& UnregisterDoesNotDispose() {
    dds_qset_writer_data_lifecycle(qos_, false);
    return *this;
  }

 private:
  dds_qos_t* qos_;
};

// Reliable and keeping everything: what most scenarios want of both ends.
inline Qos Plain() { return Qos().Reliable().KeepAll(); }
// Alive as long as the program is.
inline Qos Leased(dds_duration_t lease) {
  return Plain().Liveliness(DDS_LIVELINESS_AUTOMATIC, lease);
}

}  // namespace dds_test
