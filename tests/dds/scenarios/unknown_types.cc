// A program that knows no type prints what another one writes: it finds the writer on the built-in
// topics, asks what its type is, and goes through the samples as the type object says.
#include <dds/dds.h>
#include <dds/ddsi/ddsi_xt_typeinfo.h>

#include <cstring>
#include <string>

#include "tests/dds/support/process.h"
#include "tests/dds/support/waits.h"
#include "unknown.h"

namespace {

using namespace dds_test;

Qos Lasting() { return Plain().TransientLocal(); }

void Writer(Process& self) {
  const dds_entity_t topic = self.Topic("a", &dds_unknown_Shape_desc);
  const dds_entity_t writer = self.Writer(topic, Lasting());
  const dds_entity_t unseen = self.Reader(self.Topic("b", &dds_unknown_Shape_desc));
  char triangle[] = "a triangle", line[] = "a line";
  dds_unknown_Point corners[] = {{0, 0}, {1.5, 0}, {0, -2}};
  const auto write = [&](char* name, dds_unknown_Colour colour, std::uint32_t count) {
    const dds_unknown_Shape shape{name, colour, {count, count, corners, false}};
    OK(dds_write(writer, &shape));
  };
  write(triangle, dds_unknown_GREEN, 3);
  self.peer.Meet("written");
  WaitForReaders(writer, 1);
  self.peer.Meet("matched");
  write(line, dds_unknown_RED, 2);
  self.peer.Meet("done");
  OK(dds_delete(unseen));
  self.peer.Meet("deleted");
}

// Texts of values as their types say. `at` is where a value lies, and goes behind it.
class Printer {
 public:
  explicit Printer(dds_entity_t participant) : participant_(participant) {}

  std::string Print(const DDS_XTypes_TypeIdentifier& type, const char*& at) const {
    switch (type._d) {
      case DDS_XTypes_TK_FLOAT64:
        return std::to_string(Next<double>(at));
      case DDS_XTypes_TI_STRING8_SMALL:
        return Next<const char*>(at);
      case DDS_XTypes_TI_PLAIN_SEQUENCE_SMALL: {
        const auto sequence = Next<dds_sequence_t>(at);
        std::string text;
        const char* element = reinterpret_cast<const char*>(sequence._buffer);
        for (std::uint32_t i = 0; i < sequence._length; i++) {
          text += (i > 0 ? ", " : "") + Print(*type._u.seq_sdefn.element_identifier, element);
        }
        return "[" + text + "]";
      }
      case DDS_XTypes_EK_COMPLETE:
        return PrintObject(type, at);
      default:
        Fail("a type of kind %u", type._d);
    }
  }

  dds_typeobj_t* ObjectOf(const DDS_XTypes_TypeIdentifier& type) const {
    dds_typeobj_t* object = nullptr;
    OK(dds_get_typeobj(participant_, reinterpret_cast<const dds_typeid_t*>(&type), DDS_SECS(2),
                       &object));
    return object;
  }

 private:
  template <class T>
  static T Next(const char*& at) {
    at += (alignof(T) - reinterpret_cast<std::uintptr_t>(at) % alignof(T)) % alignof(T);
    T value;
    memcpy(&value, at, sizeof value);
    at += sizeof value;
    return value;
  }

  std::string PrintObject(const DDS_XTypes_TypeIdentifier& type, const char*& at) const {
    dds_typeobj_t* object = ObjectOf(type);
    const auto& complete = reinterpret_cast<const DDS_XTypes_TypeObject*>(object)->_u.complete;
    std::string text;
    if (complete._d == DDS_XTypes_TK_ENUM) {
      const auto value = Next<std::int32_t>(at);
      const auto& literals = complete._u.enumerated_type.literal_seq;
      for (std::uint32_t i = 0; i < literals._length; i++) {
        if (literals._buffer[i].common.value == value) text = literals._buffer[i].detail.name;
      }
    } else if (complete._d == DDS_XTypes_TK_STRUCTURE) {
      const auto& members = complete._u.struct_type.member_seq;
      for (std::uint32_t i = 0; i < members._length; i++) {
        const auto& member = members._buffer[i];
        text += (i > 0 ? ", " : "") + std::string(member.detail.name) + " " +
                Print(member.common.member_type_id, at);
      }
      text = "{" + text + "}";
    }
    dds_free_typeobj(object);
    return text;
  }

  dds_entity_t participant_;
};

// Waits for an endpoint of that topic; the caller returns the loan.
dds_builtintopic_endpoint_t* Find(dds_entity_t reader, const char* topic) {
  dds_builtintopic_endpoint_t* found = nullptr;
  WaitUntil("it is on the built-in topic", [&] {
    void* sample[1] = {};
    dds_sample_info_t info;
    if (OK(dds_take(reader, sample, &info, 1, 1)) == 0) return false;
    auto* endpoint = static_cast<dds_builtintopic_endpoint_t*>(sample[0]);
    if (info.valid_data && strcmp(endpoint->topic_name, topic) == 0) {
      found = endpoint;
      return true;
    }
    OK(dds_return_loan(reader, sample, 1));
    return false;
  });
  return found;
}

void Reader(Process& self) {
  self.peer.Meet("written");
  const dds_entity_t publications =
      OK(dds_create_reader(self.participant, DDS_BUILTIN_TOPIC_DCPSPUBLICATION, nullptr, nullptr));
  const dds_entity_t subscriptions =
      OK(dds_create_reader(self.participant, DDS_BUILTIN_TOPIC_DCPSSUBSCRIPTION, nullptr, nullptr));
  void* reading = Find(subscriptions, "b");
  Event("a reader of type %s", static_cast<dds_builtintopic_endpoint_t*>(reading)->type_name);
  OK(dds_return_loan(subscriptions, &reading, 1));

  dds_builtintopic_endpoint_t* writing = Find(publications, "a");
  const dds_typeinfo_t* information = nullptr;
  OK(dds_builtintopic_get_endpoint_type_info(writing, &information));
  Event("a writer of type %s, type information: %s", writing->type_name,
        information != nullptr ? "yes" : "no");
  // Topics themselves are made known only where a configuration says so.
  for (const dds_find_scope_t scope : {DDS_FIND_SCOPE_LOCAL_DOMAIN, DDS_FIND_SCOPE_GLOBAL}) {
    Event("the topic itself: %s",
          Code(dds_find_topic(scope, self.participant, "a", information, DDS_MSECS(100))));
  }
  const dds_entity_t topics =
      OK(dds_create_reader(self.participant, DDS_BUILTIN_TOPIC_DCPSTOPIC, nullptr, nullptr));
  void* seen[1] = {};
  dds_sample_info_t info;
  Event("topics: %d", OK(dds_take(topics, seen, &info, 1, 1)));
  dds_topic_descriptor_t* descriptor = nullptr;
  OK(dds_create_topic_descriptor(DDS_FIND_SCOPE_GLOBAL, self.participant, information, DDS_SECS(5),
                                 &descriptor));
  const dds_entity_t topic =
      OK(dds_create_topic(self.participant, descriptor, "a", nullptr, nullptr));
  OK(dds_delete_topic_descriptor(descriptor));

  const Printer printer(self.participant);
  const DDS_XTypes_TypeIdentifier type =
      reinterpret_cast<const DDS_XTypes_TypeInformation*>(information)
          ->complete.typeid_with_size.type_id;
  const dds_entity_t reader = self.Reader(topic, Lasting());
  const auto print_next = [&] {
    WaitUntil("there is a sample", [&] {
      void* sample[1] = {};
      dds_sample_info_t info;
      if (OK(dds_take(reader, sample, &info, 1, 1)) == 0) return false;
      const char* at = static_cast<const char*>(sample[0]);
      Event("%s", printer.Print(type, at).c_str());
      OK(dds_return_loan(reader, sample, 1));
      return true;
    });
  };
  print_next();
  self.peer.Meet("matched");
  print_next();
  void* loan = writing;
  OK(dds_return_loan(publications, &loan, 1));
  self.peer.Meet("done");
  self.peer.Meet("deleted");
  WaitUntil("the reader is gone", [&] {
    void* sample[1] = {};
    dds_sample_info_t info;
    if (OK(dds_take(subscriptions, sample, &info, 1, 1)) == 0) return false;
    OK(dds_return_loan(subscriptions, sample, 1));
    return info.instance_state != DDS_IST_ALIVE;
  });
  Event("the reader is gone");
}

}  // namespace

TCS_DDS_SCENARIO(unknown_types, Writer, Reader);
