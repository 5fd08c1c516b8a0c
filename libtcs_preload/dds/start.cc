// The one symbol that libtcs_dds.so exports: the beginning of DDS by endpoints in a process.
#include <vector>

#include "libtcs_preload/dds/cyclone.h"
#include "libtcs_preload/dds/deaf_mute.h"
#include "libtcs_preload/dds/deliverer.h"
#include "libtcs_preload/dds/entities.h"
#include "libtcs_preload/dds/identity.h"
#include "libtcs_preload/dds/link.h"
#include "libtcs_preload/dds/listening.h"
#include "libtcs_preload/dds/liveliness.h"
#include "libtcs_preload/dds/outgoing.h"
#include "libtcs_preload/dds/public_calls.h"
#include "libtcs_preload/dds/reading.h"
#include "libtcs_preload/dds/silence.h"
#include "libtcs_preload/dds/writing.h"

namespace tcs::dds {
namespace {

template <class Function>
Hook HookOf(const char* name, Function RealCalls::*, Function hook) {
  return {name, reinterpret_cast<void*>(hook)};
}

const Hook* Hooks() {
#define TCS_DDS_HOOK(name, hook) HookOf(#name, &RealCalls::name, hook)
#define TCS_DDS_READING_HOOK(name) {#name, ReadingHook(kCall_##name)},
#define TCS_DDS_WRITING_HOOK(name) {#name, WritingHook(kCall_##name)},
  static const auto* hooks =
      new std::vector<Hook>{TCS_DDS_HOOK(dds_create_participant, CreateParticipant),
                            TCS_DDS_HOOK(dds_create_topic_impl, CreateTopic),
                            TCS_DDS_HOOK(dds_create_writer, CreateWriter),
                            TCS_DDS_HOOK(dds_delete, Delete),
                            TCS_DDS_HOOK(dds_assert_liveliness, AssertLiveliness),
                            TCS_DDS_HOOK(dds_lookup_participant, LookUpParticipants),
                            TCS_DDS_HOOK(dds_get_children, GetChildren),
                            TCS_DDS_HOOK(dds_find_topic, FindTopic),
                            TCS_DDS_HOOK(dds_find_topic_scoped, FindTopicScoped),
                            TCS_DDS_HOOK(dds_create_topic_descriptor, CreateTopicDescriptor),
                            TCS_DDS_HOOK(dds_get_typeobj, GetTypeObject),
                            TCS_DDS_HOOK(dds_entity_pin, PinEntity),
                            TCS_DDS_HOOK(ddsi_new_topic, NewTopic),
                            TCS_DDS_HOOK(ddsi_update_topic_qos, UpdateTopic),
                            TCS_DDS_HOOK(ddsi_delete_topic, DeleteTopic),
                            TCS_DDS_HOOK(dds_reader_data_available_cb, DataAvailable),
                            TCS_DDS_HOOK(ddsi_new_participant, NewParticipant),
                            TCS_DDS_HOOK(ddsi_delete_participant, DeleteParticipant),
                            TCS_DDS_HOOK(ddsi_update_participant_plist, UpdateParticipant),
                            TCS_DDS_HOOK(ddsi_new_writer, NewWriter),
                            TCS_DDS_HOOK(ddsi_delete_writer, DeleteWriter),
                            TCS_DDS_HOOK(ddsi_update_writer_qos, UpdateWriter),
                            TCS_DDS_HOOK(ddsi_new_reader, NewReader),
                            TCS_DDS_HOOK(ddsi_delete_reader, DeleteReader),
                            TCS_DDS_HOOK(ddsi_update_reader_qos, UpdateReader),
                            TCS_DDS_HOOK(ddsi_set_deafmute, SetDeafMute),
                            TCS_DDS_HOOK(ddsi_delete_proxy_participant_by_guid, DeleteProxy),
                            TCS_DDS_HOOK(ddsi_iid_gen, GenerateInstance),
                            TCS_DDS_HOOK(ddsrt_prng_makeseed, MakeSeed),
                            TCS_DDS_HOOK(rtps_config_prep, PrepareConfiguration),
                            TCS_DDS_READING_CALLS(TCS_DDS_READING_HOOK)
                                TCS_DDS_WRITING_CALLS(TCS_DDS_WRITING_HOOK){nullptr, nullptr}};
#undef TCS_DDS_WRITING_HOOK
#undef TCS_DDS_READING_HOOK
#undef TCS_DDS_HOOK
  return hooks->data();
}

}  // namespace
}  // namespace tcs::dds

extern "C" __attribute__((visibility("default"))) const tcs::dds::Hook* tcs_dds_start(
    const tcs::dds::Link& link);

extern "C" const tcs::dds::Hook* tcs_dds_start(const tcs::dds::Link& link) {
  if (!tcs::dds::FindCyclone(link) || !tcs::dds::Join(link)) return nullptr;
  tcs::dds::StartDeliverer();
  return tcs::dds::Hooks();
}
