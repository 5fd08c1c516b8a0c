#include "libtcs_preload/dds/program.h"

#include <algorithm>
#include <condition_variable>
#include <map>
#include <mutex>
#include <set>
#include <unordered_map>
#include <utility>

#include "libtcs_preload/dds/other_type.h"
#include "libtcs_preload/dds/tap.h"

namespace tcs::dds {
namespace {

struct Domain {
  ddsi_domaingv* gv = nullptr;  // valid while there are participants, and visits
  std::uint32_t name = 0;       // on the network
  std::vector<Guid> participants;
  std::set<Guid> past_participants;
  int visits = 0;
  int ends = 0;  // threads that are about to end the domain
  std::map<std::pair<std::string, std::string>, ddsi_sertype*> types;
};

// The last sample shipped to a process, referred to so that no other sample can have its address.
struct Shipped {
  ddsi_serdata* sample = nullptr;
  const Tap* by = nullptr;
};

// A promise to the process's readers of a writer's topic; looked at again when the taps have
// changed.
struct Promise {
  std::uint64_t taps_version = 0;
  bool is_made = false;
};

struct Writer {
  std::uint32_t domain = 0;
  std::string topic;
  bool has_history = false;
  bool is_reliable = false;
  std::int64_t blocks_ns = 0;
  std::uint32_t keeps_last = 0;
  std::map<std::uint32_t, Shipped> shipped;  // by process
  std::map<std::uint32_t, Promise> promises;
  std::unordered_map<std::uint64_t, ddsi_tkmap_instance*> instances;
};

struct Reader {
  std::uint32_t domain = 0;
  std::string topic;
};

using Prefix = std::pair<std::uint64_t, std::uint32_t>;

// The most instances that are kept of a writer that never unregisters its instances.
constexpr std::size_t kMostInstances = 4096;

struct ProgramState {
  std::mutex mutex;
  std::condition_variable left;                                            // by a visitor
  std::set<std::pair<std::uint32_t, Prefix>> shadows;                      // by domain
  std::map<std::pair<std::uint32_t, Guid>, std::string> shadow_endpoints;  // the endpoints' topics
  std::map<std::uint32_t, Domain> domains;
  std::set<std::uint32_t> met;  // names of which there have been several at a time
  std::unordered_map<Guid, Writer, GuidHash> writers;
  std::unordered_map<Guid, Reader, GuidHash> readers;
  std::vector<const Tap*> taps;
  std::uint64_t taps_version = 1;
  bool looks_around = false;
};

// Never destroyed: the deliverer and Cyclone's threads outlive main.
ProgramState& TheProgramState() {
  static auto* state = new ProgramState;
  return *state;
}

Prefix PrefixOf(const ddsi_guid_t& guid) {
  return {std::uint64_t{guid.prefix.u[0]} << 32 | guid.prefix.u[1], guid.prefix.u[2]};
}

void Forget(Writer& writer, const ddsi_domaingv* gv) {
  for (auto& [process, shipped] : writer.shipped) {
    if (shipped.sample != nullptr) ddsi_serdata_unref(shipped.sample);
  }
  const Awake awake(gv);
  for (auto& [iid, instance] : writer.instances) ddsi_tkmap_instance_unref(gv->m_tkmap, instance);
}

std::vector<Guid> LockedWritersOf(const ProgramState& state, std::uint32_t domain,
                                  const std::string& topic, bool with_history) {
  std::vector<Guid> guids;
  for (const auto& [guid, writer] : state.writers) {
    if ((writer.has_history || !with_history) && writer.domain == domain && writer.topic == topic) {
      guids.push_back(guid);
    }
  }
  return guids;
}

std::vector<std::uint32_t> LockedDomainsCalled(const ProgramState& state,
                                               std::uint32_t network_domain) {
  std::vector<std::uint32_t> ids;
  for (const auto& [id, domain] : state.domains) {
    if (!domain.participants.empty() && domain.name == network_domain) ids.push_back(id);
  }
  return ids;
}

}  // namespace

std::uint32_t NetworkDomain(const ddsi_domaingv& gv) {
  const ddsi_config_maybe_uint32& external = gv.config.extDomainId;
  return external.isdefault != 0 ? gv.config.domainId : external.value;
}

void AddShadow(std::uint32_t domain, const Guid& participant) {
  ProgramState& state = TheProgramState();
  const std::lock_guard lock(state.mutex);
  state.shadows.insert({domain, PrefixOf(InnerOf(participant))});
}

void RemoveShadow(std::uint32_t domain, const Guid& participant) {
  ProgramState& state = TheProgramState();
  const std::lock_guard lock(state.mutex);
  state.shadows.erase({domain, PrefixOf(InnerOf(participant))});
}

bool IsShadow(const ddsi_domaingv* gv, const ddsi_guid_t& entity) {
  return IsShadow(gv->config.domainId, entity);
}

bool IsShadow(std::uint32_t domain, const ddsi_guid_t& entity) {
  ProgramState& state = TheProgramState();
  const std::lock_guard lock(state.mutex);
  return state.shadows.contains({domain, PrefixOf(entity)});
}

void AddShadowEndpoint(std::uint32_t domain, const char* topic, const Guid& guid) {
  ProgramState& state = TheProgramState();
  const std::lock_guard lock(state.mutex);
  state.shadow_endpoints[{domain, guid}] = topic;
}

void RemoveShadowEndpoint(std::uint32_t domain, const Guid& guid) {
  ProgramState& state = TheProgramState();
  const std::lock_guard lock(state.mutex);
  state.shadow_endpoints.erase({domain, guid});
}

std::vector<Guid> ShadowEndpointsOf(std::uint32_t domain, const std::string& topic) {
  ProgramState& state = TheProgramState();
  const std::lock_guard lock(state.mutex);
  std::vector<Guid> guids;
  for (const auto& [key, of] : state.shadow_endpoints) {
    if (key.first == domain && of == topic) guids.push_back(key.second);
  }
  return guids;
}

bool HasDomain(std::uint32_t domain) {
  ProgramState& state = TheProgramState();
  const std::lock_guard lock(state.mutex);
  const auto found = state.domains.find(domain);
  return found != state.domains.end() && !found->second.participants.empty();
}

Visit::Visit(std::uint32_t domain) : domain_(domain), gv_(nullptr) {
  ProgramState& state = TheProgramState();
  const std::lock_guard lock(state.mutex);
  const auto found = state.domains.find(domain);
  if (found == state.domains.end()) return;
  Domain& visited = found->second;
  if (visited.participants.empty() || visited.ends > 0) return;
  ++visited.visits;
  gv_ = visited.gv;
}

Visit::~Visit() {
  if (gv_ == nullptr) return;
  ProgramState& state = TheProgramState();
  const std::lock_guard lock(state.mutex);
  if (--state.domains[domain_].visits == 0) state.left.notify_all();
}

void BeginEnd(std::uint32_t id, bool waits) {
  ProgramState& state = TheProgramState();
  std::unique_lock lock(state.mutex);
  Domain& domain = state.domains[id];
  ++domain.ends;
  if (waits) state.left.wait(lock, [&domain] { return domain.visits == 0; });
}

bool IsEnding(std::uint32_t domain) {
  ProgramState& state = TheProgramState();
  const std::lock_guard lock(state.mutex);
  return state.domains[domain].ends > 0;
}

void OverEnd(std::uint32_t domain) {
  ProgramState& state = TheProgramState();
  const std::lock_guard lock(state.mutex);
  --state.domains[domain].ends;
}

std::vector<std::uint32_t> DomainsCalled(std::uint32_t network_domain) {
  ProgramState& state = TheProgramState();
  const std::lock_guard lock(state.mutex);
  return LockedDomainsCalled(state, network_domain);
}

bool MeetsItself(std::uint32_t network_domain) {
  ProgramState& state = TheProgramState();
  const std::lock_guard lock(state.mutex);
  return state.met.contains(network_domain);
}

void AddParticipant(ddsi_domaingv* gv, const Guid& guid) {
  ProgramState& state = TheProgramState();
  const std::lock_guard lock(state.mutex);
  Domain& domain = state.domains[gv->config.domainId];
  domain.gv = gv;
  domain.name = NetworkDomain(*gv);
  domain.participants.push_back(guid);
  if (LockedDomainsCalled(state, domain.name).size() > 1) state.met.insert(domain.name);
}

void RemoveParticipant(ddsi_domaingv* gv, const Guid& guid) {
  ProgramState& state = TheProgramState();
  const std::lock_guard lock(state.mutex);
  Domain& domain = state.domains[gv->config.domainId];
  std::erase(domain.participants, guid);
  domain.past_participants.insert(guid);
}

bool IsParticipant(const ddsi_domaingv* gv, const Guid& guid) {
  ProgramState& state = TheProgramState();
  const std::lock_guard lock(state.mutex);
  const auto found = state.domains.find(gv->config.domainId);
  return found != state.domains.end() && std::ranges::count(found->second.participants, guid) != 0;
}

bool IsOrWasParticipant(const ddsi_domaingv* gv, const Guid& guid) {
  ProgramState& state = TheProgramState();
  const std::lock_guard lock(state.mutex);
  const Domain& domain = state.domains[gv->config.domainId];
  return std::ranges::count(domain.participants, guid) != 0 ||
         domain.past_participants.contains(guid);
}

bool IsLastParticipant(const Guid& guid) {
  ProgramState& state = TheProgramState();
  const std::lock_guard lock(state.mutex);
  return std::any_of(state.domains.begin(), state.domains.end(), [&guid](const auto& domain) {
    return domain.second.participants == std::vector{guid};
  });
}

std::vector<std::uint32_t> Domains() {
  ProgramState& state = TheProgramState();
  const std::lock_guard lock(state.mutex);
  std::vector<std::uint32_t> ids;
  for (const auto& [id, domain] : state.domains) {
    if (!domain.participants.empty()) ids.push_back(id);
  }
  return ids;
}

void AddType(std::uint32_t domain, const char* topic, const ddsi_sertype* type) {
  ProgramState& state = TheProgramState();
  const std::lock_guard lock(state.mutex);
  ddsi_sertype*& held = state.domains[domain].types[{topic, type->type_name}];
  if (held == nullptr) held = ddsi_sertype_ref(type);
}

ddsi_sertype* ReferType(std::uint32_t domain, const std::string& topic, const std::string& type) {
  ProgramState& state = TheProgramState();
  const std::lock_guard lock(state.mutex);
  const auto& types = state.domains[domain].types;
  const auto found = types.find({topic, type});
  return found == types.end() ? nullptr : ddsi_sertype_ref(found->second);
}

void ReleaseTypes(std::uint32_t domain) {
  ProgramState& state = TheProgramState();
  std::map<std::pair<std::string, std::string>, ddsi_sertype*> types;
  {
    const std::lock_guard lock(state.mutex);
    types.swap(state.domains[domain].types);
  }
  for (const auto& [name, type] : types) ddsi_sertype_unref(type);
}

bool HasTopic(std::uint32_t domain, const std::string& topic) {
  ProgramState& state = TheProgramState();
  const std::lock_guard lock(state.mutex);
  const auto& types = state.domains[domain].types;
  const auto first = types.lower_bound({topic, ""});
  return first != types.end() && first->first.first == topic;
}

bool LookAround() {
  ProgramState& state = TheProgramState();
  const std::lock_guard lock(state.mutex);
  return !std::exchange(state.looks_around, true);
}

bool LooksAround() {
  ProgramState& state = TheProgramState();
  const std::lock_guard lock(state.mutex);
  return state.looks_around;
}

bool AddWriter(const ddsi_writer& writer) {
  ProgramState& state = TheProgramState();
  const std::lock_guard lock(state.mutex);
  const auto [place, is_new] = state.writers.try_emplace(GuidOf(writer.e.guid));
  if (!is_new) return false;
  place->second.domain = writer.e.gv->config.domainId;
  place->second.topic = writer.xqos->topic_name;
  place->second.is_reliable = writer.xqos->reliability.kind == DDS_RELIABILITY_RELIABLE;
  place->second.blocks_ns = writer.xqos->reliability.max_blocking_time;
  if (writer.xqos->history.kind == DDS_HISTORY_KEEP_LAST) {
    place->second.keeps_last = static_cast<std::uint32_t>(writer.xqos->history.depth);
  }
  place->second.has_history = writer.xqos->durability.kind >= DDS_DURABILITY_TRANSIENT_LOCAL;
  return true;
}

void RemoveWriter(const ddsi_domaingv* gv, const Guid& guid) {
  ProgramState& state = TheProgramState();
  Writer writer;
  {
    const std::lock_guard lock(state.mutex);
    const auto found = state.writers.find(guid);
    if (found == state.writers.end() || found->second.domain != gv->config.domainId) return;
    writer = std::move(found->second);
    state.writers.erase(found);
  }
  Forget(writer, gv);
}

bool IsWriter(const ddsi_domaingv* gv, const Guid& guid) {
  ProgramState& state = TheProgramState();
  const std::lock_guard lock(state.mutex);
  const auto found = state.writers.find(guid);
  return found != state.writers.end() && found->second.domain == gv->config.domainId;
}

std::vector<Guid> WritersOf(std::uint32_t domain, const std::string& topic) {
  ProgramState& state = TheProgramState();
  const std::lock_guard lock(state.mutex);
  return LockedWritersOf(state, domain, topic, false);
}

std::optional<std::int64_t> MostBlocking(const Guid& guid) {
  ProgramState& state = TheProgramState();
  const std::lock_guard lock(state.mutex);
  const auto found = state.writers.find(guid);
  if (found == state.writers.end()) return std::nullopt;
  const Writer& writer = found->second;
  if (!writer.is_reliable || writer.keeps_last > 0) return std::nullopt;
  return writer.blocks_ns;
}

namespace {

bool IsReadReliably(const ProgramState& state, const Writer& writer, std::uint32_t process) {
  return std::ranges::any_of(state.taps, [&](const Tap* tap) {
    return tap->process == process && tap->is_reliable && tap->domain == writer.domain &&
           tap->topic == writer.topic;
  });
}

bool LockedHasPromised(const ProgramState& state, Writer& writer, std::uint32_t process) {
  if (!writer.is_reliable) return false;
  Promise& promise = writer.promises[process];
  if (promise.taps_version != state.taps_version) {
    promise = {state.taps_version, IsReadReliably(state, writer, process)};
  }
  return promise.is_made;
}

}  // namespace

std::vector<std::uint32_t> PromisedProcesses(const Guid& guid) {
  ProgramState& state = TheProgramState();
  const std::lock_guard lock(state.mutex);
  std::vector<std::uint32_t> processes;
  const auto found = state.writers.find(guid);
  if (found == state.writers.end()) return processes;
  for (const auto& [process, shipped] : found->second.shipped) {
    if (LockedHasPromised(state, found->second, process)) processes.push_back(process);
  }
  return processes;
}

namespace {

// `*unneeded`: to be unreferred to without the lock, since that may run a serdata's own code.
Carries LockedCarriesSample(ProgramState& state, const ddsi_guid_t& writer_guid, const Tap& tap,
                            ddsi_serdata* sample, ddsi_tkmap_instance* instance,
                            ddsi_serdata** unneeded, WriterKeeps* keeps) {
  const auto found = state.writers.find(GuidOf(writer_guid));
  if (found == state.writers.end() || found->second.domain != tap.domain) {
    const bool is_shadow = state.shadows.contains({tap.domain, PrefixOf(writer_guid)});
    return is_shadow ? Carries::kNo : Carries::kUnknownWriter;
  }
  Writer& writer = found->second;
  *keeps = {writer.keeps_last, LockedHasPromised(state, writer, tap.process)};
  Shipped& shipped = writer.shipped[tap.process];
  if (shipped.by != &tap && shipped.sample != nullptr && IsSameSample(shipped.sample, sample)) {
    return Carries::kNo;
  }
  *unneeded = shipped.sample;
  shipped = {ddsi_serdata_ref(sample), &tap};

  if ((sample->statusinfo & NN_STATUSINFO_UNREGISTER) != 0) {
    if (const auto held = writer.instances.find(instance->m_iid); held != writer.instances.end()) {
      ddsi_tkmap_instance_unref(tap.gv->m_tkmap, held->second);
      writer.instances.erase(held);
    }
  } else if (writer.instances.size() < kMostInstances &&
             writer.instances.try_emplace(instance->m_iid, instance).second) {
    ddsi_tkmap_instance_ref(instance);
  }
  return Carries::kYes;
}

}  // namespace

Carries CarriesSample(const ddsi_guid_t& writer, const Tap& tap, ddsi_serdata* sample,
                      ddsi_tkmap_instance* instance, WriterKeeps* keeps) {
  ProgramState& state = TheProgramState();
  ddsi_serdata* unneeded = nullptr;
  Carries carries;
  {
    const std::lock_guard lock(state.mutex);
    carries = LockedCarriesSample(state, writer, tap, sample, instance, &unneeded, keeps);
  }
  if (unneeded != nullptr) ddsi_serdata_unref(unneeded);
  return carries;
}

void AddReader(const ddsi_reader& reader) {
  ProgramState& state = TheProgramState();
  const std::lock_guard lock(state.mutex);
  state.readers[GuidOf(reader.e.guid)] = {reader.e.gv->config.domainId, reader.xqos->topic_name};
}

bool RemoveReader(const ddsi_domaingv* gv, const Guid& guid) {
  ProgramState& state = TheProgramState();
  const std::lock_guard lock(state.mutex);
  const auto found = state.readers.find(guid);
  if (found == state.readers.end() || found->second.domain != gv->config.domainId) return false;
  state.readers.erase(found);
  return true;
}

std::vector<Guid> ReadersOf(std::uint32_t domain, const std::string& topic) {
  ProgramState& state = TheProgramState();
  const std::lock_guard lock(state.mutex);
  std::vector<Guid> guids;
  for (const auto& [guid, reader] : state.readers) {
    if (reader.domain == domain && reader.topic == topic) guids.push_back(guid);
  }
  return guids;
}

void AddTap(const Tap* tap) {
  ProgramState& state = TheProgramState();
  const std::lock_guard lock(state.mutex);
  state.taps.push_back(tap);
  ++state.taps_version;
}

void RemoveTap(const Tap* tap) {
  ProgramState& state = TheProgramState();
  const std::lock_guard lock(state.mutex);
  std::erase(state.taps, tap);
  ++state.taps_version;
}

std::vector<LateReader> ReadersThatCatchUp(std::uint32_t domain, const std::string& topic) {
  ProgramState& state = TheProgramState();
  const std::lock_guard lock(state.mutex);
  std::vector<LateReader> readers;
  for (const Tap* tap : state.taps) {
    if (tap->catches_up && tap->is_complete && tap->domain == domain && tap->topic == topic) {
      readers.push_back({tap->reader, tap->process});
    }
  }
  return readers;
}

std::vector<Guid> CompleteTap(Tap& tap) {
  ProgramState& state = TheProgramState();
  const std::lock_guard lock(state.mutex);
  tap.is_complete = true;
  return LockedWritersOf(state, tap.domain, tap.topic, true);
}

}  // namespace tcs::dds
