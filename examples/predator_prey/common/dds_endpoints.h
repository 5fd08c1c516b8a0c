// Topics, and their readers and writers, of messages that idlc has compiled to C. All endpoints are
// reliable and keep the last sample: only the newest counts here.
//
// Everything is for one thread, is deleted with its owner, before its participant, and throws
// std::runtime_error when DDS refuses.
#pragma once

#include <memory>
#include <string>
#include <utility>

#include "examples/predator_prey/common/dds_entity.h"

namespace predator_prey {

template <class Message>
class Topic : public DdsEntity {
 public:
  // `type` is the descriptor of Message.
  Topic(const DdsEntity& participant, const dds_topic_descriptor_t& type, const std::string& name)
      : DdsEntity(dds_create_topic(participant.handle(), &type, name.c_str(), nullptr, nullptr),
                  "make the topic " + name) {}
};

namespace internal {

DdsEntity CreateReader(const DdsEntity& topic);
DdsEntity CreateWriter(const DdsEntity& topic);
void* TakeLoan(const DdsEntity& reader);

}  // namespace internal

// A sample that a reader has lent; it is given back with its owner, before the reader goes.
struct ReturnLoan {
  dds_entity_t reader = 0;
  void operator()(const void* sample) const {
    void* samples[] = {const_cast<void*>(sample)};
    dds_return_loan(reader, samples, 1);
  }
};
template <class Message>
using Loan = std::unique_ptr<const Message, ReturnLoan>;

template <class Message>
class Reader {
 public:
  explicit Reader(Topic<Message> topic)
      : topic_(std::move(topic)),
        reader_(internal::CreateReader(topic_)),
        has_samples_(dds_create_readcondition(reader_.handle(), DDS_ANY_STATE),
                     "make a read condition") {}

  // Takes the newest sample; none when none has come since the last call.
  Loan<Message> TakeNewest() {
    return Loan<Message>(static_cast<const Message*>(internal::TakeLoan(reader_)),
                         ReturnLoan{reader_.handle()});
  }

  // Whether there is anybody who writes for this reader.
  bool IsMatched() const {
    dds_subscription_matched_status_t status{};
    CheckDds(dds_get_subscription_matched_status(reader_.handle(), &status), "ask for writers");
    return status.current_count > 0;
  }

  // Triggered as long as there is something to take: for waitsets.
  const DdsEntity& has_samples() const { return has_samples_; }

 private:
  Topic<Message> topic_;
  DdsEntity reader_;
  DdsEntity has_samples_;
};

template <class Message>
class Writer {
 public:
  explicit Writer(Topic<Message> topic)
      : topic_(std::move(topic)), writer_(internal::CreateWriter(topic_)) {}

  void Write(const Message& message) {
    const dds_return_t result = dds_write(writer_.handle(), &message);
    // A reader that does not keep up misses this one; the next sample makes up for it.
    if (result != DDS_RETCODE_TIMEOUT) CheckDds(result, "write a sample");
  }

  // Whether there is anybody who reads what this writer writes.
  bool IsMatched() const {
    dds_publication_matched_status_t status{};
    CheckDds(dds_get_publication_matched_status(writer_.handle(), &status), "ask for readers");
    return status.current_count > 0;
  }

 private:
  Topic<Message> topic_;
  DdsEntity writer_;
};

}  // namespace predator_prey
