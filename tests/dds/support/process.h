// One of the two processes of a scenario, and how a scenario is written:
//
//   void Writer(Process& self) { ... }
//   void Reader(Process& self) { ... }
//   TCS_DDS_SCENARIO(late_reader, Writer, Reader);
#pragma once

#include <dds/dds.h>

#include <string>

#include "sample.h"
#include "tests/dds/support/events.h"
#include "tests/dds/support/peer.h"
#include "tests/dds/support/qos.h"

namespace dds_test {

enum class Role { kWriter, kReader };

// What carries the samples, which decides how exact the times are.
enum class Under { kNative, kSockets, kEndpoints };

struct Process {
  dds_domainid_t domain;
  dds_entity_t participant;
  Peer& peer;
  Under under;

  // One more participant, in the scenario's domain or in one beside it.
  dds_entity_t Participant(dds_domainid_t beside = 0) const;
  // Makes the domain beside the scenario's, with this in its configuration.
  dds_entity_t DomainBeside(const std::string& settings) const;
  // Goes over to the domain beside the scenario's, with a lease of so long (Cyclone's form: "2s")
  // rather than ten seconds.
  void UseShortLease(const std::string& lease);
  // Topics of a scenario are told apart by a letter.
  dds_entity_t Topic(const char* name = "a",
                     const dds_topic_descriptor_t* type = &dds_test_Sample_desc) const;
  dds_entity_t Writer(dds_entity_t topic, const Qos& qos = Plain()) const;
  dds_entity_t Reader(dds_entity_t topic, const Qos& qos = Plain()) const;
};

// Whether the processes end as they should, or one of them kills itself or goes as it is.
enum class End { kOrderly, kWriterKilled, kReaderKilled, kWriterExits };

struct Scenario {
  Scenario(const char* scenario_name, void (*writer)(Process&), void (*reader)(Process&),
           End how_it_ends = End::kOrderly);

  const char* name;
  void (*writer_role)(Process&);
  void (*reader_role)(Process&);
  End end;
  const Scenario* next;
};

// Null if there is none of that name.
const Scenario* FindScenario(const char* name);

#define TCS_DDS_SCENARIO(name, ...) const ::dds_test::Scenario scenario_##name(#name, __VA_ARGS__)

}  // namespace dds_test
