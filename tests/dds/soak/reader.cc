#include "tests/dds/soak/reader.h"

#include <inttypes.h>
#include <string.h>
#include <time.h>

#include <algorithm>

#include "tests/dds/support/events.h"

namespace dds_soak {
namespace {

using dds_test::Event;
using dds_test::Fail;

constexpr int kAtOnce = 256;

std::int64_t RealTime() {
  timespec t;
  clock_gettime(CLOCK_REALTIME, &t);
  return t.tv_sec * DDS_NSECS_IN_SEC + t.tv_nsec;
}

// Times are counted from a moment that all runs have, whenever they are made.
std::int64_t Origin() {
  static const std::int64_t origin = [] {
    timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return RealTime() - (t.tv_sec * DDS_NSECS_IN_SEC + t.tv_nsec);
  }();
  return origin;
}

}  // namespace

Reader::Reader(dds_entity_t participant, const Flow& flow, const ReadBy& how, std::uint64_t total,
               dds_entity_t done)
    : flow_(flow), how_(how), of_each_(SamplesOfEach(flow, total)), done_(done) {
  const auto keys = static_cast<std::uint32_t>(flow.keys);
  for (int writer = 0; writer < kProcesses; ++writer) {
    if (!Writes(flow, writer)) continue;
    for (std::uint32_t first = 0; first < std::min(keys, of_each_); ++first) {
      const std::uint32_t more = (of_each_ - 1 - first) / keys;
      streams_[{writer, KeyOf(flow, writer, first)}] = {first, first + more * keys};
      if (how.promise == Promise::kAll) missing_ += more + 1;
      if (how.promise == Promise::kLast) missing_ += 1;
    }
  }
  Origin();
  const dds_entity_t topic =
      OK(dds_create_topic(participant, &dds_soak_Sample_desc, flow.name, nullptr, nullptr));
  dds_listener_t* listener = how.listens ? dds_create_listener(this) : nullptr;
  if (how.listens) {
    dds_lset_data_available(listener, [](dds_entity_t reader, void* argument) {
      Reader& self = *static_cast<Reader*>(argument);
      self.TakeFrom(reader);
      if (self.HasAll()) OK(dds_set_guardcondition(self.done_, true));
    });
  }
  entity_ = OK(dds_create_reader(participant, topic, how.qos.get(), listener));
  dds_delete_listener(listener);
}

Reader::~Reader() { OK(dds_delete(entity_)); }

void Reader::TakeFrom(dds_entity_t reader) {
  void* samples[kAtOnce];
  dds_sample_info_t infos[kAtOnce];
  for (;;) {
    samples[0] = nullptr;
    const int count = OK(dds_take(reader, samples, infos, kAtOnce, kAtOnce));
    const std::int64_t now_ns = RealTime();
    for (int i = 0; i < count; ++i) {
      Check(*static_cast<const Sample*>(samples[i]), infos[i], now_ns);
    }
    if (count > 0) OK(dds_return_loan(reader, samples, count));
    if (count < kAtOnce) return;
  }
}

void Reader::Fold(std::uint64_t value) { digest_ = (digest_ ^ value) * 1099511628211u; }

void Reader::Check(const Sample& sample, const dds_sample_info_t& info, std::int64_t now_ns) {
  const auto late_ns = now_ns - info.source_timestamp;
  if (late_ns < 0)
    Fail("%s: a sample was there %" PRId64 " ns before its write", flow_.name, -late_ns);
  Fold(static_cast<std::uint64_t>(now_ns - Origin()));
  Fold(static_cast<std::uint64_t>(info.source_timestamp - Origin()));
  Fold(static_cast<std::uint64_t>(sample.key));
  Fold(info.instance_state | static_cast<std::uint64_t>(info.view_state) << 8 |
       static_cast<std::uint64_t>(info.valid_data) << 16);
  Fold(static_cast<std::uint64_t>(info.disposed_generation_count) << 32 |
       info.no_writers_generation_count);
  if (info.instance_state != DDS_IST_ALIVE) ++ended_;
  if (!info.valid_data) return;
  Fold(static_cast<std::uint64_t>(sample.writer) << 32 | sample.number);
  longest_ns_ = std::max(longest_ns_, late_ns);
  ++taken_;
  if (info.source_timestamp < sample.written_ns)
    Fail("%s: a source timestamp is older than the sample", flow_.name);
  const auto found = streams_.find({sample.writer, sample.key});
  if (found == streams_.end())
    Fail("%s: nobody writes key %d as writer %d", flow_.name, sample.key, sample.writer);
  Stream& stream = found->second;
  const auto keys = static_cast<std::uint32_t>(flow_.keys);
  const std::uint32_t number = sample.number;
  if (number < stream.next || number > stream.last || (number - stream.next) % keys != 0)
    Fail("%s: of writer %d, %u came in place of %u", flow_.name, sample.writer, number,
         stream.next);
  const std::uint32_t skipped = (number - stream.next) / keys;
  if (skipped > 0 && how_.promise == Promise::kAll)
    Fail("%s: of writer %d, %u are lost before %u", flow_.name, sample.writer, skipped, number);
  skipped_ += skipped;
  stream.next = number + keys;
  const auto wanted = PayloadOf(flow_, sample.writer, number);
  if (sample.payload._length != wanted.size() ||
      (!wanted.empty() && memcmp(sample.payload._buffer, wanted.data(), wanted.size()) != 0))
    Fail("%s: sample %u of writer %d is not as it was written", flow_.name, number, sample.writer);
  if (how_.promise == Promise::kAll || (how_.promise == Promise::kLast && number == stream.last))
    --missing_;
}

void Reader::Conclude() {
  if (missing_ != 0) Fail("%s: %" PRIu64 " samples are lost", flow_.name, missing_.load());
  dds_sample_lost_status_t lost;
  OK(dds_get_sample_lost_status(entity_, &lost));
  if (how_.promise == Promise::kAll && lost.total_count != 0)
    Fail("%s: the reader says that it has lost %u samples", flow_.name, lost.total_count);
  for (const auto& [from, stream] : streams_)
    if (stream.next <= stream.last)
      skipped_ += (stream.last - stream.next) / static_cast<std::uint32_t>(flow_.keys) + 1;
  Event("%-8s read %8" PRIu64 "  not seen %7" PRIu64 "  ends %5" PRIu64
        "  longest %9.3f ms  digest %016" PRIx64,
        flow_.name, taken_.load(), skipped_, ended_, static_cast<double>(longest_ns_) * 1e-6,
        digest_);
}

}  // namespace dds_soak
