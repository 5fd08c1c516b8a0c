#include "coordinator/trace/csv_file.h"

#include <fmt/format.h>

#include <cerrno>
#include <charconv>

#include "coordinator/os/file_errors.h"

namespace tcs {

namespace {

constexpr std::size_t kNotedBytes = 64 << 10;
// From ten bytes noted to at most 24 characters and a comma.
constexpr std::size_t kMostGrowth = 3;

}  // namespace

CsvFile::~CsvFile() {
  if (file_ != nullptr) std::fclose(file_);
}

std::string CsvFile::Open(const std::string& path, std::string_view header) {
  path_ = path;
  file_ = std::fopen(path.c_str(), "we");
  if (file_ == nullptr) return CannotBeWritten(path);
  noted_.resize(kNotedBytes);
  // Each write holds whole lines and is in the file at once: a run that is killed leaves no half
  // lines.
  std::setvbuf(file_, nullptr, _IONBF, 0);
  const std::string line = std::string(header) + "\n";
  std::fwrite(line.data(), 1, line.size(), file_);
  return {};
}

void CsvFile::WriteNoted() {
  std::vector<char> text(kMostGrowth * used_);
  char* to = text.data();
  const char* at = noted_.data();
  const auto take = [&at](auto* what) {
    memcpy(what, at, sizeof *what);
    at += sizeof *what;
  };
  while (at < noted_.data() + used_) {
    Mark mark;
    take(&mark);
    if (mark == kLineEnd) {
      to[-1] = '\n';  // for the last comma
      continue;
    }
    if (mark == kNumber) {
      std::int64_t number;
      take(&number);
      to = std::to_chars(to, text.data() + text.size(), number).ptr;
    } else if (mark == kReal) {
      double number;
      take(&number);
      to = std::to_chars(to, text.data() + text.size(), number).ptr;
    } else {
      memcpy(to, at, mark);
      at += mark;
      to += mark;
    }
    *to++ = ',';
  }
  std::fwrite(text.data(), 1, static_cast<std::size_t>(to - text.data()), file_);
  used_ = 0;
}

void CsvFile::Flush() {
  if (file_ != nullptr && used_ > 0) WriteNoted();
}

std::string CsvFile::Close() {
  if (file_ == nullptr) return {};
  WriteNoted();
  const bool bad = std::ferror(file_) != 0;
  const bool closed = std::fclose(file_) == 0;
  file_ = nullptr;
  if (bad || !closed) return NotWrittenWhole(path_);
  return {};
}

}  // namespace tcs
