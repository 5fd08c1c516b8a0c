// The program's participants, topics and endpoints, as the hooks see them come and go.
//
// The endpoints of other processes are mirrored by *shadows* in this process (mirrors.h), which
// Cyclone takes for the program's own. Shadows pass through the same hooks and are told apart by
// their participant.
//
// Thread-safe, by a lock that is held for look-ups only: everything here may be called from inside
// Cyclone.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "libtcs_preload/dds/guid.h"

namespace tcs::dds {

struct Tap;

// Domains are told apart by the program's own numbers. The name of a domain outside, in messages,
// is NetworkDomain: several domains of one program may have one name, and then meet as if they were
// several programs'; each has shadows of what the others have.
std::uint32_t NetworkDomain(const ddsi_domaingv& gv);

// Shadow participants, by the first part of their GUIDs.
void AddShadow(std::uint32_t domain, const Guid& participant);
void RemoveShadow(std::uint32_t domain, const Guid& participant);
bool IsShadow(const ddsi_domaingv* gv, const ddsi_guid_t& entity);
bool IsShadow(std::uint32_t domain, const ddsi_guid_t& entity);
// The endpoints of shadow participants.
void AddShadowEndpoint(std::uint32_t domain, const char* topic, const Guid& guid);
void RemoveShadowEndpoint(std::uint32_t domain, const Guid& guid);
std::vector<Guid> ShadowEndpointsOf(std::uint32_t domain, const std::string& topic);

// Domains, those in which the program has participants.
bool HasDomain(std::uint32_t domain);
std::vector<std::uint32_t> DomainsCalled(std::uint32_t network_domain);
std::vector<std::uint32_t> Domains();
// Whether the program has several domains of that name, or has had: then what it told itself of has
// to be taken back, too.
bool MeetsItself(std::uint32_t network_domain);
void AddParticipant(ddsi_domaingv* gv, const Guid& guid);
void RemoveParticipant(ddsi_domaingv* gv, const Guid& guid);
bool IsParticipant(const ddsi_domaingv* gv, const Guid& guid);
// True if the participant is the program's, or was, in this domain: no shadow there is to stand for
// it. A participant that is being deleted is in Cyclone's tables for longer than it is here, and
// GUIDs do not come back.
bool IsOrWasParticipant(const ddsi_domaingv* gv, const Guid& guid);
bool IsLastParticipant(const Guid& guid);

// While this object lives, a thread, mostly the deliverer, is in a domain, which stays: a thread
// that is about to end the domain waits (BeginEnd).
class Visit {
 public:
  explicit Visit(std::uint32_t domain);
  ~Visit();
  Visit(const Visit&) = delete;
  Visit& operator=(const Visit&) = delete;

  // Null: the program has no participant there, or the domain is about to end.
  ddsi_domaingv* gv() const { return gv_; }

 private:
  std::uint32_t domain_;
  ddsi_domaingv* gv_;
};

// A domain is about to be taken down, or to lose its last participant: no thread visits the domain
// any more. `waits`: returns when all visitors have left. Until OverEnd, as often.
void BeginEnd(std::uint32_t domain, bool waits);
bool IsEnding(std::uint32_t domain);
void OverEnd(std::uint32_t domain);

// The types of the domain's topics. A type is held until the domain's last participant is about to
// go: Cyclone aborts if it is held any longer.
void AddType(std::uint32_t domain, const char* topic, const ddsi_sertype* type);
ddsi_sertype* ReferType(std::uint32_t domain, const std::string& topic, const std::string& type);
void ReleaseTypes(std::uint32_t domain);
bool HasTopic(std::uint32_t domain, const std::string& topic);

// The program has looked at what there is in domains, beyond its own topics: from now on it has
// shadows of everything. False: the program did already.
bool LookAround();
bool LooksAround();

// Writers. False: known already.
bool AddWriter(const ddsi_writer& writer);
void RemoveWriter(const ddsi_domaingv* gv, const Guid& guid);
bool IsWriter(const ddsi_domaingv* gv, const Guid& guid);
std::vector<Guid> WritersOf(std::uint32_t domain, const std::string& topic);

// Whether `tap` is the one to ship `sample` to its process: of several shadow readers of one
// process the first that sees the sample. Keeps the sample's instance alive, since Cyclone would
// otherwise make and collect one for each write. kUnknownWriter: the writer is unknown, and to be
// announced first.
enum class Carries { kNo, kYes, kUnknownWriter };
struct WriterKeeps {
  std::uint32_t last = 0;  // samples kept of an instance until they are taken; 0: all
  bool promised = false;   // to a reader of that process: writer and reader are reliable
};
Carries CarriesSample(const ddsi_guid_t& writer, const Tap& tap, ddsi_serdata* sample,
                      ddsi_tkmap_instance* instance, WriterKeeps* keeps);

// How long a write of the program's may wait for readers that cannot keep up; none if the write
// never waits, as with a writer that keeps only the last samples.
std::optional<std::int64_t> MostBlocking(const Guid& writer);
// The processes with readers that the writer's samples have been promised to.
std::vector<std::uint32_t> PromisedProcesses(const Guid& writer);

// Readers.
void AddReader(const ddsi_reader& reader);
bool RemoveReader(const ddsi_domaingv* gv, const Guid& guid);
std::vector<Guid> ReadersOf(std::uint32_t domain, const std::string& topic);

// The shadow readers to which writers of the program owe their history's end.
void AddTap(const Tap* tap);
void RemoveTap(const Tap* tap);
struct LateReader {
  Guid guid{};
  std::uint32_t process;
};
// The readers whose shadow reader is complete; the others are told of a new writer when their
// shadow reader is.
std::vector<LateReader> ReadersThatCatchUp(std::uint32_t domain, const std::string& topic);
// The shadow reader is complete: the transient-local writers that it has met. In one step, so that
// a writer that is made meanwhile is told of by the one or by the other.
std::vector<Guid> CompleteTap(Tap& tap);

}  // namespace tcs::dds
