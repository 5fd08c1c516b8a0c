// "Ignore what is in my own process", a QoS policy of Cyclone's, although shadows are in the
// process, too. And the opposite: endpoints that match what is in their own process only
// (ignored_partitions.h), and no shadow.
//
// Cyclone compares the two endpoints' policies whenever one of them is made. So the program's
// endpoints with that policy have a milder one while a shadow is made; and while one of them is
// made itself, it is the program's others that ignore it. Those that are to match no shadow have
// that policy only then, and all shadows of their topic have it while one of them is made.
// Endpoints and shadows are made one after another.
#pragma once

#include <mutex>
#include <utility>
#include <vector>

#include "libtcs_preload/dds/guid.h"

namespace tcs::dds {

// While it lives, the calling thread makes a shadow.
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

// While it lives, the calling thread makes an endpoint of the program's, with qos(). `others`: the
// endpoints of the program that it may match, `shadows`: those of others. `no_shadows`: it is to
// match none of the latter.
class OwnMatches {
 public:
  OwnMatches(ddsi_domaingv* gv, const dds_qos_t* qos, const std::vector<Guid>& others,
             const std::vector<Guid>& shadows, bool no_shadows);
  ~OwnMatches();
  OwnMatches(const OwnMatches&) = delete;
  OwnMatches& operator=(const OwnMatches&) = delete;

  const dds_qos_t* qos() const { return milder_ != nullptr ? milder_ : given_; }
  // It has been made.
  void Made(const ddsi_guid_t& guid);

 private:
  std::unique_lock<std::recursive_timed_mutex> turn_;
  ddsi_domaingv* gv_;
  const dds_qos_t* given_;
  bool no_shadows_;
  dds_qos_t* milder_ = nullptr;  // null: it has another policy
  // Those that ignore it meanwhile, and their own policies.
  std::vector<std::pair<Guid, dds_ignorelocal_kind_t>> ignoring_it_;
};

void ForgetIgnoring(const Guid& guid);

}  // namespace tcs::dds
