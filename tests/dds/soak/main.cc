// Four processes that all write and read topics of many kinds of QoS: nothing is lost that must
// come, nothing comes early, what a writer writes stays in order.
//   dds_soak PROCESS SAMPLES
// PROCESS is 0 to 3; the four together write SAMPLES. Prints what each of its readers has seen.
// The variable TCS_DDS_DOMAIN is the domain to use, 0 without it.
#include <stdlib.h>

#include <algorithm>
#include <list>
#include <set>
#include <thread>
#include <utility>
#include <vector>

#include "tests/dds/soak/reader.h"
#include "tests/dds/soak/writer.h"
#include "tests/dds/support/events.h"
#include "tests/dds/support/waits.h"

namespace dds_soak {
namespace {

using dds_test::Fail;
using dds_test::Qos;

// How far the processes are, told by DDS itself.
class Stages {
 public:
  Stages(dds_entity_t participant, int process) : process_(process) {
    const dds_entity_t topic =
        OK(dds_create_topic(participant, &dds_soak_Mark_desc, "stages", nullptr, nullptr));
    const Qos qos = Qos().Reliable().KeepAll().TransientLocal();
    reader_ = OK(dds_create_reader(participant, topic, qos.get(), nullptr));
    writer_ = OK(dds_create_writer(participant, topic, qos.get(), nullptr));
  }
  dds_entity_t reader() const { return reader_; }

  void Reached(int stage) {
    const Mark mark{process_, stage};
    OK(dds_write(writer_, &mark));
  }
  // All processes have reached it, as far as is known here.
  bool AllReached(int stage) {
    Mark mark;
    void* samples[] = {&mark};
    dds_sample_info_t info;
    while (OK(dds_take(reader_, samples, &info, 1, 1)) == 1) {
      if (info.valid_data) reached_.insert({mark.stage, mark.process});
    }
    const auto first = reached_.lower_bound({stage, 0});
    return std::distance(first, reached_.lower_bound({stage + 1, 0})) == kProcesses;
  }
  void Await(int stage) {
    while (!AllReached(stage)) dds_test::WaitForTrigger(reader_);
  }

 private:
  int process_;
  dds_entity_t reader_, writer_;
  std::set<std::pair<int, int>> reached_;
};

class Program {
 public:
  Program(int process, std::uint64_t total, dds_domainid_t domain)
      : process_(process),
        total_(total),
        participant_(OK(dds_create_participant(domain, nullptr, nullptr))),
        waits_(OK(dds_create_waitset(participant_))),
        done_(OK(dds_create_guardcondition(participant_))),
        stages_(participant_, process) {
    Attach(stages_.reader());
    OK(dds_waitset_attach(waits_, done_, done_));
    for (const Flow& flow : Flows()) {
      if (Writes(flow, process)) writers_.emplace_back(participant_, flow, process, total);
    }
    MakeReaders(false);
  }
  ~Program() {
    readers_.clear();
    OK(dds_delete(participant_));
  }
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  void Run() {
    for (const Writer& writer : writers_) writer.AwaitReaders();
    stages_.Reached(kMatched);
    stages_.Await(kMatched);
    std::vector<std::thread> threads;
    for (const Writer& writer : writers_) threads.emplace_back([&writer] { writer.WriteAll(); });
    std::thread ends([this, &threads] {
      for (std::thread& thread : threads) thread.join();
      stages_.Reached(kWritten);
    });
    bool late = !HasLateReaders();
    while (!HasAll() || !late) {
      if (OK(dds_waitset_wait(waits_, nullptr, 0, dds_test::kPatience)) == 0)
        Fail("nothing comes any more");
      for (Reader& reader : readers_) {
        if (!reader.listens()) reader.Take();
      }
      stages_.AllReached(kWritten);
      if (!late && IsUnderWay()) {
        late = true;
        MakeReaders(true);
      }
    }
    ends.join();
    // What has been sent without a promise has had its chance.
    stages_.Await(kWritten);
    for (Reader& reader : readers_) {
      if (!reader.listens()) reader.Take();
    }
    for (Reader& reader : readers_) reader.Conclude();
    // Nobody's writers go while others still read.
    stages_.Reached(kRead);
    stages_.Await(kRead);
  }

 private:
  static constexpr int kMatched = 1, kWritten = 2, kRead = 3;

  void Attach(dds_entity_t reader) {
    OK(dds_set_status_mask(reader, DDS_DATA_AVAILABLE_STATUS));
    OK(dds_waitset_attach(waits_, reader, reader));
  }

  void MakeReaders(bool late) {
    for (const Flow& flow : Flows()) {
      for (const ReadBy& how : flow.readers) {
        if (how.process != process_ || how.comes_late != late) continue;
        Reader& reader = readers_.emplace_back(participant_, flow, how, total_, done_);
        if (!how.listens) Attach(reader.entity());
      }
    }
  }

  bool HasLateReaders() const {
    return std::ranges::any_of(Flows(), [this](const Flow& flow) {
      return std::ranges::any_of(flow.readers, [this](const ReadBy& how) {
        return how.process == process_ && how.comes_late;
      });
    });
  }

  bool HasAll() const {
    for (const Reader& reader : readers_) {
      if (!reader.HasAll()) return false;
    }
    return true;
  }

  bool IsUnderWay() const {
    std::uint64_t taken = 0;
    for (const Reader& reader : readers_) taken += reader.taken();
    return taken >= total_ / 20;
  }

  int process_;
  std::uint64_t total_;
  dds_entity_t participant_, waits_, done_;
  Stages stages_;
  std::list<Writer> writers_;
  std::list<Reader> readers_;
};

int Main(int argc, char** argv) {
  const int process = argc == 3 ? atoi(argv[1]) : -1;
  const long long total = argc == 3 ? atoll(argv[2]) : 0;
  if (process < 0 || process >= kProcesses || total < 1000) {
    fprintf(stderr, "usage: %s PROCESS SAMPLES, a process from 0 to 3, at least 1000 samples\n",
            argv[0]);
    return 2;
  }
  const char* domain = getenv("TCS_DDS_DOMAIN");
  Program program(process, static_cast<std::uint64_t>(total),
                  domain == nullptr ? 0u : static_cast<dds_domainid_t>(atoi(domain)));
  program.Run();
  return 0;
}

}  // namespace
}  // namespace dds_soak

int main(int argc, char** argv) { return dds_soak::Main(argc, argv); }
