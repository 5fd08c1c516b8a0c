#include "coordinator/report/read_said.h"

#include <algorithm>
#include <map>
#include <optional>
#include <string_view>
#include <utility>

#include "coordinator/text/csv.h"

namespace tcs::report {
namespace {

constexpr std::size_t kLongest = 200;
constexpr std::string_view kMark = "mark:";

std::string_view Trimmed(std::string_view text) {
  while (!text.empty() && (text.back() == '\r' || text.back() == ' ')) text.remove_suffix(1);
  return text;
}

}  // namespace

std::optional<Said> SaidOf(std::int64_t time_us, const std::string& client,
                           const std::string& stream, std::string_view line) {
  line = Trimmed(line);
  if (line.empty()) return {};
  const bool is_mark = line.starts_with(kMark);
  if (is_mark) {
    line.remove_prefix(kMark.size());
    while (line.starts_with(' ')) line.remove_prefix(1);
  }
  return Said{time_us, client, stream, std::string(line.substr(0, kLongest)), is_mark};
}

std::string SaidFile(const std::string& folder, std::string client, const std::string& stream) {
  std::replace(client.begin(), client.end(), '/', '-');
  return folder + "/" + client + "." + stream + ".log";
}

namespace {

class SaidReader {
 public:
  SaidReader(const std::string& folder, Replay* replay) : folder_(folder), replay_(*replay) {}

  bool Take(const CsvFields& fields) {
    const auto time = ToInteger(fields[0]);
    const auto begin = ToInteger(fields[3]), end = ToInteger(fields[4]);
    if (!time || !begin || !end || *begin < 0 || *begin > *end) return false;
    Stream& stream = StreamOf(std::string(fields[1]), std::string(fields[2]));
    if (!stream.text) return false;
    const auto until = std::min(static_cast<std::size_t>(*end), stream.text->size());
    stream.time_us = *time / 1000;
    // A line counts from when its end was there.
    for (;;) {
      const std::size_t line_end = stream.text->find('\n', stream.done);
      if (line_end >= until) return true;
      Add(stream, std::string_view(*stream.text).substr(stream.done, line_end - stream.done));
      stream.done = line_end + 1;
    }
  }

  // Takes the text that was written last without an end of line.
  void TakeRests() {
    for (auto& [name, stream] : streams_) {
      if (stream.text) Add(stream, std::string_view(*stream.text).substr(stream.done));
    }
    CutShort();
    std::stable_sort(replay_.said.begin(), replay_.said.end(),
                     [](const Said& a, const Said& b) { return a.time_us < b.time_us; });
  }

 private:
  struct Stream {
    std::string client, name;
    std::optional<std::string> text;
    std::size_t done = 0;
    std::int64_t time_us = 0;
  };

  Stream& StreamOf(const std::string& client, const std::string& name) {
    const auto [place, is_new] = streams_.try_emplace({client, name});
    Stream& stream = place->second;
    if (!is_new) return stream;
    stream.client = client;
    stream.name = name;
    stream.text = ReadFile(SaidFile(folder_, client, name));
    return stream;
  }

  // All clients have the same room.
  void CutShort() {
    const std::size_t of_each =
        kMostSaidLines / std::max<std::size_t>(1, counts_.size() - counts_.count(""));
    std::map<std::string, std::size_t> kept;
    const std::size_t all = std::erase_if(replay_.said, [&](const Said& line) {
      return ++kept[line.is_mark ? "" : line.client] > (line.is_mark ? kMostSaidMarks : of_each);
    });
    replay_.said_more = static_cast<std::int64_t>(all);
  }

  void Add(const Stream& stream, std::string_view line) {
    auto said = SaidOf(stream.time_us, stream.client, stream.name, line);
    if (!said) return;
    ++counts_[said->is_mark ? "" : stream.client];
    replay_.said.push_back(std::move(*said));
  }

  const std::string folder_;
  Replay& replay_;
  std::map<std::pair<std::string, std::string>, Stream> streams_;
  std::map<std::string, std::size_t> counts_;
};

}  // namespace

void ReadSaid(const std::string& folder, Replay* replay) {
  const std::string path = folder + "/output.csv";
  if (!IsFile(path)) return;
  SaidReader reader(folder, replay);
  // Lines that are of no use tell of text that is not there.
  static_cast<void>(ReadCsv(path, {"time_ns", "client", "stream", "begin", "end"},
                            [&](const CsvFields& fields) { return reader.Take(fields); }));
  reader.TakeRests();
}

}  // namespace tcs::report
