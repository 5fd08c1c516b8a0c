// A type that no IDL compiler made: a keyed C++ struct with a serialization of its own, put into
// Cyclone by dds_create_topic_sertype, as language bindings and ROS 2's middleware do.
#pragma once

#include <dds/dds.h>

#include <cstdint>
#include <string>

namespace dds_test {

struct Word {
  std::int32_t id = 0;  // the key
  std::string text;
};

dds_entity_t CreateWordTopic(dds_entity_t participant, const char* name);

}  // namespace dds_test
