#include "tests/dds/soak/writer.h"

#include <time.h>

#include <algorithm>

#include "tests/dds/support/events.h"
#include "tests/dds/support/waits.h"

namespace dds_soak {

Writer::Writer(dds_entity_t participant, const Flow& flow, int process, std::uint64_t total)
    : flow_(flow), process_(process), of_each_(SamplesOfEach(flow, total)) {
  const dds_entity_t topic =
      OK(dds_create_topic(participant, &dds_soak_Sample_desc, flow.name, nullptr, nullptr));
  entity_ = OK(dds_create_writer(participant, topic, flow.writer_qos.get(), nullptr));
}

void Writer::AwaitReaders() const {
  const auto at_first = std::ranges::count(flow_.readers, false, &ReadBy::comes_late);
  dds_test::WaitForReaders(entity_, static_cast<std::uint32_t>(at_first));
}

void Writer::WriteAll() const {
  for (std::uint32_t number = 0; number < of_each_; ++number) {
    const auto payload = PayloadOf(flow_, process_, number);
    const auto size = static_cast<std::uint32_t>(payload.size());
    timespec t;
    clock_gettime(CLOCK_REALTIME, &t);
    const Sample sample{KeyOf(flow_, process_, number),
                        process_,
                        number,
                        t.tv_sec * DDS_NSECS_IN_SEC + t.tv_nsec,
                        {size, size, const_cast<std::uint8_t*>(payload.data()), false}};
    if (flow_.disposes_every != 0 && number % flow_.disposes_every == flow_.disposes_every - 1) {
      OK(dds_writedispose(entity_, &sample));
    } else {
      OK(dds_write(entity_, &sample));
    }
    if (flow_.at_once != 0 && number % flow_.at_once == flow_.at_once - 1) {
      dds_sleepfor(flow_.pause);
    }
  }
}

}  // namespace dds_soak
