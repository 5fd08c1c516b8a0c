#include "libtcs_preload/dds/tap.h"

#include <algorithm>

#include "libtcs_preload/dds/announce.h"
#include "libtcs_preload/dds/other_type.h"
#include "libtcs_preload/dds/outgoing.h"
#include "libtcs_preload/dds/program.h"

namespace tcs::dds {
namespace {

thread_local const Tap* t_making;

// As many as threads can be writing at a time, and more.
constexpr std::size_t kMostHad = 64;

Tap& TapOf(ddsi_rhc* rhc) { return *reinterpret_cast<Tap*>(rhc); }

// The treatment of a sample that a tap carries for all readers of its process, where too many wait.
struct Carried {
  WriterKeeps keeps;
  std::uint64_t instance;
};

// Ships the sample to the tap's reader alone unless the sample is carried for all.
void Ship(const Tap& tap, const ddsi_guid_t& writer, const ddsi_serdata& sample,
          const Carried* carried) {
  shm::DdsMessage message =
      MessageOf(shm::DdsKind::kSample, NetworkDomain(*tap.gv), GuidOf(writer));
  message.to = tap.process;
  if (carried == nullptr) {
    PutGuid(tap.reader, message.other);
  } else {
    message.keep_last = carried->keeps.last;
    message.instance = carried->instance;
    if (!carried->keeps.promised) message.flags |= shm::kDdsUnreliable;
  }
  message.source_timestamp_ns = sample.timestamp.v;
  message.status_info = sample.statusinfo;
  message.sample_kind = sample.kind;
  SendSample(*tap.gv, message, sample, tap.topic);
}

bool HasHad(const Tap& tap, const ddsi_serdata* sample) {
  return std::ranges::any_of(
      tap.had, [sample](const ddsi_serdata* had) { return IsSameSample(had, sample); });
}

// A sample that Cyclone has made of another type does not have the time.
bool WasBeforeLoss(const Tap& tap, const ddsi_serdata& sample) {
  return sample.twrite.v != INT64_MIN && sample.twrite.v <= tap.lost_at_ns;
}

// Ships the sample to the tap's reader alone, unless the reader has had it.
void ShipAlone(Tap& tap, const ddsi_guid_t& writer, ddsi_serdata* sample) {
  if (WasBeforeLoss(tap, *sample) || HasHad(tap, sample)) return;
  tap.had.push_back(ddsi_serdata_ref(sample));
  if (tap.had.size() > kMostHad) {
    ddsi_serdata_unref(tap.had.front());
    tap.had.pop_front();
  }
  Ship(tap, writer, *sample, nullptr);
}

// The program's listener may write while its writer is still being made: others have to know the
// writer first.
bool Announced(const Tap& tap, const ddsi_guid_t& guid) {
  const ddsi_writer* writer = entidx_lookup_writer_guid(tap.gv->entity_index, &guid);
  if (writer == nullptr) return false;
  AnnounceWriter(*writer);
  return true;
}

// While this object lives, the instance that a sample is of for its writer: a tap of another type
// does not know keys.
class InstanceOfWriter {
 public:
  InstanceOfWriter(const Tap& tap, const ddsi_guid_t& guid, ddsi_serdata* sample,
                   ddsi_tkmap_instance* instance)
      : map_(tap.gv->m_tkmap), instance_(instance) {
    if (!IsOfOtherType(sample)) return;
    const ddsi_writer* writer = entidx_lookup_writer_guid(tap.gv->entity_index, &guid);
    if (writer == nullptr || IsShadow(tap.gv, guid)) return;
    ddsi_serdata* as_written = ddsi_serdata_ref_as_type(writer->type, sample);
    if (as_written == nullptr) return;
    held_ = ddsi_tkmap_lookup_instance_ref(map_, as_written);
    ddsi_serdata_unref(as_written);
    if (held_ != nullptr) instance_ = held_;
  }
  ~InstanceOfWriter() {
    if (held_ != nullptr) ddsi_tkmap_instance_unref(map_, held_);
  }
  InstanceOfWriter(const InstanceOfWriter&) = delete;
  InstanceOfWriter& operator=(const InstanceOfWriter&) = delete;
  ddsi_tkmap_instance* get() const { return instance_; }

 private:
  ddsi_tkmap* map_;
  ddsi_tkmap_instance* instance_;
  ddsi_tkmap_instance* held_ = nullptr;
};

bool StoreTapped(ddsi_rhc* rhc, const ddsi_writer_info* info, ddsi_serdata* sample,
                 ddsi_tkmap_instance* instance) {
  Tap& tap = TapOf(rhc);
  std::unique_lock lock(tap.mutex, std::defer_lock);
  if (tap.catches_up) lock.lock();
  if (t_making == &tap) {
    if (tap.catches_up && !IsShadow(tap.gv, info->guid)) ShipAlone(tap, info->guid, sample);
    return true;
  }
  if (!tap.catching_up && HasHad(tap, sample)) return true;
  const InstanceOfWriter of(tap, info->guid, sample, instance);
  Carried carried{{}, of.get()->m_iid};
  Carries carries = CarriesSample(info->guid, tap, sample, of.get(), &carried.keeps);
  if (carries == Carries::kUnknownWriter && Announced(tap, info->guid)) {
    carries = CarriesSample(info->guid, tap, sample, of.get(), &carried.keeps);
  }
  if (carries == Carries::kYes) Ship(tap, info->guid, *sample, &carried);
  if (tap.catching_up && carries != Carries::kUnknownWriter && !IsShadow(tap.gv, info->guid)) {
    ShipAlone(tap, info->guid, sample);
  }
  return true;
}

void UnregisterWriter(ddsi_rhc*, const ddsi_writer_info*) {}
void RelinquishOwnership(ddsi_rhc*, const std::uint64_t) {}
void SetQos(ddsi_rhc*, const dds_qos_t*) {}

void FreeTap(ddsi_rhc* rhc) {
  Tap* tap = &TapOf(rhc);
  RemoveTap(tap);
  for (ddsi_serdata* sample : tap->had) ddsi_serdata_unref(sample);
  delete tap;
}

std::int32_t ReadNothing(dds_rhc*, bool, void**, dds_sample_info_t*, std::uint32_t, std::uint32_t,
                         dds_instance_handle_t, dds_readcond*) {
  return 0;
}
std::int32_t ReadNoCdr(dds_rhc*, bool, ddsi_serdata**, dds_sample_info_t*, std::uint32_t,
                       std::uint32_t, std::uint32_t, std::uint32_t, dds_instance_handle_t) {
  return 0;
}
bool AddCondition(dds_rhc*, dds_readcond*) { return true; }
void RemoveCondition(dds_rhc*, dds_readcond*) {}
std::uint32_t LockSamples(dds_rhc*) { return 0; }
dds_return_t Associate(dds_rhc*, dds_reader*, const ddsi_sertype*, ddsi_tkmap*) {
  return DDS_RETCODE_OK;
}

constexpr dds_rhc_ops kOperations = {
    {StoreTapped, UnregisterWriter, RelinquishOwnership, SetQos, FreeTap},
    ReadNothing,
    ReadNothing,
    ReadNoCdr,
    ReadNoCdr,
    AddCondition,
    RemoveCondition,
    LockSamples,
    Associate};

}  // namespace

Tap* NewTap(ddsi_domaingv* gv, std::uint32_t domain, std::uint32_t process, const Guid& reader,
            const std::string& topic, bool is_reliable, bool catches_up) {
  Tap* tap =
      new Tap{{}, gv, domain, process, reader, topic, is_reliable, catches_up, false, catches_up};
  tap->rhc.common.ops = &kOperations;
  AddTap(tap);
  return tap;
}

MakingTap::MakingTap(const Tap* tap) { t_making = tap; }
MakingTap::~MakingTap() { t_making = nullptr; }

void EndCatchUp(Tap& tap) {
  const std::lock_guard lock(tap.mutex);
  for (const Guid& writer : CompleteTap(tap)) {
    SendHistoryEnd(*tap.gv, writer, tap.reader, tap.process);
  }
  tap.catching_up = false;
}

void SendHistoryEnd(const ddsi_domaingv& gv, const Guid& writer, const Guid& reader,
                    std::uint32_t process) {
  shm::DdsMessage message = MessageOf(shm::DdsKind::kHistoryEnd, NetworkDomain(gv), writer);
  message.to = process;
  PutGuid(reader, message.other);
  Send(gv, message, {});
}

}  // namespace tcs::dds
