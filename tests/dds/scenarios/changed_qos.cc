// A writer changes its user data: the matched reader sees what it is now, and refuses are errors.
#include <string>

#include "tests/dds/support/process.h"
#include "tests/dds/support/samples.h"

namespace {

using namespace dds_test;

void Writer(Process& self) {
  const dds_entity_t writer = self.Writer(self.Topic(), Plain().UserData("before"));
  WaitForReaders(writer, 1);
  self.peer.Meet("matched");
  self.peer.Await("before told");
  Event("user data: %s", Code(dds_set_qos(writer, Qos().UserData("after").get())));
  Event("durability: %s", Code(dds_set_qos(writer, Qos().TransientLocal().get())));
  Write(writer, 1, 1);
}

std::string UserDataOfWriter(dds_entity_t reader) {
  dds_instance_handle_t handle;
  if (OK(dds_get_matched_publications(reader, &handle, 1)) != 1) return "";
  dds_builtintopic_endpoint_t* data = dds_get_matched_publication_data(reader, handle);
  void* user;
  std::size_t size;
  dds_qget_userdata(data->qos, &user, &size);
  const std::string text(static_cast<const char*>(user), size);
  dds_free(user);
  dds_builtintopic_free_endpoint(data);
  return text;
}

void Reader(Process& self) {
  const dds_entity_t reader = self.Reader(self.Topic());
  WaitForWriters(reader, 1);
  self.peer.Meet("matched");
  Event("%s", UserDataOfWriter(reader).c_str());
  self.peer.Reached("before told");
  WaitUntil("the user data change", [=] { return UserDataOfWriter(reader) == "after"; });
  Event("after");
  WaitForSample<1>(reader);
  TakeAndTell(reader, "reader");
}

}  // namespace

TCS_DDS_SCENARIO(changed_qos, Writer, Reader);
