#include "libtcs_preload/dds/qos_code.h"

#include <dds/ddsi/ddsi_xqos.h>

#include <algorithm>
#include <cstring>
#include <string_view>

namespace tcs::dds {
namespace {

using shm::DdsBytes;
using shm::DdsEndpoint;
using shm::DdsQos;

// Cyclone's own properties tell of the process number and the host's name. The length of these
// texts changes nothing of a run with set costs, in which allocations are charged and programs wait
// for room in shared memory.
constexpr std::size_t kPropertiesRoom = 1024;

// Lays texts behind the structure that a payload begins with.
class Texts {
 public:
  explicit Texts(std::size_t structure) : base_(structure) {}

  DdsBytes Add(const void* data, std::size_t size) {
    const DdsBytes where{static_cast<std::uint32_t>(base_ + bytes_.size()),
                         static_cast<std::uint32_t>(size)};
    const auto* from = static_cast<const std::byte*>(data);
    bytes_.insert(bytes_.end(), from, from + size);
    return where;
  }
  DdsBytes Add(std::string_view text) { return Add(text.data(), text.size()); }
  // The payload is as long whatever the text is, up to `room`; and so are the allocations.
  DdsBytes AddWithRoom(std::string_view text, std::size_t room) {
    const std::size_t end = bytes_.size() + std::max(text.size(), room);
    bytes_.reserve(end);
    const DdsBytes where = Add(text);
    bytes_.resize(end);
    return where;
  }

  template <class Structure>
  Payload Behind(const Structure& structure) const {
    Payload payload(sizeof(structure) + bytes_.size());
    std::memcpy(payload.data(), &structure, sizeof(structure));
    if (!bytes_.empty()) {
      std::memcpy(payload.data() + sizeof(structure), bytes_.data(), bytes_.size());
    }
    return payload;
  }

 private:
  std::size_t base_;
  std::vector<std::byte> bytes_;
};

void FreeNames(char** names, std::uint32_t count) {
  for (std::uint32_t i = 0; i < count; ++i) dds_free(names[i]);
  dds_free(names);
}

void EncodeTexts(const dds_qos_t* qos, DdsQos& to, Texts& texts) {
  void* value = nullptr;
  std::size_t size = 0;
  const auto data = [&](auto get, std::uint32_t bit, DdsBytes& where) {
    if (!get(qos, &value, &size)) return;
    to.present |= bit;
    where = texts.Add(value, size);
    dds_free(value);
  };
  data(dds_qget_userdata, shm::kDdsUserData, to.user_data);
  data(dds_qget_topicdata, shm::kDdsTopicData, to.topic_data);
  data(dds_qget_groupdata, shm::kDdsGroupData, to.group_data);
  if (char* name = nullptr; dds_qget_entity_name(qos, &name)) {
    to.present |= shm::kDdsEntityName;
    to.entity_name = texts.Add(name);
    dds_free(name);
  }
  std::uint32_t count = 0;
  char** names = nullptr;
  if (dds_qget_partition(qos, &count, &names)) {
    std::string all;
    for (std::uint32_t i = 0; i < count; ++i) all.append(names[i]).push_back('\0');
    to.present |= shm::kDdsPartition;
    to.partition = texts.Add(all);
    FreeNames(names, count);
  }
  dds_data_representation_id_t* representations = nullptr;
  if (dds_qget_data_representation(qos, &count, &representations)) {
    to.present |= shm::kDdsDataRepresentation;
    to.data_representation = texts.Add(representations, count * sizeof(*representations));
    dds_free(representations);
  }
}

// The properties that others are to see. Programs' own properties are not among them: Cyclone keeps
// these to itself.
void EncodeProperties(const dds_qos_t* qos, DdsQos& to, Texts& texts) {
  if ((qos->present & QP_PROPERTY_LIST) == 0) return;
  const auto& text = qos->property.value;
  const auto& binary = qos->property.binary_value;
  std::string all;
  all.reserve(kPropertiesRoom);
  for (std::uint32_t i = 0; i < text.n; ++i) {
    if (text.props[i].propagate == 0) continue;
    all.append(text.props[i].name).push_back('\0');
    all.append(text.props[i].value).push_back('\0');
  }
  if (!all.empty()) {
    to.present |= shm::kDdsProperties;
    to.properties = texts.AddWithRoom(all, kPropertiesRoom);
  }
  all.clear();
  for (std::uint32_t i = 0; i < binary.n; ++i) {
    if (binary.props[i].propagate == 0) continue;
    const auto& value = binary.props[i].value;
    all.append(binary.props[i].name).push_back('\0');
    all.append(reinterpret_cast<const char*>(&value.length), sizeof(value.length));
    all.append(reinterpret_cast<const char*>(value.value), value.length);
  }
  if (!all.empty()) {
    to.present |= shm::kDdsBinaryProperties;
    to.binary_properties = texts.Add(all);
  }
}

template <class Enum>
Enum& As(std::int32_t& number) {
  static_assert(sizeof(Enum) == sizeof(std::int32_t));
  return reinterpret_cast<Enum&>(number);
}

bool& Flag(std::uint8_t& number) {
  static_assert(sizeof(bool) == sizeof(std::uint8_t));
  return reinterpret_cast<bool&>(number);
}

void EncodeNumbers(const dds_qos_t* qos, DdsQos& to) {
  const auto have = [&to](bool present, std::uint32_t bit) {
    if (present) to.present |= bit;
  };
  have(dds_qget_durability(qos, &As<dds_durability_kind_t>(to.durability)), shm::kDdsDurability);
  have(dds_qget_durability_service(qos, &to.service_cleanup_ns,
                                   &As<dds_history_kind_t>(to.service_history),
                                   &to.service_history_depth, &to.service_max_samples,
                                   &to.service_max_instances, &to.service_max_samples_per_instance),
       shm::kDdsDurabilityService);
  have(dds_qget_history(qos, &As<dds_history_kind_t>(to.history), &to.history_depth),
       shm::kDdsHistory);
  have(dds_qget_resource_limits(qos, &to.max_samples, &to.max_instances,
                                &to.max_samples_per_instance),
       shm::kDdsResourceLimits);
  have(dds_qget_presentation(qos, &As<dds_presentation_access_scope_kind_t>(to.presentation_scope),
                             &Flag(to.coherent_access), &Flag(to.ordered_access)),
       shm::kDdsPresentation);
  have(dds_qget_lifespan(qos, &to.lifespan_ns), shm::kDdsLifespan);
  have(dds_qget_deadline(qos, &to.deadline_ns), shm::kDdsDeadline);
  have(dds_qget_latency_budget(qos, &to.latency_budget_ns), shm::kDdsLatencyBudget);
  have(dds_qget_ownership(qos, &As<dds_ownership_kind_t>(to.ownership)), shm::kDdsOwnership);
  have(dds_qget_ownership_strength(qos, &to.ownership_strength), shm::kDdsOwnershipStrength);
  have(dds_qget_liveliness(qos, &As<dds_liveliness_kind_t>(to.liveliness), &to.liveliness_lease_ns),
       shm::kDdsLivelinessPolicy);
  have(dds_qget_time_based_filter(qos, &to.time_based_filter_ns), shm::kDdsTimeBasedFilter);
  have(dds_qget_reliability(qos, &As<dds_reliability_kind_t>(to.reliability), &to.max_blocking_ns),
       shm::kDdsReliability);
  have(dds_qget_transport_priority(qos, &to.transport_priority), shm::kDdsTransportPriority);
  have(dds_qget_destination_order(qos, &As<dds_destination_order_kind_t>(to.destination_order)),
       shm::kDdsDestinationOrder);
  have(dds_qget_writer_data_lifecycle(qos, &Flag(to.autodispose)), shm::kDdsWriterDataLifecycle);
  have(dds_qget_reader_data_lifecycle(qos, &to.purge_no_writer_ns, &to.purge_disposed_ns),
       shm::kDdsReaderDataLifecycle);
  have(dds_qget_ignorelocal(qos, &As<dds_ignorelocal_kind_t>(to.ignore_local)),
       shm::kDdsIgnoreLocal);
  have(dds_qget_type_consistency(qos, &As<dds_type_consistency_kind_t>(to.type_consistency),
                                 &Flag(to.ignore_sequence_bounds), &Flag(to.ignore_string_bounds),
                                 &Flag(to.ignore_member_names), &Flag(to.prevent_type_widening),
                                 &Flag(to.force_type_validation)),
       shm::kDdsTypeConsistency);
}

DdsQos Encode(const dds_qos_t* qos, Texts& texts) {
  DdsQos to{};
  if (qos == nullptr) return to;
  EncodeTexts(qos, to, texts);
  EncodeProperties(qos, to, texts);
  EncodeNumbers(qos, to);
  return to;
}

// The text that a DdsBytes leads to; empty where it leads out of the payload.
std::string_view View(const Payload& payload, DdsBytes where) {
  if (where.offset > payload.size() || where.size > payload.size() - where.offset) return {};
  return {reinterpret_cast<const char*>(payload.data()) + where.offset, where.size};
}

// The text up to the next zero; moves past it.
std::string NextText(std::string_view& rest) {
  const std::size_t end = rest.find('\0');
  std::string text(rest.substr(0, end));
  rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
  return text;
}

void DecodeTexts(const Payload& payload, const DdsQos& from, dds_qos_t* qos) {
  const auto data = [&](auto set, std::uint32_t bit, DdsBytes where) {
    if ((from.present & bit) == 0) return;
    const std::string_view view = View(payload, where);
    set(qos, view.data(), view.size());
  };
  data(dds_qset_userdata, shm::kDdsUserData, from.user_data);
  data(dds_qset_topicdata, shm::kDdsTopicData, from.topic_data);
  data(dds_qset_groupdata, shm::kDdsGroupData, from.group_data);
  if (from.present & shm::kDdsEntityName) {
    dds_qset_entity_name(qos, std::string(View(payload, from.entity_name)).c_str());
  }
  if (from.present & shm::kDdsPartition) {
    std::vector<std::string> names;
    for (std::string_view rest = View(payload, from.partition); !rest.empty();) {
      names.push_back(NextText(rest));
    }
    std::vector<const char*> pointers;
    for (const std::string& name : names) pointers.push_back(name.c_str());
    dds_qset_partition(qos, static_cast<std::uint32_t>(pointers.size()), pointers.data());
  }
  if (from.present & shm::kDdsDataRepresentation) {
    const std::string_view view = View(payload, from.data_representation);
    std::vector<dds_data_representation_id_t> ids(view.size() / sizeof(ids[0]));
    if (!ids.empty()) std::memcpy(ids.data(), view.data(), ids.size() * sizeof(ids[0]));
    dds_qset_data_representation(qos, static_cast<std::uint32_t>(ids.size()), ids.data());
  }
}

void DecodeProperties(const Payload& payload, const DdsQos& from, dds_qos_t* qos) {
  if (from.present & shm::kDdsProperties) {
    for (std::string_view rest = View(payload, from.properties); !rest.empty();) {
      const std::string name = NextText(rest);
      dds_qset_prop(qos, name.c_str(), NextText(rest).c_str());
    }
  }
  if (from.present & shm::kDdsBinaryProperties) {
    for (std::string_view rest = View(payload, from.binary_properties); !rest.empty();) {
      const std::string name = NextText(rest);
      std::uint32_t size = 0;
      if (rest.size() < sizeof(size)) return;
      std::memcpy(&size, rest.data(), sizeof(size));
      rest.remove_prefix(sizeof(size));
      if (rest.size() < size) return;
      dds_qset_bprop(qos, name.c_str(), rest.data(), size);
      rest.remove_prefix(size);
    }
  }
}

void DecodeNumbers(const DdsQos& from, dds_qos_t* qos) {
  const auto has = [&from](std::uint32_t bit) { return (from.present & bit) != 0; };
  const auto history = [](std::int32_t kind) { return static_cast<dds_history_kind_t>(kind); };
  if (has(shm::kDdsDurability)) {
    dds_qset_durability(qos, static_cast<dds_durability_kind_t>(from.durability));
  }
  if (has(shm::kDdsDurabilityService)) {
    dds_qset_durability_service(qos, from.service_cleanup_ns, history(from.service_history),
                                from.service_history_depth, from.service_max_samples,
                                from.service_max_instances, from.service_max_samples_per_instance);
  }
  if (has(shm::kDdsHistory)) dds_qset_history(qos, history(from.history), from.history_depth);
  if (has(shm::kDdsResourceLimits)) {
    dds_qset_resource_limits(qos, from.max_samples, from.max_instances,
                             from.max_samples_per_instance);
  }
  if (has(shm::kDdsPresentation)) {
    dds_qset_presentation(
        qos, static_cast<dds_presentation_access_scope_kind_t>(from.presentation_scope),
        from.coherent_access != 0, from.ordered_access != 0);
  }
  if (has(shm::kDdsLifespan)) dds_qset_lifespan(qos, from.lifespan_ns);
  if (has(shm::kDdsDeadline)) dds_qset_deadline(qos, from.deadline_ns);
  if (has(shm::kDdsLatencyBudget)) dds_qset_latency_budget(qos, from.latency_budget_ns);
  if (has(shm::kDdsOwnership)) {
    dds_qset_ownership(qos, static_cast<dds_ownership_kind_t>(from.ownership));
  }
  if (has(shm::kDdsOwnershipStrength)) dds_qset_ownership_strength(qos, from.ownership_strength);
  if (has(shm::kDdsLivelinessPolicy)) {
    dds_qset_liveliness(qos, static_cast<dds_liveliness_kind_t>(from.liveliness),
                        from.liveliness_lease_ns);
  }
  if (has(shm::kDdsTimeBasedFilter)) dds_qset_time_based_filter(qos, from.time_based_filter_ns);
  if (has(shm::kDdsReliability)) {
    dds_qset_reliability(qos, static_cast<dds_reliability_kind_t>(from.reliability),
                         from.max_blocking_ns);
  }
  if (has(shm::kDdsTransportPriority)) dds_qset_transport_priority(qos, from.transport_priority);
  if (has(shm::kDdsDestinationOrder)) {
    dds_qset_destination_order(qos,
                               static_cast<dds_destination_order_kind_t>(from.destination_order));
  }
  if (has(shm::kDdsWriterDataLifecycle)) {
    dds_qset_writer_data_lifecycle(qos, from.autodispose != 0);
  }
  if (has(shm::kDdsReaderDataLifecycle)) {
    dds_qset_reader_data_lifecycle(qos, from.purge_no_writer_ns, from.purge_disposed_ns);
  }
  if (has(shm::kDdsIgnoreLocal)) {
    dds_qset_ignorelocal(qos, static_cast<dds_ignorelocal_kind_t>(from.ignore_local));
  }
  if (has(shm::kDdsTypeConsistency)) {
    dds_qset_type_consistency(qos, static_cast<dds_type_consistency_kind_t>(from.type_consistency),
                              from.ignore_sequence_bounds != 0, from.ignore_string_bounds != 0,
                              from.ignore_member_names != 0, from.prevent_type_widening != 0,
                              from.force_type_validation != 0);
  }
}

template <class Structure>
bool Read(const Payload& payload, Structure& to) {
  if (payload.size() < sizeof(to)) return false;
  std::memcpy(&to, payload.data(), sizeof(to));
  return true;
}

}  // namespace

Payload EncodeParticipant(const dds_qos_t* qos) {
  Texts texts(sizeof(DdsQos));
  const DdsQos encoded = Encode(qos, texts);
  return texts.Behind(encoded);
}

Payload EncodeEndpoint(std::uint32_t kind, const char* topic, const ddsi_sertype* type,
                       const dds_qos_t* qos) {
  Texts texts(sizeof(DdsEndpoint));
  DdsEndpoint endpoint{};
  endpoint.kind = kind;
  endpoint.keyless = type->typekind_no_key != 0 ? 1 : 0;
  endpoint.topic = texts.Add(topic);
  endpoint.type = texts.Add(type->type_name);
  const TypeCode code = CodeOf(type);
  endpoint.type_information = texts.Add(code.information.data(), code.information.size());
  endpoint.type_mapping = texts.Add(code.mapping.data(), code.mapping.size());
  endpoint.qos = Encode(qos, texts);
  return texts.Behind(endpoint);
}

DecodedEndpoint DecodeEndpoint(const Payload& payload) {
  DdsEndpoint endpoint;
  DecodedEndpoint decoded;
  if (!Read(payload, endpoint)) return decoded;
  decoded.kind = endpoint.kind;
  decoded.topic = View(payload, endpoint.topic);
  decoded.type = View(payload, endpoint.type);
  decoded.keyless = endpoint.keyless != 0;
  const auto bytes = [&payload](DdsBytes where) {
    const std::string_view all = View(payload, where);
    const auto* start = reinterpret_cast<const std::byte*>(all.data());
    return Payload(start, start + all.size());
  };
  decoded.type_code = Checked({bytes(endpoint.type_information), bytes(endpoint.type_mapping)});
  return decoded;
}

dds_qos_t* DecodeQos(const Payload& payload, bool participant) {
  dds_qos_t* qos = dds_create_qos();
  DdsEndpoint endpoint{};
  if (participant ? !Read(payload, endpoint.qos) : !Read(payload, endpoint)) return qos;
  DecodeTexts(payload, endpoint.qos, qos);
  DecodeProperties(payload, endpoint.qos, qos);
  DecodeNumbers(endpoint.qos, qos);
  return qos;
}

}  // namespace tcs::dds
