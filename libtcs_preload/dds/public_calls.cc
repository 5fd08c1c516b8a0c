#include "libtcs_preload/dds/public_calls.h"

#include <algorithm>
#include <vector>

#include "libtcs_preload/dds/deliverer.h"
#include "libtcs_preload/dds/listening.h"
#include "libtcs_preload/dds/outgoing.h"
#include "libtcs_preload/dds/program.h"

namespace tcs::dds {
namespace {

// The domains whose last participant of the program's goes with `entity`.
std::vector<std::uint32_t> DomainsThatEndWith(dds_entity_t entity) {
  if (entity == DDS_CYCLONEDDS_HANDLE) return Domains();
  dds_domainid_t domain = 0;
  if (dds_get_domainid(entity, &domain) != DDS_RETCODE_OK) return {};
  const dds_entity_t participant = dds_get_participant(entity);
  if (participant <= 0) return {domain};  // the entity is a domain
  dds_guid_t guid;
  if (participant != entity || dds_get_guid(entity, &guid) != DDS_RETCODE_OK) return {};
  if (!IsLastParticipant(GuidAt(guid.v))) return {};
  return {domain};
}

bool IsShadowHandle(dds_entity_t participant) {
  dds_guid_t guid;
  dds_domainid_t domain = 0;
  return dds_get_guid(participant, &guid) == DDS_RETCODE_OK &&
         dds_get_domainid(participant, &domain) == DDS_RETCODE_OK &&
         IsShadow(domain, InnerOf(GuidAt(guid.v)));
}

// The entities that `list` has, but for shadows, as Cyclone's own calls return them.
template <class List>
dds_return_t WithoutShadows(dds_entity_t* entities, std::size_t size, List list) {
  const dds_return_t count = list(nullptr, 0);
  // Wrong arguments are Cyclone's to find.
  if (count <= 0 || (entities == nullptr) != (size == 0)) return list(entities, size);
  std::vector<dds_entity_t> all(static_cast<std::size_t>(count));
  const dds_return_t now = list(all.data(), all.size());
  all.resize(static_cast<std::size_t>(std::clamp(now, 0, count)));
  std::erase_if(all, IsShadowHandle);
  std::copy_n(all.begin(), std::min(size, all.size()), entities);
  return static_cast<dds_return_t>(all.size());
}

}  // namespace

dds_entity_t CreateParticipant(dds_domainid_t domain, const dds_qos_t* qos,
                               const dds_listener_t* listener) {
  const dds_entity_t participant = Real().dds_create_participant(domain, qos, listener);
  if (participant > 0) LookAgain();
  return participant;
}

dds_entity_t CreateTopic(dds_entity_t participant, const char* name, bool allow_dcps,
                         ddsi_sertype** type, const dds_qos_t* qos, const dds_listener_t* listener,
                         const ddsi_plist* discovery, bool is_builtin) {
  const dds_entity_t topic = Real().dds_create_topic_impl(participant, name, allow_dcps, type, qos,
                                                          listener, discovery, is_builtin);
  dds_domainid_t domain = 0;
  if (topic > 0 && !is_builtin && dds_get_domainid(topic, &domain) == DDS_RETCODE_OK) {
    AddType(domain, name, *type);
    LookAgain();
  }
  return topic;
}

// A writer has met all readers that there are before its program goes on: samples that it writes at
// once reach them, too, be they volatile, and recordings have the samples at their time.
dds_entity_t CreateWriter(dds_entity_t of, dds_entity_t topic, const dds_qos_t* qos,
                          const dds_listener_t* listener) {
  const dds_entity_t writer = Real().dds_create_writer(of, topic, qos, listener);
  if (writer > 0 && !IsDeliverer() && !IsListening()) TheLink().settle();
  return writer;
}

// The types are let go before the participant goes, the shadows after it: the program's readers and
// writers must not see them go. The deliverer is out of a domain before the domain is taken down.
// On the deliverer itself a listener deletes, as in Cyclone's own threads: the deliverer cannot
// wait for itself.
dds_return_t Delete(dds_entity_t entity) {
  const std::vector<std::uint32_t> ending = DomainsThatEndWith(entity);
  for (const std::uint32_t domain : ending) BeginEnd(domain, !IsDeliverer());
  for (const std::uint32_t domain : ending) ReleaseTypes(domain);
  const dds_return_t result = Real().dds_delete(entity);
  for (const std::uint32_t domain : ending) CloseDomain(domain);
  return result;
}

dds_return_t LookUpParticipants(dds_domainid_t domain, dds_entity_t* participants,
                                std::size_t size) {
  return WithoutShadows(participants, size, [domain](dds_entity_t* all, std::size_t most) {
    return Real().dds_lookup_participant(domain, all, most);
  });
}

namespace {

void SeeWhatThereIs() {
  if (LookAround()) LookAgain();
  if (!IsDeliverer() && !IsListening()) TheLink().sync();
}

// While the calling thread looks for topics in all participants of a domain.
thread_local bool t_finding;

class Finding {
 public:
  Finding() {
    SeeWhatThereIs();
    t_finding = true;
  }
  ~Finding() { t_finding = false; }
  Finding(const Finding&) = delete;
  Finding& operator=(const Finding&) = delete;
};

}  // namespace

dds_entity_t FindTopic(dds_find_scope_t scope, dds_entity_t participant, const char* name,
                       const dds_typeinfo_t* type, dds_duration_t timeout) {
  const Finding finding;
  return Real().dds_find_topic(scope, participant, name, type, timeout);
}

dds_entity_t FindTopicScoped(dds_find_scope_t scope, dds_entity_t participant, const char* name,
                             dds_duration_t timeout) {
  const Finding finding;
  return Real().dds_find_topic_scoped(scope, participant, name, timeout);
}

dds_return_t CreateTopicDescriptor(dds_find_scope_t scope, dds_entity_t participant,
                                   const dds_typeinfo_t* type, dds_duration_t timeout,
                                   dds_topic_descriptor_t** descriptor) {
  SeeWhatThereIs();
  return Real().dds_create_topic_descriptor(scope, participant, type, timeout, descriptor);
}

dds_return_t GetTypeObject(dds_entity_t entity, const dds_typeid_t* type, dds_duration_t timeout,
                           dds_typeobj_t** object) {
  SeeWhatThereIs();
  return Real().dds_get_typeobj(entity, type, timeout, object);
}

// The topics of shadows are not the domain's.
dds_return_t PinEntity(dds_entity_t handle, dds_entity** entity) {
  if (t_finding) {
    t_finding = false;
    const bool is_shadow = IsShadowHandle(handle);
    t_finding = true;
    if (is_shadow) return DDS_RETCODE_BAD_PARAMETER;
  }
  return Real().dds_entity_pin(handle, entity);
}

// The children of a domain are participants.
dds_return_t GetChildren(dds_entity_t entity, dds_entity_t* children, std::size_t size) {
  if (dds_get_participant(entity) > 0) return Real().dds_get_children(entity, children, size);
  return WithoutShadows(children, size, [entity](dds_entity_t* all, std::size_t most) {
    return Real().dds_get_children(entity, all, most);
  });
}

}  // namespace tcs::dds
