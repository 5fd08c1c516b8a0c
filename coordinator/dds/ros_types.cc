#include "coordinator/dds/ros_types.h"

namespace tcs::dds {

void SetText(char** field, std::string_view text) {
  TCS_CHECK(*field == nullptr);
  *field = static_cast<char*>(dds_alloc(text.size() + 1));
  text.copy(*field, text.size());
  (*field)[text.size()] = '\0';
}

}  // namespace tcs::dds
