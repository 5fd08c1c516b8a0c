// Cyclone DDS as libtcs_dds.so calls it.
//
// Functions that the shim stands before are called through Real(): their plain names would lead
// back to the hooks. All other functions are called as they are.
#pragma once

#include <dds/dds.h>
#include <dds/ddsc/dds_rhc.h>
// q_sockwaitset.h is not C++: it gives a structure and a pointer to it one name.
#define Q_SOCKWAITSET_H
typedef struct TcsSockWaitset* os_sockWaitset;

#include <dds/ddsi/ddsi_builtin_topic_if.h>
#include <dds/ddsi/ddsi_domaingv.h>
#include <dds/ddsi/ddsi_entity_index.h>
#include <dds/ddsi/ddsi_iid.h>
#include <dds/ddsi/ddsi_participant.h>
#include <dds/ddsi/ddsi_proxy_participant.h>
#include <dds/ddsi/ddsi_serdata.h>
#include <dds/ddsi/ddsi_sertype.h>
#include <dds/ddsi/ddsi_tkmap.h>
#include <dds/ddsi/ddsi_topic.h>
#include <dds/ddsi/q_bswap.h>
#include <dds/ddsi/q_rtps.h>
#include <dds/ddsrt/random.h>
#include <dds/version.h>

#include "libtcs_preload/dds/calls.h"
#include "libtcs_preload/dds/link.h"

// Functions that are in no header of libddsc's.
extern "C" {
// Makes sure that an entity stays while it is looked at.
dds_return_t dds_entity_pin(dds_entity_t handle, struct dds_entity** entity);
// The function that all ways to make a topic come to. Replaces `*type` by the type that the topic
// has then.
dds_entity_t dds_create_topic_impl(dds_entity_t participant, const char* name, bool allow_dcps,
                                   ddsi_sertype** type, const dds_qos_t* qos,
                                   const dds_listener_t* listener, const ddsi_plist* discovery,
                                   bool is_builtin);
}

namespace tcs::dds {

struct RealCalls {
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wdeprecated-declarations"
#define TCS_DDS_MEMBER(name) decltype(&::name) name;
  TCS_DDS_CALLS(TCS_DDS_MEMBER)
#undef TCS_DDS_MEMBER
#pragma GCC diagnostic pop
};

const RealCalls& Real();

// Fills Real(). False, and one line on stderr, if the program's libddsc is not the version whose
// inner structures this library was compiled with.
bool FindCyclone(const Link& link);

// As FindCyclone, for what can be seen only once there is a participant: whether its structures lie
// where the headers say.
bool LayoutIsAsCompiled(const ddsi_domaingv& gv, const ddsi_participant& participant);

// While this object lives, all that the index of entities leads to stays.
class Awake {
 public:
  explicit Awake(const ddsi_domaingv* gv) : thread_(lookup_thread_state()) {
    thread_state_awake(thread_, gv);
  }
  ~Awake() { thread_state_asleep(thread_); }
  Awake(const Awake&) = delete;
  Awake& operator=(const Awake&) = delete;

 private:
  thread_state* thread_;
};

}  // namespace tcs::dds
