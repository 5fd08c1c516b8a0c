#include "coordinator/trace/csv_file.h"

#include <fmt/format.h>

#include <cerrno>
#include <charconv>

namespace tcs {

namespace {

constexpr std::size_t kNotedBytes = 64 << 10;

}  // namespace

CsvFile::~CsvFile() {
  if (file_ != nullptr) std::fclose(file_);
}

std::string CsvFile::Open(const std::string& path, std::string_view header) {
  path_ = path;
  file_ = std::fopen(path.c_str(), "we");
  if (file_ == nullptr) return fmt::format("{} cannot be written: {}", path, strerror(errno));
  noted_.resize(kNotedBytes);
  fmt::print(file_, "{}\n", header);
  return {};
}

void CsvFile::WriteNoted() {
  std::string text;
  text.reserve(2 * used_);
  const char* at = noted_.data();
  const auto take = [&at](auto* to) {
    memcpy(to, at, sizeof *to);
    at += sizeof *to;
  };
  while (at < noted_.data() + used_) {
    Mark mark;
    take(&mark);
    if (mark == kLineEnd) {
      text.back() = '\n';  // for the last comma
      continue;
    }
    if (mark == kNumber) {
      std::int64_t number;
      take(&number);
      char digits[24];
      text.append(digits, std::to_chars(digits, digits + sizeof digits, number).ptr);
    } else {
      text.append(at, mark);
      at += mark;
    }
    text += ',';
  }
  std::fwrite(text.data(), 1, text.size(), file_);
  used_ = 0;
}

std::string CsvFile::Close() {
  if (file_ == nullptr) return {};
  WriteNoted();
  const bool bad = std::ferror(file_) != 0;
  const bool closed = std::fclose(file_) == 0;
  file_ = nullptr;
  if (bad || !closed) return fmt::format("{} was not written whole: {}", path_, strerror(errno));
  return {};
}

}  // namespace tcs
