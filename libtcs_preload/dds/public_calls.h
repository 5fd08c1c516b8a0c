// Hooks of public functions around which something has to be done outside Cyclone's locks.
#pragma once

#include "libtcs_preload/dds/cyclone.h"

namespace tcs::dds {

dds_entity_t CreateParticipant(dds_domainid_t domain, const dds_qos_t* qos,
                               const dds_listener_t* listener);
dds_entity_t CreateTopic(dds_entity_t participant, const char* name, bool allow_dcps,
                         ddsi_sertype** type, const dds_qos_t* qos, const dds_listener_t* listener,
                         const ddsi_plist* discovery, bool is_builtin);
dds_entity_t CreateWriter(dds_entity_t of, dds_entity_t topic, const dds_qos_t* qos,
                          const dds_listener_t* listener);
dds_return_t Delete(dds_entity_t entity);
dds_return_t LookUpParticipants(dds_domainid_t domain, dds_entity_t* participants,
                                std::size_t size);
dds_entity_t FindTopic(dds_find_scope_t scope, dds_entity_t participant, const char* name,
                       const dds_typeinfo_t* type, dds_duration_t timeout);
dds_entity_t FindTopicScoped(dds_find_scope_t scope, dds_entity_t participant, const char* name,
                             dds_duration_t timeout);
dds_return_t CreateTopicDescriptor(dds_find_scope_t scope, dds_entity_t participant,
                                   const dds_typeinfo_t* type, dds_duration_t timeout,
                                   dds_topic_descriptor_t** descriptor);
dds_return_t GetTypeObject(dds_entity_t entity, const dds_typeid_t* type, dds_duration_t timeout,
                           dds_typeobj_t** object);
dds_return_t PinEntity(dds_entity_t handle, dds_entity** entity);
dds_return_t GetChildren(dds_entity_t entity, dds_entity_t* children, std::size_t size);

}  // namespace tcs::dds
