// Hooks of Cyclone's inner seams where the program's entities are made, changed and ended.
#pragma once

#include "libtcs_preload/dds/cyclone.h"

namespace tcs::dds {

dds_return_t NewParticipant(ddsi_guid_t* guid, ddsi_domaingv* gv, unsigned flags,
                            const ddsi_plist_t* plist);
dds_return_t DeleteParticipant(ddsi_domaingv* gv, const ddsi_guid_t* guid);
void UpdateParticipant(ddsi_participant* participant, const ddsi_plist_t* plist);

dds_return_t NewWriter(ddsi_writer** writer, ddsi_guid_t* guid, const ddsi_guid_t* group,
                       ddsi_participant* participant, const char* topic, const ddsi_sertype* type,
                       const dds_qos_t* qos, whc* cache, ddsi_status_cb_t status, void* argument);
dds_return_t DeleteWriter(ddsi_domaingv* gv, const ddsi_guid_t* guid);
void UpdateWriter(ddsi_writer* writer, const dds_qos_t* qos);

dds_return_t NewReader(ddsi_reader** reader, ddsi_guid_t* guid, const ddsi_guid_t* group,
                       ddsi_participant* participant, const char* topic, const ddsi_sertype* type,
                       const dds_qos_t* qos, ddsi_rhc* cache, ddsi_status_cb_t status,
                       void* argument);
dds_return_t DeleteReader(ddsi_domaingv* gv, const ddsi_guid_t* guid);
void UpdateReader(ddsi_reader* reader, const dds_qos_t* qos);

dds_return_t NewTopic(ddsi_topic** topic, ddsi_guid_t* guid, ddsi_participant* participant,
                      const char* name, const ddsi_sertype* type, const dds_qos_t* qos,
                      bool is_builtin, bool* is_new);
void UpdateTopic(ddsi_topic* topic, const dds_qos_t* qos);
dds_return_t DeleteTopic(ddsi_domaingv* gv, const ddsi_guid_t* guid);

}  // namespace tcs::dds
