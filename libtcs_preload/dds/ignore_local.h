// "Ignore what is in my own process", a QoS policy of Cyclone's, although shadows are in the
// process, too. And the opposite: endpoints that match what is in their own process only
// (ignored_partitions.h), and no shadow.
//
// Cyclone compares the two endpoints' policies whenever one of them is made. So the program's
// endpoints with that policy have a milder one while a shadow is made; and while such an endpoint
// is made itself, the program's other endpoints ignore it. Endpoints that are to match no shadow
// have that policy only while a shadow is made, and all shadows of their topic have it while such
// an endpoint is made. Endpoints and shadows are made one after another.
#pragma once

#include <mutex>
#include <utility>
#include <vector>

#include "libtcs_preload/dds/guid.h"

namespace tcs::dds {

// While this object lives, the calling thread makes a shadow.
class ShadowMatches {
 public:
  explicit ShadowMatches(ddsi_domaingv* gv);
  ~ShadowMatches();
  ShadowMatches(const ShadowMatches&) = delete;
  ShadowMatches& operator=(const ShadowMatches&) = delete;

 private:
  std::unique_lock<std::recursive_timed_mutex> turn_;
  ddsi_domaingv* gv_;
};

// While this object lives, the calling thread makes an endpoint of the program's, with qos().
// `others`: the endpoints of the program that the endpoint may match, `shadows`: the endpoints of
// others. `no_shadows`: the endpoint is to match no shadow.
class OwnMatches {
 public:
  OwnMatches(ddsi_domaingv* gv, const dds_qos_t* qos, const std::vector<Guid>& others,
             const std::vector<Guid>& shadows, bool no_shadows);
  ~OwnMatches();
  OwnMatches(const OwnMatches&) = delete;
  OwnMatches& operator=(const OwnMatches&) = delete;

  const dds_qos_t* qos() const { return milder_ != nullptr ? milder_ : given_; }
  // The endpoint has been made.
  void Made(const ddsi_guid_t& guid);

 private:
  std::unique_lock<std::recursive_timed_mutex> turn_;
  ddsi_domaingv* gv_;
  const dds_qos_t* given_;
  bool no_shadows_;
  dds_qos_t* milder_ = nullptr;  // null: the endpoint has another policy
  // The endpoints that ignore it meanwhile, and their own policies.
  std::vector<std::pair<Guid, dds_ignorelocal_kind_t>> ignoring_it_;
};

void ForgetIgnoring(const Guid& guid);

}  // namespace tcs::dds
