#include "tests/dds/support/process.h"

#include <string.h>

namespace dds_test {

namespace {
const Scenario* g_scenarios = nullptr;
}

Scenario::Scenario(const char* scenario_name, void (*writer)(Process&), void (*reader)(Process&),
                   End how_it_ends)
    : name(scenario_name),
      writer_role(writer),
      reader_role(reader),
      end(how_it_ends),
      next(g_scenarios) {
  g_scenarios = this;
}

const Scenario* FindScenario(const char* name) {
  const Scenario* scenario = g_scenarios;
  while (scenario != nullptr && strcmp(scenario->name, name) != 0) scenario = scenario->next;
  return scenario;
}

dds_entity_t Process::Participant(dds_domainid_t beside) const {
  return OK(dds_create_participant(domain + beside, nullptr, nullptr));
}

dds_entity_t Process::DomainBeside(const std::string& settings) const {
  const std::string configuration =
      "<CycloneDDS><Domain><General><Interfaces>"
      "<NetworkInterface name=\"lo\" multicast=\"true\"/></Interfaces></General>" +
      settings + "</Domain></CycloneDDS>";
  return OK(dds_create_domain(domain + 1, configuration.c_str()));
}

void Process::UseShortLease(const std::string& lease) {
  DomainBeside("<Discovery><LeaseDuration>" + lease + "</LeaseDuration></Discovery>");
  participant = Participant(1);
}

dds_entity_t Process::Topic(const char* name, const dds_topic_descriptor_t* type) const {
  return OK(dds_create_topic(participant, type, name, nullptr, nullptr));
}

dds_entity_t Process::Writer(dds_entity_t topic, const Qos& qos) const {
  return OK(dds_create_writer(participant, topic, qos.get(), nullptr));
}

dds_entity_t Process::Reader(dds_entity_t topic, const Qos& qos) const {
  return OK(dds_create_reader(participant, topic, qos.get(), nullptr));
}

}  // namespace dds_test
