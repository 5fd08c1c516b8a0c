#include "coordinator/report/said_tail.h"

#include <algorithm>
#include <fstream>
#include <utility>

#include "coordinator/report/read_said.h"

namespace tcs::report {

namespace {

// The most that is read of what a client writes at one time.
constexpr std::size_t kMostAtOnce = 1 << 20;

}  // namespace

SaidTail::SaidTail(std::string folder)
    : folder_(std::move(folder)),
      table_(folder_ + "/output.csv", {"time_ns", "client", "stream", "begin", "end"}, 5) {}

void SaidTail::Look(Replay* replay) {
  // A new run has new tables, and is noticed by the first of them.
  static_cast<void>(table_.Look([&](const CsvFields& fields) {
    Take(fields, replay);
    return CsvTail::Taken::kYes;
  }));
}

void SaidTail::Take(const CsvFields& fields, Replay* replay) {
  const auto time = ToInteger(fields[0]), end = ToInteger(fields[4]);
  const std::string client(fields[1]), name(fields[2]);
  Stream& stream = streams_[{client, name}];
  if (!time || !end || *end <= static_cast<std::int64_t>(stream.read)) return;
  std::string text(std::min(static_cast<std::size_t>(*end) - stream.read, kMostAtOnce), '\0');
  std::ifstream file(SaidFile(folder_, client, name), std::ios::binary);
  file.seekg(static_cast<std::streamoff>(stream.read));
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(file.gcount()));
  stream.read = static_cast<std::size_t>(*end);
  stream.begun += text;
  std::size_t begin = 0;
  for (std::size_t at; (at = stream.begun.find('\n', begin)) != std::string::npos; begin = at + 1) {
    auto said = SaidOf(*time / 1000, client, name,
                       std::string_view(stream.begun).substr(begin, at - begin));
    if (!said) continue;
    std::size_t& count = said->is_mark ? marks_ : lines_;
    if (count >= (said->is_mark ? kMostSaidMarks : kMostSaidLines)) {
      ++replay->said_more;
      continue;
    }
    ++count;
    replay->said.push_back(std::move(*said));
  }
  stream.begun.erase(0, begin);
}

}  // namespace tcs::report
