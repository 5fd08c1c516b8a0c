// A participant, topic, reader, … of DDS: Cyclone's handle, deleted with its owner.
#pragma once

#include <string>

#include "dds/dds.h"

namespace predator_prey {

// Returns `result`, or throws std::runtime_error "cannot WHAT: Cyclone's reason" if it is an error.
dds_return_t CheckDds(dds_return_t result, const std::string& what);

class DdsEntity {
 public:
  // Takes what a dds_create_… function returned; throws as CheckDds does.
  DdsEntity(dds_entity_t created, const std::string& what) : handle_(CheckDds(created, what)) {}
  ~DdsEntity() {
    if (handle_ > 0) dds_delete(handle_);
  }
  DdsEntity(DdsEntity&& other) noexcept : handle_(other.handle_) { other.handle_ = 0; }
  DdsEntity& operator=(DdsEntity&&) = delete;

  dds_entity_t handle() const { return handle_; }

 private:
  dds_entity_t handle_;
};

}  // namespace predator_prey
