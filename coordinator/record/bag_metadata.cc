#include "coordinator/record/bag_metadata.h"

#include <yaml-cpp/yaml.h>

#include <optional>

namespace tcs::record {
namespace {

using YAML::BeginMap;
using YAML::BeginSeq;
using YAML::EndMap;
using YAML::EndSeq;
using YAML::Key;
using YAML::Value;

constexpr std::int64_t kSecond_ns = 1'000'000'000;

// The numbers of rmw's enumerations; 0 is "the system's default" in each.
int NumberOf(dds::History history) { return history == dds::History::kKeepLast ? 1 : 2; }

int NumberOf(dds::Reliability reliability) {
  return reliability == dds::Reliability::kReliable ? 1 : 2;
}

int NumberOf(dds::Durability durability) {
  return durability == dds::Durability::kTransientLocal ? 1 : 2;
}

int NumberOf(dds::Liveliness liveliness) {
  switch (liveliness) {
    case dds::Liveliness::kManualByParticipant:
      return 2;
    case dds::Liveliness::kManualByTopic:
      return 3;
    default:
      return 1;
  }
}

void EmitDuration(YAML::Emitter& out, const char* key, const std::optional<VirtualDuration>& d) {
  // rmw's infinity: the most nanoseconds that 64 bits hold.
  const std::int64_t ns = d ? d->ns() : INT64_MAX;
  out << Key << key << Value << BeginMap << Key << "sec" << Value << ns / kSecond_ns << Key
      << "nsec" << Value << ns % kSecond_ns << EndMap;
}

void EmitNumber(YAML::Emitter& out, const char* key, const char* unit, std::int64_t number) {
  out << Key << key << Value << BeginMap << Key << unit << Value << number << EndMap;
}

void EmitTimes(YAML::Emitter& out, const BagMetadata& metadata) {
  EmitNumber(out, "duration", "nanoseconds", metadata.last_ns - metadata.first_ns);
  EmitNumber(out, "starting_time", "nanoseconds_since_epoch", metadata.first_ns);
}

void EmitTopic(YAML::Emitter& out, const BagTopic& topic) {
  out << BeginMap << Key << "topic_metadata" << Value << BeginMap;
  out << Key << "name" << Value << topic.name;
  out << Key << "type" << Value << topic.type;
  out << Key << "serialization_format" << Value << "cdr";
  out << Key << "offered_qos_profiles" << Value << YAML::DoubleQuoted
      << OfferedQosYaml(topic.offered);
  out << EndMap << Key << "message_count" << Value << topic.messages << EndMap;
}

void Emit(YAML::Emitter& out, const BagMetadata& metadata) {
  out << BeginMap;
  out << Key << "version" << Value << kMetadataVersion;
  out << Key << "storage_identifier" << Value << metadata.storage;
  EmitTimes(out, metadata);
  out << Key << "message_count" << Value << metadata.messages;
  out << Key << "topics_with_message_count" << Value << BeginSeq;
  for (const BagTopic& topic : metadata.topics) EmitTopic(out, topic);
  out << EndSeq;
  out << Key << "compression_format" << Value << YAML::DoubleQuoted << "";
  out << Key << "compression_mode" << Value << YAML::DoubleQuoted << "";
  out << Key << "relative_file_paths" << Value << BeginSeq << metadata.file << EndSeq;
  out << Key << "files" << Value << BeginSeq << BeginMap;
  out << Key << "path" << Value << metadata.file;
  EmitTimes(out, metadata);
  out << Key << "message_count" << Value << metadata.messages;
  out << EndMap << EndSeq << EndMap;
}

}  // namespace

std::string OfferedQosYaml(std::span<const dds::Qos> offered) {
  if (offered.empty()) return "";
  YAML::Emitter out;
  out << BeginSeq;
  for (const dds::Qos& qos : offered) {
    out << BeginMap;
    out << Key << "history" << Value << NumberOf(qos.history);
    out << Key << "depth" << Value << (qos.history == dds::History::kKeepLast ? qos.depth : 0);
    out << Key << "reliability" << Value << NumberOf(qos.reliability);
    out << Key << "durability" << Value << NumberOf(qos.durability);
    EmitDuration(out, "deadline", qos.deadline);
    EmitDuration(out, "lifespan", qos.lifespan);
    out << Key << "liveliness" << Value << NumberOf(qos.liveliness);
    EmitDuration(out, "liveliness_lease_duration", qos.lease);
    out << Key << "avoid_ros_namespace_conventions" << Value << false;
    out << EndMap;
  }
  out << EndSeq;
  return out.c_str();
}

std::string MetadataYaml(const BagMetadata& metadata) {
  YAML::Emitter out;
  Emit(out, metadata);
  return out.c_str();
}

std::string MetadataFile(const BagMetadata& metadata) {
  YAML::Emitter out;
  out << BeginMap << Key << "rosbag2_bagfile_information" << Value;
  Emit(out, metadata);
  out << EndMap;
  return std::string(out.c_str()) + "\n";
}

}  // namespace tcs::record
