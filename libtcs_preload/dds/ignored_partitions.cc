#include "libtcs_preload/dds/ignored_partitions.h"

#include <string>

namespace tcs::dds {
namespace {

bool IsEmptyOrAll(const char* pattern) {
  return pattern[0] == '\0' || (pattern[0] == '*' && pattern[1] == '\0');
}

// Whether a text may suit both patterns, as Cyclone sees it: Cyclone's own function for that is not
// exported.
bool Overlap(const char* a, const char* b) {
  if (IsEmptyOrAll(a) && IsEmptyOrAll(b)) return true;
  if (*a == '\0' || *b == '\0') return false;
  if ((*a == '*' || *b == '*') && (Overlap(a, b + 1) || Overlap(a + 1, b))) return true;
  return (*a == '?' || *b == '?' || *a == *b) && Overlap(a + 1, b + 1);
}

bool IsIgnoredIn(const ddsi_config& config, const std::string& partition, const char* topic) {
  const std::string both = partition + "." + topic;
  for (const auto* ignored = config.ignoredPartitions; ignored != nullptr;
       ignored = ignored->next) {
    if (Overlap(both.c_str(), ignored->DCPSPartitionTopic)) return true;
  }
  return false;
}

}  // namespace

bool IsIgnored(const ddsi_config& config, const char* topic, const dds_qos_t& qos) {
  if (config.ignoredPartitions == nullptr) return false;
  if ((qos.present & QP_PARTITION) == 0 || qos.partition.n == 0) {
    return IsIgnoredIn(config, "", topic);
  }
  for (std::uint32_t i = 0; i < qos.partition.n; ++i) {
    if (IsIgnoredIn(config, qos.partition.strs[i], topic)) return true;
  }
  return false;
}

}  // namespace tcs::dds
